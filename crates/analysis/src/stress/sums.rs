//! Sums of the sizes of a place's directions, many directions at a time.

use pulp::{Simd, WithSimd};

/// Padding of numbers to a multiple of this: the most that a vector of any processor holds.
pub(super) const LANES: usize = 16;

/// Factor above the rounding error of a sum of sizes in single precision.
const ROUNDED_UP: f64 = 1.0 + 1e-4;

/// Largest coefficients of directions, by which their stresses are summed.
pub(super) struct Sums {
    arch: pulp::Arch,
    /// Coefficients relative to the largest one, padded.
    reach: Vec<f32>,
    largest: f64,
}

/// Sums at one place; von Mises stress first, then three times the mean normal stress.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum {
    /// Sum Σ |a_k| reach_k, rounded up.
    pub(super) sizes: [f64; 2],
    /// Sum of the squares of both parts of a_k, whatever their reach.
    pub(super) squares: [f64; 2],
}

impl Sums {
    /// Sums over directions with these largest coefficients, `padded` with zeros.
    pub(super) fn new(reach: &[f64], padded: usize) -> Self {
        let largest = reach.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut shares: Vec<f32> = reach.iter().map(|reach| (reach / largest) as f32).collect();
        shares.resize(padded, 0.0);
        Self { arch: rubmap_numerics::vectors::arch(), reach: shares, largest }
    }

    /// Sums of the `parts` of a place, `[component][part][direction]`, with the padded number of directions.
    pub(super) fn of(&self, parts: &[f32]) -> Sum {
        let found = self.arch.dispatch(OfPlace { reach: &self.reach, parts }).map(|part| part.map(f64::from));
        Sum { sizes: found[0].map(|size| size * self.largest * ROUNDED_UP), squares: found[1] }
    }
}

struct OfPlace<'a> {
    reach: &'a [f32],
    parts: &'a [f32],
}

impl WithSimd for OfPlace<'_> {
    type Output = [[f32; 2]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let count = self.reach.len();
        let zero = simd.splat_f32s(0.0);
        let half = simd.splat_f32s(0.5);
        let mut sums = [[zero; 2]; 2];
        for first in (0..count).step_by(S::F32_LANES) {
            let load = |values: &[f32], at: usize| S::as_simd_f32s(&values[at..at + S::F32_LANES]).0[0];
            let s: [[S::f32s; 6]; 2] = std::array::from_fn(|part| {
                std::array::from_fn(|component| load(self.parts, (2 * component + part) * count + first))
            });
            let form = |a: &[S::f32s; 6], b: &[S::f32s; 6]| {
                let difference =
                    |k: usize, l: usize| simd.mul_f32s(simd.sub_f32s(a[k], a[l]), simd.sub_f32s(b[k], b[l]));
                let normal =
                    simd.add_f32s(difference(0, 1), simd.add_f32s(difference(1, 2), difference(2, 0)));
                let shear = |k: usize| simd.mul_f32s(a[k], b[k]);
                let shear = simd.add_f32s(shear(3), simd.add_f32s(shear(4), shear(5)));
                simd.mul_add_e_f32s(half, normal, simd.mul_f32s(simd.splat_f32s(3.0), shear))
            };
            // Half the long axis of an ellipse.
            let (aa, bb, ab) = (form(&s[0], &s[0]), form(&s[1], &s[1]), form(&s[0], &s[1]));
            let (sum, difference) = (simd.add_f32s(aa, bb), simd.sub_f32s(aa, bb));
            let cross = simd.mul_f32s(simd.splat_f32s(4.0), simd.mul_f32s(ab, ab));
            let root = simd.sqrt_f32s(simd.mul_add_e_f32s(difference, difference, cross));
            let size = simd.sqrt_f32s(simd.mul_f32s(half, simd.add_f32s(sum, root)));
            let trace = |a: &[S::f32s; 6]| simd.add_f32s(a[0], simd.add_f32s(a[1], a[2]));
            let (re, im) = (trace(&s[0]), trace(&s[1]));
            let squared = simd.mul_add_e_f32s(re, re, simd.mul_f32s(im, im));
            let sway = simd.sqrt_f32s(squared);
            let reach = load(self.reach, first);
            sums[0][0] = simd.mul_add_e_f32s(reach, size, sums[0][0]);
            sums[0][1] = simd.mul_add_e_f32s(reach, sway, sums[0][1]);
            sums[1][0] = simd.add_f32s(sums[1][0], sum);
            sums[1][1] = simd.add_f32s(sums[1][1], squared);
        }
        sums.map(|sums| sums.map(|sum| simd.reduce_sum_f32s(sum)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::measure::{Stress, ellipse, form, trace};
    use super::*;

    #[test]
    fn sums_are_those_of_single_directions_and_never_below() {
        let count = 21usize;
        let value = |component: usize, part: usize, k: usize| {
            0.3 * ((1 + component + 7 * part + 13 * k) as f64).sin() / (1.0 + k as f64)
        };
        let reach: Vec<f64> = (0..count).map(|k| 40.0 / (1.0 + k as f64)).collect();
        let padded = count.next_multiple_of(LANES);
        let mut parts = vec![0.0f32; 12 * padded];
        for component in 0..6 {
            for part in 0..2 {
                for k in 0..count {
                    parts[(2 * component + part) * padded + k] = value(component, part, k) as f32;
                }
            }
        }
        let (mut sizes, mut squares) = ([0.0; 2], [0.0; 2]);
        for (k, reach) in reach.iter().enumerate() {
            let [re, im] = [0, 1].map(|part| -> Stress { std::array::from_fn(|c| value(c, part, k)) });
            sizes[0] += reach * ellipse(&re, &im);
            sizes[1] += reach * trace(&re).hypot(trace(&im));
            squares[0] += form(&re, &re) + form(&im, &im);
            squares[1] += trace(&re).powi(2) + trace(&im).powi(2);
        }
        let found = Sums::new(&reach, padded).of(&parts);
        for (found, expected) in found.sizes.into_iter().zip(sizes) {
            assert!(found >= expected && found < expected * 1.0003, "{found} {expected}");
        }
        for (found, expected) in found.squares.into_iter().zip(squares) {
            assert!((found - expected).abs() < 1e-5 * expected, "{found} {expected}");
        }
    }
}
