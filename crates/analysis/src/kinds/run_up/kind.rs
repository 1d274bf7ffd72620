//! Run-ups and run-downs: responses of a scene whose speed changes.

use std::sync::Arc;

use crate::error::{AnalysisError, Violation};
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, Asked, GivenModel, Kind, Leg, LegNames, Legs, NamedModel, NotStored, ResolvedJob, Resolving, Units,
    Words, Work,
};
use crate::kinds::plan::{Capacity, Grounds, Plan};
use crate::kinds::run_up::march::run_up_leg;
use crate::kinds::run_up::plan::{plan_run_ups, run_ups_memory};
use crate::kinds::run_up::resolve::resolve_run_ups;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::request::RunUpRequest;
use crate::resolved::{ResolvedRunUps, ResolvedSweep};
use crate::result::RunUpPlan;

/// Run-ups: a scene whose speed changes.
pub static RUN_UP: Kind = Kind {
    name: "run_up",
    route: "/v1/run-ups",
    operation: "run_ups",
    about: "Run-ups and run-downs: a wheel whose speed changes",
    create: Words::new(
        "Run a wheel up or down through its critical speeds.",
        "The speed changes at given rates, a run for each, or through given points; stiffness, modes, clearances given cold and all that \
         depends on the angle follow it. `GET /v1/jobs/{id}/run-ups` and `GET /v1/jobs/{id}/spectrogram` have the results so far, also \
         while the job runs. With several rates and a `limit`, the result has the rate at which the wheel must pass to stay below it.",
    ),
    plan: Words::new(
        "Plan run-ups: what they would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/run-ups` and answers at once with durations, revolutions and pieces of one speed; if the reduction \
         is stored, also with steps and their expected times, from a short calibration of this machine.",
    ),
    example: include_str!("example.json"),
    results: &[("run-ups", "/run-ups"), ("spectrogram", "/spectrogram")],
    documents: &[LEGS.leg, LEGS.course, SPECTRA],
    units: Units::Legs,
    read: kind::read::<RunUpRequest>,
    stored: |text, _| {
        let written = serde_json::from_str(text)?;
        Ok(Arc::new(ResolvedRunUps::stored(written).map_err(NotStored::Unsound)?))
    },
    #[cfg(feature = "schema")]
    request: Shape::of::<RunUpRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<RunUpPlan>(),
};

/// Spectra of the leg of this index.
pub const SPECTRA: &str = "run_up_spectra";

/// Documents of the legs.
pub const LEGS: LegNames = LegNames { leg: "run_ups", course: "run_up_course", beside: Some(SPECTRA) };

impl Asked for RunUpRequest {
    fn kind(&self) -> &'static Kind {
        &RUN_UP
    }

    fn models(&self) -> Vec<NamedModel<'_>> {
        vec![NamedModel::own(&self.model)]
    }

    fn sensors(&self) -> &[crate::request::Sensor] {
        &self.sensors
    }

    fn resolve(mut self: Box<Self>, models: Vec<GivenModel>) -> Result<Resolving, Vec<Violation>> {
        let GivenModel { facts, sensors } = kind::only(models)?;
        self.sensors = sensors;
        Ok(Resolving::Done(Arc::new(resolve_run_ups(*self, &facts)?)))
    }
}

impl ResolvedJob for ResolvedRunUps {
    fn kind(&self) -> &'static Kind {
        &RUN_UP
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn models(&self) -> Vec<&str> {
        vec![self.sweep.model()]
    }

    fn speeds(&self) -> u32 {
        self.runs()
    }

    fn modes_per_speed(&self) -> Option<u32> {
        self.sweep.modes().given()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![&self.sweep]
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let (model, Capacity { machine, costs, .. }) = (&grounds.models[0], grounds.capacity()?);
        let plan = plan_run_ups(self, &model.facts, model.reduced.as_deref(), costs);
        let plan = RunUpPlan { machine: Some(machine.clone()), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(&self) -> Work<'_> {
        Work::Legs(self)
    }
}

impl Legs for ResolvedRunUps {
    fn names(&self) -> LegNames {
        LEGS
    }

    fn scene(&self) -> &ResolvedSweep {
        &self.sweep
    }

    fn has_euler_force(&self) -> bool {
        self.has_euler_force()
    }

    fn memory(&self, reduced: &ReducedSector) -> u64 {
        run_ups_memory(reduced, self)
    }

    fn leg(
        &self,
        reduced: &ReducedSector,
        course: Option<&str>,
        monitor: &dyn Monitor,
    ) -> Result<serde_json::Result<Leg>, AnalysisError> {
        let course = match course.map(serde_json::from_str).transpose() {
            Ok(course) => course,
            Err(error) => return Ok(Err(error)),
        };
        let (leg, course) = run_up_leg(reduced, self, course, monitor)?;
        let written = || {
            let course = course.as_ref().map(kind::text).transpose()?;
            Ok(Leg {
                text: kind::text(&leg)?,
                beside: Some(kind::text(&leg.spectra())?),
                ended: leg.status(),
                course,
            })
        };
        Ok(written())
    }
}
