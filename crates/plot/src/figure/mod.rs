//! Results as figures for Plotly, which a page shows and a reader zooms: pure functions from [`rubmap_analysis::result`] to [`Figure`].
//!
//! Content, words and verdicts of a figure are those of the drawings beside this folder. A figure has no more lines, samples and cells than
//! a screen shows; of merged cells and samples the largest is drawn, and the figure says so.

mod amplitudes;
mod attributes;
mod branches;
mod campaign;
mod campbell;
mod campbell_fixed_frame;
mod cells;
mod critical_speeds;
mod document;
mod error_over_step;
mod force_map;
mod haigh;
mod histories;
mod interaction_map;
mod level;
mod map_sheet;
mod marched;
mod marks;
mod palette;
mod run_ups;
mod section;
mod spectrogram;
mod spectrum;
mod speed_histories;
mod text;
mod thinned;
mod trajectories;
mod wear_map;
mod work_precision;

pub use branches::branches;
pub use campaign::campaign;
pub use campbell::campbell;
pub use campbell_fixed_frame::campbell_fixed_frame;
pub use critical_speeds::critical_speeds;
pub use document::Figure;
pub use error_over_step::error_over_step;
pub use force_map::force_map;
pub use haigh::haigh;
pub use histories::histories;
pub use interaction_map::{fixed_frame_map, interaction_map};
pub use map_sheet::map_sheet;
pub use run_ups::run_ups;
pub use section::section;
pub use spectrogram::spectrogram;
pub use spectrum::spectrum;
pub use speed_histories::speed_histories;
pub use trajectories::trajectories;
pub use wear_map::wear_map;
pub use work_precision::work_precision;
