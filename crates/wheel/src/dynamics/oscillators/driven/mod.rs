//! Modal oscillators under forces other than contact: engine orders, mistuning, blades that stiffen, Coriolis and Euler forces.
//!
//! The recursion of [`recursion`](super::recursion), with known modal forces at the middle instant of each step and, for
//! Coriolis forces, swings turned by S ([`super::super::coriolis`]):
//!
//! ```text
//! z⁺ − z⁻ = S (keep·d − pull·z + receptance·f + d),   d⁺ = z⁺ − z⁻ − d,   z⁺ = z + d⁺
//! ```
//!
//! A step is completed before the next one is predicted: of one nodal diameter after the other, or with mistuning or stiffening, whose
//! pull depends on the displacements of all of them, in two passes over the mode shapes. Contact forces move S R φᴴ f within a step.

mod acting;
mod circulation;
mod stiffening;
mod turning;

use faer::{Mat, c64};
use pulp::{Simd, WithSimd};

use super::super::coriolis::swing_matrix;
use super::super::direction::Direction;
use super::super::effects::Effects;
use super::super::energy::EffectWork;
use super::super::excitation::{EngineOrderExcitation, ModalExcitation};
use super::super::initial::InitialMode;
use super::super::mistuning::{ModalMistuning, ModeOffsets, RESOLVED};
use super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::recursion::{Exchange, Modes};
use super::rows::{Loads, Readout, Rows};
use super::segment::Segment;
use super::{Oscillators, Part};
use acting::{Acting, DrivenSums, Excitation};
use circulation::Circulation;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;
use rubmap_numerics::vectors::arch;
use stiffening::Stiffening;
use turning::Turning;

/// Drive of the oscillators: forces other than contact, and the numbers of the step under way.
#[derive(Debug)]
pub(crate) struct Drive {
    excitations: Vec<Excitation>,
    mistuning: Option<ModalMistuning>,
    stiffening: Option<Stiffening>,
    offsets: Vec<ModeOffsets>,
    turning: Option<Turning>,
    circulation: Option<Circulation>,
    acting: Acting,
    /// Swings z⁺ − z⁻ of a step that is not counted yet, otherwise 0.
    swing: Aligned,
    /// Displacements of one nodal diameter by contact forces, or its swing before S.
    moved: Aligned,
    /// Swing of one nodal diameter after S.
    turned: Aligned,
    /// Sum of the forces on one part of a nodal diameter, where there are several.
    total: Aligned,
}

impl Drive {
    /// Drive of the oscillators; none if only contact moves the modes. Steps last `step` seconds, contact forces act along `loaded`.
    pub(crate) fn new(
        wheel: &ModalWheel,
        contact_nodes: usize,
        effects: &Effects<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        step: f64,
        loaded: Option<&Rows>,
    ) -> Option<Self> {
        if !Self::acts(wheel, effects) {
            return None;
        }
        let turning = Turning::new(wheel, oscillators, step, loaded);
        let state = oscillators.state.z.len();
        let of = |wanted: bool| Aligned::zeros(if wanted { state } else { 0 });
        let mistuning = effects.mistuning.map(|deviations| {
            ModalMistuning::new(deviations, wheel, contact_nodes, fourier, oscillators.resolved_families())
        });
        let stiffening = effects.stiffening().map(|bending| {
            let resolved = oscillators.resolved_families();
            Stiffening::new(bending, wheel, fourier, resolved, step)
        });
        let longest = oscillators.segments.iter().map(|segment| segment.length).max().unwrap_or(0);
        let segments = &oscillators.segments;
        let engine_order = |excitation: &EngineOrderExcitation| {
            Excitation::engine_order(ModalExcitation::new(excitation, wheel), segments)
        };
        let euler = effects.euler_force.map(|force| Excitation::euler(force, segments));
        let excitations: Vec<_> = effects.excitation.iter().map(engine_order).chain(euler).collect();
        let circulation =
            effects.euler_force.and_then(|force| Circulation::new(&force.rate, wheel, segments));
        let excited = |index: usize| {
            circulation.is_some() || excitations.iter().any(|excitation| excitation.harmonic == index)
        };
        Some(Self {
            acting: Acting {
                contact: Aligned::zeros(2 * longest),
                excitation: of(effects.forces_are_known()),
                excited: (0..wheel.harmonics.len()).map(excited).collect(),
                mistuning: of(mistuning.is_some()),
                stiffening: of(stiffening.is_some()),
            },
            excitations,
            mistuning,
            stiffening,
            offsets: oscillators.segments.iter().map(Segment::offsets).collect(),
            turning,
            circulation,
            swing: of(true),
            moved: Aligned::zeros(2 * longest),
            turned: Aligned::zeros(2 * longest),
            total: Aligned::zeros(longest),
        })
    }

