//! Known modal forces, and the energy that a step exchanges with them.

use faer::c64;
use pulp::Simd;

use super::super::super::energy::EffectWork;
use super::super::super::euler::{EulerForce, SpeedRate};
use super::super::super::excitation::ModalExcitation;
use super::super::recursion::Exchange;
use super::super::segment::Segment;
use rubmap_numerics::aligned::Aligned;

/// Force on the modes of a nodal diameter that is known beforehand.
#[derive(Debug)]
pub(super) struct Excitation {
    /// Index of the nodal diameter.
    pub(super) harmonic: usize,
    course: Course,
    /// Amplitude of every mode, padded.
    re: Aligned,
    im: Aligned,
}

/// Course of an excitation: the factor of its amplitudes.
#[derive(Debug)]
enum Course {
    EngineOrder(ModalExcitation),
    Euler(SpeedRate),
}

impl Excitation {
    /// Excitation at an engine order, on nodal diameters at `segments` of the state.
    pub(super) fn engine_order(force: ModalExcitation, segments: &[Segment]) -> Self {
        let Segment { integrated, length, .. } = segments[force.harmonic];
        let (mut re, mut im) = (Aligned::zeros(length), Aligned::zeros(length));
        for (m, amplitude) in force.amplitude[..integrated].iter().enumerate() {
            (re[m], im[m]) = (amplitude.re, amplitude.im);
        }
        Self { harmonic: force.harmonic, course: Course::EngineOrder(force), re, im }
    }

    /// Excitation by the Euler force on the wheel at rest in its frame.
    pub(super) fn euler(force: &EulerForce, segments: &[Segment]) -> Self {
        let Segment { integrated, length, .. } = segments[0];
        let mut re = Aligned::zeros(length);
        re[..integrated].copy_from_slice(&force.load[..integrated]);
        Self { harmonic: 0, course: Course::Euler(force.rate.clone()), re, im: Aligned::zeros(length) }
    }

    fn factor(&self, revolutions: f64) -> c64 {
        match &self.course {
            Course::EngineOrder(force) => force.turn(revolutions),
            Course::Euler(rate) => c64::from(rate.at(revolutions)),
        }
    }
}

/// Modal forces of the step under way.
#[derive(Debug)]
pub(super) struct Acting {
    /// Modal forces φᴴf of contact on the nodal diameter under way.
    pub(super) contact: Aligned,
    /// Modal forces at engine orders and of the Euler force on all nodal diameters; empty without.
    pub(super) excitation: Aligned,
    /// Whether `excitation` acts on each nodal diameter.
    pub(super) excited: Vec<bool>,
    /// Modal forces of mistuning on all nodal diameters; empty without.
    pub(super) mistuning: Aligned,
    /// Modal forces of blades that stiffen on all nodal diameters; empty without.
    pub(super) stiffening: Aligned,
}

impl Acting {
    /// Sets the forces of `excitations` on nodal diameter `index` to those `revolutions` after the start.
    #[inline(always)]
    pub(super) fn excite<S: Simd>(
        &mut self,
        simd: S,
        excitations: &[Excitation],
        index: usize,
        segment: Segment,
        revolutions: f64,
    ) {
        if !self.is_excited(index) {
            return;
        }
        self.excitation[segment.state..segment.state + segment.size()].fill(0.0);
        for excitation in excitations.iter().filter(|excitation| excitation.harmonic == index) {
            let turn = excitation.factor(revolutions);
            let (re, im) = (S::as_simd_f64s(&excitation.re).0, S::as_simd_f64s(&excitation.im).0);
            // Re and Im of amplitude × turn.
            let factors = [(turn.re, -turn.im), (turn.im, turn.re)];
            for (start, (of_re, of_im)) in segment.parts().zip(factors) {
                let (of_re, of_im) = (simd.splat_f64s(of_re), simd.splat_f64s(of_im));
                let sums = S::as_mut_simd_f64s(&mut self.excitation[start..start + segment.length]).0;
                for m in 0..sums.len() {
                    sums[m] = simd.mul_add_e_f64s(of_re, re[m], sums[m]);
                    sums[m] = simd.mul_add_e_f64s(of_im, im[m], sums[m]);
                }
            }
        }
    }

