//! Time steps and recorded samples of a revolution.

use super::auto_or::AutoOr;
use super::request::SweepRequest;

/// Steps and samples of a revolution.
pub(super) struct Discretisation {
    /// S.
    pub(super) per_revolution: usize,
    /// Recorded samples, a divisor of S.
    pub(super) samples: usize,
}

/// Samples per revolution for each engine order asked for, so that what aliases onto a line of the spectrum comes
/// from orders at least seven times as high.
const SAMPLES_PER_ORDER: usize = 8;

/// Fewest samples a revolution: blades that rattle move at orders of some hundreds, which must not alias onto the low ones.
const LEAST_SAMPLES: usize = 512;

impl Discretisation {
    /// Exactly `steps` per revolution.
    pub(super) fn exactly(steps: usize, request: &SweepRequest) -> Self {
        Self { per_revolution: steps, samples: samples_of(steps, wanted_samples(request)) }
    }

    /// At least `steps` per revolution and as many as are sampled, a convenient number for `sectors`.
    pub(super) fn at_least(steps: usize, request: &SweepRequest, sectors: usize) -> Self {
        let steps = steps.max(wanted_samples(request));
        // S = decimation · samples, both whole; samples a multiple of N share the casing table.
        let decimation = steps / wanted_samples(request);
        let samples = steps.div_ceil(decimation).next_multiple_of(sectors);
        Self { per_revolution: decimation * samples, samples }
    }
}

fn wanted_samples(request: &SweepRequest) -> usize {
    LEAST_SAMPLES.max(SAMPLES_PER_ORDER * request.max_engine_order as usize)
}

/// The smallest divisor of `steps` that is at least `wanted`; `steps` itself if there is none.
fn samples_of(steps: usize, wanted: usize) -> usize {
    (wanted..=steps / 2).find(|samples| steps.is_multiple_of(*samples)).unwrap_or(steps)
}

/// Upper bound of the samples a revolution of this request records at any speed, on `sectors` sectors.
pub(super) fn most_samples(request: &SweepRequest, sectors: usize) -> usize {
    let wanted = wanted_samples(request);
    match request.integration.steps_per_revolution {
        AutoOr::Auto => 2 * wanted + sectors,
        AutoOr::Fixed(steps) => samples_of(steps as usize, wanted),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_divide_the_steps() {
        assert_eq!(samples_of(6000, 192), 200);
        assert_eq!(samples_of(10007, 192), 10007);
        assert_eq!(samples_of(100, 192), 100);
    }
}
