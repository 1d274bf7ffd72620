//! State of a coating that the blades have worn.

use super::super::super::sector::ContactNode;
use super::fresh::{Coating, CoatingMaterial};
use super::rods::RodPlaces;
use rubmap_numerics::complementarity::law::BilinearLaw;

/// Share of the thickness from which on a tip is on the metal: the accuracy of contact solutions, with much to spare.
const ON_METAL: f64 = 1.0 - 1e-9;

/// Coating with its wear. Rods are counted in the direction of rotation from the package's x axis, rows are contact nodes from the leading edge.
#[derive(Debug, Clone, PartialEq)]
pub struct WornCoating {
    coating: Coating,
    places: RodPlaces,
    /// Slopes of the law of every row.
    slopes: Vec<[f64; 2]>,
    /// Plastic strains ε_p, `[rod][row]`.
    plastic_strain: Vec<f64>,
    plastic_work: f64,
    reached_metal: bool,
}

impl WornCoating {
    /// Unworn `coating` in front of the `contact_nodes` of `sectors`, for runs of `steps` per revolution, at least as many as rods, so that
    /// no blade skips one.
    pub fn new(coating: Coating, contact_nodes: &[ContactNode], sectors: usize, steps: usize) -> Self {
        let angles: Vec<_> = contact_nodes.iter().map(|node| node.position[1]).collect();
        let CoatingMaterial { modulus, hardening, .. } = coating.material;
        let plastic = modulus * hardening / (modulus + hardening);
        let slopes = |area: &f64| [modulus, plastic].map(|stiffness| area * stiffness / coating.thickness);
        Self {
            places: RodPlaces::new(&angles, coating.rods_around, sectors, steps),
            slopes: coating.areas.iter().map(slopes).collect(),
            plastic_strain: vec![0.0; coating.rods_around * coating.areas.len()],
            plastic_work: 0.0,
            reached_metal: false,
            coating,
        }
    }

    /// Rod that the node of `row` of `sector` faces at `step` of the revolution (0 ≤ step < steps): no other sector faces it then.
    #[inline(always)]
    pub fn rod(&self, step: usize, sector: usize, row: usize) -> usize {
        self.places.rod(step, sector, row)
    }

    /// Force of a rod over the penetration into the unworn coating, as it is worn now.
    #[inline(always)]
    pub fn law(&self, rod: usize, row: usize) -> BilinearLaw {
        let CoatingMaterial { modulus, yield_stress, hardening } = self.coating.material;
        let (thickness, strain) = (self.coating.thickness, self.plastic_strain[self.index(rod, row)]);
        let start = thickness * strain;
        let knee = start + thickness * ((yield_stress + hardening * strain) / modulus);
        BilinearLaw { start, knee: knee.min(thickness), stop: thickness, slopes: self.slopes[row] }
    }

    /// Records the wear of a rod by a penetration into the unworn coating, pressed once a step's forces are known.
    #[inline(always)]
    pub fn press(&mut self, rod: usize, row: usize, penetration: f64) {
        let CoatingMaterial { modulus, yield_stress, hardening } = self.coating.material;
        let strain = (penetration / self.coating.thickness).min(1.0);
        self.reached_metal |= strain >= ON_METAL;
        let index = self.index(rod, row);
        let before = self.plastic_strain[index];
        // Of the strain alone, not of what it adds: a pass as deep as the last one adds nothing, to the last bit.
        let after = (modulus * strain - yield_stress) / (modulus + hardening);
        if after > before {
            self.plastic_strain[index] = after;
            let mean_stress = yield_stress + 0.5 * hardening * (before + after);
            self.plastic_work += self.volume(row) * mean_stress * (after - before);
        }
    }

    /// Coating before it was worn.
    pub fn unworn(&self) -> &Coating {
        &self.coating
    }

    /// Energy that a rod at `penetration` would give back, force·length.
    #[cfg(test)]
    fn elastic_energy(&self, rod: usize, row: usize, penetration: f64) -> f64 {
        let strain =
            (penetration / self.coating.thickness).min(1.0) - self.plastic_strain[self.index(rod, row)];
        0.5 * self.volume(row) * self.coating.material.modulus * strain.max(0.0).powi(2)
    }

