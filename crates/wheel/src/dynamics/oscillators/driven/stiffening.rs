//! Forces of blades that stiffen as they bend, at the middle instant of a step ([`super::super::super::bending`]).
//!
//! The force of inertia needs accelerations at an instant of which only the past is known: p̈ and q̈ are backward differences of second order,
//! h²q̈ ≈ 2q − 5q⁻ + 4q⁻⁻ − q⁻⁻⁻. A step is stable while the inertia of second order is below (1 − ω²h²/4)/3 of the linear one: a third for slow
//! modes, a twelfth at ω²h² = 3, the fastest that a step resolves.

use std::ops::Range;

use pulp::Simd;

use super::super::super::bending::{Bending, EnergyForm, MOST_COORDINATES, MOST_PRODUCTS, products};
use super::super::super::modal_wheel::ModalWheel;
use super::super::Oscillators;
use super::super::lanes::padded;
use super::super::rows::{Loads, Rows};
use super::super::segment::Segment;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Geometric stiffening of all blades.
#[derive(Debug)]
pub(super) struct Stiffening {
    rows: Rows,
    potential: EnergyForm,
    inertia: EnergyForm,
    /// Step h, s.
    step: f64,
    /// Columns of the Fourier basis, `[column][sector]`, sectors padded to whole vectors by zeros.
    waves: Aligned,
    /// Coordinates in Fourier coordinates, `[column][coordinate]`, padded.
    harmonic: Vec<f64>,
    /// Forces on the coordinates in Fourier coordinates, in the same order.
    force: Vec<f64>,
    /// Indices of all coordinates.
    all: Vec<usize>,
    /// Coordinates of all sectors, and behind them their products, `[row][sector]`, padded as the waves.
    now: Aligned,
    /// Values of `now` at the three instants before, latest first.
    before: [Aligned; 3],
    /// Values of `now` at the first end of a step whose energy is asked for.
    first: Aligned,
    /// Forces on the coordinates, `[coordinate][sector]`, padded as the waves.
    f: Aligned,
}

impl Stiffening {
    /// Stiffening of the blades of `wheel` by the first `resolved` modes of every nodal diameter: faster ones carry no bending.
    pub(super) fn new(
        bending: Bending<'_>,
        wheel: &ModalWheel,
        fourier: &SectorFourier,
        resolved: usize,
        step: f64,
    ) -> Self {
        let directions: Vec<_> = bending.directions().collect();
        let rows = Rows::new(wheel, &directions, |modes| resolved.min(modes));
        let (m, sectors, stride) = (directions.len(), fourier.sectors(), rows.stride);
        let of_wave = padded(sectors);
        let moving = (m + products(m).count()) * of_wave;
        let mut waves = Aligned::zeros(sectors * of_wave);
        for sector in 0..sectors {
            let columns = waves.iter_mut().skip(sector).step_by(of_wave);
            columns.zip(fourier.row(sector)).for_each(|(wave, row)| *wave = *row);
        }
        Self {
            potential: bending.blade.potential.clone(),
            inertia: bending.blade.inertia.clone(),
            step,
            waves,
            harmonic: vec![0.0; sectors * stride],
            force: vec![0.0; sectors * stride],
            all: (0..m).collect(),
            now: Aligned::zeros(moving),
            before: [(); 3].map(|()| Aligned::zeros(moving)),
            first: Aligned::zeros(moving),
            f: Aligned::zeros(m * of_wave),
            rows,
        }
    }

    /// Fills the past with the free motion that leads to the state of `oscillators`.
    #[inline(always)]
    pub(super) fn begin<S: Simd>(&mut self, simd: S, oscillators: &Oscillators) {
        let Oscillators { segments, coefficients, state, .. } = oscillators;
        let (mut z, mut d) = (state.z.clone(), state.d.clone());
        for before in 0..3 {
            for segment in segments {
                for start in segment.parts() {
                    for m in 0..segment.integrated {
                        let (at, mode) = (start + m, segment.modes + m);
                        z[at] -= d[at];
                        d[at] = (d[at] + coefficients.pull[mode] * z[at]) / coefficients.keep[mode];
                    }
                }
            }
            self.read(simd, segments, &z);
            self.before[before].copy_from_slice(&self.now);
        }
    }