    /// Whether anything but contact acts on the modes.
    pub(crate) fn acts(wheel: &ModalWheel, effects: &Effects<'_>) -> bool {
        wheel.turns()
            || effects.mistuning.is_some()
            || effects.stiffening().is_some()
            || effects.forces_are_known()
    }

    /// Adds the part of the drive's forces after `revolutions` to the first increments d = z − z⁻, which are those of free motion: without
    /// it the start would be of first order in h only.
    pub(crate) fn start(
        &mut self,
        wheel: &ModalWheel,
        initial: &[InitialMode],
        oscillators: &mut Oscillators,
        revolutions: f64,
    ) {
        arch().dispatch(Begin(self, oscillators));
        self.add_to_increments(wheel, initial, oscillators, revolutions, -1.0);
    }

    /// Stiffness −∂f/∂z of mistuning between the Fourier columns of every family that it couples.
    pub(crate) fn mistuned(&self) -> Vec<Mat<f64>> {
        self.mistuning.as_ref().map(|mistuning| mistuning.stiffness(&self.offsets)).unwrap_or_default()
    }

    /// Reverses [`Self::start`] after `revolutions`: leaves the increments that free motion has at the same velocities, as `read` finds them.
    pub(crate) fn end(
        &mut self,
        wheel: &ModalWheel,
        revolutions: f64,
        oscillators: &mut Oscillators,
        read: impl Fn(&Oscillators) -> Vec<InitialMode>,
    ) {
        // Coriolis forces depend on the velocities they are read with, by hΩ|g|/2 of them.
        const ROUNDS: usize = 20;
        let increments = oscillators.state.d.clone();
        for _ in 0..ROUNDS {
            let modes = read(oscillators);
            oscillators.state.d.copy_from_slice(&increments);
            self.add_to_increments(wheel, &modes, oscillators, revolutions, 1.0);
        }
    }

    /// Adds `sign` times the part that the drive's forces have in the increments of a wheel whose `modes` move.
    fn add_to_increments(
        &mut self,
        wheel: &ModalWheel,
        modes: &[InitialMode],
        oscillators: &mut Oscillators,
        revolutions: f64,
        sign: f64,
    ) {
        arch().dispatch(Prepare(self, oscillators, revolutions));
        self.swing.fill(0.0);
        for force in [&self.acting.excitation, &self.acting.mistuning, &self.acting.stiffening] {
            for (sum, f) in self.swing.iter_mut().zip(force.iter()) {
                *sum += f;
            }
        }
        for mode in modes {
            let (segment, harmonic) = (oscillators.segments[mode.harmonic], &wheel.harmonics[mode.harmonic]);
            let Some(g) = &harmonic.gyroscopic else { continue };
            for m in 0..segment.integrated {
                let velocity = if segment.single { c64::from(mode.velocity.re) } else { mode.velocity };
                let force = -g[(m, mode.family)] * velocity * wheel.speed_rad_s;
                for (start, part) in segment.parts().zip([force.re, force.im]) {
                    self.swing[start + m] += part;
                }
            }
        }
        let Oscillators { segments, coefficients, state, .. } = oscillators;
        for segment in segments {
            for start in segment.parts() {
                for m in 0..segment.integrated {
                    let mode = segment.modes + m;
                    let share = coefficients.receptance[mode] / (1.0 + coefficients.keep[mode]);
                    state.d[start + m] += sign * share * self.swing[start + m];
                }
            }
        }
        self.swing.fill(0.0);
    }

