//! Sobol points.

/// Largest number of dimensions: those for which there are direction numbers.
pub const MOST_DIMENSIONS: usize = sobol_burley::NUM_DIMENSIONS as usize;

/// Largest number of points of one sequence.
pub const MOST_POINTS: usize = 1 << 16;

/// Half of the grid of 2⁻²³ on which the generator rounds down.
const HALF_A_CELL: f64 = 1.0 / (1u64 << 24) as f64;

/// Point `index` of Sobol's sequence in `dimensions` dimensions (direction numbers of Joe and Kuo, 2008), with Owen's nested uniform
/// scrambling by `seed` (Burley, Practical Hash-based Owen Scrambling, 2020). The first 2ᵐ points of any seed have one in every of 2ᵐ equal
/// intervals of every axis.
///
/// # Panics
/// Beyond [`MOST_POINTS`] or [`MOST_DIMENSIONS`].
pub fn sobol_point(index: usize, dimensions: usize, seed: u32) -> Vec<f64> {
    assert!(index < MOST_POINTS && dimensions <= MOST_DIMENSIONS, "point {index} in {dimensions} dimensions");
    let coordinate = |dimension| f64::from(sobol_burley::sample(index as u32, dimension, seed)) + HALF_A_CELL;
    (0..dimensions as u32).map(coordinate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::latin_hypercube;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    /// Squared L₂ star discrepancy, by Warnock's formula.
    fn discrepancy(points: &[Vec<f64>]) -> f64 {
        let (n, dimensions) = (points.len() as f64, points[0].len() as i32);
        let single = |x: &Vec<f64>| x.iter().map(|x| (1.0 - x * x) / 2.0).product::<f64>();
        let pair = |x: &Vec<f64>, y: &Vec<f64>| -> f64 {
            x.iter().zip(y).map(|(x, y)| 1.0 - x.max(*y)).product::<f64>()
        };
        let pairs: f64 = points.iter().flat_map(|x| points.iter().map(move |y| pair(x, y))).sum();
        3f64.powi(-dimensions) - 2.0 / n * points.iter().map(single).sum::<f64>() + pairs / (n * n)
    }

    #[test]
    fn every_interval_of_every_axis_is_hit_once() {
        for seed in [0, 1, 77] {
            let points: Vec<_> = (0..256).map(|index| sobol_point(index, 12, seed)).collect();
            for axis in 0..12 {
                let mut hit: Vec<_> = points.iter().map(|point| (point[axis] * 256.0) as usize).collect();
                hit.sort_unstable();
                assert_eq!(hit, (0..256).collect::<Vec<_>>(), "axis {axis}, seed {seed}");
            }
        }
    }

    #[test]
    fn points_fill_the_cube_better_than_chance() {
        let mut generator = SplitMix64::seed_from_u64(3);
        let mut unit = || (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let mean = |of: &mut dyn FnMut(u32) -> Vec<Vec<f64>>| {
            (0..8).map(|seed| discrepancy(&of(seed))).sum::<f64>() / 8.0
        };
        let sobol = mean(&mut |seed| (0..256).map(|index| sobol_point(index, 4, seed)).collect());
        let hypercube = mean(&mut |seed| latin_hypercube(256, 4, u64::from(seed)));
        let random = mean(&mut |_| (0..256).map(|_| (0..4).map(|_| unit()).collect()).collect());
        // Of random points the expectation is known: (2⁻ᵈ − 3⁻ᵈ)/n.
        let expected = (0.5f64.powi(4) - 3f64.powi(-4)) / 256.0;
        assert!((random / expected - 1.0).abs() < 0.5, "{random:e} {expected:e}");
        assert!(sobol < 0.1 * random, "{sobol:e} {random:e}");
        assert!(hypercube < 0.8 * random, "{hypercube:e} {random:e}");
    }

    /// Points computed once stay the same: another version of the generator may not change them unseen.
    #[test]
    fn seeds_mean_what_they_meant() {
        let cells = |index, seed| -> Vec<u32> {
            sobol_point(index, 3, seed).iter().map(|x| (x * f64::from(1 << 23)) as u32).collect()
        };
        assert_eq!(
            [cells(0, 0), cells(1, 0), cells(1000, 9)],
            [
                [2_199_104, 4_503_796, 6_002_907],
                [8_147_970, 3_863_781, 633_150],
                [5_890_552, 6_630_780, 216_927]
            ]
        );
    }
}
