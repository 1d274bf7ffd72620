//! Run-ups and run-downs: responses of a scene whose speed changes.

use std::sync::Arc;

use crate::error::{AnalysisError, Violation};
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, GivenModel, Kind, Leg, LegNames, Legs, OfOneModel, ResolvedJob, Units, Words, Work,
};
use crate::kinds::plan::{Capacity, Grounds, Plan};
use crate::kinds::run_up::march::run_up_leg;
use crate::kinds::run_up::plan::{plan_run_ups, run_ups_memory};
use crate::kinds::run_up::resolve::resolve_run_ups;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
#[cfg(feature = "schema")]
use crate::request::RunUpSettings;
use crate::request::{RunUpRequest, Sensor};
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
        "Takes the body of `POST /v1/run-ups` and answers at once with durations, revolutions and segments of one speed; if the reduction \
         is stored, also with steps and their expected times, from a short calibration of this machine.",
    ),
    example: include_str!("example.json"),
    results: &[("run-ups", "/run-ups"), ("spectrogram", "/spectrogram")],
    units: Units::Legs,
    read: kind::read::<RunUpRequest>,
    stored: |text, _| kind::stored(text, ResolvedRunUps::stored),
    #[cfg(feature = "schema")]
    request: Shape::of::<RunUpRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<RunUpSettings>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<RunUpPlan>(),
};

/// Spectra of the leg of this index.
pub const SPECTRA: &str = "run_up_spectra";

/// Documents of the legs.
pub const LEGS: LegNames = LegNames { leg: "run_ups", course: "run_up_course", beside: Some(SPECTRA) };

impl OfOneModel for RunUpRequest {
    const KIND: &'static Kind = &RUN_UP;

    type Job = ResolvedRunUps;

    fn model(&self) -> &str {
        &self.model
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(self, GivenModel { facts, sensors }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_run_ups(Self { sensors, ..self }, &facts)
    }
}

impl ResolvedJob for ResolvedRunUps {
    fn kind(&self) -> &'static Kind {
        &RUN_UP
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn speeds(&self) -> u32 {
        self.runs()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![&self.sweep]
    }

    fn span_rad_s(&self) -> Option<[f64; 2]> {
        Some(self.speed.range().into())
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let (model, Capacity { machine, costs, .. }) = (&grounds.models[0], grounds.capacity()?);
        let plan = plan_run_ups(self, &model.facts, model.reduced.as_deref(), costs);
        let plan = RunUpPlan { machine: Some(machine.clone()), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(self: Arc<Self>) -> Work {
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
        kind::next_leg(
            course,
            |course| run_up_leg(reduced, self, course, monitor),
            |leg| {
                Ok(Leg {
                    text: kind::text(leg)?,
                    beside: Some(kind::text(&leg.spectra())?),
                    ended: leg.status(),
                    course: None,
                })
            },
        )
    }
}
