//! Mass that is not the same in all directions.
//!
//! Two nodes of a solid are coupled by a number times the unit matrix, so that the mass times a translation is along that translation at every
//! node, in whatever frame the components are.

use nalgebra::Vector3;
use rubmap_wheel::dynamics::findings::UnevenMass;

use super::rigid::{Body, absolute_sums, forces};
use crate::package::check::layout::NONE;
use crate::package::raw::RawPackage;

/// Part of Σ|M_ij| up to which the product is along the translation: matrices of four digits leave less.
const ALONG: f64 = 1e-3;

/// Nodes of which the mass differs by direction, if there are such; none where a node has some of its components alone.
pub(super) fn find(body: &Body, package: &RawPackage) -> Option<UnevenMass> {
    let rows_of_node = &body.stated.rows_of_node;
    let whole: Vec<usize> =
        (0..rows_of_node.len()).filter(|&node| !rows_of_node[node].contains(&NONE)).collect();
    if 3 * whole.len() != package.dofs.len() {
        return None;
    }
    let scale = absolute_sums(&package.mass);
    let by_row = forces(&package.mass, &body.motions(&body.stated));
    let is_uneven = |node: usize| {
        let moved: [Vector3<f64>; 3] =
            std::array::from_fn(|motion| body.stated.vector(node, &by_row, motion) / body.size);
        let mean = (0..3).map(|k| moved[k][k]).sum::<f64>() / 3.0;
        let off = |k: usize| {
            let mut off = moved[k];
            off[k] -= mean;
            off.amax()
        };
        let most = (0..3).map(off).fold(0.0, f64::max);
        let scale = rows_of_node[node].iter().map(|&row| scale[row as usize]).fold(0.0, f64::max);
        most > ALONG * scale
    };
    let uneven = whole.iter().filter(|&&node| is_uneven(node)).count();
    (uneven > 0).then_some(UnevenMass { uneven, nodes: whole.len() })
}
