//! What computations return: numbers with their credentials.

pub mod campbell;
pub mod choice;
pub mod errors;
pub mod plan;
pub mod point;
pub mod reduction;
pub mod refinement;
pub mod study;
pub mod sweep;
pub mod trial;

pub use campbell::*;
pub use choice::*;
pub use errors::*;
pub use plan::*;
pub use point::*;
pub use reduction::*;
pub use refinement::*;
pub use study::*;
pub use sweep::*;
pub use trial::*;

pub use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
pub use rubmap_wheel::response::coincidence::Coincidence;
pub use rubmap_wheel::response::settling::{Settling, Verdict};
pub use rubmap_wheel::response::side_bands::SideBands;
pub use rubmap_wheel::response::symmetry_breaking::SymmetryBreaking;
pub use rubmap_wheel::response::waves::{Table, Wave};
