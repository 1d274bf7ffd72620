//! Time steps and recorded samples of a revolution.

use num_integer::gcd;

use crate::effects::casing::shape::Shape;
use crate::request::AutoOr;
use crate::resolved::ResolvedSweep;

/// Time steps and recorded samples of a revolution.
#[derive(Debug, Clone)]
pub(super) struct Discretisation {
    /// Steps per revolution S.
    pub(super) per_revolution: usize,
    /// Recorded samples per revolution, a divisor of S.
    pub(super) samples: usize,
}

/// Samples per revolution for each engine order asked for: the decimation of the window passes a band of an eighth of the samples.
const SAMPLES_PER_ORDER: usize = 8;

/// Fewest samples per revolution: levels and histories are taken at these instants, and blades that rattle move at orders of some hundreds.
const LEAST_SAMPLES: usize = 512;

impl Discretisation {
    /// Discretisation with exactly `steps` per revolution of a wheel of `sectors`.
    pub(super) fn exactly(steps: usize, request: &ResolvedSweep, sectors: usize) -> Self {
        let aligned = aligned_samples(request, sectors);
        let samples =
            if steps.is_multiple_of(aligned) { aligned } else { samples_of(steps, wanted_samples(request)) };
        Self { per_revolution: steps, samples }
    }

    /// Samples per revolution, the same at every speed whatever its steps.
    pub(super) fn of_every_speed(request: &ResolvedSweep, sectors: usize) -> usize {
        match request.integration.steps_per_revolution {
            AutoOr::Auto => aligned_samples(request, sectors),
            AutoOr::Fixed(steps) => Self::exactly(steps as usize, request, sectors).samples,
        }
    }

    /// Discretisation with `samples` per revolution and the same number of steps or a few more.
    pub(super) fn sampled(&self, samples: usize) -> Self {
        Self { per_revolution: self.per_revolution.next_multiple_of(samples), samples }
    }

    /// Discretisation with at least `steps` per revolution and at least the samples, aligned with the blades of a wheel of `sectors` and
    /// with the lobes.
    pub(super) fn at_least(steps: usize, request: &ResolvedSweep, sectors: usize) -> Self {
        let steps = steps.max(wanted_samples(request));
        // S = decimation · samples, both whole; samples a multiple of N share the casing table.
        let decimation = steps / wanted_samples(request);
        let samples = steps.div_ceil(decimation).next_multiple_of(alike(request, sectors));
        Self { per_revolution: decimation * samples, samples }
    }
}

/// Divisor that samples, and thus steps, have in common: the number of blades of a wheel of `sectors`, and the lobes as well unless that
/// adds more than a quarter. Lobes that a blade meets sometimes on a step and sometimes between two drive orders that are no multiple of
/// their number by some thousandths of the response.
fn alike(request: &ResolvedSweep, sectors: usize) -> usize {
    let lobes = request.scene.touched_shape().and_then(Shape::repeats).unwrap_or(1);
    let both = sectors * (lobes / gcd(lobes, sectors as u32)) as usize;
    if both <= LEAST_SAMPLES / 4 { both } else { sectors }
}

/// Fewest samples, and steps, that are aligned with the blades and with the lobes: runs with multiples of them share instants.
pub(super) fn aligned_samples(request: &ResolvedSweep, sectors: usize) -> usize {
    wanted_samples(request).next_multiple_of(alike(request, sectors))
}

fn wanted_samples(request: &ResolvedSweep) -> usize {
    LEAST_SAMPLES.max(SAMPLES_PER_ORDER * request.max_engine_order as usize)
}

/// Smallest divisor of `steps` that is at least `wanted`; `steps` itself if there is none.
fn samples_of(steps: usize, wanted: usize) -> usize {
    (wanted..=steps / 2).find(|samples| steps.is_multiple_of(*samples)).unwrap_or(steps)
}

/// Upper bound of the samples per revolution that this request records at any speed, on a wheel of `sectors`.
pub(super) fn most_samples(request: &ResolvedSweep, sectors: usize) -> usize {
    let wanted = wanted_samples(request);
    match request.integration.steps_per_revolution {
        AutoOr::Auto => 2 * wanted + alike(request, sectors),
        AutoOr::Fixed(steps) => samples_of(steps as usize, wanted).max(aligned_samples(request, sectors)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolved::from_json;

    #[test]
    fn blades_meet_lobes_at_the_same_steps() {
        let steps = |sectors: usize, lobes: u32| {
            let casing = serde_json::json!({"clearance": {"leading": 1, "trailing": 1},
                "lobes": {"count": lobes, "amplitude": 1, "width_rad": 0.3}});
            let request = from_json::sweep(serde_json::json!({
                "model": "", "speeds": {"values": [1.0], "unit": "rad_s"},
                "scene": {"casing": casing, "contact": {}}, "integration": {}
            }));
            let found = Discretisation::at_least(3600, &request, sectors);
            assert!(found.per_revolution.is_multiple_of(found.samples) && found.per_revolution >= 3600);
            found.per_revolution
        };
        for (sectors, lobes) in [(10, 2), (5, 2), (13, 2), (10, 3), (19, 6)] {
            let steps = steps(sectors, lobes);
            assert!(
                steps.is_multiple_of(sectors) && steps.is_multiple_of(lobes as usize),
                "{sectors} {lobes}"
            );
            assert!(steps < 4500, "{steps}");
        }
        // Not at any price.
        assert!(steps(97, 89) < 4500);
    }

    #[test]
    fn samples_divide_the_steps() {
        assert_eq!(samples_of(6000, 192), 200);
        assert_eq!(samples_of(10007, 192), 10007);
        assert_eq!(samples_of(100, 192), 100);
    }
}
