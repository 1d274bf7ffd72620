//! Prices of blades that bend far.

use std::sync::Arc;

use super::convert::Bent;
use super::request::Bending;
use crate::calibration::size::EffectSize;
use crate::effects::effect::{Price, Sample, SampleOn};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::bending::BladeBending;

/// Coordinates of the sample.
const COORDINATES: usize = 4;

pub(super) const KINEMATICS: Price = Price {
    part: "bending",
    amount: |scene| coordinates(scene, Bending::Kinematics),
    grows_with: read_coordinates,
    sample: |wheel| sample(wheel.contact_nodes().len(), false),
    same_in_contact: false,
};

pub(super) const STIFFENING: Price = Price {
    part: "stiffening",
    amount: |scene| coordinates(scene, Bending::Full),
    grows_with: read_coordinates,
    sample: |wheel| sample(wheel.contact_nodes().len(), true),
    same_in_contact: false,
};

/// Products that take the modes to one coordinate of all sectors.
fn read_coordinates(size: EffectSize) -> f64 {
    (size.step.unknowns + size.step.sectors * size.step.sectors) as f64
}

fn coordinates(scene: &Scene, include: Bending) -> usize {
    let asked = scene.geometric_nonlinearity.as_ref().filter(|asked| asked.include == include);
    asked.map_or(0, |asked| asked.coordinates as usize)
}

/// Blades whose coordinates are displacements of their first contact nodes, and that hardly bend.
fn sample(nodes: usize, stiffens: bool) -> Sample {
    let blade = BladeBending::alike(COORDINATES, nodes, Vec::new(), 1e-6);
    let bent = Bent { blade: Arc::new(blade), first: 0, stiffens };
    Sample { amount: COORDINATES, on: SampleOn::Simulation(Box::new(bent)) }
}
