//! Modal oscillators under forces other than contact: engine orders, mistuning and Coriolis forces.
//!
//! The recursion of [`recursion`](super::recursion), with known modal forces at the middle instant of each step and, for
//! Coriolis forces, swings turned by S ([`super::super::coriolis`]):
//!
//! ```text
//! z⁺ − z⁻ = S (keep·d − pull·z + d + receptance·f),   d⁺ = z⁺ − z⁻ − d,   z⁺ = z + d⁺
//! ```
//!
//! It is the swing that S turns, so the swing comes first, and products are rounded before they are added: other bits than
//! the recursion without a drive. Completion and prediction are two passes over the mode shapes.

use faer::{Mat, c64};
use pulp::Simd;

use super::super::coriolis::swing_matrix;
use super::super::direction::Direction;
use super::super::effects::Effects;
use super::super::energy::EffectWork;
use super::super::excitation::{EngineOrderExcitation, ModalExcitation};
use super::super::initial::InitialMode;
use super::super::mistuning::{ModalMistuning, Place, RESOLVED};
use super::super::modal_wheel::ModalWheel;
use super::Oscillators;
use super::recursion::Exchange;
use super::rows::{Loads, RowBlock};
use super::segment::Segment;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;

/// What drives the oscillators, and the numbers of the step under way.
#[derive(Debug)]
pub(crate) struct Drive {
    excitations: Vec<ModalExcitation>,
    /// Their modal forces at the middle of the step; empty without.
    excitation: Aligned,
    mistuning: Option<ModalMistuning>,
    /// Its modal forces; empty without.
    pull: Aligned,
    places: Vec<Place>,
    /// S per nodal diameter; empty without Coriolis forces.
    turning: Vec<RowBlock>,
    /// z⁺ − z⁻ of the step.
    swing: Aligned,
    /// φᴴf of the loads on one nodal diameter.
    force: Aligned,
    /// What they all move it by, and room for the same turned by S.
    moved: Aligned,
    turned: Aligned,
}

impl Drive {
    /// None if nothing but contact moves the modes.
    pub(crate) fn new(
        wheel: &ModalWheel,
        contact_nodes: usize,
        effects: &Effects<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        step: f64,
    ) -> Option<Self> {
        let coriolis = wheel.harmonics.iter().any(|harmonic| harmonic.gyroscopic.is_some());
        if !coriolis && effects.mistuning.is_none() && effects.excitation.is_empty() {
            return None;
        }
        let state = oscillators.state.z.len();
        let of = |wanted: bool| Aligned::zeros(if wanted { state } else { 0 });
        let place = |segment: &Segment| Place {
            re: segment.state,
            im: (!segment.single).then_some(segment.state + segment.length),
            column: segment.column,
        };
        let turning = wheel.harmonics.iter().zip(&oscillators.segments).filter_map(|(harmonic, segment)| {
            let g = harmonic.gyroscopic.as_ref()?;
            let receptance = &oscillators.coefficients.receptance[segment.modes..][..segment.integrated];
            let s = swing_matrix(g.as_ref(), wheel.speed_rad_s, step, receptance);
            Some(RowBlock::padded(s.as_ref(), segment.length))
        });
        let mistuning = effects.mistuning.map(|deviations| {
            ModalMistuning::new(deviations, wheel, contact_nodes, fourier, oscillators.resolved_families())
        });
        let longest = oscillators.segments.iter().map(|segment| segment.length).max().unwrap_or(0);
        let excitation = |excitation: &EngineOrderExcitation| {
            let mut modal = ModalExcitation::new(excitation, wheel);
            modal.amplitude.truncate(oscillators.segments[modal.harmonic].integrated);
            modal
        };
        Some(Self {
            excitations: effects.excitation.iter().map(excitation).collect(),
            excitation: of(!effects.excitation.is_empty()),
            pull: of(mistuning.is_some()),
            mistuning,
            places: oscillators.segments.iter().map(place).collect(),
            turning: turning.collect(),
            swing: of(true),
            force: Aligned::zeros(2 * longest),
            moved: Aligned::zeros(2 * longest),
            turned: Aligned::zeros(2 * longest),
        })
    }

