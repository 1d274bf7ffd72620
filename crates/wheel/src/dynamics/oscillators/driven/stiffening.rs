//! Forces of blades that stiffen as they bend, at the middle instant of a step ([`super::super::super::bending`]).

use pulp::Simd;

use super::super::super::bending::{Bending, Potential};
use super::super::super::modal_wheel::ModalWheel;
use super::super::Oscillators;
use super::super::rows::{Loads, Rows};
use super::super::segment::Segment;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Geometric stiffening of all blades.
#[derive(Debug)]
pub(super) struct Stiffening {
    rows: Rows,
    potential: Potential,
    fourier: SectorFourier,
    /// Coordinates in Fourier coordinates, `[column][coordinate]`, padded.
    harmonic: Vec<f64>,
    /// Forces on them, in the same order.
    force: Vec<f64>,
    /// Indices of all coordinates.
    all: Vec<usize>,
    /// Coordinates of one sector, forces on them, and what the potential needs.
    p: Vec<f64>,
    f: Vec<f64>,
    scratch: Vec<f64>,
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
        let potential = bending.blade.potential.clone();
        Self {
            scratch: vec![0.0; m * (m + 1)],
            potential,
            fourier: fourier.clone(),
            harmonic: vec![0.0; sectors * stride],
            force: vec![0.0; sectors * stride],
            all: (0..m).collect(),
            p: vec![0.0; m],
            f: vec![0.0; m],
            rows,
        }
    }

    /// Writes the modal forces of the state `z`.
    #[inline(always)]
    pub(super) fn force<S: Simd>(&mut self, simd: S, segments: &[Segment], z: &[f64], out: &mut Aligned) {
        let Self { rows, potential, fourier, harmonic, force, all, p, f, scratch } = self;
        for (index, &segment) in segments.iter().enumerate() {
            rows.project(simd, index, segment, z, harmonic);
        }
        force.fill(0.0);
        for sector in 0..fourier.sectors() {
            coordinates(fourier, sector, harmonic, rows.stride, p);
            f.fill(0.0);
            potential.add_force(p, f, scratch);
            for (&row, column) in fourier.row(sector).iter().zip(force.chunks_exact_mut(rows.stride)) {
                column.iter_mut().zip(&*f).for_each(|(sum, f)| *sum += row * f);
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
        let Self { rows, potential, fourier, harmonic, p, .. } = self;
        for (index, &segment) in segments.iter().enumerate() {
            rows.project(simd, index, segment, z, harmonic);
        }
        let of = |sector: usize| {
            coordinates(fourier, sector, harmonic, rows.stride, p);
            potential.energy(p)
        };
        (0..fourier.sectors()).map(of).sum()
    }
}

/// Writes the coordinates of a sector, given in Fourier coordinates `[column][coordinate]` padded to `stride`, into `p`.
#[inline(always)]
pub(crate) fn coordinates(
    fourier: &SectorFourier,
    sector: usize,
    harmonic: &[f64],
    stride: usize,
    p: &mut [f64],
) {
    p.fill(0.0);
    for (&row, column) in fourier.row(sector).iter().zip(harmonic.chunks(stride)) {
        p.iter_mut().zip(column).for_each(|(p, value)| *p += row * value);
    }
}
