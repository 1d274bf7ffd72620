//! Computing time of a time step on this machine: the real step loop on a few synthetic wheels, measured in some tenths of a second.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::calibration::effects::{EffectCosts, EffectSizes};
use crate::calibration::size::StepSize;
use crate::calibration::wheel::{Case, StepSeconds, Wheel};
use rubmap_wheel::dynamics::effects::Effects;

pub(crate) mod effects;
pub(crate) mod size;
mod stress;
pub(crate) mod wheel;

/// Computing times of a time step on one machine; measured once and stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Cost of a step of a wheel that nothing can touch.
    without_contact: StepCost,
    /// Cost of a step in front of a casing, out of its reach.
    free: StepCost,
    /// Cost of a step with contact.
    contact: StepCost,
    /// Costs that effects add to these.
    effects: EffectCosts,
    /// Computing time that the spectra of a sensor add to a step of the window, ns per unknown.
    spectra: f64,
    /// Computing time of stress, ns per real number of the stress of a reduction, once a speed.
    stress: f64,
}

/// Computing time of a step, ns: `fixed + per_product·products + per_transform·transforms`, fitted to measurements.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct StepCost {
    fixed: f64,
    per_product: f64,
    per_transform: f64,
}

impl StepCost {
    fn seconds(self, size: StepSize) -> f64 {
        1e-9 * (self.fixed + self.per_product * size.products() + self.per_transform * size.transforms())
    }

    /// Fits costs to measurements: the least relative error among costs that are not negative.
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
    /// Computing time of a step with such effects, s: if nothing ever touches, and if something always does.
    pub(super) fn step_seconds(&self, size: StepSize, effects: &EffectSizes) -> (f64, f64) {
        let (added_free, added_contact) = self.effects.seconds(effects);
        if size.nodes == 0 {
            let seconds = self.without_contact.seconds(size) + added_free;
            return (seconds, seconds);
        }
        let free = self.free.seconds(size) + added_free;
        (free, (self.contact.seconds(size) + added_contact).max(free))
    }

    /// Computing time that the spectra of `sensors` add to a step of the window, s.
    pub(super) fn spectra_seconds(&self, size: StepSize, sensors: usize) -> f64 {
        1e-9 * self.spectra * (size.unknowns * sensors) as f64
    }

    /// Computing time of the stress of a speed, s, with a reduction whose stress has `numbers` real numbers.
    pub(super) fn stress_seconds(&self, numbers: u64) -> f64 {
        1e-9 * self.stress * numbers as f64
    }

    /// Measures this machine, on the calling thread.
    pub fn measure() -> Self {
        let wheels = SIZES.map(|(sectors, nodes, modes)| Wheel::new(sectors, nodes, modes));
        let measured = wheel::measure(&wheels.each_ref().map(|wheel| Case::of(wheel, Effects::default())));
        let fit = |of: fn(&StepSeconds) -> f64, touching: bool| {
            let sizes = SIZES.iter().zip(&wheels).map(|(&(sectors, nodes, _), wheel)| StepSize {
                sectors,
                nodes: if touching { nodes } else { 0 },
                unknowns: wheel.unknowns(),
            });
            StepCost::fit(&sizes.zip(measured.iter().map(of)).collect::<Vec<_>>())
        };
        Self {
            without_contact: fit(|seconds| seconds.without, false),
            free: fit(|seconds| seconds.free, true),
            contact: fit(|seconds| seconds.contact, true),
            effects: EffectCosts::measure(),
            spectra: 1e9 * wheel::measure_spectra(&wheels[2]),
            stress: 1e9 * stress::measure(),
        }
    }
}

/// Measured wheels: sectors, contact nodes of each, and modes per nodal diameter.
const SIZES: [(usize, usize, usize); 4] = [(4, 2, 8), (10, 10, 30), (10, 10, 90), (16, 5, 60)];

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
        // Costs that would have to be negative are left out.
        let falling = StepCost::fit(&sizes.map(|size| (size, 1e-6 / size.products())));
        assert!(falling.per_product >= 0.0 && falling.per_transform >= 0.0, "{falling:?}");
    }

    #[test]
    fn the_synthetic_wheels_touch_and_run_to_the_end() {
        for (sectors, nodes, modes) in SIZES {
            let wheel = Wheel::new(sectors, nodes, modes);
            assert_eq!(wheel.unknowns(), sectors * modes);
            wheel.assert_rubbing(Effects::default(), &format!("{sectors} sectors"));
        }
        let measured = Calibration::measure();
        let size = StepSize { sectors: 10, nodes: 10, unknowns: 600 };
        let (free, contact) = measured.step_seconds(size, &EffectSizes::default());
        assert!(free > 0.0 && contact >= free);
    }

    #[test]
    fn a_calibration_without_effects_does_not_read() {
        let measured = Calibration::measure();
        let mut body = serde_json::to_value(&measured).unwrap();
        assert_eq!(serde_json::from_value::<Calibration>(body.clone()).unwrap(), measured);
        body.as_object_mut().unwrap().remove("effects");
        assert!(serde_json::from_value::<Calibration>(body).is_err());
    }
}