    /// Swings z⁺ − z⁻ of every mode in a step that is not complete.
    pub(crate) fn swung(&self) -> &[f64] {
        &self.swing
    }

    /// Computes the known forces on nodal diameter `index`, `revolutions` after the start, and the Euler force on its displacements in `z`.
    #[inline(always)]
    fn force<S: Simd>(&mut self, simd: S, index: usize, segment: Segment, revolutions: f64, z: &[f64]) {
        let Self { acting, excitations, circulation, .. } = self;
        acting.excite(simd, excitations, index, segment, revolutions);
        if let Some(circulation) = circulation {
            let range = segment.state..segment.state + segment.size();
            circulation.push(
                simd,
                index,
                segment,
                revolutions,
                &z[range.clone()],
                &mut acting.excitation[range],
            );
        }
    }

    /// Energy of blades that stiffen beyond the quadratic one, half-way through the last complete step. None where blades do not stiffen.
    #[inline(always)]
    pub(crate) fn stiffening_energy<S: Simd>(&mut self, simd: S, oscillators: &Oscillators) -> Option<f64> {
        let Self { stiffening, acting, .. } = self;
        let (stiffening, state) = (stiffening.as_mut()?, &oscillators.state);
        // The forces are not needed any more once the step is complete.
        let before = &mut acting.stiffening;
        before
            .iter_mut()
            .zip(state.z.iter().zip(state.d.iter()))
            .for_each(|(before, (z, d))| *before = z - d);
        Some(stiffening.energy(simd, &oscillators.segments, [before, &state.z]))
    }

    /// Computes the forces of mistuning and stiffening at the beginning of a step from the state `z` of the oscillators with these segments, once
    /// per step, and stores the state as past.
    #[inline(always)]
    fn pull_and_remember<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64]) {
        self.pull(simd, segments, z);
        if let Some(stiffening) = &mut self.stiffening {
            stiffening.remember();
        }
    }

    /// Computes the forces of mistuning and stiffening in the state `z` of the oscillators with these segments.
    #[inline(always)]
    fn pull<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64]) {
        if let Some(mistuning) = &mut self.mistuning {
            mistuning.force(simd, &self.offsets, z, &mut self.acting.mistuning);
        }
        if let Some(stiffening) = &mut self.stiffening {
            stiffening.force(simd, segments, z, &mut self.acting.stiffening);
        }
    }
}

/// Fills the past of blades that stiffen, before the step loop.
struct Begin<'a>(&'a mut Drive, &'a Oscillators);

impl WithSimd for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(drive, oscillators) = self;
        if let Some(stiffening) = &mut drive.stiffening {
            stiffening.begin(simd, oscillators);
        }
    }
}

/// Computation, beside the step loop, of all forces of the state z, a number of revolutions after the start.
struct Prepare<'a>(&'a mut Drive, &'a Oscillators, f64);

impl WithSimd for Prepare<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(drive, oscillators, revolutions) = self;
        drive.pull(simd, &oscillators.segments, &oscillators.state.z);
        for (index, &segment) in oscillators.segments.iter().enumerate() {
            drive.force(simd, index, segment, revolutions, &oscillators.state.z);
        }
    }
}

impl Oscillators {
    /// Number of families that a step resolves in every nodal diameter, ω²B ≤ 3.
    fn resolved_families(&self) -> usize {
        let of = |segment: &Segment| {
            let resolved = |m: &usize| {
                let mode = segment.modes + m;
                let (stiffness, inertia) =
                    (self.coefficients.stiffness[mode], self.coefficients.inertia[mode]);
                stiffness <= RESOLVED * inertia
            };
            (0..segment.integrated).take_while(resolved).count()
        };
        self.segments.iter().map(of).min().unwrap_or(0)
    }

