//! Outward growth of the tips with speed: the static solution under the centrifugal load (docs/method.md, Casing and gap).

use crate::stress::StaticWheel;
use rubmap_wheel::dynamics::reduction::StaticSpan;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Outward displacement n·u of the contact nodes under the centrifugal load.
#[derive(Debug, Clone, PartialEq)]
pub struct TipGrowth {
    /// Displacement `[contact node][given speed]`: that of the solutions at the given speeds per unit Ω².
    outward: Vec<f64>,
    span: StaticSpan,
}

impl TipGrowth {
    /// Growth of the wheel of a reduction with these contact nodes.
    pub fn of(fixed: &StaticWheel, contact: &[ContactNode]) -> Self {
        let span = fixed.stress.span.clone();
        let speeds = span.speeds_rad_s.len();
        let outward = contact.iter().flat_map(|node| {
            (0..speeds).map(|speed| {
                let moved = node.dofs.iter().map(|dof| fixed.displacement[speeds * dof + speed]);
                moved.zip(node.normal).map(|(u, n)| u * n).sum::<f64>()
            })
        });
        Self { outward: outward.collect(), span }
    }

    /// Zero growth of this number of contact nodes.
    pub(crate) fn none(contact_nodes: usize) -> Self {
        Self { outward: vec![0.0; contact_nodes], span: StaticSpan::at_rest() }
    }

    /// Growth of every contact node at a speed, in the unit of length; negative where a tip moves away from the casing.
    pub fn at(&self, speed_rad_s: f64, stiffening: bool) -> Vec<f64> {
        let shares = self.span.at(speed_rad_s, stiffening);
        let of = |node: &[f64]| shares.iter().zip(node).map(|(share, outward)| share * outward).sum();
        self.outward.chunks_exact(shares.len()).map(of).collect()
    }
}
