//! Extremes of one place over all blades and instants, in single precision, many instants at a time.

use pulp::{Simd, WithSimd};

/// Stress of a place over time: σ_s(t) = σ₀ + Σ_i Re( e^{jisα} w_i(t) ).
pub(super) struct Moved<'a> {
    /// Static stress σ₀, all components.
    pub(super) fixed: [f32; 6],
    /// Waves w of every nodal diameter: `[component][part][instant]`, the instants padded to whole vectors.
    pub(super) waves: &'a [&'a [f32]],
    pub(super) instants: usize,
    /// Real and imaginary part of e^{jisα}, `[blade][nodal diameter]`.
    pub(super) turns: &'a [(f32, f32)],
    pub(super) blades: usize,
    /// Largest error of the trace that follows from the waves.
    pub(super) trace_error: f32,
}

/// Extremes of the squared von Mises stress, signed by the trace where its sign is certain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes {
    pub(super) largest: f32,
    /// Largest signed square if every doubtful sign is plus.
    pub(super) high_at_most: f32,
    /// Smallest signed square if every doubtful sign is minus.
    pub(super) low_at_least: f32,
    /// Largest signed square if every doubtful sign is minus.
    pub(super) high_at_least: f32,
    /// Smallest signed square if every doubtful sign is plus.
    pub(super) low_at_most: f32,
}

/// Computation of the extremes of every blade.
struct AllBlades<'a, 'b> {
    moved: &'b Moved<'a>,
    found: &'b mut Vec<Extremes>,
}

impl Moved<'_> {
    /// Writes the extremes of every blade into `found`.
    pub(super) fn extremes(&self, arch: pulp::Arch, found: &mut Vec<Extremes>) {
        found.clear();
        arch.dispatch(AllBlades { moved: self, found });
    }
}

impl WithSimd for AllBlades<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for blade in 0..self.moved.blades {
            self.found.push(self.moved.of_blade(simd, blade));
        }
    }
}

impl Moved<'_> {
    #[inline(always)]
    fn of_blade<S: Simd>(&self, simd: S, blade: usize) -> Extremes {
        let count = self.waves.len();
        let turns = &self.turns[blade * count..][..count];
        let instants = self.instants;
        let zero = simd.splat_f32s(0.0);
        let error = simd.splat_f32s(self.trace_error);
        let against = simd.splat_f32s(-self.trace_error);
        let (least, most) = (simd.splat_f32s(f32::NEG_INFINITY), simd.splat_f32s(f32::INFINITY));
        let (mut largest, mut high_at_most, mut high_at_least) = (least, least, least);
        let (mut low_at_least, mut low_at_most) = (most, most);
        for first in (0..instants).step_by(S::F32_LANES) {
            let mut s = self.fixed.map(|fixed| simd.splat_f32s(fixed));
            for (wave, &(cos, sin)) in self.waves.iter().zip(turns) {
                let (cos, minus_sin) = (simd.splat_f32s(cos), simd.splat_f32s(-sin));
                for (component, sum) in s.iter_mut().enumerate() {
                    let at = 2 * component * instants + first;
                    let re = S::as_simd_f32s(&wave[at..at + S::F32_LANES]).0[0];
                    let im = S::as_simd_f32s(&wave[at + instants..at + instants + S::F32_LANES]).0[0];
                    *sum = simd.mul_add_e_f32s(cos, re, *sum);
                    *sum = simd.mul_add_e_f32s(minus_sin, im, *sum);
                }
            }
            let square = |a: S::f32s| simd.mul_f32s(a, a);
            let normal = simd.add_f32s(
                square(simd.sub_f32s(s[0], s[1])),
                simd.add_f32s(square(simd.sub_f32s(s[1], s[2])), square(simd.sub_f32s(s[2], s[0]))),
            );
            let shear = simd.add_f32s(square(s[3]), simd.add_f32s(square(s[4]), square(s[5])));
            let size =
                simd.mul_add_e_f32s(simd.splat_f32s(0.5), normal, simd.mul_f32s(simd.splat_f32s(3.0), shear));
            let trace = simd.add_f32s(s[0], simd.add_f32s(s[1], s[2]));
            let minus = simd.sub_f32s(zero, size);
            // Tension for sure, and perhaps.
            let sure = simd.select_f32s(simd.greater_than_f32s(trace, error), size, minus);
            let perhaps = simd.select_f32s(simd.less_than_f32s(trace, against), minus, size);
            largest = simd.max_f32s(largest, size);
            high_at_most = simd.max_f32s(high_at_most, perhaps);
            low_at_least = simd.min_f32s(low_at_least, sure);
            high_at_least = simd.max_f32s(high_at_least, sure);
            low_at_most = simd.min_f32s(low_at_most, perhaps);
        }
        Extremes {
            largest: simd.reduce_max_f32s(largest),
            high_at_most: simd.reduce_max_f32s(high_at_most),
            low_at_least: simd.reduce_min_f32s(low_at_least),
            high_at_least: simd.reduce_max_f32s(high_at_least),
            low_at_most: simd.reduce_min_f32s(low_at_most),
        }
    }
}
