//! The modal oscillators of the whole wheel: Eq. 8 made element-wise, and its projection on chosen DOF.
//!
//! Kernels work on SIMD lanes; modes of every nodal diameter are padded to whole vectors with oscillators that
//! stay at rest. A pair keeps the real and the imaginary part of z as two consecutive segments that share their
//! coefficients.

use faer::{Mat, c64};
use pulp::Simd;

use super::modal_wheel::ModalWheel;

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

/// Modal coordinates of the wheel under central differences, in increments:
///
/// ```text
/// d⁺ = ((1 − ζωh) d − (ωh)² z)/(1 + ζωh),   z⁺ = z + d⁺          (Eq. 8, d = z − z⁻)
/// ```
///
/// which is Eq. 8 exactly, but does not lose digits to the difference z − z⁻ at small steps. A force f̂ adds
/// β φᴴ f̂ with β = h²/(1 + ζωh) (Eq. 10).
#[derive(Debug, Clone)]
pub(crate) struct Oscillators {
    segments: Vec<Segment>,
    step: f64,
    /// (1 − ζωh)/(1 + ζωh)
    keep: Vec<f64>,
    /// (ωh)²/(1 + ζωh)
    pull: Vec<f64>,
    /// β
    receptance: Vec<f64>,
    /// ζω/(2h): energy lost in a step is Σ loss·(z⁺ − z⁻)².
    loss: Vec<f64>,
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
    /// z⁺ − z⁻ of the last free step, for the damping loss; empty without damping.
    swing: Vec<f64>,
}

/// One part (real or imaginary) of one nodal diameter's coordinates, as vectors.
struct Part<'a, S: Simd, const DAMPED: bool> {
    z: &'a mut [S::f64s],
    d: &'a mut [S::f64s],
    /// Empty unless `DAMPED`.
    swing: &'a mut [S::f64s],
}

impl State {
    /// The part of `length` numbers (`vectors` vectors) at `start`.
    #[inline(always)]
    fn part<S: Simd, const DAMPED: bool>(
        &mut self,
        start: usize,
        length: usize,
        vectors: usize,
    ) -> Part<'_, S, DAMPED> {
        let swing = if DAMPED { &mut self.swing[start..start + length] } else { &mut [][..] };
        Part {
            z: &mut S::as_mut_simd_f64s(&mut self.z[start..start + length]).0[..vectors],
            d: &mut S::as_mut_simd_f64s(&mut self.d[start..start + length]).0[..vectors],
            swing: &mut S::as_mut_simd_f64s(swing).0[..if DAMPED { vectors } else { 0 }],
        }
    }

    /// Both parts of a pair at `start`.
    #[inline(always)]
    fn pair<S: Simd, const DAMPED: bool>(
        &mut self,
        start: usize,
        length: usize,
        vectors: usize,
    ) -> (Part<'_, S, DAMPED>, Part<'_, S, DAMPED>) {
        let Part { z, d, swing } = self.part::<S, DAMPED>(start, 2 * length, 2 * vectors);
        let (z_re, z_im) = z.split_at_mut(vectors);
        let (d_re, d_im) = d.split_at_mut(vectors);
        let (swing_re, swing_im) = swing.split_at_mut(if DAMPED { vectors } else { 0 });
        (Part { z: z_re, d: d_re, swing: swing_re }, Part { z: z_im, d: d_im, swing: swing_im })
    }
}

