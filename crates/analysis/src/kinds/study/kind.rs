//! Convergence studies: accuracy of settings and its cost in time.

use std::sync::Arc;

use crate::error::Violation;
use crate::kinds::document::Document;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, Asked, GivenModel, Kind, NamedModel, NotStored, ResolvedJob, Resolving, Units, Words, Work,
};
use crate::kinds::plan::{Grounds, Plan};
use crate::kinds::study::resolve::resolve_study;
use crate::kinds::study::work_precision::plan_study;
use crate::kinds::sweep::kind::HISTORIES;
use crate::request::StudyRequest;
use crate::resolved::ResolvedStudy;
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
    documents: &[WORK_PRECISION.name, HISTORIES],
    units: Units::Once,
    read: kind::read::<StudyRequest>,
    stored: |text, _| {
        let written = serde_json::from_str(text)?;
        Ok(Arc::new(ResolvedStudy::stored(written).map_err(NotStored::Unsound)?))
    },
    #[cfg(feature = "schema")]
    request: Shape::of::<StudyRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<StudyPlan>(),
};

/// Errors and times of every setting.
pub const WORK_PRECISION: Document = Document::only("work_precision");

impl Asked for StudyRequest {
    fn kind(&self) -> &'static Kind {
        &STUDY
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
        Ok(Resolving::Done(Arc::new(resolve_study(*self, &facts)?)))
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

    fn modes_per_speed(&self) -> Option<u32> {
        None
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        Plan::of(&plan_study(self, &grounds.models[0].facts), None)
    }

    fn work(&self) -> Work<'_> {
        Work::Trials(self)
    }
}
