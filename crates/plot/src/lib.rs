//! Results as SVG drawings: pure functions from [`rubmap_analysis::result`] to text, without files, fonts or HTTP.
//!
//! Texts name common font families and leave the choice to the viewer; nothing is measured. Amplitudes are embedded
//! as one small image with a palette, at a fixed resolution, so that the size of a drawing does not grow with the
//! sweep; everything else stays vectors. Marks carry a `<title>`, which browsers show under the pointer.
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
//! let drawing = rubmap_plot::histories(&histories, 0);
//! assert!(drawing.contains("<svg") && drawing.contains("6,000 rpm") && drawing.contains("displacement, mm"));
//! # Ok::<(), serde_json::Error>(())
//! ```

mod axis;
mod campbell;
mod cells;
mod colour;
mod diagram;
mod heading;
mod heat;
mod histories;
mod interaction_map;
mod key;
mod level;
mod marks;
pub mod report;
mod scheme;
mod settling_strip;
mod svg;
#[cfg(test)]
mod tests;
mod work_precision;

pub use campbell::campbell;
pub use histories::histories;
pub use interaction_map::{VerticalAxis, interaction_map};
pub use work_precision::work_precision;