    /// Work that went into plastic strain so far, force·length.
    pub fn plastic_work(&self) -> f64 {
        self.plastic_work
    }

    /// Whether a tip has met the metal behind the coating.
    pub fn reached_metal(&self) -> bool {
        self.reached_metal
    }

    /// Worn depths w = ε_p t0, `[rod][row]`, length.
    pub fn worn_depths(&self) -> Vec<Vec<f64>> {
        let depths = |rod: &[f64]| rod.iter().map(|strain| strain * self.coating.thickness).collect();
        self.plastic_strain.chunks_exact(self.coating.areas.len()).map(depths).collect()
    }

    /// Volume of the coating worn off, Σ A w, length³.
    pub fn removed_volume(&self) -> f64 {
        let removed = |rod: &[f64]| rod.iter().enumerate().map(|(row, e)| self.volume(row) * e).sum::<f64>();
        self.plastic_strain.chunks_exact(self.coating.areas.len()).map(removed).sum()
    }

    /// Volume A t0 of a rod.
    fn volume(&self, row: usize) -> f64 {
        self.coating.areas[row] * self.coating.thickness
    }

    #[inline(always)]
    fn index(&self, rod: usize, row: usize) -> usize {
        rod * self.coating.areas.len() + row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubmap_numerics::complementarity::ContactOperator;
    use rubmap_numerics::complementarity::branches::BranchSolver;

    const E: f64 = 2000.0;
    const YIELD: f64 = 6.0;
    const K: f64 = 80.0;
    const THICKNESS: f64 = 0.5;

    fn nodes() -> Vec<ContactNode> {
        let node = |z: f64| ContactNode {
            id: 0,
            position: [50.0, 0.0, z],
            normal: [1.0, 0.0, 0.0],
            dofs: [0, 1, 2],
        };
        vec![node(0.0), node(4.0), node(12.0)]
    }

    fn coating(hardening: f64) -> WornCoating {
        let material = CoatingMaterial { modulus: E, yield_stress: YIELD, hardening };
        WornCoating::new(Coating::new(material, THICKNESS, 100, &nodes(), 5).unwrap(), &nodes(), 5, 100)
    }

    /// Worn share w/t0 of a monotone push to strain ε and its unloading, with linear hardening.
    fn worn(strain: f64) -> f64 {
        (E * strain - YIELD) / (E + K)
    }

    /// Monotone push of a rod: σ = σ_Y + EK/(E+K)(ε − σ_Y/E); an identical second pass adds nothing, a deeper one the difference.
    #[test]
    fn follows_the_closed_form_of_a_rod() {
        let mut coating = coating(K);
        let area = coating.coating.areas[1];
        for (strain, depth) in [(0.5 * YIELD / E, 0.0), (0.1, worn(0.1)), (0.1, worn(0.1)), (0.3, worn(0.3))]
        {
            let stress = coating.law(7, 1).force(strain * THICKNESS) / area;
            let expected =
                if strain < YIELD / E { E * strain } else { YIELD + E * K / (E + K) * (strain - YIELD / E) };
            assert!((stress / expected - 1.0).abs() < 1e-12, "{stress} {expected}");
            coating.press(7, 1, strain * THICKNESS);
            let found = coating.worn_depths()[7][1];
            assert!((found - depth * THICKNESS).abs() < 1e-15, "{found}");
        }
        let untouched = coating.worn_depths().concat().iter().filter(|&&depth| depth == 0.0).count();
        assert_eq!(untouched, 299);
        assert!((coating.removed_volume() / (area * THICKNESS * worn(0.3)) - 1.0).abs() < 1e-14);
        assert!(!coating.reached_metal());
    }

    #[test]
    fn an_identical_pass_changes_no_bit() {
        let mut coating = coating(K);
        coating.press(3, 0, 0.123);
        let (depths, work) = (coating.worn_depths(), coating.plastic_work());
        for penetration in [0.123, 0.05, 0.123] {
            coating.press(3, 0, penetration);
        }
        assert_eq!((coating.worn_depths(), coating.plastic_work()), (depths, work));
    }

    /// Flexible tips, two, that push each other away.
    struct Tips;

    impl ContactOperator for Tips {
        fn size(&self) -> usize {
            2
        }

        fn entry(&self, i: usize, j: usize) -> f64 {
            [[2e-4, 5e-5], [5e-5, 1e-4]][i][j]
        }

        fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
            for (i, (q, gap)) in q.iter().zip(gap).enumerate() {
                *gap = q + active.iter().zip(lambda).map(|(&j, l)| self.entry(i, j) * l).sum::<f64>();
            }
        }
    }

