//! The modal oscillators of the whole wheel: Eq. 8 made element-wise, and its projection on chosen DOF.
//!
//! Kernels work on SIMD lanes; modes of every nodal diameter are padded to whole vectors with oscillators that
//! stay at rest. A pair keeps the real and the imaginary part of z as two consecutive segments that share their
//! coefficients. The modes of one nodal diameter are forced, advanced and projected one after the other, while its mode
//! shapes are in the first-level cache.

mod project;
pub(crate) mod rows;

use pulp::Simd;

use self::project::{project_pair, project_single};
pub use self::rows::Direction;
use self::rows::{RowBlock, Rows};
use super::initial::InitialMode;
use super::modal_wheel::ModalWheel;
use super::schemes::Scheme;

/// Doubles per padded group: the widest vector in use (AVX-512).
pub(crate) const LANES: usize = 8;

pub(crate) fn padded(count: usize) -> usize {
    count.next_multiple_of(LANES)
}

/// Modal damping of the reduced wheel (§6).
#[derive(Debug, Clone, PartialEq)]
pub struct ModalDamping {
    /// ζ of every mode not listed below.
    pub modal_ratio: f64,
    /// ζ of the first modal families, the same in every nodal diameter.
    pub family_ratios: Vec<f64>,
}

impl ModalDamping {
    /// ζ of modal family `family`, counted from 0.
    pub fn ratio(&self, family: usize) -> f64 {
        self.family_ratios.get(family).copied().unwrap_or(self.modal_ratio)
    }
}

/// Where the modes of one nodal diameter live.
#[derive(Debug, Clone, Copy)]
struct Segment {
    single: bool,
    /// Modes, padded.
    length: usize,
    /// Start in the coefficient arrays.
    modes: usize,
    /// Start in the state arrays (the imaginary part of a pair follows after `length`).
    state: usize,
    /// Fourier column of the real part (the imaginary part is the next).
    column: usize,
}

/// Modal coordinates of the wheel under one of the [schemes](super::schemes), in increments d = z − z⁻, which lose no
/// digits to differences at small steps.
#[derive(Debug, Clone)]
pub(crate) struct Oscillators {
    segments: Vec<Segment>,
    /// Share of the increment that survives a step.
    keep: Vec<f64>,
    /// ω²·receptance
    pull: Vec<f64>,
    /// Displacement per unit force within a step.
    receptance: Vec<f64>,
    /// c/(2B): energy lost in a step is Σ loss·(z⁺ − z⁻)².
    loss: Vec<f64>,
    /// 1/B
    inertia: Vec<f64>,
    /// ω²
    stiffness: Vec<f64>,
    state: State,
}

/// What a step changes.
#[derive(Debug, Clone, Default)]
struct State {
    /// z
    z: Vec<f64>,
    /// d = z − z⁻
    d: Vec<f64>,
    /// z⁺ − z⁻ of the last free step, for the loss; empty unless something dissipates.
    swing: Vec<f64>,
}

/// Forces on rows, in Fourier coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Loads<'a> {
    /// Rows with a force on any sector.
    pub(crate) rows: &'a [usize],
    /// `[column][row]`, rows padded to their stride.
    pub(crate) force: &'a [f64],
}

/// One part (real or imaginary) of one nodal diameter's coordinates, as vectors.
struct Part<'a, S: Simd, const DISSIPATES: bool> {
    z: &'a mut [S::f64s],
    d: &'a mut [S::f64s],
    /// Empty unless `DISSIPATES`.
    swing: &'a mut [S::f64s],
}

impl State {
    /// The part of `length` numbers (`vectors` vectors) at `start`.
    #[inline(always)]
    fn part<S: Simd, const DISSIPATES: bool>(
        &mut self,
        start: usize,
        length: usize,
        vectors: usize,
    ) -> Part<'_, S, DISSIPATES> {
        let swing = if DISSIPATES { &mut self.swing[start..start + length] } else { &mut [][..] };
        Part {
            z: &mut S::as_mut_simd_f64s(&mut self.z[start..start + length]).0[..vectors],
            d: &mut S::as_mut_simd_f64s(&mut self.d[start..start + length]).0[..vectors],
            swing: &mut S::as_mut_simd_f64s(swing).0[..if DISSIPATES { vectors } else { 0 }],
        }
    }

    /// Both parts of a pair at `start`.
    #[inline(always)]
    fn pair<S: Simd, const DISSIPATES: bool>(
        &mut self,
        start: usize,
        length: usize,
        vectors: usize,
    ) -> (Part<'_, S, DISSIPATES>, Part<'_, S, DISSIPATES>) {
        let Part { z, d, swing } = self.part::<S, DISSIPATES>(start, 2 * length, 2 * vectors);
        let (z_re, z_im) = z.split_at_mut(vectors);
        let (d_re, d_im) = d.split_at_mut(vectors);
        let (swing_re, swing_im) = swing.split_at_mut(if DISSIPATES { vectors } else { 0 });
        (Part { z: z_re, d: d_re, swing: swing_re }, Part { z: z_im, d: d_im, swing: swing_im })
    }
}

