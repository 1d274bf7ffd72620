//! Abradable coating rod by rod, with the worn depth of each.

use std::f64::consts::TAU;

use rubmap::dynamics::sector::ContactNode;

use super::contact::{Law, Piece};
use crate::scene::Abradable;

#[derive(Debug)]
pub(super) struct Rods {
    of: Abradable,
    /// Area A of every row.
    areas: Vec<f64>,
    /// Worn depth, `[rod][row]`.
    pub(super) depth: Vec<Vec<f64>>,
}

impl Rods {
    pub(super) fn new(of: Abradable, nodes: &[ContactNode]) -> Self {
        let distance = |a: &ContactNode, b: &ContactNode| {
            let (r, z) = (a.position[0] - b.position[0], a.position[2] - b.position[2]);
            (r * r + z * z).sqrt()
        };
        let area = |k: usize| {
            let mut width = 0.0;
            if k > 0 {
                width += distance(&nodes[k], &nodes[k - 1]) / 2.0;
            }
            if k + 1 < nodes.len() {
                width += distance(&nodes[k], &nodes[k + 1]) / 2.0;
            }
            width * nodes[k].position[0] * TAU / of.rods_around as f64
        };
        let areas = (0..nodes.len()).map(area).collect();
        Self { of, areas, depth: vec![vec![0.0; nodes.len()]; of.rods_around] }
    }

    pub(super) fn at(&self, angle: f64) -> usize {
        let place = (angle / TAU).rem_euclid(1.0) * self.of.rods_around as f64;
        assert!((place - place.round()).abs() > 1e-9, "round-off decides which rod it is");
        place as usize
    }

    /// Law of a rod: its spring, then its plastic flow, then the metal.
    pub(super) fn law(&self, rod: usize, row: usize) -> Law {
        let (t0, area, worn) = (self.of.thickness, self.areas[row], self.depth[rod][row]);
        let spring = t0 / (area * self.of.material.modulus);
        let flow = spring + t0 / (area * self.of.material.hardening);
        let yields = area * (self.of.material.yield_stress + self.of.material.hardening * worn / t0);
        let at_yield = worn + spring * yields;
        // A crushed rod yields where the metal is.
        assert!(at_yield < t0 * (1.0 + 1e-12), "this rod never yields");
        let crushed = yields + (t0 - at_yield) / flow;
        let piece = |start, compliance, least_force, greatest_force| Piece {
            start,
            compliance,
            least_force,
            greatest_force,
        };
        Law {
            free_to: worn,
            pieces: vec![
                piece(worn, spring, 0.0, yields),
                piece(at_yield - flow * yields, flow, yields, crushed),
                piece(t0, 0.0, crushed, f64::INFINITY),
            ],
        }
    }

    /// Presses a rod by λ, and by no more than what crushes it; it springs back from where it was pressed to.
    pub(super) fn press(&mut self, rod: usize, row: usize, lambda: f64) {
        let law = self.law(rod, row);
        let [spring, flow, metal] = law.pieces[..] else { unreachable!("a coating has three pieces") };
        let lambda = lambda.min(metal.least_force);
        if lambda > flow.least_force {
            let pressed_to = flow.start + flow.compliance * lambda;
            self.depth[rod][row] = pressed_to - spring.compliance * lambda;
        }
    }
}

#[cfg(test)]
mod tests {
    use rubmap::dynamics::contact::coating::CoatingMaterial;

    use super::*;
    use crate::scene::contact_nodes;

    /// Linear hardening of a rod that is pushed and unloaded: w/t0 = (Eε − σ_Y)/(E + K), and an identical second pass adds none.
    #[test]
    fn a_rod_follows_its_closed_form() {
        let material = CoatingMaterial { modulus: 400.0, yield_stress: 2.0, hardening: 60.0 };
        let mut rods = Rods::new(Abradable { material, thickness: 0.2, rods_around: 40 }, &contact_nodes(2));
        for strain in [0.3, 0.3, 0.7] {
            let stress = 2.0 + 400.0 * 60.0 / 460.0 * (strain - 2.0 / 400.0);
            rods.press(3, 1, stress * rods.areas[1]);
            assert!((rods.depth[3][1] / 0.2 - (400.0 * strain - 2.0) / 460.0).abs() < 1e-14);
        }
    }
}
