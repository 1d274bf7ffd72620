//! What a time step costs on this machine: the real step loop on a few synthetic wheels, some hundredths of a second.

use std::f64::consts::TAU;
use std::time::Instant;

use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::dynamics::casing::{Casing, Restriction};
use crate::dynamics::effects::Effects;
use crate::dynamics::integrate::{SensorRow, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::oscillators::{Direction, ModalDamping};
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;
use crate::numerics::sector_fourier::{harmonic_count, is_single};

/// What a time step costs on one machine; measured once and kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// A wheel that nothing can touch.
    without_contact: StepCost,
    /// In front of a casing, out of its reach.
    free: StepCost,
    /// Something touches.
    contact: StepCost,
}

/// Nanoseconds of a step: `fixed + per_product·products + per_transform·transforms`, fitted to what was measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct StepCost {
    fixed: f64,
    per_product: f64,
    per_transform: f64,
}

/// What the cost of a step depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StepSize {
    pub(super) sectors: usize,
    /// Contact nodes of a sector; 0 where nothing can touch.
    pub(super) nodes: usize,
    /// Real unknowns that are integrated.
    pub(super) unknowns: usize,
}

impl StepSize {
    /// Reading an unknown's own recursion takes about as long as its mode shape at two nodes.
    fn products(self) -> f64 {
        (self.unknowns * (self.nodes + 2)) as f64
    }

    /// Normal displacements of all sectors from their Fourier coordinates.
    fn transforms(self) -> f64 {
        (self.sectors * self.sectors * self.nodes.next_multiple_of(8)) as f64
    }
}

impl StepCost {
    fn seconds(self, size: StepSize) -> f64 {
        1e-9 * (self.fixed + self.per_product * size.products() + self.per_transform * size.transforms())
    }

    /// The costs that fit best, relatively, of those that are not negative.
    fn fit(measured: &[(StepSize, f64)]) -> Self {
        let features = |size: StepSize| [1.0, size.products(), size.transforms()];
        let ones = DVector::from_element(measured.len(), 1.0);
        let mut best = (f64::INFINITY, [0.0; 3]);
        for chosen in 1..8_u32 {
            let columns: Vec<usize> = (0..3).filter(|j| chosen & (1 << j) != 0).collect();
            let matrix = DMatrix::from_fn(measured.len(), columns.len(), |i, j| {
                let (size, seconds) = measured[i];
                features(size)[columns[j]] / (1e9 * seconds)
            });
            let Ok(found) = matrix.clone().svd(true, true).solve(&ones, 1e-12) else { continue };
            let error = (matrix * &found - &ones).norm();
            if found.iter().all(|&cost| cost >= 0.0) && error < best.0 {
                let mut costs = [0.0; 3];
                columns.iter().zip(found.iter()).for_each(|(&column, &cost)| costs[column] = cost);
                best = (error, costs);
            }
        }
        let [fixed, per_product, per_transform] = best.1;
        Self { fixed, per_product, per_transform }
    }
}

impl Calibration {
    /// Seconds of a step, if nothing ever touches and if something always does.
    pub(super) fn step_seconds(&self, size: StepSize) -> (f64, f64) {
        if size.nodes == 0 {
            let seconds = self.without_contact.seconds(size);
            return (seconds, seconds);
        }
        let free = self.free.seconds(size);
        (free, self.contact.seconds(size).max(free))
    }

    /// Measures this machine, on the calling thread.
    pub fn measure() -> Self {
        let (mut without, mut free, mut contact) = (Vec::new(), Vec::new(), Vec::new());
        for (sectors, nodes, modes) in SIZES {
            let wheel = Wheel::new(sectors, nodes, modes);
            let size = StepSize { sectors, nodes, unknowns: wheel.modal.unknowns() };
            without.push((StepSize { nodes: 0, ..size }, wheel.step_seconds(None).0));
            let (alone, _) = wheel.step_seconds(Some(OUT_OF_REACH));
            free.push((size, alone));
            let (touching, share) = wheel.step_seconds(Some(WITHIN_REACH));
            // As if every step had a contact.
            contact.push((size, alone + (touching - alone).max(0.0) / share.max(0.1)));
        }
        let [without_contact, free, contact] = [without, free, contact].map(|times| StepCost::fit(&times));
        Self { without_contact, free, contact }
    }
}

/// Sectors, contact nodes of each, and modes per nodal diameter.
const SIZES: [(usize, usize, usize); 4] = [(4, 2, 8), (10, 10, 30), (10, 10, 90), (16, 5, 60)];

/// Clearances over the height of the lobes.
const OUT_OF_REACH: f64 = 100.0;
const WITHIN_REACH: f64 = 0.6;

const SPEED_RAD_S: f64 = 1000.0;
const STEPS: usize = 480;
const SAMPLES: usize = 60;
/// Revolutions beyond the first, which has the set-up to itself.
const REVOLUTIONS: usize = 3;
const ROUNDS: usize = 4;

/// A wheel of no particular shape.
struct Wheel {
    modal: ModalWheel,
    contact_nodes: Vec<ContactNode>,
}