    /// Tips pushed in, out, and in further, step by step as in a run: the work done on the rods is what they store and what they wear, and
    /// the depth follows from the deepest penetration alone.
    #[test]
    fn work_is_elastic_energy_plus_plastic_work() {
        let mut coating = coating(K);
        let mut solver: BranchSolver = BranchSolver::new(2);
        let steps = 2000;
        let (mut work, mut last, mut deepest) = (0.0, [(0.0, 0.0); 2], [0.0f64; 2]);
        for step in 0..=steps {
            let time = f64::from(step) / f64::from(steps);
            // 0 → 0.1 → −0.02 → 0.24
            let push = if time < 0.3 {
                time / 3.0
            } else if time < 0.6 {
                0.1 - 0.4 * (time - 0.3)
            } else {
                0.65 * (time - 0.6) - 0.02
            };
            solver.solve(&Tips, |row| coating.law(0, row), &[-push, -0.7 * push], 1e-16).unwrap();
            let mut force = [0.0; 2];
            for (&i, &lambda) in solver.active().iter().zip(solver.lambda()) {
                force[i] = lambda;
            }
            for row in 0..2 {
                let x = -solver.gap()[row];
                work += 0.5 * (force[row] + last[row].1) * (x - last[row].0);
                last[row] = (x, force[row]);
                deepest[row] = deepest[row].max(x);
                coating.press(0, row, x);
            }
        }
        let stored: f64 = (0..2).map(|row| coating.elastic_energy(0, row, last[row].0)).sum();
        assert!(coating.plastic_work() > stored && stored > 0.0);
        // The trapezoidal rule is exact but for the steps across a corner of the law.
        let difference = work / (stored + coating.plastic_work()) - 1.0;
        assert!(difference.abs() < 1e-5, "{difference}");
        for (row, deepest) in deepest.iter().enumerate() {
            let depth = coating.worn_depths()[0][row];
            assert!((depth / (worn(deepest / THICKNESS) * THICKNESS) - 1.0).abs() < 1e-12);
        }
    }

    /// Coating that holds a tip up to its own strength, and the metal from there on.
    #[test]
    fn a_worn_through_coating_meets_the_metal() {
        let mut coating = coating(K);
        let mut solver: BranchSolver = BranchSolver::new(2);
        solver.solve(&Tips, |row| coating.law(0, row), &[-0.9, 0.1], 1e-16).unwrap();
        assert_eq!(solver.active(), [0]);
        assert!((solver.lambda()[0] / ((0.9 - THICKNESS) / 2e-4) - 1.0).abs() < 1e-12);
        coating.press(0, 0, -solver.gap()[0]);
        assert!(coating.reached_metal());
        assert!((coating.worn_depths()[0][0] - worn(1.0) * THICKNESS).abs() < 1e-12);
        let law = coating.law(0, 0);
        assert!(law.start <= law.knee && law.knee <= law.stop);
    }

    /// Coating with K → ∞: nothing yields, nothing wears.
    #[test]
    fn a_coating_that_hardens_without_bound_is_elastic() {
        let mut coating = coating(1e15);
        let law = coating.law(0, 0);
        let elastic = coating.coating.areas[0] * E * 0.3;
        assert!((law.force(0.3 * THICKNESS) / elastic - 1.0).abs() < 1e-9);
        coating.press(0, 0, 0.3 * THICKNESS);
        assert!(coating.worn_depths()[0][0] < 1e-11);
    }
}
