//! Sobol's first-order and total indices: how much of the variance of a number each of its independent inputs accounts for.

use crate::sampling::sobol_point;

/// Design of experiments for indices: `base` blocks of points in `dimensions` dimensions. A block has a point of A, then for every dimension the
/// same point with that coordinate of B, then the point of B; A and B are the two halves of Sobol points in twice as many dimensions (Saltelli et
/// al., Computer Physics Communications 181, 2010, 259–270). Blocks are in order, so that a longer design begins with a shorter one.
///
/// # Panics
/// Beyond the points and dimensions of [`sobol_point`], which is asked for twice as many dimensions.
pub fn design(base: usize, dimensions: usize, seed: u32) -> Vec<Vec<f64>> {
    let block = |index| {
        let both = sobol_point(index, 2 * dimensions, seed);
        let (a, b) = both.split_at(dimensions);
        let mixed = (0..dimensions).map(|axis| {
            let mut point = a.to_vec();
            point[axis] = b[axis];
            point
        });
        let mut block = vec![a.to_vec()];
        block.extend(mixed);
        block.push(b.to_vec());
        block
    };
    (0..base).flat_map(block).collect()
}

/// Number of points in a block of a [`design`].
pub fn block_len(dimensions: usize) -> usize {
    dimensions + 2
}

/// A number with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Estimate itself.
    pub value: f64,
    /// Standard error of the estimate.
    pub standard_error: f64,
}

/// Indices of one input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// Share of the variance that would be gone, on average, if the input were known: V(E(f|xᵢ))/V.
    pub first_order: Estimate,
    /// Share of the variance that would be left, on average, if all other inputs were known: E(V(f|x₋ᵢ))/V.
    pub total: Estimate,
}

/// Mean, variance and indices of what was computed on a [`design`].
#[derive(Debug, Clone, PartialEq)]
pub struct Decomposition {
    /// Mean of the values.
    pub mean: f64,
    /// Variance of the values.
    pub variance: f64,
    /// Indices of every input.
    pub inputs: Vec<Indices>,
    /// Number of blocks that count.
    pub blocks: usize,
}

/// Sums over blocks: enough for all estimates, and to leave a block out again.
#[derive(Debug, Clone)]
struct Sums {
    values: f64,
    squares: f64,
    /// Products per input: f(B)·(f(ABᵢ) − f(A)), and (f(A) − f(ABᵢ))²/2.
    products: Vec<(f64, f64)>,
}

impl Sums {
    fn of(block: &[f64], center: f64) -> Self {
        let (a, b) = (block[0] - center, block[block.len() - 1] - center);
        let product = |mixed: &f64| {
            let difference = mixed - center - a;
            (b * difference, 0.5 * difference * difference)
        };
        let products = block[1..block.len() - 1].iter().map(product).collect();
        Self { values: a + b, squares: a * a + b * b, products }
    }

    fn add(&mut self, other: &Self, sign: f64) {
        self.values += sign * other.values;
        self.squares += sign * other.squares;
        for (mine, theirs) in self.products.iter_mut().zip(&other.products) {
            mine.0 += sign * theirs.0;
            mine.1 += sign * theirs.1;
        }
    }

    /// Variance, then first-order and total index per input, of `blocks` blocks.
    fn indices(&self, blocks: f64) -> (f64, Vec<(f64, f64)>) {
        let mean = self.values / (2.0 * blocks);
        let variance = self.squares / (2.0 * blocks) - mean * mean;
        let share = |(first, total): &(f64, f64)| (first / blocks / variance, total / blocks / variance);
        (variance, self.products.iter().map(share).collect())
    }
}