    /// Gives the drive's forces after `revolutions` their part in the first increments d = z − z⁻, which are those of free motion:
    /// without it the start would be of first order in h only.
    pub(crate) fn start(
        &mut self,
        wheel: &ModalWheel,
        initial: &[InitialMode],
        oscillators: &mut Oscillators,
        revolutions: f64,
    ) {
        self.add_to_increments(wheel, initial, oscillators, revolutions, -1.0);
    }

    /// −∂f/∂z of mistuning between the Fourier columns of every family that it couples.
    pub(crate) fn mistuned(&self) -> Vec<Mat<f64>> {
        self.mistuning.as_ref().map(|mistuning| mistuning.stiffness(&self.places)).unwrap_or_default()
    }

    /// The counterpart of [`Self::start`] after `revolutions`: leaves the increments that free motion has at the same
    /// velocities, as `read` finds them.
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
        self.prepare(&oscillators.state.z, revolutions);
        self.swing.fill(0.0);
        for force in [&self.excitation, &self.pull] {
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

    /// Forces at the instant of the state `z`, `revolutions` after the start.
    fn prepare(&mut self, z: &[f64], revolutions: f64) {
        self.excitation.fill(0.0);
        for excitation in &self.excitations {
            let Place { re, im, .. } = self.places[excitation.harmonic];
            let turn = excitation.turn(revolutions);
            for (m, amplitude) in excitation.amplitude.iter().enumerate() {
                let force = amplitude * turn;
                self.excitation[re + m] += force.re;
                if let Some(start) = im {
                    self.excitation[start + m] += force.im;
                }
            }
        }
        if let Some(mistuning) = &mut self.mistuning {
            mistuning.force(&self.places, z, &mut self.pull);
        }
    }

    /// The step's swing of `segment` is final: what the drive's forces did in it.
    fn count(&self, segment: Segment, work: &mut EffectWork) {
        let half_product = |force: &Aligned| {
            let parts = segment.parts().map(|start| {
                let range = start..start + segment.length;
                force[range.clone()].iter().zip(&self.swing[range]).map(|(f, s)| f * s).sum::<f64>()
            });
            0.5 * parts.sum::<f64>()
        };
        if !self.excitation.is_empty() {
            work.excitation += half_product(&self.excitation);
        }
        if self.mistuning.is_some() {
            work.mistuning += half_product(&self.pull);
        }
    }

    /// `moved` by S of nodal diameter `index`; as it is without Coriolis forces.
    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, index: usize, segment: Segment) {
        if self.turning.is_empty() {
            return;
        }
        let Segment { integrated, length, .. } = segment;
        let moved = &self.moved[..segment.size()];
        self.turning[index].project(simd, segment, moved, &mut self.turned, (integrated, length));
        // Oscillators that only pad the vectors stay at rest, whatever the last nodal diameter left there.
        for part in 0..segment.parts().count() {
            self.turned[part * length + integrated..(part + 1) * length].fill(0.0);
        }
        std::mem::swap(&mut self.moved, &mut self.turned);
    }
}

impl Oscillators {
    /// Families that a step resolves in every nodal diameter, ω²B ≤ 3.
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

    /// Completes the last step by `loads`, and counts it.
    #[inline(always)]
    pub(crate) fn complete_driven<S: Simd>(
        &mut self,
        simd: S,
        drive: &mut Drive,
        loads: Loads<'_>,
        work: &mut EffectWork,
    ) -> Exchange {
        let mut exchange = Exchange { work: 0.0, loss: 0.0 };
        let loaded = !loads.loaded.is_empty();
        for index in 0..self.segments.len() {
            let segment = self.segments[index];
            if loaded {
                loads.modal(simd, index, segment, &mut drive.force);
                let receptance = &self.coefficients.receptance[segment.modes..][..segment.length];
                for part in 0..segment.parts().count() {
                    let range = part * segment.length..(part + 1) * segment.length;
                    let (moved, force) = (&mut drive.moved[range.clone()], &drive.force[range]);
                    for (moved, (r, f)) in moved.iter_mut().zip(receptance.iter().zip(force)) {
                        *moved = r * f;
                    }
                }
                drive.turn(simd, index, segment);
                for (part, start) in segment.parts().enumerate() {
                    for m in 0..segment.length {
                        let moved = drive.moved[part * segment.length + m];
                        self.state.z[start + m] += moved;
                        self.state.d[start + m] += moved;
                        drive.swing[start + m] += moved;
                    }
                }
            }
            self.count(segment, drive, loaded, &mut exchange);
            drive.count(segment, work);
        }
        drive.swing.fill(0.0);
        exchange
    }