    /// Writes the modal forces of the state `z`, one step after the last that was [remembered](Self::remember).
    #[inline(always)]
    pub(super) fn force<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64], out: &mut Aligned) {
        self.read(simd, segments, z);
        let Self { rows, potential, inertia, step, waves, force, all, now, before, f, .. } = self;
        let (now, waves) = (S::as_simd_f64s(now).0, S::as_simd_f64s(waves).0);
        let [one, two, three] = &*before;
        let before = [S::as_simd_f64s(one).0, S::as_simd_f64s(two).0, S::as_simd_f64s(three).0];
        let f = S::as_mut_simd_f64s(f).0;
        let m = all.len();
        let vectors = f.len() / m.max(1);
        let rate = 1.0 / (*step * *step);
        let mut differences = [simd.splat_f64s(rate); 4];
        for (difference, c) in differences.iter_mut().zip([2.0, -5.0, 4.0, -1.0]) {
            *difference = simd.splat_f64s(rate * c);
        }
        for v in 0..vectors {
            let p = lanes(simd, now, vectors, v, 0..m);
            let q = lanes(simd, now, vectors, v, m..now.len() / vectors);
            let mut accelerations = [simd.splat_f64s(0.0); MOST_COORDINATES];
            let mut rates = [simd.splat_f64s(0.0); MOST_PRODUCTS];
            second_differences(simd, differences, now, before, (vectors, v), 0, &mut accelerations[..m]);
            let count = now.len() / vectors - m;
            second_differences(simd, differences, now, before, (vectors, v), m, &mut rates[..count]);
            let mut forces = [simd.splat_f64s(0.0); MOST_COORDINATES];
            potential.add_forces(simd, &p, &p, &q, &mut forces);
            inertia.add_forces(simd, &p, &accelerations, &rates, &mut forces);
            for (f, &force) in f.chunks_exact_mut(vectors).zip(&forces) {
                f[v] = force;
            }
        }
        for (column, wave) in force.chunks_exact_mut(rows.stride).zip(waves.chunks_exact(vectors)) {
            for (force, f) in column.iter_mut().zip(f.chunks_exact(vectors)) {
                let mut sum = simd.splat_f64s(0.0);
                for (&wave, &f) in wave.iter().zip(f) {
                    sum = simd.mul_add_e_f64s(wave, f, sum);
                }
                *force = simd.reduce_sum_f64s(sum);
            }
        }
        let loads = Loads { rows, loaded: all, force };
        for (index, &segment) in segments.iter().enumerate() {
            loads.modal(simd, index, segment, &mut out[segment.state..]);
        }
    }

    /// Adds the state whose forces were computed last to the past.
    pub(super) fn remember(&mut self) {
        self.before.rotate_right(1);
        std::mem::swap(&mut self.before[0], &mut self.now);
    }

    /// Energy beyond the quadratic one half-way between the states `ends` of a step: the mean of the strain energy at both, and the kinetic
    /// energy of the change.
    #[inline(always)]
    pub(super) fn energy<S: Simd>(&mut self, simd: S, segments: &[Segment], ends: [&[f64]; 2]) -> f64 {
        self.read(simd, segments, ends[0]);
        std::mem::swap(&mut self.first, &mut self.now);
        self.read(simd, segments, ends[1]);
        let (first, last) = (S::as_simd_f64s(&self.first).0, S::as_simd_f64s(&self.now).0);
        let m = self.all.len();
        let vectors = S::as_simd_f64s(&self.f).0.len() / m.max(1);
        let (half, rate) = (simd.splat_f64s(0.5), simd.splat_f64s(1.0 / self.step));
        let mut energy = simd.splat_f64s(0.0);
        for v in 0..vectors {
            let products = m..first.len() / vectors;
            let mut velocity = lanes(simd, first, vectors, v, 0..m);
            let mut rates = lanes(simd, first, vectors, v, products.clone());
            let (q, last) = (lanes(simd, last, vectors, v, products), lanes(simd, last, vectors, v, 0..m));
            for (p, q) in [(&velocity, &rates), (&last, &q)] {
                energy = simd.mul_add_e_f64s(half, self.potential.values(simd, p, q), energy);
            }
            for (velocity, last) in velocity.iter_mut().zip(last) {
                *velocity = simd.mul_f64s(rate, simd.sub_f64s(last, *velocity));
            }
            for (change, q) in rates.iter_mut().zip(q) {
                *change = simd.mul_f64s(rate, simd.sub_f64s(q, *change));
            }
            energy = simd.add_f64s(energy, self.inertia.values(simd, &velocity, &rates));
        }
        simd.reduce_sum_f64s(energy)
    }

    /// Reads the coordinates of all sectors, and their products, in the state `z`.
    #[inline(always)]
    fn read<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64]) {
        let Self { rows, potential, waves, harmonic, all, now, .. } = self;
        for (index, &segment) in segments.iter().enumerate() {
            rows.project(simd, index, segment, z, harmonic);
        }
        let waves = S::as_simd_f64s(waves).0;
        let vectors = waves.len() / (harmonic.len() / rows.stride);
        let (p, q) = S::as_mut_simd_f64s(now).0.split_at_mut(all.len() * vectors);
        for (j, p) in p.chunks_exact_mut(vectors).enumerate() {
            p.fill(simd.splat_f64s(0.0));
            for (column, wave) in harmonic.chunks_exact(rows.stride).zip(waves.chunks_exact(vectors)) {
                let value = simd.splat_f64s(column[j]);
                for (p, &wave) in p.iter_mut().zip(wave) {
                    *p = simd.mul_add_e_f64s(value, wave, *p);
                }
            }
        }
        for (q, &(j, k)) in q.chunks_exact_mut(vectors).zip(potential.products()) {
            for (v, q) in q.iter_mut().enumerate() {
                *q = simd.mul_f64s(p[j * vectors + v], p[k * vectors + v]);
            }
        }
    }
}

/// Vector `v` of some of the rows in `moving`, `vectors` of each.
#[inline(always)]
fn lanes<S: Simd, const COUNT: usize>(
    simd: S,
    moving: &[S::f64s],
    vectors: usize,
    v: usize,
    rows: Range<usize>,
) -> [S::f64s; COUNT] {
    let mut lanes = [simd.splat_f64s(0.0); COUNT];
    for (lane, row) in
        lanes.iter_mut().zip(moving[rows.start * vectors..rows.end * vectors].chunks_exact(vectors))
    {
        *lane = row[v];
    }
    lanes
}

/// Writes second differences of rows from `first` on into `out`, by these coefficients of now and the three instants before: vector `v` of
/// `vectors` of each.
#[inline(always)]
fn second_differences<S: Simd>(
    simd: S,
    [c0, c1, c2, c3]: [S::f64s; 4],
    now: &[S::f64s],
    [one, two, three]: [&[S::f64s]; 3],
    (vectors, v): (usize, usize),
    first: usize,
    out: &mut [S::f64s],
) {
    for (i, out) in out.iter_mut().enumerate() {
        let at = (first + i) * vectors + v;
        let older = simd.mul_add_e_f64s(c2, two[at], simd.mul_f64s(c3, three[at]));
        *out = simd.mul_add_e_f64s(c0, now[at], simd.mul_add_e_f64s(c1, one[at], older));
    }
}
