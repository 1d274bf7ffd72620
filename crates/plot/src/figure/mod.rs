//! Results as figures for Plotly, which a page shows and a reader zooms: pure functions from [`rubmap_analysis::result`] to [`Figure`].
//!
//! Content, words and verdicts of a figure are those of the drawings beside this folder. A figure has no more lines, samples and cells than
//! a screen shows; of merged cells and samples the largest is drawn, and the figure says so.

mod amplitudes;
mod attributes;
mod cells;
mod document;
mod interaction_map;
mod level;
mod map_sheet;
mod marks;
mod palette;
pub(crate) mod sketched;
mod text;
mod thinned;

pub use document::Figure;
pub(super) use interaction_map::{fixed_frame_map, interaction_map};
pub(super) use map_sheet::map_sheet;
