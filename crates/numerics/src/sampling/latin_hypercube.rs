//! Latin hypercubes.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Latin hypercube of `points` points: of as many equal intervals of every axis each has exactly one, anywhere within it (McKay, Beckman
/// and Conover, 1979). Axes are permuted by Fisher and Yates with numbers of SplitMix64.
pub fn latin_hypercube(points: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut generator = SplitMix64::seed_from_u64(seed);
    let mut cube = vec![vec![0.0; dimensions]; points];
    for axis in 0..dimensions {
        let mut strata: Vec<usize> = (0..points).collect();
        for last in (1..points).rev() {
            strata.swap(last, below(&mut generator, last + 1));
        }
        for (point, stratum) in cube.iter_mut().zip(strata) {
            point[axis] = (stratum as f64 + open_unit(&mut generator)) / points as f64;
        }
    }
    cube
}

/// Random whole number below `bound`: the high half of a product with 64 bits, which prefers none by more than bound/2⁶⁴.
fn below(generator: &mut SplitMix64, bound: usize) -> usize {
    ((u128::from(generator.next_u64()) * bound as u128) >> 64) as usize
}

/// Random number within (0, 1), from 52 bits.
fn open_unit(generator: &mut SplitMix64) -> f64 {
    ((generator.next_u64() >> 12) as f64 + 0.5) / (1u64 << 52) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_are_hit_once() {
        for (points, seed) in [(1, 5), (2, 0), (37, 1), (200, 9)] {
            let cube = latin_hypercube(points, 5, seed);
            assert_eq!(cube, latin_hypercube(points, 5, seed));
            for axis in 0..5 {
                let mut hit: Vec<_> =
                    cube.iter().map(|point| (point[axis] * points as f64) as usize).collect();
                hit.sort_unstable();
                assert_eq!(hit, (0..points).collect::<Vec<_>>());
            }
        }
        assert_ne!(latin_hypercube(8, 2, 1), latin_hypercube(8, 2, 2));
    }

    /// Orders of three strata come all equally often.
    #[test]
    fn orders_are_equally_likely() {
        let mut seen = std::collections::BTreeMap::new();
        for seed in 0..6000 {
            let order: Vec<_> =
                latin_hypercube(3, 1, seed).iter().map(|point| (point[0] * 3.0) as u8).collect();
            *seen.entry(order).or_insert(0) += 1;
        }
        assert_eq!(seen.len(), 6);
        // Five standard deviations of a share of one sixth.
        assert!(seen.values().all(|&count: &i32| (count - 1000).abs() < 145), "{seen:?}");
    }
}
