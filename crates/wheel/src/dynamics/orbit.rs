//! Orbit of the wheel's axis off the casing's: eccentric casing and whirling shaft.
//!
//! With the axis displaced by e towards the angle κΩt + ψ of the fixed frame, the gap at angle φ shrinks by
//!
//! ```text
//! n_r e cos(φ − κΩt − ψ),   φ = θ_k + sα + Ωt
//! ```
//!
//! n_r being the radial component of the node's normal (first order in e over the radius). κ = 0 is an eccentric
//! casing, which the turning blades feel once a revolution; κ = 1 a synchronous whirl, which they feel as a constant.
//! The motion is prescribed: what it costs is part of the work of contact. It grows with the restriction. The inertia forces
//! of a whirling axis on the blades, −κ²Ω²e times their mass, are left out.

use std::f64::consts::TAU;

use super::sector::ContactNode;

/// Circular orbit of the wheel's axis about the casing's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Radius e, length.
    pub radius: f64,
    /// Whirl speed over Ω, κ; negative against the rotation.
    pub whirl_ratio: f64,
    /// Angle ψ of the displaced axis at the start, rad.
    pub phase_rad: f64,
}

/// Change of the gaps by an orbit, with all that can be known before the loop.
#[derive(Debug)]
pub(crate) struct OrbitShift {
    orbit: Orbit,
    /// Factors n_r e cos and n_r e sin of θ_k + sα − ψ, `[sector][node]`.
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl OrbitShift {
    /// Prepares the orbit for `sectors` of the `around` on the circumference, nodes padded to `stride`.
    pub(crate) fn new(
        orbit: Orbit,
        contact_nodes: &[ContactNode],
        sectors: usize,
        around: usize,
        stride: usize,
    ) -> Self {
        let mut shift = Self { orbit, cos: vec![0.0; sectors * stride], sin: vec![0.0; sectors * stride] };
        for sector in 0..sectors {
            for (k, node) in contact_nodes.iter().enumerate() {
                let angle = node.position[1] + TAU * sector as f64 / around as f64 - orbit.phase_rad;
                let (sin, cos) = angle.sin_cos();
                shift.cos[sector * stride + k] = node.normal[0] * orbit.radius * cos;
                shift.sin[sector * stride + k] = node.normal[0] * orbit.radius * sin;
            }
        }
        shift
    }

    /// Subtracts the orbit's displacement after `revolutions` from the gaps.
    pub(crate) fn add(&self, revolutions: f64, growth: f64, gaps: &mut [f64]) {
        let (sin, cos) = (TAU * ((1.0 - self.orbit.whirl_ratio) * revolutions).fract()).sin_cos();
        let (sin, cos) = (growth * sin, growth * cos);
        for (gap, (c, s)) in gaps.iter_mut().zip(self.cos.iter().zip(&self.sin)) {
            *gap -= c * cos - s * sin;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whirl_is_seen_at_its_own_order() {
        let node = |theta: f64| ContactNode {
            id: 0,
            position: [10.0, theta, 0.0],
            normal: [0.8, 0.0, 0.6],
            dofs: [0, 1, 2],
        };
        let nodes = [node(0.2), node(-1.1)];
        for whirl_ratio in [0.0, 1.0, -0.4, 0.5] {
            let orbit = Orbit { radius: 0.3, whirl_ratio, phase_rad: 0.7 };
            let shift = OrbitShift::new(orbit, &nodes, 3, 6, 8);
            for revolutions in [0.0, 0.37, 12.81] {
                let mut gaps = vec![1.0; 24];
                shift.add(revolutions, 0.5, &mut gaps);
                for (sector, k) in [(0, 0), (2, 1)] {
                    let turned = TAU * revolutions;
                    let phi = nodes[k].position[1] + TAU * sector as f64 / 6.0 + turned;
                    let towards = whirl_ratio * turned + 0.7;
                    let expected = 1.0 - 0.5 * 0.8 * 0.3 * (phi - towards).cos();
                    assert!((gaps[sector * 8 + k] - expected).abs() < 1e-13);
                }
                assert_eq!(gaps[2], 1.0);
            }
        }
    }
}
