//! Contact nodes and normals that no blade tip has.

use nalgebra::Vector3;
use rubmap_wheel::dynamics::findings::OddContact;

use super::rigid::Body;
use crate::package::check::layout::Layout;
use crate::package::raw::RawPackage;

/// Share of a normal along the tip line, or around the axis, from which on it is odd: a casing is a surface of revolution along the tip.
const ODD: f64 = 0.75;

/// Nodes at which the tip line doubles back, and normals that flip, run along the line or around the axis.
pub(super) fn find(body: &Body, package: &RawPackage, layout: &Layout) -> OddContact {
    let nodes: Vec<usize> = layout.contact.iter().map(|&node| node as usize).collect();
    let at: Vec<Vector3<f64>> =
        nodes.iter().map(|&node| Vector3::from(package.nodes[node].position)).collect();
    let normal = |k: usize| body.stated.bases[nodes[k]].tr_mul(&Vector3::from(layout.normals[k]));
    let along = |k: usize| (at[(k + 1).min(at.len() - 1)] - at[k.saturating_sub(1)]).normalize();
    let ids = |is_odd: &dyn Fn(usize) -> bool| -> Vec<u64> {
        (0..nodes.len()).filter(|&k| is_odd(k)).map(|k| package.nodes[nodes[k]].id).collect()
    };
    OddContact {
        doubling_back: ids(&|k| {
            k > 0 && k + 1 < at.len() && (at[k] - at[k - 1]).dot(&(at[k + 1] - at[k])) < 0.0
        }),
        flipped: ids(&|k| k > 0 && normal(k).dot(&normal(k - 1)) < 0.0),
        along_tip: ids(&|k| at.len() > 1 && normal(k).dot(&along(k)).abs() > ODD),
        around_axis: ids(&|k| body.around(nodes[k], normal(k)).abs() > ODD),
    }
}
