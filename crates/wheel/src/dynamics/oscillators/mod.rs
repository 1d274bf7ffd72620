//! Modal oscillators of the whole wheel: Eq. 8 made element-wise, and its projection on chosen DOF.
//!
//! `recursion` is the step of one vector of modes, `product` loads and reads them, and `Oscillators::pass` takes all of
//! them through both. Modes of every nodal diameter are padded to whole vectors with oscillators that stay at rest. A pair
//! keeps the real and the imaginary part of z as two consecutive segments that share their coefficients. The modes of one
//! nodal diameter are forced, advanced and projected one after the other, while its mode shapes are in the first-level
//! cache.

pub(crate) mod driven;
pub(crate) mod lanes;
mod product;
mod recursion;
pub(crate) mod rows;
mod segment;

use faer::c64;
use pulp::Simd;

use self::lanes::padded;
pub(crate) use self::recursion::Exchange;
use self::recursion::{Advance, Complete, CompleteAndPredict, Modes, Numbers, Pass, Sums};
use self::rows::{Loads, Readout, Rows};
use self::segment::Segment;
use super::initial::{InitialMode, SteppedMode};
use super::modal_wheel::ModalWheel;
use super::schemes::{ModeStep, Scheme};
use rubmap_numerics::aligned::Aligned;

/// Modal damping of the reduced wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalDamping {
    /// Damping ratio ζ of every mode that `family_ratios` does not cover.
    pub modal_ratio: f64,
    /// Damping ratios ζ of the first modal families, the same in every nodal diameter.
    pub family_ratios: Vec<f64>,
    /// Ranks of the modes of these families, by harmonic of the wheel; none where a family is a rank.
    pub ranks: Vec<Vec<usize>>,
}

impl ModalDamping {
    /// Damping ratio ζ of the mode of this rank, counted from 0, of a harmonic of the wheel.
    pub fn ratio(&self, harmonic: usize, rank: usize) -> f64 {
        let family = match self.ranks.get(harmonic) {
            None => Some(rank),
            Some(ranks) => ranks.iter().position(|&of_family| of_family == rank),
        };
        family.and_then(|family| self.family_ratios.get(family)).copied().unwrap_or(self.modal_ratio)
    }
}

/// Modal coordinates of the wheel under one of the [schemes](super::schemes), in increments d = z − z⁻, which lose no
/// digits to differences at small steps.
#[derive(Debug, Clone)]
pub(crate) struct Oscillators {
    segments: Vec<Segment>,
    coefficients: Coefficients,
    state: State,
    /// Whether any mode loses energy.
    dissipates: bool,
}

/// Coefficients of the recursion, one number a mode, the same for both parts of a pair.
#[derive(Debug, Clone)]
struct Coefficients {
    /// Share of the increment that survives a step.
    keep: Aligned,
    /// Pull ω²·receptance of a mode.
    pull: Aligned,
    /// Displacement per unit force within a step.
    receptance: Aligned,
    /// Loss c/(2B): energy lost in a step is Σ loss·(z⁺ − z⁻)².
    loss: Aligned,
    /// Inertia 1/B of a mode.
    inertia: Aligned,
    /// Stiffness ω² of a mode.
    stiffness: Aligned,
}

/// State of the oscillators, which a step changes.
#[derive(Debug, Clone)]
struct State {
    /// Displacements z.
    z: Aligned,
    /// Increments d = z − z⁻.
    d: Aligned,
    /// Swings z⁺ − z⁻ of a step whose exchange is not counted yet, otherwise 0; empty without contact.
    swing: Aligned,
    /// Modal forces φᴴf of the loads on one nodal diameter; empty without contact.
    force: Aligned,
}

