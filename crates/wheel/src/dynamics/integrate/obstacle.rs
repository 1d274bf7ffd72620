//! Contact between the blades and the casing, within a step.

use pulp::Simd;

use super::super::amplitude_sums::amplitude_sums;
use super::super::casing::{Casing, RestrictionTable, ramp};
use super::super::clearance_change::ClearanceChange;
use super::super::clearance_drift::ClearanceDrift;
use super::super::contact::coating::Coating;
use super::super::contact::delassus::Delassus;
use super::super::contact::flexibility::{outward_normals, ridge};
use super::super::effects::{Effects, FrictionLaw};
use super::super::energy::EffectWork;
use super::super::oscillators::Oscillators;
use super::super::oscillators::lanes::LANES;
use super::super::oscillators::rows::{Loads, Readout, Rows};
use super::super::statistics::RunStatistics;
use super::instant::Instant;
use super::residual::ResidualDisplacement;
use super::simulation::Simulation;
use super::step_flexibility::{step_flexibility, symmetric_flexibility};
use super::surroundings::{Law, Solution, Surroundings};
use super::tally::{ContactInterval, ContactTally};
use super::trace::Trace;
use rubmap_numerics::complementarity::active_set::ActiveSetSolver;
use rubmap_numerics::complementarity::{ComplementarityError, ContactOperator, any_below};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Largest penetration that the ridge of a singular W may leave, relative to clearance and restriction. Nodes that W cannot tell apart but
/// that agree keep to a thousandth of it; where they contradict each other no forces help.
const LEFT: f64 = 1e-6;

/// Number of sectors up to which all are transformed: finding the far ones would cost as much.
const ALL_TRANSFORMED: usize = 16;

/// Number of sectors transformed together: as many sums as are in flight at once.
const TOGETHER: usize = 4;

#[derive(Debug)]
pub(super) struct Obstacle {
    rows: Rows,
    delassus: Delassus,
    solver: ActiveSetSolver,
    residual: ResidualDisplacement,
    ramp_revolutions: f64,
    pub(super) restriction: Option<RestrictionTable>,
    /// Heights p = 0 of a circular casing.
    unrestricted: Vec<f64>,
    /// Clearances c_k, padded with +∞.
    clearance: Vec<f64>,
    tolerance: f64,
    /// Largest penetration that may be left where W is singular.
    most_left: f64,
    step_s: f64,
    /// Normal displacements of the integrated modes, `[Fourier column][node]`.
    harmonic: Vec<f64>,
    /// Upper bounds of nᵀu in any sector.
    amplitude_sums: Vec<f64>,
    /// Predicted gaps: exact for near sectors, lower bounds for far ones.
    predicted_gap: Vec<f64>,
    /// Whether a sector is far: no displacement that the wheel has anywhere would bring it to the casing.
    is_far: Vec<bool>,
    /// Sectors that are not far.
    near: Vec<usize>,
    /// Contact nodes with a force on any sector.
    loaded: Vec<usize>,
    is_loaded: Vec<bool>,
    /// Forces along the directions of [`Surroundings::applied`], `[Fourier column][row]`.
    pub(super) force: Vec<f64>,
    /// Number of rows of a node in `force`, and of numbers in a column.
    force_rows: usize,
    force_stride: usize,
    pub(super) tally: ContactTally,
}

/// Casing as the gaps of one step see it.
#[derive(Clone, Copy)]
struct Wall<'a> {
    /// Number of the step in the revolution.
    step: usize,
    /// Growth of the restriction.
    growth: f64,
    /// Shift of all gaps.
    shift: Option<&'a [f64]>,
}