/// Indices from the values on a [`design`], in its order, one per point; a block with a value that is missing does not count. None
/// from fewer than three blocks, and where nothing varies.
///
/// First-order indices are estimated by Saltelli's formula (2010, Table 2 b) about the mean, total ones by Jansen's (f); standard errors by
/// the jackknife over blocks, which takes blocks for independent: Sobol points are better than that, and the true error is smaller.
pub fn decompose(values: &[Option<f64>], dimensions: usize) -> Option<Decomposition> {
    let complete = |block: &[Option<f64>]| block.iter().copied().collect::<Option<Vec<f64>>>();
    let blocks: Vec<Vec<f64>> = values.chunks_exact(block_len(dimensions)).filter_map(complete).collect();
    if blocks.len() < 3 {
        return None;
    }
    let n = blocks.len() as f64;
    let center = blocks.iter().map(|block| block[0] + block[block.len() - 1]).sum::<f64>() / (2.0 * n);
    let parts: Vec<Sums> = blocks.iter().map(|block| Sums::of(block, center)).collect();
    let mut all = Sums { values: 0.0, squares: 0.0, products: vec![(0.0, 0.0); dimensions] };
    parts.iter().for_each(|part| all.add(part, 1.0));
    let (variance, shares) = all.indices(n);
    // What is left of equal numbers is round-off.
    let largest = blocks.iter().flatten().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if variance <= (1e-13 * largest).powi(2) {
        return None;
    }
    let without = |part: &Sums| {
        let mut rest = all.clone();
        rest.add(part, -1.0);
        rest.indices(n - 1.0).1
    };
    let left_out: Vec<Vec<(f64, f64)>> = parts.iter().map(without).collect();
    let estimate = |axis: usize, of: fn((f64, f64)) -> f64| {
        let mean = left_out.iter().map(|indices| of(indices[axis])).sum::<f64>() / n;
        let spread: f64 = left_out.iter().map(|indices| (of(indices[axis]) - mean).powi(2)).sum();
        Estimate { value: of(shares[axis]), standard_error: ((n - 1.0) / n * spread).sqrt() }
    };
    let input = |axis| Indices {
        first_order: estimate(axis, |(first, _)| first),
        total: estimate(axis, |(_, total)| total),
    };
    let inputs = (0..dimensions).map(input).collect();
    Some(Decomposition { mean: center, variance, inputs, blocks: blocks.len() })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn of(f: impl Fn(&[f64]) -> f64, base: usize, dimensions: usize, seed: u32) -> Decomposition {
        let values: Vec<_> = design(base, dimensions, seed).iter().map(|x| Some(f(x))).collect();
        decompose(&values, dimensions).unwrap()
    }

    /// Test function of Ishigami and Homma (1990): sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ over (−π, π)³.
    fn ishigami(u: &[f64]) -> f64 {
        let [x, y, z] = [u[0], u[1], u[2]].map(|u| PI * (2.0 * u - 1.0));
        x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
    }

    fn assert_within(found: &[Indices], first: &[f64], total: &[f64], deviations: f64) {
        for (axis, found) in found.iter().enumerate() {
            for (estimate, exact) in [(found.first_order, first[axis]), (found.total, total[axis])] {
                // Below the last term the exact numbers themselves are rounded.
                let bound = deviations * estimate.standard_error + 1e-4;
                assert!((estimate.value - exact).abs() < bound, "axis {axis}: {estimate:?}, exact {exact}");
            }
        }
    }

    #[test]
    fn indices_of_ishigamis_function_are_within_their_errors() {
        // V₁ = ½(1 + bπ⁴/5)², V₂ = a²/8, V₁₃ = 8b²π⁸/225.
        let (a, b) = (7.0f64, 0.1f64);
        let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
        let v2 = a * a / 8.0;
        let v13 = 8.0 * b * b * PI.powi(8) / 225.0;
        let v = v1 + v2 + v13;
        for (base, seed) in [(64, 1), (256, 1), (256, 2), (1024, 3), (4096, 4)] {
            let found = of(ishigami, base, 3, seed);
            assert_within(&found.inputs, &[v1 / v, v2 / v, 0.0], &[(v1 + v13) / v, v2 / v, v13 / v], 3.0);
            assert_eq!(found.blocks, base);
            assert!((found.mean - a / 2.0).abs() < 3.0 * (v / base as f64).sqrt());
        }
        let errors =
            [64, 256, 1024].map(|base| of(ishigami, base, 3, 1).inputs[0].first_order.standard_error);
        // Errors fall as one over the root of the number of blocks.
        assert!(errors.windows(2).all(|pair| (1.4..2.9).contains(&(pair[0] / pair[1]))), "{errors:?}");
    }

    #[test]
    fn indices_of_sobols_g_function_are_within_their_errors() {
        // Vᵢ = 1/(3(1 + aᵢ)²), V = Π(1 + Vᵢ) − 1, V of all that has i: Vᵢ Π_{j≠i}(1 + Vⱼ).
        let a: [f64; 6] = [0.0, 0.5, 3.0, 9.0, 99.0, 99.0];
        let g = |x: &[f64]| -> f64 {
            x.iter().zip(a).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product::<f64>()
        };
        let parts = a.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
        let all: f64 = parts.iter().map(|part| 1.0 + part).product::<f64>();
        let first = parts.map(|part| part / (all - 1.0));
        let total = parts.map(|part| part * all / (1.0 + part) / (all - 1.0));
        for (base, seed) in [(128, 1), (1024, 2)] {
            assert_within(&of(g, base, 6, seed).inputs, &first, &total, 3.0);
        }
    }

    /// Standard errors of the jackknife over independent blocks: the true index is within so many of them as often as of a normal
    /// distribution. Sobol points of different seeds, of each its first block alone, are independent.
    #[test]
    fn standard_errors_are_honest() {
        let (blocks, trials) = (200, 150);
        let exact = 1.0 / (1.0 + 4.0 + 0.25);
        let linear = |x: &[f64]| x[0] + 2.0 * x[1] + 0.5 * x[2];
        let mut within = 0;
        for trial in 0..trials {
            let seeds = (0..blocks).map(|block| trial * blocks + block);
            let points = seeds.flat_map(|seed| design(1, 3, seed));
            let values: Vec<_> = points.map(|x| Some(linear(&x))).collect();
            let Estimate { value, standard_error } = decompose(&values, 3).unwrap().inputs[0].first_order;
            within += u32::from((value - exact).abs() < 2.0 * standard_error);
        }
        // 95.4 % of 150, ± four deviations.
        assert!((133..=150).contains(&within), "{within} of {trials}");
    }

    #[test]
    fn missing_values_cost_their_block_and_constants_have_no_indices() {
        let mut values: Vec<_> = design(64, 3, 1).iter().map(|x| Some(ishigami(x))).collect();
        let all = decompose(&values, 3).unwrap();
        values[7] = None;
        let found = decompose(&values, 3).unwrap();
        assert_eq!((all.blocks, found.blocks), (64, 63));
        values.drain(5..10);
        assert_eq!(decompose(&values, 3), Some(found));
        assert_eq!(decompose(&[Some(0.1); 30], 3), None);
        assert_eq!(decompose(&values[..10], 3), None);
    }
}
