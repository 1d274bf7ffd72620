//! Contact between the blades and the casing, within a step.

use pulp::Simd;

use super::super::bending::{Bending, MOST_COORDINATES};
use super::super::casing::Casing;
use super::super::clearance_change::ClearanceChange;
use super::super::clearance_drift::ClearanceDrift;
use super::super::contact::coating::{Coating, WornCoating};
use super::super::contact::delassus::Delassus;
use super::super::contact::flexibility::{outward_normals, ridge};
use super::super::direction::Direction;
use super::super::effects::{Effects, Friction};
use super::super::energy::EffectWork;
use super::super::flexible_casing::CasingMotion;
use super::super::oscillators::Oscillators;
use super::super::oscillators::lanes::LANES;
use super::super::oscillators::rows::{Loads, Readout, Rows};
use super::super::statistics::RunStatistics;
use super::disc::DIRECTIONS;
use super::gaps::Gaps;
use super::instant::Instant;
use super::law::{Law, Solution};
use super::residual::ResidualDisplacement;
use super::simulation::Simulation;
use super::step_flexibility::{step_flexibility, symmetric_flexibility};
use super::tally::{ContactInterval, ContactTally};
use super::trace::Trace;
use rubmap_numerics::complementarity::{ComplementarityError, ContactOperator};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Largest penetration that the ridge of a singular W may leave, relative to clearance and restriction. Nodes that W cannot tell apart but
/// that agree keep to a thousandth of it; where they contradict each other no forces help.
const LEFT: f64 = 1e-6;

/// Contact of all tips with the casing, to which the effects of a scene give its law, the shift of its gaps and the directions of its forces.
#[derive(Debug)]
pub(super) struct Contact {
    /// Normals of the contact nodes.
    rows: Rows,
    pub(super) gaps: Gaps,
    law: Law,
    /// Friction of tips that slide forwards.
    sliding: Option<Sliding>,
    delassus: Delassus,
    residual: ResidualDisplacement,
    tolerance: f64,
    /// Largest penetration that may be left where W is singular.
    most_left: f64,
    step_s: f64,
    /// Contact nodes with a force on any sector.
    loaded: Vec<usize>,
    is_loaded: Vec<bool>,
    /// Forces along the directions of [`applied`], `[Fourier column][row]`.
    pub(super) force: Vec<f64>,
    /// Number of rows of a node in `force`, and of numbers in a column.
    force_rows: usize,
    force_stride: usize,
    pub(super) tally: ContactTally,
}

/// Friction of tips that slide forwards, at the contact nodes.
#[derive(Debug)]
struct Sliding {
    /// Directions n + μt, along which forces act.
    rows: Rows,
    /// Heat per unit of λ in a step, μ t_θ rΩ h of every node.
    heat: Vec<f64>,
}

impl Contact {
    pub(super) fn new(
        simulation: &Simulation<'_>,
        casing: &Casing,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
    ) -> Self {
        let Simulation { wheel, scheme, effects, .. } = *simulation;
        let normals = read(simulation);
        let rows = Rows::new(wheel, &normals, |modes| scheme.integrated_modes(modes));
        let (stride, sectors) = (rows.stride, fourier.sectors());
        let gaps = Gaps::new(simulation, casing, stride);
        let elastic = gaps.shift.as_ref().and_then(|shift| shift.casing.as_ref());
        let law = Law::new(simulation, oscillators, fourier, elastic, stride);
        let delassus = delassus(simulation, oscillators, fourier, &gaps);
        let sliding = effects.sliding().map(|friction| Sliding::new(simulation, friction));
        let force_stride = applied(&rows, sliding.as_ref(), &law).stride;
        let Effects { coating, orbit, clearance_change, clearance_drift, .. } = effects;
        let length = casing.length_scale(simulation.reach())
            + coating.map_or(0.0, Coating::thickness)
            + orbit.map_or(0.0, |orbit| orbit.radius)
            + clearance_change.map_or(0.0, ClearanceChange::largest)
            + clearance_drift.map_or(0.0, ClearanceDrift::largest);
        Self {
            delassus,
            residual: ResidualDisplacement::new(simulation, &normals),
            // Gaps are differences of lengths of this scale. A casing far out of reach of some node must not loosen it.
            tolerance: 1e-14 * length,
            most_left: LEFT * if length > 0.0 { length } else { simulation.reach() },
            step_s: simulation.step_s(),
            loaded: Vec::with_capacity(force_stride),
            is_loaded: vec![false; force_stride],
            force: vec![0.0; sectors * force_stride],
            force_rows: if law.disc().is_some() { DIRECTIONS } else { 1 },
            force_stride,
            tally: ContactTally::new(simulation),
            rows,
            gaps,
            law,
            sliding,
        }
    }