impl Oscillators {
    /// Oscillators in the state `initial` (at rest where it has nothing), steps of `step` seconds, of a wheel that may touch the casing or
    /// not, and whose fast modes `follow` or not.
    pub(crate) fn new(
        wheel: &ModalWheel,
        scheme: Scheme,
        step: f64,
        damping: Option<&ModalDamping>,
        touching: bool,
        follow: bool,
        initial: &[InitialMode],
    ) -> Self {
        let mut segments = Vec::with_capacity(wheel.harmonics.len());
        let (mut modes, mut state, mut column) = (0, 0, 0);
        for harmonic in &wheel.harmonics {
            let integrated = scheme.integrated_modes(harmonic.omega.len());
            let length = padded(integrated);
            let parts = if harmonic.single { 1 } else { 2 };
            segments.push(Segment { single: harmonic.single, integrated, length, modes, state, column });
            modes += length;
            state += parts * length;
            column += parts;
        }
        let mut of = Coefficients::zeros(modes);
        for (index, (harmonic, segment)) in wheel.harmonics.iter().zip(&segments).enumerate() {
            for family in 0..segment.length {
                let omega = if family < segment.integrated { harmonic.omega[family] } else { 0.0 };
                let zeta = damping.map_or(0.0, |damping| damping.ratio(index, family));
                of.set(segment.modes + family, omega, scheme.mode_step(omega, zeta, step, follow));
            }
        }
        let contact = if touching { state } else { 0 };
        let longest = segments.iter().map(|segment| segment.length).max().unwrap_or(0);
        let state = State {
            z: Aligned::zeros(state),
            d: Aligned::zeros(state),
            swing: Aligned::zeros(contact),
            force: Aligned::zeros(if touching { 2 * longest } else { 0 }),
        };
        let dissipates = of.loss.iter().any(|&loss| loss > 0.0);
        let mut this = Self { segments, coefficients: of, state, dissipates };
        for mode in initial {
            let zeta = damping.map_or(0.0, |damping| damping.ratio(mode.harmonic, mode.family));
            this.start(mode, |z, v| {
                let omega = wheel.harmonics[mode.harmonic].omega[mode.family];
                scheme.first_increment(omega, zeta, step, z, v, follow)
            });
        }
        this
    }

    fn start(&mut self, mode: &InitialMode, first_increment: impl Fn(f64, f64) -> f64) {
        let segment = self.segments[mode.harmonic];
        assert!(mode.family < segment.integrated, "an initial mode is one that is integrated");
        let values = [(mode.displacement.re, mode.velocity.re), (mode.displacement.im, mode.velocity.im)];
        for (start, (z, v)) in segment.parts().zip(values) {
            self.state.z[start + mode.family] = z;
            self.state.d[start + mode.family] = first_increment(z, v);
        }
    }

    /// Puts all modes where another motion left them, at rest where it has none.
    pub(crate) fn go_on_from(&mut self, modes: &[SteppedMode]) {
        let Self { segments, state, .. } = self;
        // What the last step exchanged is forgotten, too.
        for values in [&mut state.z, &mut state.d, &mut state.swing] {
            values.fill(0.0);
        }
        for mode in modes {
            let (z, d) = (mode.displacement, mode.increment);
            let parts = segments[mode.harmonic].parts().zip([(z.re, d.re), (z.im, d.im)]);
            for (start, (z, d)) in parts {
                state.z[start + mode.family] = z;
                state.d[start + mode.family] = d;
            }
        }
    }

    /// Whether any mode loses energy.
    pub(crate) fn dissipates(&self) -> bool {
        self.dissipates
    }

    /// Takes one free step of every mode.
    #[inline(always)]
    pub(crate) fn advance<S: Simd>(&mut self, simd: S) -> Exchange {
        self.pass::<S, Advance>(simd, None, None)
    }

    /// Takes one step of every mode under `loads`, which act from its start. Reads rows as [`Self::project`] does, at its end.
    #[inline(always)]
    pub(crate) fn advance_loaded<S: Simd>(
        &mut self,
        simd: S,
        loads: Loads<'_>,
        reading: Readout<'_>,
    ) -> Exchange {
        self.pass::<S, Advance>(simd, Some(loads), Some(reading))
    }

