//! Effects of a scene on contact.

use super::super::clearance_change::ClearanceShift;
use super::super::clearance_drift::ClearanceDrift;
use super::super::contact::coating::WornCoating;
use super::super::contact::delassus::Delassus;
use super::super::effects::FrictionLaw;
use super::super::flexible_casing::CasingMotion;
use super::super::orbit::OrbitShift;
use super::super::oscillators::Oscillators;
use super::super::oscillators::lanes::padded;
use super::super::oscillators::rows::Rows;
use super::disc::{DIRECTIONS, Disc};
use super::simulation::Simulation;
use rubmap_numerics::complementarity::ComplementarityError;
use rubmap_numerics::complementarity::active_set::{ActiveSetSolver, PivotStatistics};
use rubmap_numerics::complementarity::branches::BranchSolver;
use rubmap_numerics::complementarity::disc::DiscSolver;
use rubmap_numerics::complementarity::factor::{Cholesky, Factor, Lu};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Effects of a scene on contact; each is absent unless the scene names it.
#[derive(Debug)]
pub(super) struct Surroundings {
    pub(super) sliding: Option<Sliding>,
    pub(super) law: Law,
    pub(super) casing: Option<CasingMotion>,
    orbit: Option<OrbitShift>,
    change: Option<ClearanceShift>,
    drift: Option<ClearanceDrift>,
    /// Contact nodes of a sector, padded.
    stride: usize,
    /// Shift of the gaps, `[sector][node]`, nodes padded to whole vectors; none for a casing that stays where it is.
    pub(super) shift: Option<Vec<f64>>,
}

/// Law of contact between tips and casing.
#[derive(Debug)]
pub(super) enum Law {
    /// Rigid wall on a symmetric operator.
    Plain,
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

/// Friction of tips that slide forwards, at the contact nodes.
#[derive(Debug)]
pub(super) struct Sliding {
    /// Directions n + μt, along which forces act.
    pub(super) rows: Rows,
    /// Heat per unit of λ in a step, μ t_θ rΩ h of every node.
    pub(super) heat: Vec<f64>,
}

impl Surroundings {
    /// Effects of the scene; none for a scene without contact or without effects on it.
    pub(super) fn new(
        simulation: &Simulation<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
    ) -> Option<Self> {
        let Simulation { wheel, casing, effects, contact_nodes, scheme, .. } = *simulation;
        casing?;
        let slides = effects.friction.filter(|friction| friction.law == FrictionLaw::Sliding);
        let sliding = slides.map(|friction| Sliding {
            rows: Rows::new(wheel, friction.directions, |modes| scheme.integrated_modes(modes)),
            heat: (contact_nodes.iter().zip(friction.directions))
                .map(|(node, direction)| {
                    let forward = direction.components[1] - node.normal[1];
                    forward * node.position[0] * wheel.speed_rad_s * simulation.step_s()
                })
                .collect(),
        });
        let coriolis = wheel.turns();
        if !effects.change_contact() && !coriolis {
            return None;
        }
        let symmetric = sliding.is_none() && !coriolis;
        let moves = effects.flexible_casing.is_some()
            || effects.orbit.is_some()
            || effects.clearance_change.is_some()
            || effects.clearance_drift.is_some();
        let stride = padded(contact_nodes.len());
        let size = wheel.sectors * stride;
        let (sectors, around) = (wheel.sectors, wheel.around());
        let casing = effects.flexible_casing.map(|casing| {
            CasingMotion::new(casing, scheme, simulation.step_s(), contact_nodes, sectors, around, stride)
        });
        let disc = effects.friction.and_then(|friction| {
            Disc::new(simulation, friction, oscillators, fourier, casing.as_ref(), stride)
        });
        Some(Self {
            law: match effects.coating {
                Some(coating) => Law::Coated(
                    if symmetric {
                        CoatedSolver::Symmetric(Box::new(BranchSolver::new(size)))
                    } else {
                        CoatedSolver::General(Box::new(BranchSolver::new(size)))
                    },
                    Box::new(WornCoating::new(
                        coating.clone(),
                        contact_nodes,
                        wheel.sectors,
                        simulation.steps_per_revolution,
                    )),
                ),
                None => match disc {
                    Some(disc) => Law::Disc(Box::new(disc)),
                    None if symmetric => Law::Plain,
                    None => Law::General(ActiveSetSolver::new(size)),
                },
            },
            sliding,
            casing,
            orbit: effects.orbit.map(|orbit| OrbitShift::new(orbit, contact_nodes, sectors, around, stride)),
            change: (effects.clearance_change)
                .map(|change| ClearanceShift::new(change, contact_nodes.len(), stride)),
            drift: effects.clearance_drift.cloned(),
            stride,
            shift: moves.then(|| vec![0.0; size]),
        })
    }

    /// Rows along which contact forces act: the normals, `rows`, unless there is friction.
    #[inline(always)]
    pub(super) fn applied<'a>(&'a self, rows: &'a Rows) -> &'a Rows {
        match (&self.sliding, &self.law) {
            (Some(sliding), _) => &sliding.rows,
            (None, Law::Disc(disc)) => &disc.rows,
            (None, _) => rows,
        }
    }

    /// Number of directions of a contact force, whose rows follow each other.
    pub(super) fn directions(&self) -> usize {
        if matches!(self.law, Law::Disc(_)) { DIRECTIONS } else { 1 }
    }

    /// Coating as it is now, if there is one.
    pub(super) fn coating(&self) -> Option<&WornCoating> {
        match &self.law {
            Law::Coated(_, coating) => Some(coating),
            Law::Plain | Law::General(_) | Law::Disc(_) => None,
        }
    }

    /// Updates the shift of the gaps to `revolutions` after the start.
    pub(super) fn move_to(&mut self, revolutions: f64, growth: f64) {
        let Some(shift) = &mut self.shift else { return };
        shift.fill(0.0);
        if let Some(orbit) = &self.orbit {
            orbit.add(revolutions, growth, shift);
        }
        if let Some(change) = &self.change {
            change.add(revolutions, shift);
        }
        if let Some(drift) = &self.drift {
            drift.add(revolutions, growth, self.stride, shift);
        }
        if let Some(casing) = &mut self.casing {
            casing.add(revolutions, shift);
        }
    }
}

impl Law {
    /// Solves for the forces of a contact operator, gaps without them and a tolerance; `plain` does so where the law has no solver of its
    /// own. `read` gives the swing of rows in the step, for friction that asks.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        plain: &mut ActiveSetSolver,
        w: &Delassus,
        gap: &[f64],
        tolerance: f64,
        step: usize,
        read: impl Fn(&Rows, &mut [f64]),
    ) -> Result<(), ComplementarityError> {
        match self {
            Self::Plain => plain.solve(w, gap, tolerance),
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

    /// Solution that was found last.
    #[inline(always)]
    pub(super) fn solution<'a>(&'a self, plain: &'a ActiveSetSolver) -> Solution<'a> {
        match self {
            Self::Plain => Solution::of(plain),
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
            Self::Plain | Self::General(_) | Self::Coated(..) => None,
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

    /// Largest depth of a tip within its obstacle.
    pub(super) fn depth(&self) -> f64 {
        match self {
            Self::Coated(_, coating) => coating.unworn().thickness(),
            Self::Plain | Self::General(_) | Self::Disc(_) => 0.0,
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