impl<S: Simd, const DISSIPATES: bool> Part<'_, S, DISSIPATES> {
    /// Moves vector `m` by `moved`; returns `lost` with what damping takes of it.
    #[inline(always)]
    fn shift(&mut self, simd: S, m: usize, moved: S::f64s, loss: S::f64s, mut lost: S::f64s) -> S::f64s {
        if DISSIPATES {
            let both = simd.add_f64s(simd.add_f64s(self.swing[m], self.swing[m]), moved);
            lost = simd.mul_add_e_f64s(loss, simd.mul_f64s(moved, both), lost);
            self.swing[m] = simd.add_f64s(self.swing[m], moved);
        }
        self.z[m] = simd.add_f64s(self.z[m], moved);
        self.d[m] = simd.add_f64s(self.d[m], moved);
        lost
    }
}

impl Oscillators {
    /// In the state `initial` (rest where it has nothing), steps of `step` seconds, of a wheel that may touch the casing or
    /// not.
    pub(crate) fn new(
        wheel: &ModalWheel,
        scheme: Scheme,
        step: f64,
        damping: Option<&ModalDamping>,
        touching: bool,
        initial: &[InitialMode],
    ) -> Self {
        let mut this = Self {
            segments: Vec::with_capacity(wheel.harmonics.len()),
            keep: Vec::new(),
            pull: Vec::new(),
            receptance: Vec::new(),
            loss: Vec::new(),
            inertia: Vec::new(),
            stiffness: Vec::new(),
            state: State::default(),
        };
        let (mut state, mut column) = (0, 0);
        for harmonic in &wheel.harmonics {
            let integrated = scheme.integrated_modes(harmonic.omega.len());
            let length = padded(integrated);
            let parts = if harmonic.single { 1 } else { 2 };
            let modes = this.keep.len();
            this.segments.push(Segment { single: harmonic.single, length, modes, state, column });
            for family in 0..length {
                let omega = if family < integrated { harmonic.omega[family] } else { 0.0 };
                let zeta = damping.map_or(0.0, |damping| damping.ratio(family));
                let mode = scheme.mode_step(omega, zeta, step, touching);
                this.keep.push(mode.keep);
                this.pull.push(omega * omega * mode.receptance);
                this.receptance.push(mode.receptance);
                this.loss.push(0.5 * mode.dissipation() * mode.inertia());
                this.inertia.push(mode.inertia());
                this.stiffness.push(omega * omega);
            }
            state += parts * length;
            column += parts;
        }
        this.state.z = vec![0.0; state];
        this.state.d = vec![0.0; state];
        if this.dissipates() {
            this.state.swing = vec![0.0; state];
        }
        for mode in initial {
            let segment = this.segments[mode.harmonic];
            let omega = wheel.harmonics[mode.harmonic].omega[mode.family];
            let zeta = damping.map_or(0.0, |damping| damping.ratio(mode.family));
            let parts = [(mode.displacement.re, mode.velocity.re), (mode.displacement.im, mode.velocity.im)];
            for (part, (z, v)) in parts.into_iter().take(if segment.single { 1 } else { 2 }).enumerate() {
                let place = segment.state + part * segment.length + mode.family;
                this.state.z[place] = z;
                this.state.d[place] = scheme.first_increment(omega, zeta, step, z, v);
            }
        }
        this
    }

    /// The same a step earlier, as the increments say.
    pub(crate) fn a_step_earlier(&self) -> Self {
        let mut earlier = self.clone();
        earlier.state.z.iter_mut().zip(&self.state.d).for_each(|(z, d)| *z -= d);
        earlier
    }

    /// Whether any mode loses energy in free motion.
    pub(crate) fn dissipates(&self) -> bool {
        self.loss.iter().any(|&loss| loss > 0.0)
    }

    /// One free step of every mode; returns the energy lost in it (0 unless `DISSIPATES`).
    #[inline(always)]
    pub(crate) fn advance<S: Simd, const DISSIPATES: bool>(&mut self, simd: S) -> f64 {
        let mut lost = simd.splat_f64s(0.0);
        for index in 0..self.segments.len() {
            lost = self.advance_segment::<S, DISSIPATES>(simd, index, lost);
        }
        simd.reduce_sum_f64s(lost)
    }