impl Wheel {
    fn new(sectors: usize, nodes: usize, modes: usize) -> Self {
        let harmonic = |harmonic| ModalHarmonic {
            harmonic,
            single: is_single(harmonic, sectors),
            omega: (0..modes).map(|m| SPEED_RAD_S * (2.3 + 0.2 * harmonic as f64 + 1.5 * m as f64)).collect(),
            contact: Mat::from_fn(3 * nodes, modes, |dof, m| {
                let phase = 0.7 * ((dof + 1) * (m + 1)) as f64;
                c64::new(phase.cos(), if is_single(harmonic, sectors) { 0.0 } else { 0.3 * phase.sin() })
            }),
            gyroscopic: None,
        };
        let modal = ModalWheel {
            speed_rad_s: SPEED_RAD_S,
            sectors,
            repeats: 1,
            harmonics: (0..harmonic_count(sectors)).map(harmonic).collect(),
        };
        let node = |k: usize| ContactNode {
            id: k as u64,
            position: [1000.0, 0.0, k as f64],
            normal: [1.0, 0.0, 0.0],
            dofs: [3 * k, 3 * k + 1, 3 * k + 2],
        };
        Self { modal, contact_nodes: (0..nodes).map(node).collect() }
    }

    /// Seconds per step, and the share of steps with contact, in front of two lobes of height 1 that always face a blade.
    fn step_seconds(&self, clearance: Option<f64>) -> (f64, f64) {
        let casing = clearance.map(|clearance| Casing {
            clearance: vec![clearance; self.contact_nodes.len()],
            restriction: Some(Restriction {
                count: 2,
                amplitude: 1.0,
                width_rad: 0.7 * TAU / self.modal.sectors as f64,
                phase_rad: 0.0,
            }),
            ramp_revolutions: 0.5,
        });
        let damping = ModalDamping { modal_ratio: 0.05, family_ratios: Vec::new() };
        let sensors =
            [SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 0 }];
        let run = |revolutions| {
            let simulation = Simulation {
                wheel: &self.modal,
                contact_nodes: &self.contact_nodes,
                damping: Some(&damping),
                casing: casing.as_ref(),
                effects: Effects::default(),
                initial: &[],
                scheme: Scheme::ExactModal,
                sensors: &sensors,
                steps_per_revolution: STEPS,
                samples_per_revolution: SAMPLES,
                revolutions,
                window_revolutions: 1,
            };
            let start = Instant::now();
            let run = simulation.run(&|_| true);
            (start.elapsed().as_secs_f64(), run.statistics)
        };
        // Each at its best: a machine that has other work interrupts the one or the other.
        let fastest = |revolutions| {
            let (mut least, statistics) = run(revolutions);
            for _ in 1..ROUNDS {
                least = least.min(run(revolutions).0);
            }
            (least, statistics)
        };
        let ((set_up, first), (whole, all)) = (fastest(1), fastest(1 + REVOLUTIONS));
        let steps = (all.steps - first.steps).max(1) as f64;
        let share = (all.contact_steps - first.contact_steps) as f64 / steps;
        // Interrupted throughout: then with the set-up.
        let beyond = if whole > set_up { (whole - set_up) / steps } else { whole / all.steps.max(1) as f64 };
        (beyond.max(1e-9), share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_finds_the_costs_it_was_made_of() {
        let cost = StepCost { fixed: 40.0, per_product: 0.12, per_transform: 0.3 };
        let size = |sectors, nodes, unknowns| StepSize { sectors, nodes, unknowns };
        let sizes = [size(4, 2, 32), size(10, 10, 300), size(10, 10, 900), size(16, 5, 960)];
        let fitted = StepCost::fit(&sizes.map(|size| (size, cost.seconds(size))));
        for (found, expected) in [
            (fitted.fixed, cost.fixed),
            (fitted.per_product, cost.per_product),
            (fitted.per_transform, cost.per_transform),
        ] {
            assert!((found - expected).abs() < 1e-6 * expected, "{fitted:?}");
        }
        // What would have to be negative is left out.
        let falling = StepCost::fit(&sizes.map(|size| (size, 1e-6 / size.products())));
        assert!(falling.per_product >= 0.0 && falling.per_transform >= 0.0, "{falling:?}");
    }

    #[test]
    fn the_synthetic_wheels_touch_and_run_to_the_end() {
        for (sectors, nodes, modes) in SIZES {
            let wheel = Wheel::new(sectors, nodes, modes);
            assert_eq!(wheel.modal.unknowns(), sectors * modes);
            assert_eq!(wheel.step_seconds(Some(OUT_OF_REACH)).1, 0.0);
            assert!(wheel.step_seconds(Some(WITHIN_REACH)).1 > 0.3, "{sectors} sectors hardly touch");
        }
        let measured = Calibration::measure();
        let (free, contact) = measured.step_seconds(StepSize { sectors: 10, nodes: 10, unknowns: 600 });
        assert!(free > 0.0 && contact >= free);
    }
}