    /// Whether effects change contact with a rigid casing that stays where it is.
    pub(super) fn is_affected(&self) -> bool {
        self.gaps.shift.is_some()
            || self.gaps.second_order.is_some()
            || !matches!(self.law, Law::Symmetric(_))
    }

    /// Coating as it is now, if there is one.
    pub(super) fn coating(&self) -> Option<&WornCoating> {
        self.law.coating()
    }

    /// Elastic casing, if there is one.
    pub(super) fn casing(&self) -> Option<&CasingMotion> {
        self.gaps.shift.as_ref()?.casing.as_ref()
    }

    pub(super) fn casing_mut(&mut self) -> Option<&mut CasingMotion> {
        self.gaps.shift.as_mut()?.casing.as_mut()
    }

    /// Forces of the last solution.
    #[inline(always)]
    pub(super) fn loads(&self) -> Loads<'_> {
        let Self { rows, sliding, law, loaded, force, .. } = self;
        Loads { rows: applied(rows, sliding.as_ref(), law), loaded, force }
    }

    /// Forces of the last solution, and the normal displacements to be read.
    #[inline(always)]
    pub(super) fn loads_and_reading(&mut self) -> (Loads<'_>, Readout<'_>) {
        let Self { rows, gaps, sliding, law, loaded, force, .. } = self;
        let loads = Loads { rows: applied(rows, sliding.as_ref(), law), loaded, force };
        (loads, Readout { rows, out: &mut gaps.harmonic })
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
        read: impl Fn(&Rows, &mut [f64]),
        statistics: &mut RunStatistics,
        work: &mut EffectWork,
    ) -> Result<(), ComplementarityError> {
        let Self { law, gaps, delassus, .. } = self;
        if gaps.second_order.is_some() {
            delassus.bend(&gaps.linear);
            law.operator_changed();
        }
        loop {
            let solved = law.solve(delassus, &gaps.predicted, self.tolerance, now.step, &read);
            let Solution { active, gap, .. } = law.solution();
            let pressed = active.iter().map(|&index| delassus.place(index).0);
            if !gaps.has_far() || (solved.is_ok() && !gaps.reach_far(pressed, gap)) {
                solved?;
                break;
            }
            gaps.complete(fourier, now);
        }
        law.wear(delassus, now.step);
        let allowed = law.depth();
        let Solution { active, lambda, gap, pivots } = law.solution();
        let deepest = (-lowest(gap) - allowed).max(0.0);
        statistics.largest_penetration = statistics.largest_penetration.max(deepest);
        // A run that explodes leaves round-off of its own size; that is for the bounds to find.
        if deepest > self.most_left && deepest > LEFT * -lowest(&gaps.predicted) {
            return Err(ComplementarityError::Infeasible { penetration: deepest });
        }
        statistics.pivots = pivots;
        let disc = law.disc();
        let mut casing = gaps.shift.as_mut().and_then(|shift| shift.casing.as_mut());
        let mut pushed = [0.0; MOST_COORDINATES];
        let mut impulse = 0.0;
        for (number, (&index, lambda)) in active.iter().zip(lambda).enumerate() {
            let (sector, row) = delassus.place(index);
            let forces = match disc {
                Some(disc) => disc.forces()[number].as_slice(),
                None => std::slice::from_ref(lambda),
            };
            let mut press = |row: usize, force: f64| {
                if !self.is_loaded[row] {
                    self.is_loaded[row] = true;
                    self.loaded.push(row);
                }
                for (column, &f) in fourier.row(sector).iter().enumerate() {
                    self.force[column * self.force_stride + row] -= f * force;
                }
            };
            for (direction, &force) in forces.iter().enumerate() {
                press(self.force_rows * row + direction, force);
            }
            let lambda = *lambda;
            if let Some(slopes) = delassus.slopes() {
                for (pushed, slope) in pushed.iter_mut().zip(slopes.of(sector, row)) {
                    *pushed += slope * lambda;
                }
                // Forces of one sector push the same coordinates.
                if active.get(number + 1).is_none_or(|&next| delassus.place(next).0 != sector) {
                    for (coordinate, force) in pushed[..slopes.coordinates()].iter_mut().enumerate() {
                        press(delassus.contact_nodes() + coordinate, std::mem::take(force));
                    }
                }
            }
            if let Some(sliding) = &self.sliding {
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
    ) -> bool {
        self.clear_forces(fourier);
        oscillators.project(simd, &self.rows, &mut self.gaps.harmonic);
        self.gaps.predict(simd, fourier, now) >= 0.0
    }

    /// Adds to `trace` the nodes that the last solution has in contact at the end of `step`; for a rigid casing without coating.
    pub(super) fn trace(&self, step: usize, trace: &mut Trace) {
        let (active, symmetric) = (self.law.solution().active, !matches!(self.law, Law::General(_)));
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
    ) -> f64 {
        oscillators.project(simd, &self.rows, &mut self.gaps.harmonic);
        self.residual.add(&self.force, self.force_stride, &mut self.gaps.harmonic, self.rows.stride);
        (-self.gaps.predict(simd, fourier, now) - self.law.depth()).max(0.0)
    }

    /// Ends the interval between two samples, after [`Self::penetration`].
    #[inline(always)]
    pub(super) fn end_interval(&mut self, fourier: &SectorFourier, seen: Option<&mut ContactInterval>) {
        let Self { tally, gaps, rows, .. } = self;
        if let Some(second_order) = &mut gaps.second_order {
            second_order.add(fourier, &mut gaps.harmonic);
        }
        let columns = gaps.harmonic.chunks_exact(rows.stride);
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

impl Sliding {
    fn new(simulation: &Simulation<'_>, friction: Friction<'_>) -> Self {
        let Simulation { wheel, scheme, contact_nodes, .. } = *simulation;
        let heat = contact_nodes.iter().zip(friction.directions).map(|(node, direction)| {
            let forward = direction.components[1] - node.normal[1];
            forward * node.position[0] * wheel.speed_rad_s * simulation.step_s()
        });
        let rows = Rows::new(wheel, friction.directions, |modes| scheme.integrated_modes(modes));
        Self { rows, heat: heat.collect() }
    }
}

/// Rows along which contact forces act: the normals, `rows`, unless there is friction.
#[inline(always)]
fn applied<'a>(rows: &'a Rows, sliding: Option<&'a Sliding>, law: &'a Law) -> &'a Rows {
    match (sliding, law.disc()) {
        (Some(sliding), _) => &sliding.rows,
        (None, Some(disc)) => &disc.rows,
        (None, None) => rows,
    }
}

/// Directions that contact reads: the normals, and behind them the coordinates of blades that bend far.
fn read(simulation: &Simulation<'_>) -> Vec<Direction> {
    let mut directions = outward_normals(simulation.contact_nodes);
    directions.extend(simulation.effects.bending.iter().flat_map(Bending::directions));
    directions
}

/// Contact operator W of the scheme, with the contributions of the effects.
fn delassus(
    simulation: &Simulation<'_>,
    oscillators: &Oscillators,
    fourier: &SectorFourier,
    gaps: &Gaps,
) -> Delassus {
    let directions = read(simulation);
    let symmetric = symmetric_flexibility(simulation, oscillators, &directions, &directions);
    // Only normals may be indistinguishable: coordinates are never solved for.
    let nodes = simulation.contact_nodes.len();
    let of_normals: Vec<_> =
        symmetric.iter().map(|block| block.submatrix(0, 0, nodes, nodes).to_owned()).collect();
    let ridge = ridge(&of_normals, simulation.wheel.sectors);
    let slopes = gaps.second_order.as_ref().map(|second_order| second_order.slopes(fourier.sectors()));
    let mut delassus = match simulation.effects.sliding() {
        None if !simulation.wheel.turns() => Delassus::new(&symmetric, ridge, gaps.stride, slopes, fourier),
        friction => {
            let from = friction.map_or(directions.as_slice(), |friction| friction.directions);
            let blocks = step_flexibility(simulation, oscillators, &directions, from);
            Delassus::new(&blocks, ridge, gaps.stride, slopes, fourier)
        }
    };
    let casing = gaps.shift.as_ref().and_then(|shift| shift.casing.as_ref());
    if let Some(casing) = casing {
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
