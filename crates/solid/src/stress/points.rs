//! Stress at the integration points of one element.

use nalgebra::{SVector, Vector3};

use crate::gradients::Gradients;
use crate::material::{Stress, stress};
use crate::mesh::{Element, SectorMesh};

/// Stress `σ = D B u` in x, y, z at every integration point of an element, of the displacements of its nodes in x, y, z. Incompatible modes
/// follow statically.
pub fn point_stress(mesh: &SectorMesh, element: &Element, displacements: &[Vector3<f64>]) -> Vec<Stress> {
    let material = &mesh.sets[element.set as usize].material;
    let gradients = Gradients::of(element.kind, &mesh.positions(element));
    let mut values = displacements.to_vec();
    if element.kind.has_bubbles() {
        let recovery = Gradients::recovery(&gradients.elastic(material.lame_constants()));
        let alpha = recovery * SVector::<f64, 24>::from_fn(|d, _| displacements[d / 3][d % 3]);
        values.extend((0..3).map(|bubble| alpha.fixed_rows::<3>(3 * bubble).into_owned()));
    }
    let constants = material.lame_constants();
    let at_point = |gradients: &Vec<Vector3<f64>>| {
        stress(constants, &values.iter().zip(gradients).map(|(u, g)| u * g.transpose()).sum())
    };
    gradients.at_points.iter().map(at_point).collect()
}
