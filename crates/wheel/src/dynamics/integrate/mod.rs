//! Time integration with contact (Eqs 8–10): what a run is given and what it returns. The loop is in `stepper`.

mod bounds;
#[cfg(test)]
mod digests;
mod obstacle;
mod recorder;
mod residual;
mod stepper;
mod surroundings;

use std::f64::consts::TAU;

use pulp::{Simd, WithSimd};

pub use self::bounds::{TipComponent, TipDisplacement};
use self::stepper::Stepper;
use super::casing::Casing;
#[cfg(test)]
use super::casing::RestrictionTable;
use super::contact::coating::WornCoating;
use super::effects::Effects;
use super::energy::EnergyAudit;
use super::initial::InitialMode;
use super::modal_wheel::ModalWheel;
use super::oscillators::{Direction, ModalDamping};
use super::schemes::Scheme;
use super::sector::ContactNode;
use super::statistics::RunStatistics;
use rubmap_numerics::complementarity::ComplementarityError;

/// One simulation of the wheel at its speed.
#[derive(Debug, Clone, Copy)]
pub struct Simulation<'a> {
    /// The wheel in modal coordinates.
    pub wheel: &'a ModalWheel,
    /// Contact nodes from leading to trailing edge.
    pub contact_nodes: &'a [ContactNode],
    /// Modal damping; absent: none.
    pub damping: Option<&'a ModalDamping>,
    /// Casing that the blades may touch; absent: none.
    pub casing: Option<&'a Casing>,
    /// Effects beyond damping and a rigid casing.
    pub effects: Effects<'a>,
    /// Modes that move at the start; empty: from rest.
    pub initial: &'a [InitialMode],
    /// Recorded displacements.
    pub sensors: &'a [SensorRow],
    /// How time is stepped.
    pub scheme: Scheme,
    /// Steps S per revolution, at least the scheme's smallest stable number.
    pub steps_per_revolution: usize,
    /// Recorded samples per revolution, a divisor of S.
    pub samples_per_revolution: usize,
    /// Revolutions to simulate.
    pub revolutions: usize,
    /// Revolutions at the end for which nodal-diameter coordinates are recorded.
    pub window_revolutions: usize,
}

/// A recorded displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorRow {
    /// Where and along what.
    pub direction: Direction,
    /// At which sector.
    pub sector: usize,
}

/// What a simulation recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// `[sensor][sample]`: displacement at the sensor's sector, over the whole run.
    pub displacement: Vec<Vec<f64>>,
    /// `[sensor][Fourier column][sample]`: coordinates of all sectors in the real orthonormal Fourier basis, over the
    /// window.
    pub harmonics: Vec<Vec<Vec<f64>>>,
    /// `[revolution][nodal diameter]`: mechanical energy at its end, if asked for.
    pub energies: Vec<Vec<f64>>,
    /// All modes at the end of the run.
    pub end: Vec<InitialMode>,
}

/// A response that left the bounds of the theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Divergence {
    /// Revolutions integrated until it was found.
    pub revolutions: f64,
    /// The tip that had moved most then; none where nothing can be touched, and numbers overflowed.
    pub tip: Option<TipDisplacement>,
    /// Mechanical energy then over that at the end of the last whole revolution; none in the first.
    pub energy_growth: Option<f64>,
}

/// How a simulation ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// All revolutions were integrated.
    Completed(History),
    /// A tip that a casing may touch moved by more than a tenth of the wheel's radius in any component, or a number
    /// overflowed. Without a casing the response is linear, and may be of any size.
    Diverged(Divergence),
    /// The contact problem of a step could not be solved.
    ContactFailed {
        /// Revolutions integrated until then.
        revolutions: f64,
        /// Why.
        error: ComplementarityError,
    },
    /// The caller asked to stop.
    Cancelled,
}

/// Outcome with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// How it ended.
    pub outcome: Outcome,
    /// What was counted.
    pub statistics: RunStatistics,
    /// The energy identity.
    pub energy: EnergyAudit,
    /// The coating at the end, if there is one.
    pub coating: Option<WornCoating>,
}

/// Displacements beyond this share of the largest contact radius end a run as diverged: linear structural theory is
/// void long before.
pub const DIVERGED_SHARE_OF_RADIUS: f64 = 0.1;

/// A restriction table larger than this many values (2 GiB) is refused.
pub const MAX_TABLE_VALUES: usize = 1 << 28;

impl Simulation<'_> {
    /// Runs the simulation. `watch` is called once all is set up, with 0, and now and then with the share of work done; `false`
    /// stops the run.
    ///
    /// # Panics
    /// If the sample count does not divide the step count, the window exceeds the run, or an initial mode is not integrated.
    pub fn run(&self, watch: &dyn Fn(f64) -> bool) -> Run {
        self.dispatch(pulp::Arch::new(), Stepper::new(self), watch)
    }

    /// Runs on vectors of a given kind.
    #[cfg(test)]
    fn run_on(&self, arch: pulp::Arch, watch: &dyn Fn(f64) -> bool) -> Run {
        self.dispatch(arch, Stepper::new(self), watch)
    }

    /// Runs against a restriction of any shape instead of the casing's lobes.
    #[cfg(test)]
    pub(super) fn run_against(&self, restriction: RestrictionTable, watch: &dyn Fn(f64) -> bool) -> Run {
        let mut stepper = Stepper::new(self);
        stepper.replace_restriction(restriction);
        self.dispatch(pulp::Arch::new(), stepper, watch)
    }

    fn dispatch(&self, arch: pulp::Arch, mut stepper: Stepper, watch: &dyn Fn(f64) -> bool) -> Run {
        assert!(self.steps_per_revolution.is_multiple_of(self.samples_per_revolution));
        assert!(self.window_revolutions <= self.revolutions);
        // Who does not want the run says so again soon.
        watch(0.0);
        arch.dispatch(Loop { simulation: self, stepper: &mut stepper, watch })
    }

    /// Displacement of a tip beyond which a run ends as diverged; without bound where all tips lie on the axis.
    fn reach(&self) -> f64 {
        let radius = self.contact_nodes.iter().fold(0.0f64, |r, node| r.max(node.position[0]));
        if radius > 0.0 { DIVERGED_SHARE_OF_RADIUS * radius } else { f64::INFINITY }
    }

    fn step_s(&self) -> f64 {
        TAU / (self.wheel.speed_rad_s * self.steps_per_revolution as f64)
    }
}

/// The loop as a value, so that the whole of it is compiled for the widest vectors of the machine.
struct Loop<'a> {
    simulation: &'a Simulation<'a>,
    stepper: &'a mut Stepper,
    watch: &'a dyn Fn(f64) -> bool,
}

impl WithSimd for Loop<'_> {
    type Output = Run;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Run {
        self.stepper.run(simd, self.simulation, self.watch)
    }
}
