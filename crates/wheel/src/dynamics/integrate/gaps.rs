//! Gaps between tips and casing within a step (Eq. 9).

use pulp::Simd;

use super::super::amplitude_sums::amplitude_sums;
use super::super::casing::{Casing, RestrictionTable, ramp};
use super::gap_shift::GapShift;
use super::instant::Instant;
use super::second_order::SecondOrder;
use super::simulation::Simulation;
use rubmap_numerics::complementarity::any_below;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Number of sectors up to which all are transformed: finding the far ones would cost as much.
const ALL_TRANSFORMED: usize = 16;

/// Number of sectors transformed together: as many sums as are in flight at once.
const TOGETHER: usize = 4;

/// Gaps of all contact nodes, predicted without the forces that close them.
#[derive(Debug)]
pub(super) struct Gaps {
    ramp_revolutions: f64,
    pub(super) restriction: Option<RestrictionTable>,
    /// Heights p = 0 of a circular casing.
    unrestricted: Vec<f64>,
    /// Clearances c_k, padded with +∞.
    pub(super) clearance: Vec<f64>,
    /// Number of contact nodes of a sector, padded to whole vectors.
    pub(super) stride: usize,
    /// Normal displacements of the integrated modes, `[Fourier column][node]`; behind them the coordinates of blades that bend far.
    pub(super) harmonic: Vec<f64>,
    /// Upper bounds of nᵀu in any sector.
    amplitude_sums: Vec<f64>,
    /// Predicted gaps, `[sector][node]`: exact for near sectors, lower bounds for far ones.
    pub(super) predicted: Vec<f64>,
    /// Whether a sector is far: no displacement that the wheel has anywhere would bring it to the casing.
    pub(super) is_far: Vec<bool>,
    /// Sectors that are not far.
    near: Vec<usize>,
    /// Shift of all gaps, where something moves them.
    pub(super) shift: Option<GapShift>,
    /// Motion of second order towards the casing, of blades that bend far.
    pub(super) second_order: Option<SecondOrder>,
    /// Linear displacements, `[sector][row]`, of blades that bend far.
    pub(super) linear: Vec<f64>,
}

/// Casing as the gaps of one step see it.
#[derive(Clone, Copy)]
struct Wall {
    /// Number of the step in the revolution.
    step: usize,
    /// Growth of the restriction.
    growth: f64,
}

impl Gaps {
    pub(super) fn new(simulation: &Simulation<'_>, casing: &Casing, stride: usize) -> Self {
        let sectors = simulation.wheel.sectors;
        let angles: Vec<_> = simulation.contact_nodes.iter().map(|node| node.position[1]).collect();
        let restriction = casing.restriction.as_ref().map(|restriction| {
            let profile = |angle, node| restriction.height(angle, node);
            let around = simulation.wheel.around();
            RestrictionTable::new(profile, &angles, simulation.steps_per_revolution, around, stride)
        });
        let mut clearance = casing.clearance.clone();
        clearance.resize(stride, f64::INFINITY);
        Self {
            ramp_revolutions: casing.ramp_revolutions,
            restriction,
            unrestricted: vec![0.0; stride],
            clearance,
            stride,
            harmonic: vec![0.0; sectors * stride],
            amplitude_sums: vec![0.0; stride],
            predicted: vec![0.0; sectors * stride],
            is_far: vec![false; sectors],
            near: (0..sectors).collect(),
            shift: GapShift::new(simulation, stride),
            second_order: (simulation.effects.bending)
                .map(|bending| SecondOrder::towards_casing(bending, simulation.contact_nodes)),
            linear: vec![0.0; simulation.effects.bending.map_or(0, |_| sectors * stride)],
        }
    }

    /// Predicts the gaps g_p = c − p − nᵀu of all sectors. Returns the smallest if it is negative, otherwise a number that is not.
    ///
    /// A far sector, where c − p is not below the upper bound of nᵀu in any sector, gets c − p less that bound.
    #[inline(always)]
    pub(super) fn predict<S: Simd>(&mut self, simd: S, fourier: &SectorFourier, now: Instant) -> f64 {
        let growth = ramp(now.revolutions, self.ramp_revolutions);
        if let Some(shift) = &mut self.shift {
            shift.move_to(now.revolutions, growth);
        }
        let wall = Wall { step: now.step, growth };
        // Motion of second order has no bound here.
        if fourier.sectors() > ALL_TRANSFORMED && self.second_order.is_none() {
            amplitude_sums(simd, fourier, &self.harmonic, &mut self.amplitude_sums);
            self.near.clear();
            for sector in 0..fourier.sectors() {
                let far = self.least_gaps(simd, wall, sector) >= 0.0;
                self.is_far[sector] = far;
                if !far {
                    self.near.push(sector);
                }
            }
        }
        self.near_gaps(simd, fourier, wall)
    }

    /// Writes the lower bounds of the gaps of a sector. Returns the smallest.
    #[inline(always)]
    fn least_gaps<S: Simd>(&mut self, simd: S, wall: Wall, sector: usize) -> f64 {
        let Wall { step, growth } = wall;
        let Self { restriction, unrestricted, clearance, amplitude_sums, predicted, shift, .. } = self;
        let stride = self.stride;
        let shift = shift.as_ref().map(|shift| shift.now.as_slice());
        let vectors = stride / S::F64_LANES;
        let range = sector * stride..(sector + 1) * stride;
        let gap = &mut S::as_mut_simd_f64s(&mut predicted[range]).0[..vectors];
        let restricted = restriction.as_ref().map_or(&unrestricted[..], |table| table.at(step, sector));
        let restricted = &S::as_simd_f64s(restricted).0[..vectors];
        let clearance = &S::as_simd_f64s(clearance).0[..vectors];
        let sums = &S::as_simd_f64s(amplitude_sums).0[..vectors];
        let growth = simd.splat_f64s(growth);
        let mut smallest = simd.splat_f64s(f64::INFINITY);
        for v in 0..vectors {
            let room = room(simd, clearance[v], growth, restricted[v], shift, sector * vectors + v);
            gap[v] = simd.sub_f64s(room, sums[v]);
            smallest = simd.min_f64s(smallest, gap[v]);
        }
        simd.reduce_min_f64s(smallest)
    }