    /// Completes the last step by `loads` (Eq. 10), takes the next one free of them (Eq. 8), and reads rows as
    /// [`Self::project`] does. Returns the exchange of the completed step.
    #[inline(always)]
    pub(crate) fn complete_and_predict<S: Simd>(
        &mut self,
        simd: S,
        loads: Loads<'_>,
        reading: Readout<'_>,
    ) -> Exchange {
        if loads.loaded.is_empty() {
            self.pass::<S, CompleteAndPredict>(simd, None, Some(reading))
        } else {
            self.pass::<S, CompleteAndPredict>(simd, Some(loads), Some(reading))
        }
    }

    /// Completes the last step by `loads` and returns its exchange.
    #[inline(always)]
    pub(crate) fn complete<S: Simd>(&mut self, simd: S, loads: Loads<'_>) -> Exchange {
        self.pass::<S, Complete>(simd, Some(loads), None)
    }

    /// Forces, moves and reads one nodal diameter after the other; `P` is the pass that moves it.
    #[inline(always)]
    fn pass<S: Simd, P: Pass>(
        &mut self,
        simd: S,
        loads: Option<Loads<'_>>,
        reading: Option<Readout<'_>>,
    ) -> Exchange {
        if self.dissipates {
            self.pass_counting::<S, P, true>(simd, loads, reading)
        } else {
            self.pass_counting::<S, P, false>(simd, loads, reading)
        }
    }

    #[inline(always)]
    fn pass_counting<S: Simd, P: Pass, const DISSIPATES: bool>(
        &mut self,
        simd: S,
        loads: Option<Loads<'_>>,
        mut reading: Option<Readout<'_>>,
    ) -> Exchange {
        let zero = simd.splat_f64s(0.0);
        let mut sums = Sums::<S, DISSIPATES>::new(simd);
        for (index, &segment) in self.segments.iter().enumerate() {
            if let Some(loads) = loads {
                loads.modal(simd, index, segment, &mut self.state.force);
            }
            let of = self.coefficients.of::<S>(segment);
            for start in segment.parts() {
                let Part { z, d, swing, force } =
                    self.state.part::<S>(segment, start, P::COUNTS_LATER, loads.is_some());
                for m in 0..of.keep.len() {
                    let force = if loads.is_some() { Some(force[m]) } else { None };
                    let of = of.at(m);
                    let swung = if P::COUNTS_LATER { swing[m] } else { zero };
                    let mut modes = Modes { z: z[m], d: d[m], swing: swung };
                    P::over(simd, &mut modes, &of, force, &mut sums);
                    (z[m], d[m]) = (modes.z, modes.d);
                    if P::COUNTS_LATER {
                        swing[m] = modes.swing;
                    }
                }
            }
            if let Some(Readout { rows, out }) = &mut reading {
                rows.project(simd, index, segment, &self.state.z, out);
            }
        }
        sums.total(simd)
    }

    /// Reads the values of `rows` in Fourier coordinates: `out[column][row]`, rows padded to `rows.stride`.
    #[inline(always)]
    pub(crate) fn project<S: Simd>(&self, simd: S, rows: &Rows, out: &mut [f64]) {
        self.project_of(simd, &self.state.z, rows, out);
    }

    /// Reads the values of `rows` as [`Self::project`] does, from `modes` in the layout of [`Self::positions`].
    #[inline(always)]
    pub(crate) fn project_of<S: Simd>(&self, simd: S, modes: &[f64], rows: &Rows, out: &mut [f64]) {
        for (index, &segment) in self.segments.iter().enumerate() {
            rows.project(simd, index, segment, modes, out);
        }
    }

    /// Swings z⁺ − z⁻ of every mode in a step that is not complete; nothing without contact, or where the modes are [driven](driven::Drive::swung).
    pub(crate) fn swung(&self) -> &[f64] {
        &self.state.swing
    }

    /// Mechanical energy E of the last step in the discrete identity (see [`super::schemes`]).
    pub(crate) fn energy(&self) -> f64 {
        0.5 * self.segments.iter().fold(0.0, |twice, segment| self.add_twice_energy(segment, twice))
    }