    /// Takes a step free of contact, `revolutions` after the start.
    #[inline(always)]
    pub(crate) fn predict_driven<S: Simd>(&mut self, simd: S, drive: &mut Drive, revolutions: f64) {
        drive.prepare(&self.state.z, revolutions);
        for index in 0..self.segments.len() {
            drive.force.fill(0.0);
            self.swing(simd, index, drive);
        }
    }

    /// Takes a step under `loads` that act from its start, `revolutions` after the start, and counts it.
    #[inline(always)]
    pub(crate) fn advance_driven<S: Simd>(
        &mut self,
        simd: S,
        drive: &mut Drive,
        loads: Option<Loads<'_>>,
        revolutions: f64,
        work: &mut EffectWork,
    ) -> Exchange {
        let mut exchange = Exchange { work: 0.0, loss: 0.0 };
        drive.prepare(&self.state.z, revolutions);
        for index in 0..self.segments.len() {
            let segment = self.segments[index];
            match loads {
                Some(loads) => loads.modal(simd, index, segment, &mut drive.force),
                None => drive.force.fill(0.0),
            }
            self.swing(simd, index, drive);
            self.count(segment, drive, loads.is_some(), &mut exchange);
            drive.count(segment, work);
        }
        exchange
    }

    /// The step of one nodal diameter under `drive.force` and the drive's own.
    #[inline(always)]
    fn swing<S: Simd>(&mut self, simd: S, index: usize, drive: &mut Drive) {
        let segment = self.segments[index];
        let modes = segment.modes..segment.modes + segment.length;
        let keep = &self.coefficients.keep[modes.clone()];
        let pull = &self.coefficients.pull[modes.clone()];
        let receptance = &self.coefficients.receptance[modes];
        for (part, start) in segment.parts().enumerate() {
            let range = start..start + segment.length;
            let (z, d) = (&self.state.z[range.clone()], &self.state.d[range.clone()]);
            let offset = part * segment.length;
            let force = &drive.force[offset..][..segment.length];
            let moved = &mut drive.moved[offset..][..segment.length];
            for m in 0..segment.length {
                moved[m] = keep[m] * d[m] - pull[m] * z[m] + d[m] + receptance[m] * force[m];
            }
            for drive in [&drive.excitation, &drive.pull] {
                if !drive.is_empty() {
                    for (moved, (r, f)) in moved.iter_mut().zip(receptance.iter().zip(&drive[range.clone()]))
                    {
                        *moved += r * f;
                    }
                }
            }
        }
        drive.turn(simd, index, segment);
        for (part, start) in segment.parts().enumerate() {
            let range = start..start + segment.length;
            let swing = &drive.moved[part * segment.length..][..segment.length];
            let (z, d) = (&mut self.state.z[range.clone()], &mut self.state.d[range.clone()]);
            let kept = &mut drive.swing[range];
            for m in 0..segment.length {
                kept[m] = swing[m];
                d[m] = swing[m] - d[m];
                z[m] += d[m];
            }
        }
    }

    /// Exchange of a segment's step whose swing is final.
    fn count(&self, segment: Segment, drive: &Drive, loaded: bool, exchange: &mut Exchange) {
        let loss = &self.coefficients.loss[segment.modes..][..segment.length];
        for (part, start) in segment.parts().enumerate() {
            let swing = &drive.swing[start..][..segment.length];
            let force = &drive.force[part * segment.length..][..segment.length];
            if loaded {
                exchange.work += 0.5 * force.iter().zip(swing).map(|(f, s)| f * s).sum::<f64>();
            }
            exchange.loss += loss.iter().zip(swing).map(|(l, s)| l * s * s).sum::<f64>();
        }
    }

    /// What a unit force along `from` moves along `to` within a step, per nodal diameter, Coriolis forces included.
    pub(crate) fn turned_flexibility(
        &self,
        wheel: &ModalWheel,
        step: f64,
        to: &[Direction],
        from: &[Direction],
    ) -> Vec<Mat<c64>> {
        let of = |(harmonic, segment): (&super::super::modal_wheel::ModalHarmonic, &Segment)| {
            let modes = segment.integrated;
            let receptance = &self.coefficients.receptance[segment.modes..][..modes];
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