impl<S: Simd, const DAMPED: bool> Part<'_, S, DAMPED> {
    /// Moves vector `m` by `moved`; returns `lost` with what damping takes of it.
    #[inline(always)]
    fn shift(&mut self, simd: S, m: usize, moved: S::f64s, loss: S::f64s, mut lost: S::f64s) -> S::f64s {
        if DAMPED {
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
    /// At rest, steps of `step` seconds.
    pub(crate) fn new(wheel: &ModalWheel, step: f64, damping: Option<&ModalDamping>) -> Self {
        let mut this = Self {
            segments: Vec::with_capacity(wheel.harmonics.len()),
            step,
            keep: Vec::new(),
            pull: Vec::new(),
            receptance: Vec::new(),
            loss: Vec::new(),
            stiffness: Vec::new(),
            state: State::default(),
        };
        let (mut state, mut column) = (0, 0);
        for harmonic in &wheel.harmonics {
            let length = padded(harmonic.omega.len());
            let parts = if harmonic.single { 1 } else { 2 };
            let modes = this.keep.len();
            this.segments.push(Segment { single: harmonic.single, length, modes, state, column });
            for family in 0..length {
                let omega = harmonic.omega.get(family).copied().unwrap_or(0.0);
                let zeta = damping.map_or(0.0, |damping| damping.ratio(family));
                let damped = 1.0 + zeta * omega * step;
                this.keep.push((1.0 - zeta * omega * step) / damped);
                this.pull.push((omega * step).powi(2) / damped);
                this.receptance.push(step * step / damped);
                this.loss.push(zeta * omega / (2.0 * step));
                this.stiffness.push(omega * omega);
            }
            state += parts * length;
            column += parts;
        }
        this.state.z = vec![0.0; state];
        this.state.d = vec![0.0; state];
        if damping.is_some() {
            this.state.swing = vec![0.0; state];
        }
        this
    }

    /// One free step of every oscillator; returns the energy lost to damping in it (0 unless `DAMPED`).
    #[inline(always)]
    pub(crate) fn advance<S: Simd, const DAMPED: bool>(&mut self, simd: S) -> f64 {
        let mut lost = simd.splat_f64s(0.0);
        for segment in &self.segments {
            let coefficients = segment.modes..segment.modes + segment.length;
            let keep = S::as_simd_f64s(&self.keep[coefficients.clone()]).0;
            let pull = S::as_simd_f64s(&self.pull[coefficients.clone()]).0;
            let loss = S::as_simd_f64s(&self.loss[coefficients]).0;
            let vectors = keep.len();
            let (pull, loss) = (&pull[..vectors], &loss[..vectors]);
            for part in 0..if segment.single { 1 } else { 2 } {
                let start = segment.state + part * segment.length;
                let Part { z, d, swing } = self.state.part::<S, DAMPED>(start, segment.length, vectors);
                for m in 0..vectors {
                    if DAMPED {
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
        }
        if DAMPED { simd.reduce_sum_f64s(lost) } else { 0.0 }
    }

    /// Values of `rows` in Fourier coordinates: `out[column][row]`, rows padded to `rows.stride`.
    #[inline(always)]
    pub(crate) fn project<S: Simd>(&self, simd: S, rows: &Rows, out: &mut [f64]) {
        for (segment, block) in self.segments.iter().zip(&rows.blocks) {
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
    }

    /// Adds the displacement that forces on `rows` cause within this step (Eq. 10): `force[column][row]` in
    /// Fourier coordinates, only rows listed in `loaded`. Returns the further energy lost to damping.
    #[inline(always)]
    pub(crate) fn correct<S: Simd, const DAMPED: bool>(
        &mut self,
        simd: S,
        rows: &Rows,
        loaded: &[usize],
        force: &[f64],
    ) -> f64 {
        let mut lost = 0.0;
        for group in loaded.chunks(6) {
            lost += match *group {
                [a] => self.push::<S, DAMPED, 1>(simd, rows, [a], force),
                [a, b] => self.push::<S, DAMPED, 2>(simd, rows, [a, b], force),
                [a, b, c] => self.push::<S, DAMPED, 3>(simd, rows, [a, b, c], force),
                [a, b, c, d] => self.push::<S, DAMPED, 4>(simd, rows, [a, b, c, d], force),
                [a, b, c, d, e] => self.push::<S, DAMPED, 5>(simd, rows, [a, b, c, d, e], force),
                [a, b, c, d, e, f, ..] => self.push::<S, DAMPED, 6>(simd, rows, [a, b, c, d, e, f], force),
                [] => 0.0,
            };
        }
        lost
    }

    /// [`Self::correct`] for R rows at once. Groups may follow each other: each updates the swing that the next one's
    /// loss is counted from.
    #[inline(always)]
    fn push<S: Simd, const DAMPED: bool, const R: usize>(
        &mut self,
        simd: S,
        rows: &Rows,
        group: [usize; R],
        force: &[f64],
    ) -> f64 {
        let mut lost = simd.splat_f64s(0.0);
        for (segment, block) in self.segments.iter().zip(&rows.blocks) {
            let Segment { single, length, modes, state, column } = *segment;
            let receptance = S::as_simd_f64s(&self.receptance[modes..modes + length]).0;
            let loss = &S::as_simd_f64s(&self.loss[modes..modes + length]).0[..receptance.len()];
            let force_re = gather(simd, &force[column * rows.stride..], group);
            let phi_re = RowBlock::rows::<S, R>(&block.re, group, length, receptance.len());
            if single {
                let mut part = self.state.part::<S, DAMPED>(state, length, receptance.len());
                for m in 0..receptance.len() {
                    let mut modal = simd.splat_f64s(0.0);
                    for r in 0..R {
                        modal = simd.mul_add_e_f64s(phi_re[r][m], force_re[r], modal);
                    }
                    lost = part.shift(simd, m, simd.mul_f64s(receptance[m], modal), loss[m], lost);
                }
                continue;
            }
            let force_im = gather(simd, &force[(column + 1) * rows.stride..], group);
            let phi_im = RowBlock::rows::<S, R>(&block.im, group, length, receptance.len());
            let (mut re, mut im) = self.state.pair::<S, DAMPED>(state, length, receptance.len());
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
        }
        if DAMPED { simd.reduce_sum_f64s(lost) } else { 0.0 }
    }

    /// E^{q+½} = ½ vᵀMv + ½ u_qᵀ K u_{q+1} of the last step (§8).
    pub(crate) fn energy(&self) -> f64 {
        let mut twice = 0.0;
        for segment in &self.segments {
            for part in 0..if segment.single { 1 } else { 2 } {
                let start = segment.state + part * segment.length;
                for m in 0..segment.length {
                    let (z, d) = (self.state.z[start + m], self.state.d[start + m]);
                    let velocity = d / self.step;
                    twice += velocity * velocity + self.stiffness[segment.modes + m] * (z - d) * z;
                }
            }
        }
        0.5 * twice
    }

    /// h, s.
    pub(crate) fn step(&self) -> f64 {
        self.step
    }

    /// β of the modes of nodal diameter `harmonic`, padding excluded by the caller's row length.
    pub(crate) fn receptance(&self, harmonic: usize) -> &[f64] {
        let segment = &self.segments[harmonic];
        &self.receptance[segment.modes..][..segment.length]
    }
}

/// Each of `group`'s values in every lane. A loop and no closure: a closure would be compiled without the wide vectors.
#[inline(always)]
fn gather<S: Simd, const R: usize>(simd: S, values: &[f64], group: [usize; R]) -> [S::f64s; R] {
    let mut lanes = [simd.splat_f64s(0.0); R];
    for (lane, row) in lanes.iter_mut().zip(group) {
        *lane = simd.splat_f64s(values[row]);
    }
    lanes
}

#[inline(always)]
fn project_single<S: Simd>(
    simd: S,
    re: &[S::f64s],
    block: &RowBlock,
    length: usize,
    count: usize,
    out: &mut [f64],
) {
    for (row, out) in out[..count].iter_mut().enumerate() {
        let phi = S::as_simd_f64s(&block.re[row * length..][..length]).0;
        let mut sum = simd.splat_f64s(0.0);
        for (&phi, &re) in phi.iter().zip(re) {
            sum = simd.mul_add_e_f64s(phi, re, sum);
        }
        *out = simd.reduce_sum_f64s(sum);
    }
}

/// Five rows at a time share the loads of z and keep ten sums in flight: what sixteen registers hold.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a kernel's operands")]
fn project_pair<S: Simd>(
    simd: S,
    re: &[S::f64s],
    im: &[S::f64s],
    block: &RowBlock,
    length: usize,
    count: usize,
    out_re: &mut [f64],
    out_im: &mut [f64],
) {
    let mut row = 0;
    while row < count {
        match count - row {
            1 => project_rows::<S, 1>(simd, re, im, block, length, row, out_re, out_im),
            2 => project_rows::<S, 2>(simd, re, im, block, length, row, out_re, out_im),
            3 => project_rows::<S, 3>(simd, re, im, block, length, row, out_re, out_im),
            4 => project_rows::<S, 4>(simd, re, im, block, length, row, out_re, out_im),
            _ => project_rows::<S, 5>(simd, re, im, block, length, row, out_re, out_im),
        }
        row += 5;
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a kernel's operands")]
fn project_rows<S: Simd, const R: usize>(
    simd: S,
    re: &[S::f64s],
    im: &[S::f64s],
    block: &RowBlock,
    length: usize,
    row: usize,
    out_re: &mut [f64],
    out_im: &mut [f64],
) {
    let vectors = re.len();
    let im = &im[..vectors];
    let mut group = [row; R];
    for (r, member) in group.iter_mut().enumerate() {
        *member += r;
    }
    let phi_re = RowBlock::rows::<S, R>(&block.re, group, length, vectors);
    let phi_im = RowBlock::rows::<S, R>(&block.im, group, length, vectors);
    let mut sum_re = [simd.splat_f64s(0.0); R];
    let mut sum_im = [simd.splat_f64s(0.0); R];
    for m in 0..vectors {
        let (a, b) = (re[m], im[m]);
        for r in 0..R {
            let (p, q) = (phi_re[r][m], phi_im[r][m]);
            sum_re[r] = simd.mul_add_e_f64s(p, a, sum_re[r]);
            sum_re[r] = simd.negate_mul_add_e_f64s(q, b, sum_re[r]);
            sum_im[r] = simd.mul_add_e_f64s(p, b, sum_im[r]);
            sum_im[r] = simd.mul_add_e_f64s(q, a, sum_im[r]);
        }
    }
    for r in 0..R {
        out_re[row + r] = simd.reduce_sum_f64s(sum_re[r]);
        out_im[row + r] = simd.reduce_sum_f64s(sum_im[r]);
    }
}

/// Scalar displacements to be read or loaded: one row a contact normal or a sensor, for every nodal diameter.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    /// Number of rows.
    pub(crate) count: usize,
    /// Rows padded to whole vectors.
    pub(crate) stride: usize,
    blocks: Vec<RowBlock>,
}

/// dᵀφ_m of each row direction d: row-major `[row][mode]`, modes padded.
#[derive(Debug, Clone)]
struct RowBlock {
    re: Vec<f64>,
    im: Vec<f64>,
}

/// A displacement direction at a contact node in (r, θ, z) components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Contact node, from the leading edge.
    pub node: usize,
    /// Components of the direction.
    pub components: [f64; 3],
}

impl RowBlock {
    /// The rows of `group` in `part` (`re` or `im`), each cut to `vectors` vectors so that no index needs a check.
    #[inline(always)]
    fn rows<S: Simd, const R: usize>(
        part: &[f64],
        group: [usize; R],
        length: usize,
        vectors: usize,
    ) -> [&[S::f64s]; R] {
        let mut rows: [&[S::f64s]; R] = [&[]; R];
        for (slice, row) in rows.iter_mut().zip(group) {
            *slice = &S::as_simd_f64s(&part[row * length..][..length]).0[..vectors];
        }
        rows
    }
}

impl Rows {
    pub(crate) fn new(wheel: &ModalWheel, directions: &[Direction]) -> Self {
        let blocks = wheel.harmonics.iter().map(|h| row_block(&h.contact, directions)).collect();
        Self { count: directions.len(), stride: padded(directions.len()), blocks }
    }

    /// dᵀφ of row `row` over the padded modes of nodal diameter `harmonic`.
    pub(crate) fn row(&self, harmonic: usize, row: usize) -> (&[f64], &[f64]) {
        let block = &self.blocks[harmonic];
        let length = block.re.len() / self.count;
        (&block.re[row * length..][..length], &block.im[row * length..][..length])
    }
}

fn row_block(contact: &Mat<c64>, directions: &[Direction]) -> RowBlock {
    let length = padded(contact.ncols());
    let mut block =
        RowBlock { re: vec![0.0; directions.len() * length], im: vec![0.0; directions.len() * length] };
    for (row, direction) in directions.iter().enumerate() {
        for m in 0..contact.ncols() {
            let value: c64 =
                (0..3).map(|c| contact[(3 * direction.node + c, m)] * direction.components[c]).sum();
            block.re[row * length + m] = value.re;
            block.im[row * length + m] = value.im;
        }
    }
    block
}