    /// Mechanical energies of every nodal diameter, as of [`Self::energy`].
    pub(crate) fn energies(&self) -> impl Iterator<Item = f64> {
        self.segments.iter().map(|segment| 0.5 * self.add_twice_energy(segment, 0.0))
    }

    fn add_twice_energy(&self, segment: &Segment, mut twice: f64) -> f64 {
        let Coefficients { inertia, stiffness, .. } = &self.coefficients;
        for start in segment.parts() {
            for m in 0..segment.length {
                let (z, d) = (self.state.z[start + m], self.state.d[start + m]);
                let mode = segment.modes + m;
                twice += inertia[mode] * d * d + stiffness[mode] * (z - d) * z;
            }
        }
        twice
    }

    /// Displacements z of every mode in the order in which they are stored; [`Self::position`] finds one.
    pub(crate) fn positions(&self) -> &[f64] {
        &self.state.z
    }

    /// Displacement z of mode `family` of nodal diameter `harmonic` within `positions`, as [`Self::positions`] gave them.
    pub(crate) fn position(&self, positions: &[f64], harmonic: usize, family: usize) -> c64 {
        let segment = self.segments[harmonic];
        let at = |start: usize| positions[start + family];
        c64::new(at(segment.state), if segment.single { 0.0 } else { at(segment.state + segment.length) })
    }

    /// Indices of z and d of mode `family` of nodal diameter `harmonic` in [`Self::state`]: of a pair both parts.
    pub(crate) fn places(&self, harmonic: usize, family: usize) -> impl Iterator<Item = usize> + use<> {
        self.segments[harmonic].parts().map(move |start| start + family)
    }

    /// Displacements z and increments d of every mode, at its [`Self::places`].
    pub(crate) fn state(&self) -> (&[f64], &[f64]) {
        (&self.state.z, &self.state.d)
    }

    /// Displacements z and velocities ż of every mode, `velocity(harmonic, family, z, d)` being the scheme's.
    pub(crate) fn modal_state(&self, velocity: impl Fn(usize, usize, f64, f64) -> f64) -> Vec<InitialMode> {
        let mut modes = Vec::new();
        for (harmonic, segment) in self.segments.iter().enumerate() {
            for family in 0..segment.integrated {
                let part = |start: usize| {
                    let (z, d) = (self.state.z[start + family], self.state.d[start + family]);
                    (z, velocity(harmonic, family, z, d))
                };
                let re = part(segment.state);
                let im = if segment.single { (0.0, 0.0) } else { part(segment.state + segment.length) };
                modes.push(InitialMode {
                    harmonic,
                    family,
                    displacement: c64::new(re.0, im.0),
                    velocity: c64::new(re.1, im.1),
                });
            }
        }
        modes
    }

    /// Displacement per unit force of mode `family` of nodal diameter `harmonic` within a step.
    pub(crate) fn receptance(&self, harmonic: usize, family: usize) -> f64 {
        self.coefficients.receptance[self.segments[harmonic].modes + family]
    }

    /// Largest z² of a mode per 2E: 1/(ω²(1 − ω²B/4)); infinite where its energy bounds no displacement.
    pub(crate) fn largest_square(&self, harmonic: usize, family: usize) -> f64 {
        let mode = self.segments[harmonic].modes + family;
        let (stiffness, inertia) = (self.coefficients.stiffness[mode], self.coefficients.inertia[mode]);
        let bounded = stiffness - 0.25 * stiffness * stiffness / inertia;
        if bounded > 0.0 { 1.0 / bounded } else { f64::INFINITY }
    }

    /// Brings modes to rest that have decayed below any meaning, before their numbers become denormal.
    #[inline(always)]
    pub(crate) fn quench(&mut self) {
        for values in [&mut self.state.z, &mut self.state.d, &mut self.state.swing] {
            for value in values.iter_mut() {
                *value = if value.abs() < VANISHED { 0.0 } else { *value };
            }
        }
    }
}

/// Modal displacement below which a mode is at rest in any unit, while its square is still a normal number. Between two calls of
/// [`Oscillators::quench`] no mode that moves shrinks by as much again; one that follows statically is at its zero, or round-off of it,
/// within a step.
pub(crate) const VANISHED: f64 = 1e-100;

