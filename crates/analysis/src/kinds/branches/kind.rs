//! Branches: periodic responses over a parameter of their scene.

use std::sync::Arc;

use crate::error::{AnalysisError, Violation};
use crate::kinds::branches::leg::branch_leg;
use crate::kinds::branches::plan::{branches_memory, plan_branches};
use crate::kinds::branches::resolve::resolve_branches;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, GivenModel, Kind, Leg, LegNames, Legs, OfOneModel, ResolvedJob, Units, Words, Work,
};
use crate::kinds::plan::{Capacity, Grounds, Plan};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
#[cfg(feature = "schema")]
use crate::request::BranchesSettings;
use crate::request::{Along, BranchParameter, BranchesRequest, Sensor};
use crate::resolved::{ResolvedBranches, ResolvedSweep};
use crate::result::BranchesPlan;

/// Branches of periodic responses over a parameter of their scene.
pub static BRANCHES: Kind = Kind {
    name: "branches",
    route: "/v1/branches",
    operation: "branches",
    about: "Periodic responses over speed, clearance, lobes or damping",
    create: Words::new(
        "Follow the periodic response of a scene while its speed, clearance, lobes or damping change.",
        "The branch is followed around folds, through stable and unstable responses, with Floquet multipliers at every point. \
         Bifurcations are located to a millionth, maxima of amplitudes as accurately as the time step permits, and branches of doubled \
         period are followed as well. `GET /v1/jobs/{id}/branches` has the points found so far, also while the job runs.",
    ),
    plan: Words::new(
        "Plan branches of periodic responses: what they would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/branches` and answers at once. If the reduction is stored, the plan has the scheme, the step, and \
         the expected time of a point and of a branch that has no folds, from a short calibration of this machine.",
    ),
    example: include_str!("example.json"),
    results: &[("branches", "/branches")],
    units: Units::Legs,
    read: kind::read::<BranchesRequest>,
    stored: |text, _| kind::stored(text, ResolvedBranches::stored),
    #[cfg(feature = "schema")]
    request: Shape::of::<BranchesRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<BranchesSettings>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<BranchesPlan>(),
};

/// Documents of the legs.
pub const LEGS: LegNames = LegNames { leg: "branches", course: "branch_course", beside: None };

impl OfOneModel for BranchesRequest {
    const KIND: &'static Kind = &BRANCHES;

    type Job = ResolvedBranches;

    fn model(&self) -> &str {
        &self.model
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(self, GivenModel { facts, sensors }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_branches(Self { sensors, ..self }, &facts)
    }
}

impl ResolvedJob for ResolvedBranches {
    fn kind(&self) -> &'static Kind {
        &BRANCHES
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn speeds(&self) -> u32 {
        self.sweep.speeds.count()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![&self.sweep]
    }

    fn span_rad_s(&self) -> Option<[f64; 2]> {
        match self.along {
            Along { parameter: BranchParameter::Speed, from, to } => Some([from, to]),
            Along { .. } => self.sweep.speeds.span_rad_s(),
        }
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let (model, Capacity { machine, costs, .. }) = (&grounds.models[0], grounds.capacity()?);
        let plan = plan_branches(self, &model.facts, model.reduced.as_deref(), costs);
        let plan = BranchesPlan { machine: Some(machine.clone()), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Legs(self)
    }
}

impl Legs for ResolvedBranches {
    fn names(&self) -> LegNames {
        LEGS
    }

    fn scene(&self) -> &ResolvedSweep {
        &self.sweep
    }

    fn memory(&self, reduced: &ReducedSector) -> u64 {
        branches_memory(reduced, self)
    }

    fn leg(
        &self,
        reduced: &ReducedSector,
        course: Option<&str>,
        monitor: &dyn Monitor,
    ) -> Result<serde_json::Result<Leg>, AnalysisError> {
        kind::next_leg(
            course,
            |course| branch_leg(reduced, self, course, monitor),
            |leg| Ok(Leg { text: kind::text(leg)?, beside: None, ended: None, course: None }),
        )
    }
}