    #[inline(always)]
    fn is_excited(&self, index: usize) -> bool {
        self.excited[index]
    }

    /// Modal forces on the part of nodal diameter `index` that begins at `start`, with contact if it is `loaded`.
    #[inline(always)]
    pub(super) fn on<S: Simd>(
        &self,
        index: usize,
        segment: Segment,
        start: usize,
        loaded: bool,
    ) -> Forces<'_, S> {
        let range = start..start + segment.length;
        let offset = start - segment.state;
        let (mistuned, stiffens) = (!self.mistuning.is_empty(), !self.stiffening.is_empty());
        Forces {
            contact: loaded.then(|| S::as_simd_f64s(&self.contact[offset..offset + segment.length]).0),
            excitation: self.is_excited(index).then(|| S::as_simd_f64s(&self.excitation[range.clone()]).0),
            mistuning: mistuned.then(|| S::as_simd_f64s(&self.mistuning[range.clone()]).0),
            stiffening: stiffens.then(|| S::as_simd_f64s(&self.stiffening[range]).0),
        }
    }
}

/// Modal forces on one part of a nodal diameter; absent where nothing of the kind acts.
#[derive(Clone, Copy)]
pub(super) struct Forces<'a, S: Simd> {
    pub(super) contact: Option<&'a [S::f64s]>,
    pub(super) excitation: Option<&'a [S::f64s]>,
    pub(super) mistuning: Option<&'a [S::f64s]>,
    pub(super) stiffening: Option<&'a [S::f64s]>,
}

impl<'a, S: Simd> Forces<'a, S> {
    /// Forces of all kinds together, if there are any; `sum` is where several of them are added up.
    #[inline(always)]
    pub(super) fn total(&self, simd: S, sum: &'a mut [S::f64s]) -> Option<&'a [S::f64s]> {
        let all = [self.contact, self.excitation, self.mistuning, self.stiffening];
        let mut acting = all.into_iter().flatten();
        let first = acting.next()?;
        let Some(second) = acting.next() else { return Some(first) };
        for ((sum, &a), &b) in sum.iter_mut().zip(first).zip(second) {
            *sum = simd.add_f64s(a, b);
        }
        for force in acting {
            for (sum, &f) in sum.iter_mut().zip(force) {
                *sum = simd.add_f64s(*sum, f);
            }
        }
        Some(sum)
    }
}

/// Sums of [`Exchange`] and works of effects in lanes, works twice.
pub(super) struct DrivenSums<S: Simd> {
    contact: S::f64s,
    excitation: S::f64s,
    mistuning: S::f64s,
    stiffening: S::f64s,
    loss: S::f64s,
}

impl<S: Simd> DrivenSums<S> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self { contact: zero, excitation: zero, mistuning: zero, stiffening: zero, loss: zero }
    }

    /// Adds the exchange of the final swings of a part under `forces`.
    #[inline(always)]
    pub(super) fn count(&mut self, simd: S, swing: &[S::f64s], loss: &[S::f64s], forces: &Forces<'_, S>) {
        for (&loss, &swing) in loss.iter().zip(swing) {
            self.loss = simd.mul_add_e_f64s(loss, simd.mul_f64s(swing, swing), self.loss);
        }
        let works = [
            (&mut self.contact, forces.contact),
            (&mut self.excitation, forces.excitation),
            (&mut self.mistuning, forces.mistuning),
            (&mut self.stiffening, forces.stiffening),
        ];
        for (work, force) in works {
            let Some(force) = force else { continue };
            let mut sum = *work;
            for (&force, &swing) in force.iter().zip(swing) {
                sum = simd.mul_add_e_f64s(force, swing, sum);
            }
            *work = sum;
        }
    }

    /// Adds the works of effects to `work`, and returns the exchange with contact and damping.
    #[inline(always)]
    pub(super) fn total(self, simd: S, work: &mut EffectWork) -> Exchange {
        work.excitation += 0.5 * simd.reduce_sum_f64s(self.excitation);
        work.mistuning += 0.5 * simd.reduce_sum_f64s(self.mistuning);
        work.stiffening += 0.5 * simd.reduce_sum_f64s(self.stiffening);
        Exchange { work: 0.5 * simd.reduce_sum_f64s(self.contact), loss: simd.reduce_sum_f64s(self.loss) }
    }
}