    /// Writes the gaps of the near sectors, and returns the smallest.
    #[inline(always)]
    fn near_gaps<S: Simd>(&mut self, simd: S, fourier: &SectorFourier, wall: Wall) -> f64 {
        let mut smallest = simd.splat_f64s(f64::INFINITY);
        for first in (0..self.near.len()).step_by(TOGETHER) {
            let of_group = match self.near[first..] {
                [a] => self.gaps_of(simd, fourier, wall, [a]),
                [a, b] => self.gaps_of(simd, fourier, wall, [a, b]),
                [a, b, c] => self.gaps_of(simd, fourier, wall, [a, b, c]),
                [a, b, c, d, ..] => self.gaps_of(simd, fourier, wall, [a, b, c, d]),
                [] => break,
            };
            smallest = simd.min_f64s(smallest, of_group);
        }
        simd.reduce_min_f64s(smallest)
    }

    /// Writes the gaps of some sectors, transformed together so that their sums do not wait for each other; returns the smallest.
    #[inline(always)]
    fn gaps_of<S: Simd, const R: usize>(
        &mut self,
        simd: S,
        fourier: &SectorFourier,
        wall: Wall,
        sectors: [usize; R],
    ) -> S::f64s {
        let Wall { step, growth } = wall;
        let Self { restriction, unrestricted, clearance, harmonic, predicted, shift, second_order, .. } =
            self;
        let shift = shift.as_ref().map(|shift| shift.now.as_slice());
        let vectors = self.stride / S::F64_LANES;
        let linear = S::as_mut_simd_f64s(&mut self.linear).0;
        let gap = S::as_mut_simd_f64s(predicted).0;
        let clearance = &S::as_simd_f64s(clearance).0[..vectors];
        let harmonic = S::as_simd_f64s(harmonic).0;
        let growth = simd.splat_f64s(growth);
        let mut smallest = simd.splat_f64s(f64::INFINITY);
        let mut basis: [&[f64]; R] = [&[]; R];
        for (basis, sector) in basis.iter_mut().zip(sectors) {
            *basis = &fourier.row(sector)[..fourier.sectors()];
        }
        for v in 0..vectors {
            let mut u = [simd.splat_f64s(0.0); R];
            for (f, column) in harmonic.chunks_exact(vectors).take(fourier.sectors()).enumerate() {
                for r in 0..R {
                    u[r] = simd.mul_add_e_f64s(simd.splat_f64s(basis[r][f]), column[v], u[r]);
                }
            }
            for r in 0..R {
                let restricted = match restriction {
                    Some(table) => table.at(step, sectors[r]),
                    None => unrestricted,
                };
                let at = sectors[r] * vectors + v;
                let restricted = S::as_simd_f64s(restricted).0[v];
                let room = room(simd, clearance[v], growth, restricted, shift, at);
                gap[at] = simd.sub_f64s(room, u[r]);
                if second_order.is_some() {
                    linear[at] = u[r];
                } else {
                    smallest = simd.min_f64s(smallest, gap[at]);
                }
            }
        }
        if let Some(second_order) = second_order {
            for sector in sectors {
                let linear = &self.linear[sector * self.stride..][..self.stride];
                let gap = &mut gap[sector * vectors..][..vectors];
                smallest = simd.min_f64s(smallest, second_order.close(simd, linear, gap));
            }
        }
        smallest
    }

    /// Transforms the gaps of far sectors, too.
    #[inline(never)]
    pub(super) fn complete(&mut self, fourier: &SectorFourier, now: Instant) {
        let wall = Wall { step: now.step, growth: ramp(now.revolutions, self.ramp_revolutions) };
        for sector in 0..fourier.sectors() {
            if std::mem::take(&mut self.is_far[sector]) {
                // Rare: not worth a second copy for the widest vectors.
                self.gaps_of(pulp::Scalar, fourier, wall, [sector]);
            }
        }
        self.near.clear();
        self.near.extend(0..fourier.sectors());
    }

    /// Whether some sectors are far, whose gaps are bounds.
    pub(super) fn has_far(&self) -> bool {
        self.near.len() < self.is_far.len()
    }

    /// Whether a solution is not one of the true gaps: forces act in a far sector, or seem to close it.
    pub(super) fn reach_far(&self, mut pressed: impl Iterator<Item = usize>, gap: &[f64]) -> bool {
        pressed.any(|sector| self.is_far[sector])
            || gap.chunks_exact(self.stride).zip(&self.is_far).any(|(gap, far)| *far && any_below(gap, 0.0))
    }
}

/// Room c − p, the restriction by its growth and height, plus the `at`-th vector of the shift.
#[inline(always)]
fn room<S: Simd>(
    simd: S,
    clearance: S::f64s,
    growth: S::f64s,
    restricted: S::f64s,
    shift: Option<&[f64]>,
    at: usize,
) -> S::f64s {
    let room = simd.negate_mul_add_e_f64s(growth, restricted, clearance);
    match shift {
        Some(shift) => simd.add_f64s(room, S::as_simd_f64s(shift).0[at]),
        None => room,
    }
}
