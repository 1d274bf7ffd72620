//! Scene at one speed: its wheel and its stepping, made once, and runs of them.

use std::borrow::Cow;
use std::sync::Arc;

use crate::effects::casing::convert::{casing, check_table, lasting_clearance, running_clearance};
use crate::effects::damping::convert::modal_damping;
use crate::effects::physics::Surroundings;
use crate::effects::table::{SceneEffects, check_at_speed};
use crate::end_state::{EndState, Shapes};
use crate::model::ReducedSector;
use crate::not_runnable::NotRunnable;
use crate::resolved::ResolvedSweep;
use crate::sensed::sensed;
use crate::start::{initial, perturbed};
use crate::steady::{Simulated, repeats, run_steady};
use crate::stepping::{Stepping, touching};
use crate::wheel::wheel_of;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::integrate::{Detail, Revolutions, Simulation};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;

/// Scene at one speed.
pub(crate) struct SpeedScene<'a> {
    pub(crate) sector: &'a ReducedSector,
    pub(crate) request: Cow<'a, ResolvedSweep>,
    /// Wheel, or the part of it that the scene repeats.
    pub(crate) wheel: ModalWheel,
    pub(crate) stepping: Stepping,
}

/// State from which a run starts.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Start<'a> {
    /// Initial state of the scene: rest, or the initial mode.
    Scene,
    /// Initial state of the scene with a tiny perturbation of every nodal diameter.
    Perturbed,
    /// End of the neighbouring speed.
    After(&'a EndState),
}

/// Additional recording of a run.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Recording {
    /// Details of chosen revolutions.
    pub(crate) detail: Option<Detail>,
    /// Revolutions of which all modes are recorded.
    pub(crate) states: Option<Revolutions>,
}

impl Recording {
    /// Recording at every speed of a sweep: the last revolution, if stress is asked for.
    pub(crate) fn of(request: &ResolvedSweep) -> Self {
        Self { detail: None, states: request.stress_outside().map(|_| Revolutions::Last(1)) }
    }
}

impl<'a> SpeedScene<'a> {
    /// Makes the wheel of a scene at a speed and chooses its stepping.
    ///
    /// # Errors
    /// Why the scene cannot be run at this speed.
    pub(crate) fn new(
        sector: &'a ReducedSector,
        request: Cow<'a, ResolvedSweep>,
        speed_rad_s: f64,
    ) -> Result<Self, NotRunnable> {
        let wheel = wheel_of(&request.scene, &sector.wheel, speed_rad_s)?;
        let stepping = Stepping::choose(&wheel, &sector.wheel.contact, &request)?;
        Ok(Self { sector, request, wheel, stepping })
    }

    /// Number of contact nodes of a sector that may touch.
    pub(crate) fn touching(&self) -> usize {
        touching(&self.sector.wheel.contact, &self.request).len()
    }

    /// Clearance of every contact node over the window; none for a scene without contact.
    pub(crate) fn lasting_clearance(&self) -> Option<Vec<f64>> {
        lasting_clearance(self.sector, &self.request, self.wheel.speed_rad_s)
    }

    /// Casing with these clearances whose lobes grow over `ramp_revolutions`, for a wheel that is known to stand the effects of the scene.
    pub(crate) fn casing(
        &self,
        clearance: Option<Vec<f64>>,
        ramp_revolutions: f64,
    ) -> Result<Option<Casing>, NotRunnable> {
        let reduced = &*self.sector.wheel;
        let casing =
            clearance.and_then(|clearance| casing(reduced, &self.request, clearance, ramp_revolutions));
        check_table(reduced, casing.as_ref(), self.stepping.discretisation.per_revolution)?;
        Ok(casing)
    }

    /// Checks that the wheel can stand the effects of the scene at this speed.
    pub(crate) fn check(&self) -> Result<(), NotRunnable> {
        check_at_speed(&self.stepping.of(&self.request, &self.wheel, &self.sector.wheel.contact))
    }

