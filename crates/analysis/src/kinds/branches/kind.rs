//! Branches: periodic responses over a parameter of their scene.

use std::sync::Arc;

use crate::error::{AnalysisError, Violation};
use crate::kinds::branches::leg::branch_leg;
use crate::kinds::branches::plan::{branches_memory, plan_branches};
use crate::kinds::branches::resolve::resolve_branches;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, Asked, GivenModel, Kind, Leg, LegNames, Legs, NamedModel, NotStored, ResolvedJob, Resolving, Units,
    Words, Work,
};
use crate::kinds::plan::{Capacity, Grounds, Plan};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::request::BranchesRequest;
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
    documents: &[LEGS.leg, LEGS.course],
    units: Units::Legs,
    read: kind::read::<BranchesRequest>,
    stored: |text, _| {
        let written = serde_json::from_str(text)?;
        Ok(Arc::new(ResolvedBranches::stored(written).map_err(NotStored::Unsound)?))
    },
    #[cfg(feature = "schema")]
    request: Shape::of::<BranchesRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<BranchesPlan>(),
};

/// Documents of the legs.
pub const LEGS: LegNames = LegNames { leg: "branches", course: "branch_course", beside: None };

impl Asked for BranchesRequest {
    fn kind(&self) -> &'static Kind {
        &BRANCHES
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
        Ok(Resolving::Done(Arc::new(resolve_branches(*self, &facts)?)))
    }
}

impl ResolvedJob for ResolvedBranches {
    fn kind(&self) -> &'static Kind {
        &BRANCHES
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn models(&self) -> Vec<&str> {
        vec![self.sweep.model()]
    }

    fn speeds(&self) -> u32 {
        self.sweep.speeds.count()
    }

    fn modes_per_speed(&self) -> Option<u32> {
        self.sweep.modes().given()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![&self.sweep]
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let (model, Capacity { machine, costs, .. }) = (&grounds.models[0], grounds.capacity()?);
        let plan = plan_branches(self, &model.facts, model.reduced.as_deref(), costs);
        let plan = BranchesPlan { machine: Some(machine.clone()), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(&self) -> Work<'_> {
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
        let course = match course.map(serde_json::from_str).transpose() {
            Ok(course) => course,
            Err(error) => return Ok(Err(error)),
        };
        let (leg, course) = branch_leg(reduced, self, course, monitor)?;
        let written = || {
            let course = course.as_ref().map(kind::text).transpose()?;
            Ok(Leg { text: kind::text(&leg)?, beside: None, ended: None, course })
        };
        Ok(written())
    }
}
