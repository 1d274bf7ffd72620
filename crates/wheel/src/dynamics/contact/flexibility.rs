//! Flexibility of contact nodes: displacement along one direction by a force along another, per nodal diameter. Blocks of W and of the
//! residual flexibility F.

use faer::{Mat, c64};

use super::super::direction::Direction;
use super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::super::sector::ContactNode;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::sector_fourier::is_single;

/// Outward normals of the contact nodes as directions.
pub fn outward_normals(contact_nodes: &[ContactNode]) -> Vec<Direction> {
    let normal = |(node, contact): (usize, &ContactNode)| Direction { node, components: contact.normal };
    contact_nodes.iter().enumerate().map(normal).collect()
}

/// Flexibility Σ_m weight(i, m) (dᵀφ_m)(d'ᵀφ_m)ᴴ for every nodal diameter i, `to.len() × from.len()`; modes of weight 0 cost nothing.
pub fn flexibility(
    wheel: &ModalWheel,
    to: &[Direction],
    from: &[Direction],
    weight: impl Fn(usize, usize) -> f64,
) -> Vec<Mat<c64>> {
    let block = |(index, harmonic): (usize, &ModalHarmonic)| {
        let contact = harmonic.contact.as_ref();
        let mut block = Mat::zeros(to.len(), from.len());
        for m in 0..harmonic.omega.len() {
            let weight = weight(index, m);
            if weight == 0.0 {
                continue;
            }
            let sources: Vec<c64> = from.iter().map(|d| d.of(contact, m).conj() * weight).collect();
            let targets: Vec<c64> = to.iter().map(|d| d.of(contact, m)).collect();
            for (j, source) in sources.iter().enumerate() {
                for (i, target) in targets.iter().enumerate() {
                    block[(i, j)] += target * source;
                }
            }
        }
        block
    };
    wheel.harmonics.iter().enumerate().map(block).collect()
}

/// Smallest over largest eigenvalue of a flexibility below which its nodes count as indistinguishable.
const SINGULAR: f64 = 1e-10;

/// Ridge to be added to the diagonal of a flexibility of the normals: 0, or 1e-10 of its largest diagonal entry over the wheel if the
/// flexibility is singular. Coincident nodes, or a basis that cannot tell two nodes apart, make it so; forces then stay finite, and the
/// part of the gap that the ridge leaves is reported as penetration.
pub fn ridge(blocks: &[Mat<c64>], sectors: usize) -> f64 {
    let nodes = blocks.first().map_or(0, Mat::nrows);
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0f64);
    let mut diagonal = vec![0.0; nodes];
    for (harmonic, block) in blocks.iter().enumerate() {
        // A block that cannot be decomposed counts as singular.
        let eigen = Dense::eigenvalues(block.as_ref()).unwrap_or_else(|_| vec![0.0; nodes]);
        smallest = smallest.min(eigen[0]);
        largest = largest.max(eigen[nodes - 1]);
        let waves = if is_single(harmonic, sectors) { 1.0 } else { 2.0 };
        for (k, entry) in diagonal.iter_mut().enumerate() {
            *entry += block[(k, k)].re * waves / sectors as f64;
        }
    }
    if smallest <= SINGULAR * largest { SINGULAR * diagonal.into_iter().fold(0.0, f64::max) } else { 0.0 }
}
