//! Campaigns: contact simulations over speeds, of many designs of a scene.

use std::borrow::Cow;
use std::sync::Arc;

use crate::error::Violation;
use crate::kinds::campaign::more::more_designs;
use crate::kinds::campaign::plan::plan_campaign;
use crate::kinds::campaign::resolve::{CampaignDesigns, ComparedModel, resolve_campaign};
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, Asked, GivenModel, Kind, NamedModel, ResolvedJob, Resolving, Speeds, Unchecked, Units, Words, Work,
};
use crate::kinds::plan::{Grounds, Plan};
use crate::kinds::sweep::kind as sweep;
use crate::request::{CampaignRequest, CampaignSettings, Sensor};
use crate::resolved::{ResolvedCampaign, ResolvedSweep};
#[cfg(feature = "schema")]
use crate::result::CampaignPlan;
use crate::result::{Point, SpeedResult, SweepPlan};
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Contact simulations over speeds, of many designs of a scene.
pub static CAMPAIGN: Kind = Kind {
    name: "campaign",
    route: "/v1/campaigns",
    operation: "campaign",
    about: "Contact over a range of speeds, of many designs of a scene",
    create: Words {
        summary: "Simulate many designs of a scene over speeds.",
        description: Some(
            "One job simulates all designs: `parameters` are the numbers of the scene that vary, and `design`, the design of experiments, \
         chooses their values. All designs share the reduction, and each is checked against the model before any simulation begins. \
         `GET /v1/jobs/{id}/campaign` has the result so far. With `threshold.within`, designs are added where it is undecided whether the \
         limit is met with the requested probability.",
        ),
        refused: Some(
            "A field is unknown, missing or impossible, also of a single design, the model is unknown \
            (`errors` points at each), or the idempotency key belongs to another request.",
        ),
    },
    plan: Words::new(
        "Plan a campaign: what it would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/campaigns` and answers at once with the values of all designs and, if the reduction is stored, the \
         expected cost of all their simulations together.",
    ),
    example: include_str!("example.json"),
    results: &[("campaign", "/campaign")],
    units: Units::Speeds,
    read: kind::read::<CampaignRequest>,
    stored: |text, _| kind::stored(text, ResolvedCampaign::stored),
    #[cfg(feature = "schema")]
    request: Shape::of::<CampaignRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<CampaignSettings>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<CampaignPlan>(),
};
impl Asked for CampaignRequest {
    fn kind(&self) -> &'static Kind {
        &CAMPAIGN
    }

    fn models(&self) -> Vec<NamedModel<'_>> {
        let compared = self.compared_model.iter();
        let compared = compared.map(|id| NamedModel { id, pointer: "/compared_model" });
        [NamedModel::own(&self.model)].into_iter().chain(compared).collect()
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(mut self: Box<Self>, models: Vec<GivenModel>) -> Result<Resolving, Vec<Violation>> {
        let mut models = models.into_iter();
        let GivenModel { facts, sensors } = kind::first(&mut models)?;
        self.sensors = sensors;
        let compared = models.next().map(|GivenModel { facts, sensors }| ComparedModel { facts, sensors });
        Ok(Resolving::Unfinished(Box::new(resolve_campaign(*self, facts, compared)?)))
    }
}

impl Unchecked for CampaignDesigns {
    fn check(mut self: Box<Self>) -> Result<Resolving, Vec<Violation>> {
        if self.check_next() {
            return Ok(Resolving::Unfinished(self));
        }
        Ok(Resolving::Done(Arc::new(self.finish()?)))
    }
}

impl ResolvedJob for ResolvedCampaign {
    fn kind(&self) -> &'static Kind {
        &CAMPAIGN
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    /// Settings without the designs, which the result has: thousands would be sent again with every step of the job.
    fn shown(&self) -> serde_json::Result<String> {
        kind::text(&CampaignSettings { designs: Vec::new(), ..self.settings.clone() })
    }

    fn speeds(&self) -> u32 {
        self.simulations()
    }

    fn speeds_at_most(&self) -> u32 {
        self.simulations_at_most()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        self.sweeps().collect()
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let scene = sweep::planned(&self.sweep, grounds, 0)?;
        let compared = self.compared().filter(|_| grounds.models.len() > 1);
        let compared = compared.map(|compared| sweep::planned(compared, grounds, 1)).transpose()?;
        // The plan of the scene has told the machine.
        let compared = compared.map(|plan| SweepPlan { machine: None, ..plan });
        let plan = plan_campaign(self, scene, compared, grounds.capacity()?.threads);
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Speeds(self)
    }
}

impl Speeds for ResolvedCampaign {
    fn speed(&self, index: u32) -> Result<(Cow<'_, ResolvedSweep>, u32), Vec<Violation>> {
        self.simulation(index).map(|(sweep, place)| (Cow::Owned(sweep), place))
    }

    /// Credentials and summary, under the index in the campaign; a design posted as a sweep gives the rest.
    fn kept(&self, found: SpeedResult, index: u32) -> SpeedResult {
        let point = Point { index, ..found.point };
        SpeedResult { point, spectra: None, end_state: None, wear: None, contact: None }
    }

    fn may_grow(&self) -> bool {
        self.speeds_at_most() > self.speeds()
    }

    fn more(&self, points: &[Point], _driven: &[DrivenCrossing]) -> Option<Arc<dyn ResolvedJob>> {
        more_designs(self, points).map(|longer| Arc::new(longer) as Arc<dyn ResolvedJob>)
    }

    fn concluded(&self) -> Option<&ResolvedSweep> {
        None
    }
}