impl Obstacle {
    pub(super) fn new(
        simulation: &Simulation<'_>,
        casing: &Casing,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        surroundings: Option<&Surroundings>,
    ) -> Self {
        let (wheel, scheme, nodes) = (simulation.wheel, simulation.scheme, simulation.contact_nodes);
        let normals = outward_normals(nodes);
        let rows = Rows::new(wheel, &normals, |modes| scheme.integrated_modes(modes));
        let (stride, sectors) = (rows.stride, fourier.sectors());
        let angles: Vec<_> = nodes.iter().map(|node| node.position[1]).collect();
        let restriction = casing.restriction.as_ref().map(|restriction| {
            let profile = |angle, node| restriction.height(angle, node);
            let around = wheel.around();
            RestrictionTable::new(profile, &angles, simulation.steps_per_revolution, around, stride)
        });
        let mut clearance = casing.clearance.clone();
        clearance.resize(stride, f64::INFINITY);
        let delassus = delassus(simulation, oscillators, fourier, stride, surroundings);
        let size = sectors * stride;
        let force_stride = applied(&rows, surroundings).stride;
        let Effects { coating, orbit, clearance_change, clearance_drift, .. } = simulation.effects;
        let length = casing.length_scale(simulation.reach())
            + coating.map_or(0.0, Coating::thickness)
            + orbit.map_or(0.0, |orbit| orbit.radius)
            + clearance_change.map_or(0.0, ClearanceChange::largest)
            + clearance_drift.map_or(0.0, ClearanceDrift::largest);
        Self {
            delassus,
            solver: ActiveSetSolver::new(size),
            residual: ResidualDisplacement::new(simulation, &normals),
            restriction,
            unrestricted: vec![0.0; stride],
            clearance,
            // Gaps are differences of lengths of this scale. A casing far out of reach of some node must not loosen it.
            tolerance: 1e-14 * length,
            most_left: LEFT * if length > 0.0 { length } else { simulation.reach() },
            ramp_revolutions: casing.ramp_revolutions,
            step_s: simulation.step_s(),
            harmonic: vec![0.0; size],
            amplitude_sums: vec![0.0; stride],
            predicted_gap: vec![0.0; size],
            is_far: vec![false; sectors],
            near: (0..sectors).collect(),
            loaded: Vec::with_capacity(force_stride),
            is_loaded: vec![false; force_stride],
            force: vec![0.0; sectors * force_stride],
            force_rows: surroundings.map_or(1, Surroundings::directions),
            force_stride,
            tally: ContactTally::new(simulation),
            rows,
        }
    }

    /// Forces of the last solution.
    #[inline(always)]
    pub(super) fn loads<'a>(&'a self, surroundings: Option<&'a Surroundings>) -> Loads<'a> {
        Loads { rows: applied(&self.rows, surroundings), loaded: &self.loaded, force: &self.force }
    }

