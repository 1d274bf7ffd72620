//! Sums of the sizes of a place's directions, many directions at a time.

use pulp::{Simd, WithSimd};

use super::bounds::Error;
use super::trajectory::Path;

/// Numbers are padded to a multiple of this: the most that a vector of any processor holds.
pub(super) const LANES: usize = 16;

/// Single precision adds fewer spacings than this to a sum of sizes.
const ROUNDED_UP: f64 = 1.0 + 1e-4;

/// How far each direction goes.
pub(super) struct Sums {
    arch: pulp::Arch,
    /// max|c_k| over the largest of them, of the directions by which places are looked at and of the others, padded.
    reach: [Vec<f32>; 2],
    largest: f64,
}

impl Sums {
    /// Of a path whose directions are `padded` with none.
    pub(super) fn new(path: &Path, padded: usize) -> Self {
        let largest = path.reach.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let of = |looked: bool| {
            let reach =
                |k: usize| if (k < path.looking) == looked { path.reach.get(k).copied() } else { None };
            (0..padded).map(|k| reach(k).map_or(0.0, |reach| (reach / largest) as f32)).collect()
        };
        Self { arch: pulp::Arch::new(), reach: [of(true), of(false)], largest }
    }

    /// Σ |a_k| max|c_k| of the directions by which places are looked at, and of the others; `parts` are those of a place,
    /// `[component][part][direction]`. No direction is larger than one at any place, so that nothing overflows.
    pub(super) fn of(&self, parts: &[f32]) -> [Error; 2] {
        let found = self.arch.dispatch(OfPlace { reach: &self.reach, parts });
        let up = |sum: f32| f64::from(sum) * self.largest * ROUNDED_UP;
        found.map(|[size, sway]| Error { von_mises: up(size), trace: up(sway) })
    }
}

struct OfPlace<'a> {
    reach: &'a [Vec<f32>; 2],
    parts: &'a [f32],
}

impl WithSimd for OfPlace<'_> {
    type Output = [[f32; 2]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let count = self.reach[0].len();
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
            let sway = simd.sqrt_f32s(simd.mul_add_e_f32s(re, re, simd.mul_f32s(im, im)));
            for (sums, reach) in sums.iter_mut().zip(self.reach) {
                let reach = load(reach, first);
                sums[0] = simd.mul_add_e_f32s(reach, size, sums[0]);
                sums[1] = simd.mul_add_e_f32s(reach, sway, sums[1]);
            }
        }
        sums.map(|sums| sums.map(|sum| simd.reduce_sum_f32s(sum)))
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::super::measure::{Stress, ellipse, trace};
    use super::*;

    #[test]
    fn sums_are_those_of_single_directions_and_never_below() {
        let count = 21;
        let value = |component: usize, part: usize, k: usize| {
            0.3 * ((1 + component + 7 * part + 13 * k) as f64).sin() / (1.0 + k as f64)
        };
        let reach: Vec<f64> = (0..count).map(|k| 40.0 / (1.0 + k as f64)).collect();
        let path = Path {
            harmonic: 2,
            directions: Mat::zeros(0, count),
            course: Mat::zeros(count, 1),
            reach: reach.clone(),
            looking: 9,
            left: 0.0,
        };
        let padded = count.next_multiple_of(LANES);
        let mut parts = vec![0.0f32; 12 * padded];
        for component in 0..6 {
            for part in 0..2 {
                for k in 0..count {
                    parts[(2 * component + part) * padded + k] = value(component, part, k) as f32;
                }
            }
        }
        let mut expected = [Error::default(); 2];
        for k in 0..count {
            let [re, im] = [0, 1].map(|part| -> Stress { std::array::from_fn(|c| value(c, part, k)) });
            let sum = &mut expected[usize::from(k >= 9)];
            sum.von_mises += reach[k] * ellipse(&re, &im);
            sum.trace += reach[k] * trace(&re).hypot(trace(&im));
        }
        for (found, expected) in Sums::new(&path, padded).of(&parts).iter().zip(expected) {
            for (found, expected) in [(found.von_mises, expected.von_mises), (found.trace, expected.trace)] {
                assert!(found >= expected && found < expected * 1.0003, "{found} {expected}");
            }
        }
    }
}
