//! Forces of blades that stiffen as they bend, at the middle instant of a step ([`super::super::super::bending`]).

use pulp::Simd;

use super::super::super::bending::{Bending, MOST_COORDINATES, Potential};
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
    potential: Potential,
    /// Columns of the Fourier basis, `[column][sector]`, sectors padded to whole vectors by zeros.
    waves: Aligned,
    /// Coordinates in Fourier coordinates, `[column][coordinate]`, padded.
    harmonic: Vec<f64>,
    /// Forces on them, in the same order.
    force: Vec<f64>,
    /// Indices of all coordinates.
    all: Vec<usize>,
    /// Coordinates, `[coordinate][sector]`, padded as the waves.
    p: Aligned,
    /// Forces on them, in the same order.
    f: Aligned,
}

impl Stiffening {
    /// Stiffening of the blades of `wheel` by the first `resolved` modes of every nodal diameter: faster ones carry no bending.
    pub(super) fn new(
        bending: Bending<'_>,
        wheel: &ModalWheel,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        resolved: usize,
    ) -> Self {
        let directions: Vec<_> = bending.directions().collect();
        let segments = &oscillators.segments;
        let integrated = |modes: usize| {
            let alike = wheel.harmonics.iter().position(|harmonic| harmonic.omega.len() == modes);
            alike.map_or(modes, |index| segments[index].integrated)
        };
        let rows = Rows::new(wheel, &directions, integrated);
        let rows = rows.map(|_, block| {
            let mut slow = block.to_owned();
            for mode in resolved..slow.ncols() {
                slow.col_mut(mode).fill(faer::c64::ZERO);
            }
            slow
        });
        let (m, sectors, stride) = (directions.len(), fourier.sectors(), rows.stride);
        let of_wave = padded(sectors);
        let mut waves = Aligned::zeros(sectors * of_wave);
        for sector in 0..sectors {
            let columns = waves.iter_mut().skip(sector).step_by(of_wave);
            columns.zip(fourier.row(sector)).for_each(|(wave, row)| *wave = *row);
        }
        Self {
            potential: bending.blade.potential.clone(),
            waves,
            harmonic: vec![0.0; sectors * stride],
            force: vec![0.0; sectors * stride],
            all: (0..m).collect(),
            p: Aligned::zeros(m * of_wave),
            f: Aligned::zeros(m * of_wave),
            rows,
        }
    }

    /// Writes the modal forces of the state `z`.
    #[inline(always)]
    pub(super) fn force<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64], out: &mut Aligned) {
        self.read(simd, segments, z);
        let Self { rows, potential, waves, harmonic: _, force, all, p, f } = self;
        let [p, waves] = [&*p, &*waves].map(|values| S::as_simd_f64s(values).0);
        let f = S::as_mut_simd_f64s(f).0;
        let vectors = p.len() / all.len().max(1);
        for v in 0..vectors {
            let forces = potential.forces(simd, &lanes(simd, p, vectors, v));
            for (f, force) in f.chunks_exact_mut(vectors).zip(forces) {
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

    /// Strain energy beyond the quadratic one in the state `z`.
    #[inline(always)]
    pub(super) fn energy<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64]) -> f64 {
        self.read(simd, segments, z);
        let p = S::as_simd_f64s(&self.p).0;
        let vectors = p.len() / self.all.len().max(1);
        let mut energy = simd.splat_f64s(0.0);
        for v in 0..vectors {
            let of = self.potential.energies(simd, &lanes(simd, p, vectors, v));
            energy = simd.add_f64s(energy, of);
        }
        simd.reduce_sum_f64s(energy)
    }

    /// Reads the coordinates of all sectors in the state `z`.
    #[inline(always)]
    fn read<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64]) {
        let Self { rows, waves, harmonic, p, .. } = self;
        for (index, &segment) in segments.iter().enumerate() {
            rows.project(simd, index, segment, z, harmonic);
        }
        let waves = S::as_simd_f64s(waves).0;
        let vectors = waves.len() / (harmonic.len() / rows.stride);
        for (j, p) in S::as_mut_simd_f64s(p).0.chunks_exact_mut(vectors).enumerate() {
            p.fill(simd.splat_f64s(0.0));
            for (column, wave) in harmonic.chunks_exact(rows.stride).zip(waves.chunks_exact(vectors)) {
                let value = simd.splat_f64s(column[j]);
                for (p, &wave) in p.iter_mut().zip(wave) {
                    *p = simd.mul_add_e_f64s(value, wave, *p);
                }
            }
        }
    }
}

/// Vector `v` of every coordinate in `p`, `vectors` of each.
#[inline(always)]
fn lanes<S: Simd>(simd: S, p: &[S::f64s], vectors: usize, v: usize) -> [S::f64s; MOST_COORDINATES] {
    let mut lanes = [simd.splat_f64s(0.0); MOST_COORDINATES];
    for (lane, p) in lanes.iter_mut().zip(p.chunks_exact(vectors)) {
        *lane = p[v];
    }
    lanes
}
