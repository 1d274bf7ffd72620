//! Results as SVG drawings: pure functions from [`rubmap_analysis::result`] to text, without files, fonts or HTTP.
//!
//! Texts name common font families and leave the choice to the viewer; nothing is measured. Amplitudes are embedded
//! as one small image with a palette, at a fixed resolution, so that the size of a drawing does not grow with the
//! sweep; everything else stays vectors. Marks carry a `<title>`, which browsers show under the pointer.

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
