//! Meshes of the generator as packages, and its cylindrical frame.

use rubmap::assembly::{PackageFacts, to_package};
use rubmap::dynamics::sector::Units;
use rubmap::impeller::Material;
use rubmap::impeller::mesh::SectorMesh;
use rubmap::package::raw::RawPackage;
use rubmap::solid::frame::{AxisFrame, Basis};

/// Package of a mesh of one material.
pub(crate) fn packed(
    name: &str,
    sector: &SectorMesh,
    material: &Material,
    units: &Units,
    top_speed_rad_s: f64,
) -> RawPackage {
    let facts =
        PackageFacts { name: name.to_owned(), units: units.clone(), top_speed_rad_s, gyroscopic: false };
    to_package(&facts, &sector.made_of(material)).unwrap()
}

/// Unit vectors r, θ, z at an angle about the z axis.
pub(crate) fn cylindrical_frame(theta: f64) -> Basis {
    AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap().cylindrical(theta)
}
