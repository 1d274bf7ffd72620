//! Coulomb friction as a disc at the contact, within a step.

#[cfg(test)]
mod tests;

use super::super::contact::disc_operator::DiscTable;
use super::super::contact::flexibility::{outward_normals, ridge};
use super::super::direction::Direction;
use super::super::effects::{Friction, FrictionLaw};
use super::super::energy::EffectWork;
use super::super::flexible_casing::CasingMotion;
use super::super::oscillators::Oscillators;
use super::super::oscillators::rows::Rows;
use super::super::schemes::Scheme;
use super::super::statistics::RunStatistics;
use super::simulation::Simulation;
use super::step_flexibility::{step_flexibility, symmetric_flexibility};
use rubmap_numerics::complementarity::ComplementarityError;
use rubmap_numerics::complementarity::disc::{DiscSolver, Forces};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Number of directions of a contact node: n, t, n × t.
pub(super) const DIRECTIONS: usize = 3;

#[derive(Debug)]
pub(super) struct Disc {
    coefficient: f64,
    /// Directions of all nodes, along which forces act.
    pub(super) rows: Rows,
    operator: DiscTable,
    pub(super) solver: DiscSolver,
    /// Contact planes of the nodes.
    planes: Vec<Plane>,
    fourier: SectorFourier,
    stride: usize,
}

/// Sliding of one contact node.
#[derive(Debug)]
struct Plane {
    rows: Rows,
    /// Swing z⁺ − z⁻ along the two directions of the plane, `[Fourier column][direction]`, of the step that was read.
    swing: Vec<f64>,
    is_read: bool,
    /// Part 2h rΩ e_θ·t of the rotation in the sliding.
    forward: f64,
}

impl Disc {
    /// Prepares friction as a disc; none under another law of friction.
    ///
    /// # Panics
    /// With a coating, or a boundary without mass.
    pub(super) fn new(
        simulation: &Simulation<'_>,
        friction: Friction<'_>,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
        casing: Option<&CasingMotion>,
        stride: usize,
    ) -> Option<Self> {
        let Friction { coefficient, law: FrictionLaw::Disc, directions } = friction else { return None };
        let Simulation { wheel, contact_nodes, scheme, .. } = *simulation;
        assert!(simulation.effects.coating.is_none() && !matches!(scheme, Scheme::MasslessBoundary { .. }));
        let rows =
            |directions: &[Direction]| Rows::new(wheel, directions, |modes| scheme.integrated_modes(modes));
        let flexible = |directions: &[Direction]| {
            ridge(&symmetric_flexibility(simulation, oscillators, directions, directions), wheel.sectors)
        };
        // Nodes that can be told apart along their normals keep the forces that they have without friction.
        let ridges = [flexible(&outward_normals(contact_nodes)), flexible(directions)];
        let blocks = step_flexibility(simulation, oscillators, directions, directions);
        let mut operator = DiscTable::new(&blocks, ridges, stride, fourier);
        if let Some(casing) = casing {
            operator.add(|distance, to, from| casing.operator(distance, to, from));
        }
        let planes = directions.chunks_exact(DIRECTIONS).zip(contact_nodes).map(|(directions, node)| {
            let rows = rows(&directions[1..]);
            let speed = wheel.speed_rad_s * node.position[0] * directions[1].components[1];
            Plane {
                swing: vec![0.0; wheel.sectors * rows.stride],
                rows,
                is_read: false,
                forward: 2.0 * simulation.step_s() * speed,
            }
        });
        Some(Self {
            coefficient,
            planes: planes.collect(),
            rows: rows(directions),
            operator,
            solver: DiscSolver::new(wheel.sectors * stride),
            fourier: fourier.clone(),
            stride,
        })
    }

    /// Solves for the forces of `gap`, the gaps without them, within a tolerance; `read` gives z⁺ − z⁻ of rows in Fourier coordinates,
    /// without forces, and is asked for the nodes that may touch.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        gap: &[f64],
        tolerance: f64,
        read: impl Fn(&Rows, &mut [f64]),
    ) -> Result<(), ComplementarityError> {
        let Self { coefficient, operator, solver, planes, fourier, stride, .. } = self;
        planes.iter_mut().for_each(|plane| plane.is_read = false);
        let free = |index: usize| {
            let (sector, node) = (index / *stride, index % *stride);
            let plane = &mut planes[node];
            if !plane.is_read {
                read(&plane.rows, &mut plane.swing);
                plane.is_read = true;
            }
            let mut sliding = [plane.forward, 0.0];
            for (f, column) in fourier.row(sector).iter().zip(plane.swing.chunks_exact(plane.rows.stride)) {
                sliding[0] += f * column[0];
                sliding[1] += f * column[1];
            }
            sliding
        };
        solver.solve(operator, *coefficient, gap, free, tolerance)
    }

    /// Forces λ and friction along the two directions of the plane, of every place that is pressed.
    pub(super) fn forces(&self) -> &[Forces] {
        self.solver.forces()
    }

    /// Adds the heat of the last step, and the numbers of nodes that stuck and slid.
    pub(super) fn count(&self, statistics: &mut RunStatistics, work: &mut EffectWork) {
        let pressed = self.solver.forces().iter().zip(self.solver.sliding());
        for ([_, along, across], [forward, aside]) in pressed {
            work.friction_heat += 0.5 * (along * forward + across * aside);
        }
        let sticking = self.solver.sticks().iter().filter(|&&sticks| sticks).count() as u64;
        statistics.sticking += sticking;
        statistics.sliding += self.solver.sticks().len() as u64 - sticking;
    }
}
