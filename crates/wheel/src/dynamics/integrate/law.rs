//! Laws of contact between tips and casing, each with its solver.

use super::super::contact::coating::WornCoating;
use super::super::contact::delassus::Delassus;
use super::super::flexible_casing::CasingMotion;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::disc::Disc;
use super::simulation::Simulation;
use rubmap_numerics::complementarity::ComplementarityError;
use rubmap_numerics::complementarity::active_set::{ActiveSetSolver, PivotStatistics};
use rubmap_numerics::complementarity::branches::BranchSolver;
use rubmap_numerics::complementarity::disc::DiscSolver;
use rubmap_numerics::complementarity::factor::{Cholesky, Factor, Lu};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Law of contact between tips and casing.
#[derive(Debug)]
pub(super) enum Law {
    /// Rigid wall, on a symmetric operator.
    Symmetric(ActiveSetSolver),
    /// Rigid wall, on an operator that is not symmetric.
    General(ActiveSetSolver<Lu>),
    /// Coating with metal behind it.
    Coated(CoatedSolver, Box<WornCoating>),
    /// Rigid wall on which tips stick or slide.
    Disc(Box<Disc>),
}

/// Solver for a coating, on a symmetric operator or on any.
#[derive(Debug)]
pub(super) enum CoatedSolver {
    Symmetric(Box<BranchSolver<Cholesky>>),
    General(Box<BranchSolver<Lu>>),
}

/// Forces that a [`Law`] found.
pub(super) struct Solution<'a> {
    /// Indices with a force.
    pub(super) active: &'a [usize],
    /// Forces of the active indices.
    pub(super) lambda: &'a [f64],
    /// Gaps under these forces, or without them where they reach nothing.
    pub(super) gap: &'a [f64],
    /// Work of all solutions so far.
    pub(super) pivots: PivotStatistics,
}

impl Law {
    /// Law of the scene. `stride` is the number of contact nodes of a sector, padded to whole vectors; `casing` the elastic casing, if there is
    /// one.
    pub(super) fn new(
        simulation: &Simulation<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        casing: Option<&CasingMotion>,
        stride: usize,
    ) -> Self {
        let Simulation { wheel, effects, contact_nodes, .. } = *simulation;
        let size = wheel.sectors * stride;
        let is_symmetric = effects.sliding().is_none() && !wheel.turns();
        if let Some(coating) = effects.coating {
            let solver = match is_symmetric {
                true => CoatedSolver::Symmetric(Box::new(BranchSolver::new(size))),
                false => CoatedSolver::General(Box::new(BranchSolver::new(size))),
            };
            let steps = simulation.steps_per_revolution;
            let worn = WornCoating::new(coating.clone(), contact_nodes, wheel.sectors, steps);
            return Self::Coated(solver, Box::new(worn));
        }
        let disc = effects
            .friction
            .and_then(|friction| Disc::new(simulation, friction, oscillators, fourier, casing, stride));
        match disc {
            Some(disc) => Self::Disc(Box::new(disc)),
            None if is_symmetric => Self::Symmetric(ActiveSetSolver::new(size)),
            None => Self::General(ActiveSetSolver::new(size)),
        }
    }

    /// Coating as it is now, if there is one.
    pub(super) fn coating(&self) -> Option<&WornCoating> {
        match self {
            Self::Coated(_, coating) => Some(coating),
            Self::Symmetric(_) | Self::General(_) | Self::Disc(_) => None,
        }
    }

    /// Solves for the forces of a contact operator, gaps without them and a tolerance. `read` gives the swing of rows in the step, for
    /// friction that asks.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        w: &Delassus,
        gap: &[f64],
        tolerance: f64,
        step: usize,
        read: impl Fn(&Rows, &mut [f64]),
    ) -> Result<(), ComplementarityError> {
        match self {
            Self::Symmetric(solver) => solver.solve(w, gap, tolerance),
            Self::General(solver) => solver.solve(w, gap, tolerance),
            Self::Coated(solver, coating) => {
                let law = |index: usize| {
                    let (sector, row) = w.place(index);
                    coating.law(coating.rod(step, sector, row), row)
                };
                match solver {
                    CoatedSolver::Symmetric(solver) => solver.solve(w, law, gap, tolerance),
                    CoatedSolver::General(solver) => solver.solve(w, law, gap, tolerance),
                }
            }
            Self::Disc(disc) => disc.solve(gap, tolerance, read),
        }
    }

    /// Takes note that the contact operator has changed since the last solution.
    #[inline(always)]
    pub(super) fn operator_changed(&mut self) {
        match self {
            Self::Symmetric(solver) => solver.operator_changed(),
            Self::General(solver) => solver.operator_changed(),
            Self::Coated(CoatedSolver::Symmetric(solver), _) => solver.operator_changed(),
            Self::Coated(CoatedSolver::General(solver), _) => solver.operator_changed(),
            // Blades that bend far, which change it, have no friction.
            Self::Disc(_) => {}
        }
    }

    /// Solution that was found last.
    #[inline(always)]
    pub(super) fn solution(&self) -> Solution<'_> {
        match self {
            Self::Symmetric(solver) => Solution::of(solver),
            Self::General(solver) => Solution::of(solver),
            Self::Coated(solver, _) => solver.solution(),
            Self::Disc(disc) => Solution::of_disc(&disc.solver),
        }
    }

    /// Disc of friction, if the law is one.
    #[inline(always)]
    pub(super) fn disc(&self) -> Option<&Disc> {
        match self {
            Self::Disc(disc) => Some(disc),
            Self::Symmetric(_) | Self::General(_) | Self::Coated(..) => None,
        }
    }

    /// Wears the coating by the forces found last.
    #[inline(always)]
    pub(super) fn wear(&mut self, w: &Delassus, step: usize) {
        let Self::Coated(solver, coating) = self else { return };
        let Solution { active, gap, .. } = solver.solution();
        for &index in active {
            let (sector, row) = w.place(index);
            coating.press(coating.rod(step, sector, row), row, -gap[index]);
        }
    }

    /// Largest depth of a tip within what it touches.
    pub(super) fn depth(&self) -> f64 {
        match self {
            Self::Coated(_, coating) => coating.unworn().thickness(),
            Self::Symmetric(_) | Self::General(_) | Self::Disc(_) => 0.0,
        }
    }
}

impl CoatedSolver {
    #[inline(always)]
    fn solution(&self) -> Solution<'_> {
        match self {
            Self::Symmetric(solver) => Solution::of_branches(solver),
            Self::General(solver) => Solution::of_branches(solver),
        }
    }
}

impl<'a> Solution<'a> {
    fn of<F: Factor>(solver: &'a ActiveSetSolver<F>) -> Self {
        let pivots = solver.statistics();
        Self { active: solver.active(), lambda: solver.lambda(), gap: solver.gap(), pivots }
    }

    fn of_branches<F: Factor>(solver: &'a BranchSolver<F>) -> Self {
        let pivots = solver.statistics();
        Self { active: solver.active(), lambda: solver.lambda(), gap: solver.gap(), pivots }
    }

    fn of_disc(solver: &'a DiscSolver) -> Self {
        let pivots = solver.statistics();
        Self { active: solver.active(), lambda: solver.lambda(), gap: solver.gap(), pivots }
    }
}