    /// Forces of the last solution, and the normal displacements to be read.
    #[inline(always)]
    pub(super) fn loads_and_reading<'a>(
        &'a mut self,
        surroundings: Option<&'a Surroundings>,
    ) -> (Loads<'a>, Readout<'a>) {
        let Self { rows, harmonic, loaded, force, .. } = self;
        (Loads { rows: applied(rows, surroundings), loaded, force }, Readout { rows, out: harmonic })
    }

    /// Predicts the gaps g_p = c − p − nᵀu of all sectors. Returns the smallest if it is negative, otherwise a number that is not.
    ///
    /// A far sector, where c − p is not below the upper bound of nᵀu in any sector, gets c − p less that bound.
    #[inline(always)]
    pub(super) fn predict_gaps<S: Simd>(
        &mut self,
        simd: S,
        fourier: &SectorFourier,
        now: Instant,
        surroundings: Option<&mut Surroundings>,
    ) -> f64 {
        let growth = ramp(now.revolutions, self.ramp_revolutions);
        let shift = match surroundings {
            Some(surroundings) => {
                surroundings.move_to(now.revolutions, growth);
                surroundings.shift.as_deref()
            }
            None => None,
        };
        let wall = Wall { step: now.step, growth, shift };
        if fourier.sectors() > ALL_TRANSFORMED {
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
    fn least_gaps<S: Simd>(&mut self, simd: S, wall: Wall<'_>, sector: usize) -> f64 {
        let Wall { step, growth, shift } = wall;
        let Self { rows, restriction, unrestricted, clearance, amplitude_sums, predicted_gap, .. } = self;
        let stride = rows.stride;
        let vectors = stride / S::F64_LANES;
        let range = sector * stride..(sector + 1) * stride;
        let gap = &mut S::as_mut_simd_f64s(&mut predicted_gap[range]).0[..vectors];
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
    fn near_gaps<S: Simd>(&mut self, simd: S, fourier: &SectorFourier, wall: Wall<'_>) -> f64 {
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
        wall: Wall<'_>,
        sectors: [usize; R],
    ) -> S::f64s {
        let Wall { step, growth, shift } = wall;
        let Self { rows, restriction, unrestricted, clearance, harmonic, predicted_gap, .. } = self;
        let vectors = rows.stride / S::F64_LANES;
        let gap = S::as_mut_simd_f64s(predicted_gap).0;
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
                smallest = simd.min_f64s(smallest, gap[at]);
            }
        }
        smallest
    }

    /// Transforms the gaps of far sectors, too.
    #[inline(never)]
    fn complete_gaps(&mut self, fourier: &SectorFourier, now: Instant, shift: Option<&[f64]>) {
        let growth = ramp(now.revolutions, self.ramp_revolutions);
        let wall = Wall { step: now.step, growth, shift };
        for sector in 0..fourier.sectors() {
            if std::mem::take(&mut self.is_far[sector]) {
                // Rare: not worth a second copy for the widest vectors.
                self.gaps_of(pulp::Scalar, fourier, wall, [sector]);
            }
        }
        self.near.clear();
        self.near.extend(0..fourier.sectors());
    }

    /// Whether a solution is not one of the true gaps: forces act in a far sector, or seem to close it.
    fn reaches_far(&self, active: &[usize], gap: &[f64]) -> bool {
        active.iter().any(|&index| self.is_far[self.delassus.place(index).0])
            || gap
                .chunks_exact(self.rows.stride)
                .zip(&self.is_far)
                .any(|(gap, far)| *far && any_below(gap, 0.0))
    }

    /// Solves for the contact forces of the predicted gaps (Eqs 9, 10) and adds to the statistics.
    ///
    /// Where all forces are in near sectors and all far ones remain open, the true gaps of the far sectors, which are larger, have the same
    /// solution; it is the only one where W is a P-matrix. Otherwise all gaps are transformed and solved for. `read` gives the swing of
    /// rows in the step without forces.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        fourier: &SectorFourier,
        now: Instant,
        surroundings: Option<&mut Surroundings>,
        read: impl Fn(&Rows, &mut [f64]),
        statistics: &mut RunStatistics,
        work: &mut EffectWork,
    ) -> Result<(), ComplementarityError> {
        let (law, sliding, mut casing, shift) = match surroundings {
            Some(s) => (&mut s.law, s.sliding.as_ref(), s.casing.as_mut(), s.shift.as_deref()),
            None => (&mut Law::Plain, None, None, None),
        };
        loop {
            let (w, gap) = (&self.delassus, self.predicted_gap.as_slice());
            let solved = law.solve(&mut self.solver, w, gap, self.tolerance, now.step, &read);
            let Solution { active, gap, .. } = law.solution(&self.solver);
            if self.near.len() == fourier.sectors() || (solved.is_ok() && !self.reaches_far(active, gap)) {
                solved?;
                break;
            }
            self.complete_gaps(fourier, now, shift);
        }
        law.wear(&self.delassus, now.step);
        let allowed = law.depth();
        let Solution { active, lambda, gap, pivots } = law.solution(&self.solver);
        let deepest = (-lowest(gap) - allowed).max(0.0);
        statistics.largest_penetration = statistics.largest_penetration.max(deepest);
        // A run that explodes leaves round-off of its own size; that is for the bounds to find.
        if deepest > self.most_left && deepest > LEFT * -lowest(&self.predicted_gap) {
            return Err(ComplementarityError::Infeasible { penetration: deepest });
        }
        statistics.pivots = pivots;
        let disc = law.disc();
        let mut impulse = 0.0;
        for (number, (&index, lambda)) in active.iter().zip(lambda).enumerate() {
            let (sector, row) = self.delassus.place(index);
            let forces = match disc {
                Some(disc) => disc.forces()[number].as_slice(),
                None => std::slice::from_ref(lambda),
            };
            for (direction, force) in forces.iter().enumerate() {
                let row = self.force_rows * row + direction;
                if !self.is_loaded[row] {
                    self.is_loaded[row] = true;
                    self.loaded.push(row);
                }
                for (column, &f) in fourier.row(sector).iter().enumerate() {
                    self.force[column * self.force_stride + row] -= f * force;
                }
            }
            let lambda = *lambda;
            if let Some(sliding) = sliding {
                work.friction_heat += sliding.heat[row] * lambda;
            }
            if let Some(casing) = &mut casing {
                casing.press(index, lambda);
            }
            // The step that ends with this solution is counted after it.
            self.tally.press(sector, row, lambda, statistics.steps + 1);
            impulse += lambda * self.step_s;
            let smallest = statistics.smallest_multiplier.map_or(lambda, |least| least.min(lambda));
            statistics.smallest_multiplier = Some(smallest);
        }
        if let Some(disc) = disc {
            disc.count(statistics, work);
        }
        if impulse > 0.0 {
            statistics.contact_steps += 1;
            statistics.contact_impulse += impulse;
        }
        Ok(())
    }

    /// Predicts the gaps of a state that no step led to; returns whether all are open.
    #[inline(always)]
    pub(super) fn look<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        now: Instant,
        surroundings: Option<&mut Surroundings>,
    ) -> bool {
        self.clear_forces(fourier);
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        self.predict_gaps(simd, fourier, now, surroundings) >= 0.0
    }

    /// Adds to `trace` the nodes that the last solution has in contact at the end of `step`; for a rigid casing without coating.
    pub(super) fn trace(&self, step: usize, surroundings: Option<&mut Surroundings>, trace: &mut Trace) {
        let law = surroundings.map_or(&Law::Plain, |surroundings| &surroundings.law);
        let (active, symmetric) = (law.solution(&self.solver).active, !matches!(law, Law::General(_)));
        let places = active.iter().map(|&index| self.delassus.place(index));
        trace.touch(step, places, |i, j| self.delassus.entry(active[i], active[j]), symmetric);
    }

    /// Largest penetration of the state at `now`, the instant of the last gaps.
    #[inline(always)]
    pub(super) fn penetration<S: Simd>(
        &mut self,
        simd: S,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        now: Instant,
        surroundings: Option<&mut Surroundings>,
    ) -> f64 {
        oscillators.project(simd, &self.rows, &mut self.harmonic);
        self.residual.add(&self.force, self.force_stride, &mut self.harmonic, self.rows.stride);
        let allowed = surroundings.as_ref().map_or(0.0, |surroundings| surroundings.law.depth());
        (-self.predict_gaps(simd, fourier, now, surroundings) - allowed).max(0.0)
    }

    /// Ends the interval between two samples, after [`Self::penetration`].
    #[inline(always)]
    pub(super) fn end_interval(&mut self, fourier: &SectorFourier, seen: Option<&mut ContactInterval>) {
        let Self { tally, harmonic, rows, .. } = self;
        let columns = harmonic.chunks_exact(rows.stride);
        let outward = |sector: usize, node: usize| {
            fourier.row(sector).iter().zip(columns.clone()).map(|(f, column)| f * column[node]).sum()
        };
        tally.sample(outward, seen);
    }

    /// Clears the forces, until the next solution.
    #[inline(always)]
    pub(super) fn clear_forces(&mut self, fourier: &SectorFourier) {
        for &row in &self.loaded {
            self.is_loaded[row] = false;
            for column in 0..fourier.sectors() {
                self.force[column * self.force_stride + row] = 0.0;
            }
        }
        self.loaded.clear();
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

/// Rows along which contact forces act, where the normals are `rows`.
#[inline(always)]
fn applied<'a>(rows: &'a Rows, surroundings: Option<&'a Surroundings>) -> &'a Rows {
    match surroundings {
        Some(surroundings) => surroundings.applied(rows),
        None => rows,
    }
}

/// Contact operator W of the scheme, with the contributions of the effects.
fn delassus(
    simulation: &Simulation<'_>,
    oscillators: &Oscillators,
    fourier: &SectorFourier,
    stride: usize,
    surroundings: Option<&Surroundings>,
) -> Delassus {
    let normals = outward_normals(simulation.contact_nodes);
    let symmetric = symmetric_flexibility(simulation, oscillators, &normals, &normals);
    let ridge = ridge(&symmetric, simulation.wheel.sectors);
    let slides = simulation.effects.friction.filter(|friction| friction.law == FrictionLaw::Sliding);
    let mut delassus = match slides {
        None if !simulation.wheel.turns() => Delassus::new(&symmetric, ridge, stride, fourier),
        friction => {
            let from = friction.map_or(normals.as_slice(), |friction| friction.directions);
            let blocks = step_flexibility(simulation, oscillators, &normals, from);
            Delassus::new(&blocks, ridge, stride, fourier)
        }
    };
    if let Some(casing) = surroundings.and_then(|surroundings| surroundings.casing.as_ref()) {
        delassus.add(|distance, to, from| casing.operator(distance, to, from));
    }
    delassus
}

/// Smallest of 0 and `values`, whose number is a multiple of the lanes; lane by lane, so that it vectorises.
#[inline(always)]
fn lowest(values: &[f64]) -> f64 {
    let mut lanes = [0.0f64; LANES];
    for chunk in values.chunks_exact(LANES) {
        for (low, &value) in lanes.iter_mut().zip(chunk) {
            *low = if value < *low { value } else { *low };
        }
    }
    lanes.iter().fold(0.0, |low, &value| low.min(value))
}

#[cfg(test)]
mod tests;
