//! Fields of the whole wheel or of one sector: displacement and stress of every node, of modes, deflection shapes and instants.
//!
//! ```text
//! u_s(φ) = Re Σ_i e^{jisα} Σ_c a_c(φ) Υ̂_i x_i,c
//! ```
//!
//! with the columns x_i,c of nodal diameter i in the coordinates of the reduction and the weights a_c of a frame. Only the products Υ̂_i x_i
//! are held, never the basis.

mod error;
mod excluded;
mod field;
mod modes;
mod points;
mod sector;
mod states;
mod surface;
mod tensor;

pub use error::FieldError;
pub use excluded::Excluded;
pub use field::{BasisProduct, Field, Frame};
pub use modes::{ModeRequest, Motion, ShapeFrequencies, mode_field, mode_frequencies};
pub use points::{Points, skin_faces};
pub use sector::{FieldSector, Part};
pub use states::{deflection_shape, instants, largest_instant};
pub use surface::surface;
pub use tensor::{principal, von_mises};