    /// One step of every mode under `loads`, and the values of `rows` after it in Fourier coordinates,
    /// `out[column][row]`. The loads complete the step before (Eq. 10), or with `NOW` act in this one. Returns the energy
    /// lost.
    #[inline(always)]
    pub(crate) fn advance_loaded<S: Simd, const DISSIPATES: bool, const NOW: bool>(
        &mut self,
        simd: S,
        rows: &Rows,
        loads: Loads<'_>,
        out: &mut [f64],
    ) -> f64 {
        let mut lost = simd.splat_f64s(0.0);
        for index in 0..self.segments.len() {
            if !NOW {
                lost = self.load_segment::<S, DISSIPATES>(simd, index, rows, loads, lost);
            }
            lost = self.advance_segment::<S, DISSIPATES>(simd, index, lost);
            if NOW {
                lost = self.load_segment::<S, DISSIPATES>(simd, index, rows, loads, lost);
            }
            self.project_segment(simd, index, rows, out);
        }
        simd.reduce_sum_f64s(lost)
    }

    /// Adds what `loads` on `rows` move within the last step; returns the further energy lost.
    #[inline(always)]
    pub(crate) fn complete<S: Simd, const DISSIPATES: bool>(
        &mut self,
        simd: S,
        rows: &Rows,
        loads: Loads<'_>,
    ) -> f64 {
        let mut lost = simd.splat_f64s(0.0);
        for index in 0..self.segments.len() {
            lost = self.load_segment::<S, DISSIPATES>(simd, index, rows, loads, lost);
        }
        simd.reduce_sum_f64s(lost)
    }

    /// Values of `rows` in Fourier coordinates: `out[column][row]`, rows padded to `rows.stride`.
    #[inline(always)]
    pub(crate) fn project<S: Simd>(&self, simd: S, rows: &Rows, out: &mut [f64]) {
        for index in 0..self.segments.len() {
            self.project_segment(simd, index, rows, out);
        }
    }

    #[inline(always)]
    fn advance_segment<S: Simd, const DISSIPATES: bool>(
        &mut self,
        simd: S,
        index: usize,
        mut lost: S::f64s,
    ) -> S::f64s {
        let segment = self.segments[index];
        let coefficients = segment.modes..segment.modes + segment.length;
        let keep = S::as_simd_f64s(&self.keep[coefficients.clone()]).0;
        let pull = S::as_simd_f64s(&self.pull[coefficients.clone()]).0;
        let loss = S::as_simd_f64s(&self.loss[coefficients]).0;
        let vectors = keep.len();
        let (pull, loss) = (&pull[..vectors], &loss[..vectors]);
        for part in 0..if segment.single { 1 } else { 2 } {
            let start = segment.state + part * segment.length;
            let Part { z, d, swing } = self.state.part::<S, DISSIPATES>(start, segment.length, vectors);
            for m in 0..vectors {
                if DISSIPATES {
                    let next = simd.sub_f64s(simd.mul_f64s(keep[m], d[m]), simd.mul_f64s(pull[m], z[m]));
                    let both = simd.add_f64s(next, d[m]);
                    lost = simd.mul_add_e_f64s(loss[m], simd.mul_f64s(both, both), lost);
                    swing[m] = both;
                    d[m] = next;
                } else {
                    d[m] = simd.negate_mul_add_e_f64s(pull[m], z[m], d[m]);
                }
                z[m] = simd.add_f64s(z[m], d[m]);
            }
        }
        lost
    }

    #[inline(always)]
    fn project_segment<S: Simd>(&self, simd: S, index: usize, rows: &Rows, out: &mut [f64]) {
        let (segment, block) = (self.segments[index], &rows.blocks[index]);
        let re = S::as_simd_f64s(&self.state.z[segment.state..][..segment.length]).0;
        let out = &mut out[segment.column * rows.stride..];
        if segment.single {
            project_single(simd, re, block, segment.length, rows.count, out);
        } else {
            let im = S::as_simd_f64s(&self.state.z[segment.state + segment.length..][..segment.length]).0;
            let (out_re, out_im) = out.split_at_mut(rows.stride);
            project_pair(simd, re, im, block, segment.length, rows.count, out_re, out_im);
        }
    }

    #[inline(always)]
    fn load_segment<S: Simd, const DISSIPATES: bool>(
        &mut self,
        simd: S,
        index: usize,
        rows: &Rows,
        loads: Loads<'_>,
        mut lost: S::f64s,
    ) -> S::f64s {
        let force = loads.force;
        for group in loads.rows.chunks(6) {
            lost = match *group {
                [a] => self.push::<S, DISSIPATES, 1>(simd, index, rows, [a], force, lost),
                [a, b] => self.push::<S, DISSIPATES, 2>(simd, index, rows, [a, b], force, lost),
                [a, b, c] => self.push::<S, DISSIPATES, 3>(simd, index, rows, [a, b, c], force, lost),
                [a, b, c, d] => self.push::<S, DISSIPATES, 4>(simd, index, rows, [a, b, c, d], force, lost),
                [a, b, c, d, e] => {
                    self.push::<S, DISSIPATES, 5>(simd, index, rows, [a, b, c, d, e], force, lost)
                }
                [a, b, c, d, e, f, ..] => {
                    self.push::<S, DISSIPATES, 6>(simd, index, rows, [a, b, c, d, e, f], force, lost)
                }
                [] => lost,
            };
        }
        lost
    }

