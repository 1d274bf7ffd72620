//! Convergence studies: accuracy of settings and its cost in time.

use std::sync::Arc;

use crate::error::Violation;
use crate::kinds::document::Document;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{self, GivenModel, Kind, OfOneModel, ResolvedJob, Units, Words, Work};
use crate::kinds::plan::{Grounds, Plan};
use crate::kinds::study::resolve::resolve_study;
use crate::kinds::study::work_precision::plan_study;
use crate::request::{Sensor, StudyRequest};
use crate::resolved::{ResolvedStudy, ResolvedSweep};
#[cfg(feature = "schema")]
use crate::result::StudyPlan;

/// Convergence studies: errors and times over a grid of settings.
pub static STUDY: Kind = Kind {
    name: "study",
    route: "/v1/studies",
    operation: "study",
    about: "Convergence study: what accuracy costs in time",
    create: Words::new(
        "Compare a grid of settings with a reference one level finer: errors, times, observed orders.",
        "Every combination of the grid is run at every speed, and a setting that is unstable is listed with the reason. Runs are stored: \
         a study that shares settings with an earlier one on the same scene computes only the others.",
    ),
    plan: Words::new(
        "Plan a study: the runs that it would make. Starts nothing.",
        "Takes the body of `POST /v1/studies` and answers at once with the number of runs and of their steps, and the reductions that \
         they rest on. A study measures times, so that none are foretold.",
    ),
    example: include_str!("example.json"),
    results: &[("work-precision", "/work-precision"), ("histories", "/histories")],
    units: Units::Once,
    read: kind::read::<StudyRequest>,
    stored: |text, _| kind::stored(text, ResolvedStudy::stored),
    #[cfg(feature = "schema")]
    request: Shape::of::<StudyRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<StudyRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<StudyPlan>(),
};

/// Errors and times of every setting.
pub const WORK_PRECISION: Document<'static> = Document::only("work_precision");

impl OfOneModel for StudyRequest {
    const KIND: &'static Kind = &STUDY;

    type Job = ResolvedStudy;

    fn model(&self) -> &str {
        &self.model
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(self, GivenModel { facts, sensors }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_study(Self { sensors, ..self }, &facts)
    }
}

impl ResolvedJob for ResolvedStudy {
    fn kind(&self) -> &'static Kind {
        &STUDY
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn as_posted(&self) -> serde_json::Result<Option<String>> {
        self.text().map(Some)
    }

    fn models(&self) -> Vec<&str> {
        vec![self.model()]
    }

    fn speeds(&self) -> u32 {
        self.sweep.speeds.count()
    }

    fn scene(&self) -> Option<&ResolvedSweep> {
        Some(&self.sweep)
    }

    fn modes_per_speed(&self) -> Option<u32> {
        None
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        Plan::of(&plan_study(self, &grounds.models[0].facts), None)
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Trials(self)
    }
}
