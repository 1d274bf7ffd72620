//! Results as figures for Plotly, which a page shows and a reader zooms: pure functions from [`rubmap_analysis::result`] to [`Figure`].
//!
//! Content, words and verdicts of a figure are those of the drawings beside this folder. A figure has no more lines, samples and cells than
//! a screen shows; of merged cells and samples the largest is drawn, and the figure says so.

mod attributes;
mod cells;
mod document;
mod heat;
mod marks;
pub(crate) mod sketched;
mod text;
mod thinned;

pub use document::Figure;