    /// Displacement per unit force of the modes of `segment` within a step.
    fn receptances(&self, segment: &Segment) -> &[f64] {
        &self.coefficients.receptance[segment.modes..][..segment.integrated]
    }

    /// Completes the last step by `loads`, and counts it.
    #[inline(always)]
    pub(crate) fn complete_driven<S: Simd>(
        &mut self,
        simd: S,
        drive: &mut Drive,
        loads: Loads<'_>,
        work: &mut EffectWork,
    ) -> Exchange {
        let mut sums = DrivenSums::new(simd);
        for index in 0..self.segments.len() {
            self.complete_one(simd, index, drive, loads, &mut sums);
        }
        sums.total(simd, work)
    }

    /// Completes the last step by `loads` as [`Self::complete_driven`] does, then takes a step free of contact, `revolutions` after the
    /// start, and reads rows as [`Self::project`] does.
    #[inline(always)]
    pub(crate) fn complete_and_predict_driven<S: Simd>(
        &mut self,
        simd: S,
        drive: &mut Drive,
        loads: Loads<'_>,
        revolutions: f64,
        reading: Readout<'_>,
        work: &mut EffectWork,
    ) -> Exchange {
        let mut sums = DrivenSums::new(simd);
        // Mistuning and stiffening pull at what all nodal diameters have come to. Without them one after the other is completed and predicted
        // while its mode shapes are in the first-level cache.
        let at_once = drive.mistuning.is_none() && drive.stiffening.is_none();
        if !at_once {
            for index in 0..self.segments.len() {
                self.complete_one(simd, index, drive, loads, &mut sums);
            }
            drive.pull_and_remember(simd, &self.segments, &self.state.z);
        }
        for index in 0..self.segments.len() {
            if at_once {
                self.complete_one(simd, index, drive, loads, &mut sums);
            }
            self.swing(simd, index, drive, revolutions, false);
            reading.rows.project(simd, index, self.segments[index], &self.state.z, reading.out);
        }
        sums.total(simd, work)
    }

    #[inline(always)]
    fn complete_one<S: Simd>(
        &mut self,
        simd: S,
        index: usize,
        drive: &mut Drive,
        loads: Loads<'_>,
        sums: &mut DrivenSums<S>,
    ) {
        let segment = self.segments[index];
        let Drive { turning, acting, swing, moved, .. } = drive;
        let loaded = !loads.loaded.is_empty();
        if loaded {
            loads.modal(simd, index, segment, &mut acting.contact);
            if let Some(turning) = turning {
                turning.moving(loads).modal(simd, index, segment, moved);
            }
        }
        let of = self.coefficients.of::<S>(segment);
        let turns = turning.is_some();
        for start in segment.parts() {
            let Part { z, d, .. } = self.state.part::<S>(segment, start, false, false);
            let forces = acting.on::<S>(index, segment, start, loaded);
            let swing = &mut S::as_mut_simd_f64s(&mut swing[start..start + segment.length]).0[..z.len()];
            let moved = &S::as_simd_f64s(&moved[start - segment.state..][..segment.length]).0[..z.len()];
            if let Some(force) = forces.contact {
                for m in 0..z.len() {
                    let mut modes = Modes { z: z[m], d: d[m], swing: swing[m] };
                    let moved = if turns { moved[m] } else { simd.mul_f64s(of.receptance[m], force[m]) };
                    modes.move_by(simd, moved);
                    (z[m], d[m], swing[m]) = (modes.z, modes.d, modes.swing);
                }
            }
            sums.count(simd, swing, of.loss, &forces);
            swing.fill(simd.splat_f64s(0.0));
        }
    }