    /// [`Self::load_segment`] for R rows at once. Groups may follow each other: each updates the swing that the next
    /// one's loss is counted from.
    #[inline(always)]
    fn push<S: Simd, const DISSIPATES: bool, const R: usize>(
        &mut self,
        simd: S,
        index: usize,
        rows: &Rows,
        group: [usize; R],
        force: &[f64],
        mut lost: S::f64s,
    ) -> S::f64s {
        let Segment { single, length, modes, state, column } = self.segments[index];
        let block = &rows.blocks[index];
        let receptance = S::as_simd_f64s(&self.receptance[modes..modes + length]).0;
        let loss = &S::as_simd_f64s(&self.loss[modes..modes + length]).0[..receptance.len()];
        let force_re = gather(simd, &force[column * rows.stride..], group);
        let phi_re = RowBlock::rows::<S, R>(&block.re, group, length, receptance.len());
        if single {
            let mut part = self.state.part::<S, DISSIPATES>(state, length, receptance.len());
            for m in 0..receptance.len() {
                let mut modal = simd.splat_f64s(0.0);
                for r in 0..R {
                    modal = simd.mul_add_e_f64s(phi_re[r][m], force_re[r], modal);
                }
                lost = part.shift(simd, m, simd.mul_f64s(receptance[m], modal), loss[m], lost);
            }
            return lost;
        }
        let force_im = gather(simd, &force[(column + 1) * rows.stride..], group);
        let phi_im = RowBlock::rows::<S, R>(&block.im, group, length, receptance.len());
        let (mut re, mut im) = self.state.pair::<S, DISSIPATES>(state, length, receptance.len());
        for m in 0..receptance.len() {
            // φᴴ f̂: (φ_re − jφ_im)(f_re + jf_im)
            let mut modal_re = simd.splat_f64s(0.0);
            let mut modal_im = simd.splat_f64s(0.0);
            for r in 0..R {
                let (p, q) = (phi_re[r][m], phi_im[r][m]);
                modal_re = simd.mul_add_e_f64s(p, force_re[r], modal_re);
                modal_im = simd.mul_add_e_f64s(p, force_im[r], modal_im);
                modal_re = simd.mul_add_e_f64s(q, force_im[r], modal_re);
                modal_im = simd.negate_mul_add_e_f64s(q, force_re[r], modal_im);
            }
            lost = re.shift(simd, m, simd.mul_f64s(receptance[m], modal_re), loss[m], lost);
            lost = im.shift(simd, m, simd.mul_f64s(receptance[m], modal_im), loss[m], lost);
        }
        lost
    }

    /// E of the last step in the discrete identity (see [`super::schemes`]).
    pub(crate) fn energy(&self) -> f64 {
        let mut twice = 0.0;
        for segment in &self.segments {
            for part in 0..if segment.single { 1 } else { 2 } {
                let start = segment.state + part * segment.length;
                for m in 0..segment.length {
                    let (z, d) = (self.state.z[start + m], self.state.d[start + m]);
                    let mode = segment.modes + m;
                    twice += self.inertia[mode] * d * d + self.stiffness[mode] * (z - d) * z;
                }
            }
        }
        0.5 * twice
    }

    /// Displacement per unit force of mode `family` of nodal diameter `harmonic` within a step.
    pub(crate) fn receptance(&self, harmonic: usize, family: usize) -> f64 {
        self.receptance[self.segments[harmonic].modes + family]
    }

    /// Brings to rest what has decayed below any meaning, before its numbers become denormal.
    #[inline(always)]
    pub(crate) fn quench(&mut self) {
        for values in [&mut self.state.z, &mut self.state.d] {
            for value in values {
                *value = if value.abs() < VANISHED { 0.0 } else { *value };
            }
        }
    }
}

/// Modal displacements below this are nothing in any unit, and their squares are still normal numbers. Between two calls
/// of [`Oscillators::quench`] no scheme shrinks them by as much again.
const VANISHED: f64 = 1e-100;

/// Each of `group`'s values in every lane. A loop and no closure: a closure would be compiled without the wide vectors.
#[inline(always)]
fn gather<S: Simd, const R: usize>(simd: S, values: &[f64], group: [usize; R]) -> [S::f64s; R] {
    let mut lanes = [simd.splat_f64s(0.0); R];
    for (lane, row) in lanes.iter_mut().zip(group) {
        *lane = simd.splat_f64s(values[row]);
    }
    lanes
}
