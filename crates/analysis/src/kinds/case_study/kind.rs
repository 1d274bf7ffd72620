//! Case studies: chosen speeds of which everything is recorded.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::error::Violation;
use crate::kinds::case_study::resolve::{histories_of, resolve_case_study};
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{self, GivenModel, Kind, OfOneModel, Recorded, ResolvedJob, Units, Words, Work};
use crate::kinds::plan::{Grounds, Plan};
use crate::kinds::sweep::kind as sweep;
#[cfg(feature = "schema")]
use crate::request::CaseStudySettings;
use crate::request::{CaseStudyRequest, HistoriesRequest, Sensor};
use crate::resolved::{ResolvedCaseStudy, ResolvedSweep};
use crate::result::SweepPlan;

/// Histories of chosen speeds.
pub static CASE_STUDY: Kind = Kind {
    name: "case_study",
    route: "/v1/case-studies",
    operation: "case_study",
    about: "Motion, forces and energy at one speed",
    create: Words::new(
        "Simulate one speed and record its histories: displacements, velocities, forces, energy.",
        "`GET /v1/jobs/{id}/histories` has the histories. A sweep records those of its own speeds with `record`.",
    ),
    plan: Words::new(
        "Plan a case study: what it would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/case-studies` and answers at once with the plan of its one speed, as of a sweep.",
    ),
    example: include_str!("example.json"),
    results: &[("histories", "/histories")],
    units: Units::Once,
    read: kind::read::<CaseStudyRequest>,
    stored: |text, rounds| kind::stored(text, |written| ResolvedCaseStudy::stored(written, rounds)),
    #[cfg(feature = "schema")]
    request: Shape::of::<CaseStudyRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<CaseStudySettings>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<SweepPlan>(),
};

impl OfOneModel for CaseStudyRequest {
    const KIND: &'static Kind = &CASE_STUDY;

    type Job = ResolvedCaseStudy;

    fn model(&self) -> &str {
        &self.model
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(self, GivenModel { facts, sensors }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_case_study(Self { sensors, ..self }, &facts)
    }
}

/// Request for histories of a sweep that has ended.
#[derive(Debug)]
pub struct HistoriesOfSweep {
    /// Sweep whose speeds are recorded.
    pub sweep: ResolvedSweep,
    /// Indices of its critical speeds, if the request asks for those.
    pub critical: BTreeSet<u32>,
    /// Speeds and quantities to record.
    pub request: HistoriesRequest,
}

impl OfOneModel for HistoriesOfSweep {
    const KIND: &'static Kind = &CASE_STUDY;

    type Job = ResolvedCaseStudy;

    fn model(&self) -> &str {
        self.sweep.model()
    }

    fn resolve(self, GivenModel { facts, .. }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        histories_of(&self.sweep, &self.request, &self.critical, &facts)
    }
}

impl ResolvedJob for ResolvedCaseStudy {
    fn kind(&self) -> &'static Kind {
        &CASE_STUDY
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn rounds(&self) -> u32 {
        self.sweep.speeds().rounds()
    }

    fn speeds(&self) -> u32 {
        self.speeds.len() as u32
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![&self.sweep]
    }

    fn span_rad_s(&self) -> Option<[f64; 2]> {
        let all = self.sweep.speeds().rad_s();
        let of = || self.speeds.iter().filter_map(|&index| all.get(index as usize).copied());
        Some([of().reduce(f64::min)?, of().reduce(f64::max)?])
    }

    fn records(&self) -> Recorded {
        Recorded { states: self.records_states(), ..Recorded::default() }
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let plan = sweep::planned(&self.sweep, grounds, 0)?;
        let plan = SweepPlan { placed_sensors: grounds.placed_sensors.clone(), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Recorded(self)
    }
}