/// Vectors of the [`Coefficients`] of one nodal diameter.
struct Slices<'a, S: Simd> {
    keep: &'a [S::f64s],
    pull: &'a [S::f64s],
    receptance: &'a [S::f64s],
    loss: &'a [S::f64s],
}

impl<S: Simd> Slices<'_, S> {
    #[inline(always)]
    fn at(&self, m: usize) -> Numbers<S> {
        Numbers { keep: self.keep[m], pull: self.pull[m], receptance: self.receptance[m], loss: self.loss[m] }
    }
}

impl Coefficients {
    fn zeros(modes: usize) -> Self {
        let zeros = || Aligned::zeros(modes);
        Self {
            keep: zeros(),
            pull: zeros(),
            receptance: zeros(),
            loss: zeros(),
            inertia: zeros(),
            stiffness: zeros(),
        }
    }

    fn set(&mut self, mode: usize, omega: f64, step: ModeStep) {
        self.keep[mode] = step.keep;
        self.pull[mode] = omega * omega * step.receptance;
        self.receptance[mode] = step.receptance;
        self.loss[mode] = 0.5 * step.dissipation() * step.inertia();
        self.inertia[mode] = step.inertia();
        self.stiffness[mode] = omega * omega;
    }

    #[inline(always)]
    fn of<S: Simd>(&self, segment: Segment) -> Slices<'_, S> {
        let range = segment.modes..segment.modes + segment.length;
        let keep = S::as_simd_f64s(&self.keep[range.clone()]).0;
        // Cut to one length, so that no index needs a check.
        Slices {
            keep,
            pull: &S::as_simd_f64s(&self.pull[range.clone()]).0[..keep.len()],
            receptance: &S::as_simd_f64s(&self.receptance[range.clone()]).0[..keep.len()],
            loss: &S::as_simd_f64s(&self.loss[range]).0[..keep.len()],
        }
    }
}

/// Part (real or imaginary) of one nodal diameter's state, as vectors.
struct Part<'a, S: Simd> {
    z: &'a mut [S::f64s],
    d: &'a mut [S::f64s],
    swing: &'a mut [S::f64s],
    force: &'a [S::f64s],
}

impl State {
    /// Part of `segment` at `start`; `swing` and `force` are empty unless asked for.
    #[inline(always)]
    fn part<S: Simd>(&mut self, segment: Segment, start: usize, swing: bool, force: bool) -> Part<'_, S> {
        let range = start..start + segment.length;
        let offset = start - segment.state;
        let z = S::as_mut_simd_f64s(&mut self.z[range.clone()]).0;
        // Cut to one length, so that no index needs a check.
        let vectors = z.len();
        let (swing, swings) = if swing { (range.clone(), vectors) } else { (0..0, 0) };
        let (force, forces) = if force { (offset..offset + segment.length, vectors) } else { (0..0, 0) };
        Part {
            d: &mut S::as_mut_simd_f64s(&mut self.d[range]).0[..vectors],
            swing: &mut S::as_mut_simd_f64s(&mut self.swing[swing]).0[..swings],
            force: &S::as_simd_f64s(&self.force[force]).0[..forces],
            z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ModalDamping;

    #[test]
    fn ratios_go_with_the_families() {
        let by_rank = ModalDamping { modal_ratio: 0.3, family_ratios: vec![0.1, 0.2], ranks: Vec::new() };
        assert_eq!([0, 1, 2].map(|rank| by_rank.ratio(1, rank)), [0.1, 0.2, 0.3]);
        let followed = ModalDamping { ranks: vec![vec![0, 1], vec![2, 0]], ..by_rank };
        assert_eq!([0, 1, 2].map(|rank| followed.ratio(0, rank)), [0.1, 0.2, 0.3]);
        assert_eq!([0, 1, 2].map(|rank| followed.ratio(1, rank)), [0.2, 0.3, 0.1]);
    }
}
