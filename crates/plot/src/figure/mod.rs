//! Results as figures for Plotly, which a page shows and a reader zooms: pure functions from [`rubmap_analysis::result`] to [`Figure`].
//!
//! What is shown, its words and its verdicts are those of the drawings beside this folder. A figure has no more lines, samples and cells
//! than a screen shows; of cells and samples that are one then, the largest is kept, and the figure says so.

mod amplitudes;
mod campbell;
mod cells;
mod critical_speeds;
mod document;
mod interaction_map;
mod level;
mod marks;
mod palette;
mod spectrum;
mod text;

pub use campbell::campbell;
pub use critical_speeds::critical_speeds;
pub use document::Figure;
pub use interaction_map::interaction_map;
pub use spectrum::spectrum;
