//! Results as drawings: pure functions from [`rubmap_analysis::result`] to [`Drawing`], without files or HTTP, which is written as SVG or
//! as a figure for Plotly; and from SVG to PNG ([`png()`]).
//!
//! Texts name common font families and leave the choice to the viewer; how wide they are is estimated, to keep labels apart. An image
//! has the font that the program brings, so that it is the same on every machine. Amplitudes are embedded as one small image with a
//! palette, at a fixed resolution, so that the size of a drawing does not grow with the sweep; everything else stays vectors. Marks
//! carry a `<title>`, which browsers show under the pointer. Keys explain what is drawn, and nothing else.
//!
//! Results come from a run, or from the JSON that the service answers:
//!
//! ```
//! use rubmap_analysis::result::Histories;
//! use serde_json::json;
//!
//! // A blade tip that swings out and back three times in a revolution.
//! let swing = |sample: u32| (std::f64::consts::TAU * 3.0 * f64::from(sample) / 60.0).sin();
//! let histories: Histories = serde_json::from_value(json!({
//!     "speed_rad_s": 200.0 * std::f64::consts::PI,
//!     "sensors": [{"contact_node": 0, "sector": 0, "component": "radial"}],
//!     "samples_per_revolution": 60,
//!     "lines": [{
//!         "modes_per_speed": 10, "kept_modes": "auto", "scheme": "exact_modal", "steps_per_revolution": 3600,
//!         "reference": true, "unknowns": 120, "displacement": [(1..=60).map(swing).collect::<Vec<_>>()],
//!     }],
//!     "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
//!     "version": "0.1.0",
//! }))?;
//! let drawing = rubmap_plot::histories(&histories, 0).svg();
//! assert!(drawing.contains("<svg") && drawing.contains("6,000 rpm") && drawing.contains("displacement, mm"));
//! # Ok::<(), serde_json::Error>(())
//! ```

mod around;
mod axis;
mod backbones;
mod branch_line;
mod branches;
mod campaign;
mod campaign_difference;
mod campbell;
mod campbell_fixed_frame;
mod cells;
mod colour;
mod colour_bar;
mod critical_speeds;
mod diagram;
mod drawing;
mod error_over_step;
mod figure;
mod force_map;
mod frame;
mod haigh;
mod hatching;
mod heading;
mod heat;
mod histories;
mod interaction_map;
mod interference;
mod key;
mod labels;
mod layer;
mod level;
mod map_lines;
mod map_sheet;
mod map_view;
mod marched;
mod margin;
mod marks;
mod merged;
mod pen;
mod pixels;
mod raster;
pub mod report;
mod run_up_line;
mod run_up_rates;
mod run_up_words;
mod run_ups;
mod run_ups_view;
mod scheme;
mod section;
mod sectors;
mod settling_strip;
mod sketch;
mod spectrogram;
mod spectrogram_cells;
mod spectrogram_strips;
mod spectrogram_view;
mod spectrum;
mod speed_histories;
mod study_runs;
mod style;
mod surface;
mod svg;
#[cfg(test)]
mod tests;
mod trace;
mod trajectories;
mod validity;
mod wear_map;
mod wheel_level;
mod window;
mod work_precision;

pub use around::around;
pub use backbones::backbones;
pub use branches::branches;
pub use campaign::campaign;
pub use campbell::campbell;
pub use campbell_fixed_frame::campbell_fixed_frame;
pub use critical_speeds::critical_speeds;
pub use drawing::Drawing;
pub use error_over_step::error_over_step;
pub use figure::Figure;
pub use force_map::{ForceQuantity, force_map};
pub use frame::Frame;
pub use haigh::{HaighColour, haigh};
pub use histories::histories;
pub use interaction_map::{fixed_frame_map, interaction_map};
pub use interference::interference;
pub use level::LevelColour;
pub use map_sheet::map_sheet;
pub use map_view::VerticalAxis;
pub use raster::{PngError, WIDTHS, png};
pub use run_ups::run_ups;
pub use section::{SectionView, section};
pub use spectrogram::spectrogram;
pub use spectrogram_view::SpectrogramUnit;
pub use spectrum::spectrum;
pub use speed_histories::{HistoryQuantity, speed_histories};
pub use surface::{SurfaceView, surface};
pub use trajectories::trajectories;
pub use wear_map::wear_map;
pub use wheel_level::wheel_level;
pub use window::Window;
pub use work_precision::work_precision;