    /// Takes a step under `loads` that act from its start, `revolutions` after the start, and counts it. Reads rows as
    /// [`Self::project`] does.
    #[inline(always)]
    pub(crate) fn advance_driven<S: Simd>(
        &mut self,
        simd: S,
        drive: &mut Drive,
        loads: Option<Loads<'_>>,
        revolutions: f64,
        mut reading: Option<Readout<'_>>,
        work: &mut EffectWork,
    ) -> Exchange {
        let mut sums = DrivenSums::new(simd);
        drive.pull_and_remember(simd, &self.segments, &self.state.z);
        for index in 0..self.segments.len() {
            let segment = self.segments[index];
            if let Some(loads) = loads {
                loads.modal(simd, index, segment, &mut drive.acting.contact);
            }
            self.swing(simd, index, drive, revolutions, loads.is_some());
            let of = self.coefficients.of::<S>(segment);
            for start in segment.parts() {
                let swing = S::as_simd_f64s(&drive.swing[start..start + segment.length]).0;
                let forces = drive.acting.on::<S>(index, segment, start, loads.is_some());
                sums.count(simd, swing, of.loss, &forces);
            }
            if let Some(Readout { rows, out }) = &mut reading {
                rows.project(simd, index, segment, &self.state.z, out);
            }
        }
        sums.total(simd, work)
    }

    /// Takes the step of one nodal diameter, `revolutions` after the start, under the drive's forces and, if it is `loaded`, those of contact.
    #[inline(always)]
    fn swing<S: Simd>(&mut self, simd: S, index: usize, drive: &mut Drive, revolutions: f64, loaded: bool) {
        let segment = self.segments[index];
        drive.force(simd, index, segment, revolutions, &self.state.z);
        let Drive { turning, acting, swing, moved, turned, total, .. } = drive;
        let of = self.coefficients.of::<S>(segment);
        let turns = turning.is_some();
        for start in segment.parts() {
            let Part { z, d, .. } = self.state.part::<S>(segment, start, false, false);
            let total = S::as_mut_simd_f64s(&mut total[..segment.length]).0;
            let force = acting.on::<S>(index, segment, start, loaded).total(simd, total);
            let swing = S::as_mut_simd_f64s(&mut swing[start..start + segment.length]).0;
            let moved = S::as_mut_simd_f64s(&mut moved[start - segment.state..][..segment.length]).0;
            for m in 0..of.keep.len() {
                let mut modes = Modes { z: z[m], d: d[m], swing: swing[m] };
                modes.advance(simd, &of.at(m), force.map(|force| force[m]));
                if turns {
                    moved[m] = modes.swing;
                } else {
                    (z[m], d[m], swing[m]) = (modes.z, modes.d, modes.swing);
                }
            }
        }
        let Some(turning) = turning else { return };
        turning.turn(simd, index, segment, moved, turned);
        for start in segment.parts() {
            let Part { z, d, .. } = self.state.part::<S>(segment, start, false, false);
            let swing = S::as_mut_simd_f64s(&mut swing[start..start + segment.length]).0;
            let turned = S::as_simd_f64s(&turned[start - segment.state..][..segment.length]).0;
            for m in 0..turned.len() {
                let mut modes = Modes { z: z[m], d: d[m], swing: swing[m] };
                modes.swing_by(simd, turned[m]);
                (z[m], d[m], swing[m]) = (modes.z, modes.d, modes.swing);
            }
        }
    }

    /// Flexibility within a step, per nodal diameter: displacements along `to` by a unit force along `from`, Coriolis forces included.
    pub(crate) fn turned_flexibility(
        &self,
        wheel: &ModalWheel,
        step: f64,
        to: &[Direction],
        from: &[Direction],
    ) -> Vec<Mat<c64>> {
        let of = |(harmonic, segment): (&ModalHarmonic, &Segment)| {
            let receptance = self.receptances(segment);
            let modes = receptance.len();
            let shapes = harmonic.contact.as_ref();
            let source = Mat::from_fn(modes, from.len(), |m, k| from[k].of(shapes, m).conj() * receptance[m]);
            let target = Mat::from_fn(to.len(), modes, |k, m| to[k].of(shapes, m));
            match &harmonic.gyroscopic {
                Some(g) => target * (swing_matrix(g.as_ref(), wheel.speed_rad_s, step, receptance) * source),
                None => target * source,
            }
        };
        wheel.harmonics.iter().zip(&self.segments).map(of).collect()
    }
}
