//! Rods that contact nodes press.

use std::f64::consts::TAU;

/// Places of the contact nodes of all sectors over the rods; rod j stands at the angles from 2πj/R to 2π(j + 1)/R.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RodPlaces {
    rods: u64,
    sectors: u64,
    steps: u64,
    /// Angles θ_k in rods: whole and fraction.
    nodes: Vec<(u64, f64)>,
}

impl RodPlaces {
    /// Places of nodes at `angles_rad` in sector 0, with R `rods` around and `steps` per revolution.
    pub(super) fn new(angles_rad: &[f64], rods: usize, sectors: usize, steps: usize) -> Self {
        let place = |theta: &f64| {
            let place = (theta / TAU).rem_euclid(1.0) * rods as f64;
            (place as u64, place.fract())
        };
        Self {
            rods: rods as u64,
            sectors: sectors as u64,
            steps: steps as u64,
            nodes: angles_rad.iter().map(place).collect(),
        }
    }

    /// Rod in front of `node` of `sector` at `step` of the revolution (0 ≤ step < S), at the angle θ_k + sα + 2πq/S.
    ///
    /// The angle sα + 2πq/S is R(sS + qN)/(NS) rods, exactly.
    #[inline(always)]
    pub(super) fn rod(&self, step: usize, sector: usize, node: usize) -> usize {
        let parts = self.sectors * self.steps;
        let turned = self.rods * (sector as u64 * self.steps + step as u64 * self.sectors);
        let (whole, fraction) = self.nodes[node];
        let carried = fraction + (turned % parts) as f64 / parts as f64 >= 1.0;
        // Less than three times around.
        let mut rod = turned / parts + whole + u64::from(carried);
        for _ in 0..2 {
            rod -= if rod >= self.rods { self.rods } else { 0 };
        }
        rod as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_angle() {
        let angles = [0.1, -0.7, 2.9, 11.0];
        for (rods, sectors, steps) in [(40, 10, 40), (2000, 10, 3601), (97, 7, 1000)] {
            let places = RodPlaces::new(&angles, rods, sectors, steps);
            for (step, sector, node) in (0..steps)
                .flat_map(|q| (0..sectors).flat_map(move |s| (0..angles.len()).map(move |k| (q, s, k))))
            {
                let turns = angles[node] / TAU + sector as f64 / sectors as f64 + step as f64 / steps as f64;
                let place = turns.rem_euclid(1.0) * rods as f64;
                // Where round-off of the angle decides, either neighbour will do.
                if (place - place.round()).abs() > 1e-9 {
                    assert_eq!(places.rod(step, sector, node), place as usize, "{step} {sector} {node}");
                }
            }
        }
    }

    /// Blades never meet on a rod, and none skips one, with the fewest rods and steps allowed.
    #[test]
    fn blades_pass_every_rod_and_share_none() {
        let (rods, sectors) = (40, 10);
        for steps in [40, 41, 100] {
            let places = RodPlaces::new(&[0.05], rods, sectors, steps);
            let at = |step: usize, sector| places.rod(step % steps, sector, 0);
            for step in 0..steps {
                let mut pressed: Vec<_> = (0..sectors).map(|sector| at(step, sector)).collect();
                pressed.sort_unstable();
                assert!(pressed.windows(2).all(|pair| pair[1] - pair[0] >= 3), "{pressed:?}");
                assert!((at(step + 1, 3) + rods - at(step, 3)) % rods <= 1);
            }
        }
    }
}