    /// Modes of the initial state.
    pub(crate) fn initial(&self, casing: Option<&Casing>) -> Result<Vec<InitialMode>, NotRunnable> {
        initial(&self.request, &self.wheel, &self.sector.wheel.contact, casing, &self.stepping)
    }

    /// Simulates the scene.
    ///
    /// # Errors
    /// Why it cannot be run.
    pub(crate) fn simulate(
        &self,
        start: Start<'_>,
        recording: Recording,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<Simulated, NotRunnable> {
        let Self { sector, request, wheel, stepping } = self;
        let reduced = &*sector.wheel;
        // A wheel that comes from another speed is in contact with a casing that is there.
        let ramp_revolutions = match start {
            Start::After(_) => 0.0,
            Start::Scene | Start::Perturbed => request.integration.ramp_revolutions,
        };
        self.staged(ramp_revolutions, |staged| {
            let casing = staged.casing;
            let mut initial = match start {
                Start::After(state) => {
                    let shapes = Shapes::of(wheel, reduced, request.scene.centrifugal_stiffening)?;
                    let modes = state.modes(wheel, &shapes, reduced, stepping.scheme);
                    modes.ok_or(NotRunnable::OtherReduction)?
                }
                Start::Scene | Start::Perturbed => self.initial(casing)?,
            };
            let repeats = repeats(request, recording.detail, wheel.around());
            if matches!(start, Start::Perturbed) {
                initial = perturbed(initial, wheel, casing);
            }
            // Where a march ends early, a motion that breaks the symmetry must not have to grow out of round-off first.
            let aside = (casing.is_some() && repeats.is_some_and(|repeats| repeats.symmetry > 1))
                .then(|| perturbed(initial.clone(), wheel, casing));
            let Recording { detail, states } = recording;
            let simulation = Simulation { initial: &initial, repeats, detail, states, ..staged };
            if let Some(aside) = aside {
                let simulated = run_steady(&Simulation { initial: &aside, ..simulation }, request, watch);
                // A run without contact breaks no symmetry, and would show only its initial perturbation.
                if simulated.run.statistics.contact_share() > 0.0 {
                    return Ok(simulated);
                }
            }
            Ok(run_steady(&simulation, request, watch))
        })?
    }

    /// Calls `act` with the simulation of the scene from rest that records only its sensors and returns its result.
    ///
    /// # Errors
    /// Why the scene cannot be run.
    pub(crate) fn staged<T>(
        &self,
        ramp_revolutions: f64,
        act: impl FnOnce(Simulation<'_>) -> T,
    ) -> Result<T, NotRunnable> {
        let Self { sector, request, wheel, stepping } = self;
        let contact_nodes = &sector.wheel.contact[..];
        self.check()?;
        let damping = modal_damping(request, sector, wheel)?;
        let clearance = running_clearance(sector, request, wheel.speed_rad_s)?;
        let casing = self.casing(clearance, ramp_revolutions)?;
        let (mut wheel, sensors) = sensed(sector, wheel, request)?;
        let bending = sector.bending.as_ref().filter(|_| request.scene.geometric_nonlinearity.is_some());
        let bending = bending.map(|blade| {
            let stiffening = request.scene.centrifugal_stiffening;
            let first = blade.join(wheel.to_mut(), &sector.wheel, stiffening)?;
            Ok::<_, ModelError>((Arc::clone(blade), first))
        });
        let sectors = wheel.around();
        let surroundings =
            Surroundings { contact_nodes, sectors, ramp_revolutions, bending: bending.transpose()? };
        let effects = SceneEffects::of(&request.scene, &surroundings)?;
        Ok(act(Simulation {
            wheel: &wheel,
            contact_nodes,
            damping: damping.as_ref(),
            casing: casing.as_ref(),
            effects: effects.borrow(),
            initial: &[],
            scheme: stepping.scheme,
            sensors: &sensors,
            steps_per_revolution: stepping.discretisation.per_revolution,
            samples_per_revolution: stepping.discretisation.samples,
            revolutions: request.integration.revolutions() as usize,
            repeats: None,
            window_revolutions: request.integration.window_revolutions as usize,
            detail: None,
            states: None,
        }))
    }
}
