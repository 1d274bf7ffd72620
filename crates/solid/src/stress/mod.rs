//! Stress from displacement: at the elements' own points, and averaged at nodes.

mod build;
mod nodal;
mod points;

pub use nodal::NodalStress;
pub use points::point_stress;
