//! Step of the oscillators in one vector, and the passes over all of them that are made of it.
//!
//! ```text
//! advance     d⁺ = keep·d − pull·z (+ receptance·f),   z⁺ = z + d⁺      Eq. 8
//! complete    z, d and z⁺ − z⁻ by receptance·f                          Eq. 10
//! ```
//!
//! Multiply-adds are fused, in this order: it is part of the result.

use pulp::Simd;

/// Energy gained and lost (see [`super::super::schemes`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Exchange {
    /// Work of the loads, Σ f (z⁺ − z⁻)/2.
    pub(crate) work: f64,
    /// Loss Σ c (z⁺ − z⁻)²/(2B).
    pub(crate) loss: f64,
}

/// Numbers of a vector of modes, those of [`Coefficients`](super::Coefficients).
pub(super) struct Numbers<S: Simd> {
    pub(super) keep: S::f64s,
    pub(super) pull: S::f64s,
    pub(super) receptance: S::f64s,
    pub(super) loss: S::f64s,
}

/// Vector of modes in motion.
pub(super) struct Modes<S: Simd> {
    pub(super) z: S::f64s,
    /// Increment d = z − z⁻.
    pub(super) d: S::f64s,
    /// Swing z⁺ − z⁻ of the last step.
    pub(super) swing: S::f64s,
}

impl<S: Simd> Modes<S> {
    /// Takes the next step, under a force that acts from its start.
    #[inline(always)]
    pub(super) fn advance(&mut self, simd: S, of: &Numbers<S>, force: Option<S::f64s>) {
        let free = simd.negate_mul_add_e_f64s(of.pull, self.z, simd.mul_f64s(of.keep, self.d));
        let next = match force {
            Some(force) => simd.mul_add_e_f64s(of.receptance, force, free),
            None => free,
        };
        self.swing = simd.add_f64s(next, self.d);
        self.d = next;
        self.z = simd.add_f64s(self.z, next);
    }

    /// Completes the last step by a force at its end.
    #[inline(always)]
    fn complete(&mut self, simd: S, of: &Numbers<S>, force: Option<S::f64s>) {
        if let Some(force) = force {
            self.move_by(simd, simd.mul_f64s(of.receptance, force));
        }
    }

    /// Moves the end of the last step by `moved`.
    #[inline(always)]
    pub(super) fn move_by(&mut self, simd: S, moved: S::f64s) {
        self.z = simd.add_f64s(self.z, moved);
        self.d = simd.add_f64s(self.d, moved);
        self.swing = simd.add_f64s(self.swing, moved);
    }

    /// Takes the next step, whose swing is known.
    #[inline(always)]
    pub(super) fn swing_by(&mut self, simd: S, swing: S::f64s) {
        self.swing = swing;
        self.d = simd.sub_f64s(swing, self.d);
        self.z = simd.add_f64s(self.z, self.d);
    }
}

/// Sums of [`Exchange`] in lanes, twice the work; without the loss of modes that lose nothing, which would cost 3 % of a step.
pub(super) struct Sums<S: Simd, const DISSIPATES: bool> {
    twice_work: S::f64s,
    loss: S::f64s,
}

impl<S: Simd, const DISSIPATES: bool> Sums<S, DISSIPATES> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self { twice_work: simd.splat_f64s(0.0), loss: simd.splat_f64s(0.0) }
    }

    /// Adds the exchange of a step that is final.
    #[inline(always)]
    fn count(&mut self, simd: S, modes: &Modes<S>, of: &Numbers<S>, force: Option<S::f64s>) {
        if let Some(force) = force {
            self.twice_work = simd.mul_add_e_f64s(force, modes.swing, self.twice_work);
        }
        if DISSIPATES {
            self.loss = simd.mul_add_e_f64s(of.loss, simd.mul_f64s(modes.swing, modes.swing), self.loss);
        }
    }

    #[inline(always)]
    pub(super) fn total(self, simd: S) -> Exchange {
        Exchange { work: 0.5 * simd.reduce_sum_f64s(self.twice_work), loss: simd.reduce_sum_f64s(self.loss) }
    }
}

/// Pass over the oscillators: its action on each vector of them.
pub(super) trait Pass {
    /// Whether a step is counted by a later pass than the one that takes it: its z⁺ − z⁻ is stored until then.
    const COUNTS_LATER: bool;

    fn over<S: Simd, const DISSIPATES: bool>(
        simd: S,
        modes: &mut Modes<S>,
        of: &Numbers<S>,
        force: Option<S::f64s>,
        sums: &mut Sums<S, DISSIPATES>,
    );
}

/// Pass that takes a step, under forces that act from its start.
pub(super) struct Advance;

impl Pass for Advance {
    const COUNTS_LATER: bool = false;

    #[inline(always)]
    fn over<S: Simd, const DISSIPATES: bool>(
        simd: S,
        modes: &mut Modes<S>,
        of: &Numbers<S>,
        force: Option<S::f64s>,
        sums: &mut Sums<S, DISSIPATES>,
    ) {
        modes.advance(simd, of, force);
        sums.count(simd, modes, of, force);
    }
}

/// Pass that completes the last step by forces at its end.
pub(super) struct Complete;

impl Pass for Complete {
    const COUNTS_LATER: bool = true;

    #[inline(always)]
    fn over<S: Simd, const DISSIPATES: bool>(
        simd: S,
        modes: &mut Modes<S>,
        of: &Numbers<S>,
        force: Option<S::f64s>,
        sums: &mut Sums<S, DISSIPATES>,
    ) {
        modes.complete(simd, of, force);
        sums.count(simd, modes, of, force);
        modes.swing = simd.splat_f64s(0.0);
    }
}

/// Pass that completes the last step by forces at its end, and takes the next one free of them.
pub(super) struct CompleteAndPredict;

impl Pass for CompleteAndPredict {
    const COUNTS_LATER: bool = true;

    #[inline(always)]
    fn over<S: Simd, const DISSIPATES: bool>(
        simd: S,
        modes: &mut Modes<S>,
        of: &Numbers<S>,
        force: Option<S::f64s>,
        sums: &mut Sums<S, DISSIPATES>,
    ) {
        modes.complete(simd, of, force);
        sums.count(simd, modes, of, force);
        modes.advance(simd, of, None);
    }
}
