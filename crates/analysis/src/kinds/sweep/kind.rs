//! Sweeps: contact simulations over rotational speeds.

use std::borrow::Cow;
use std::sync::Arc;

use crate::error::Violation;
use crate::kinds::document::Document;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, GivenModel, Kind, OfOneModel, Recorded, ResolvedJob, Speeds, ToChoose, Units, Words, Work,
};
use crate::kinds::plan::{Capacity, Grounds, Plan};
use crate::measured;
use crate::plan::plan_sweep;
use crate::refine::refine;
use crate::request::{Sensor, SweepRequest};
use crate::resolve::resolve_sweep;
use crate::resolved::ResolvedSweep;
use crate::result::{Chosen, Point, SpeedResult, SweepPlan};
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Contact simulations over rotational speeds.
pub static SWEEP: Kind = Kind {
    name: "sweep",
    route: "/v1/sweeps",
    operation: "sweep",
    about: "Contact over a range of speeds",
    create: Words::new(
        "Simulate contact over rotational speeds.",
        "The request is checked against its model at once; all violations come in one answer. If the reduction is stored, it is also \
         checked against the reduced model (fixed numbers of steps or kept modes against the stability limit, friction against what lets \
         the tips slide); if not, such a violation fails the job before its first speed, with the same pointers. `POST /v1/sweeps/plan` \
         refuses the same requests.",
    ),
    plan: Words::new(
        "Plan a sweep: what it would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/sweeps` and answers at once with effects on and off, symmetry, contact pairs, and, if the reduction \
         is stored, unknowns, scheme and step with the reason that set them, and the expected computing time and memory, from a short \
         calibration of this machine. The results of a sweep repeat the estimate beside the cost that was spent.",
    ),
    example: include_str!("example.json"),
    results: &[
        ("interaction-map", "/interaction-map"),
        ("critical-speeds", "/critical-speeds"),
        ("wheel-critical-speeds", "/critical-speeds/wheel"),
        ("verdict", "/verdict"),
        ("level", "/level"),
        ("spectra", "/spectra/{index}"),
        ("forces", "/forces"),
        ("report", "/report"),
    ],
    units: Units::Speeds,
    read: kind::read::<SweepRequest>,
    stored: |text, rounds| kind::stored(text, |written| ResolvedSweep::stored(written, rounds)),
    #[cfg(feature = "schema")]
    request: Shape::of::<SweepRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<SweepRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<SweepPlan>(),
};

/// Critical speeds at the sensor of this index.
pub const CRITICAL_SPEEDS: &str = "critical_speeds";

/// Critical speeds of the wheel as a whole.
pub const WHEEL_CRITICAL_SPEEDS: Document<'static> = Document::only("wheel_critical_speeds");

/// Estimated errors of all speeds.
pub const ERRORS: Document<'static> = Document::only("errors");

/// Histories at the speed of this index.
pub const HISTORIES: &str = "histories";

/// States of the whole wheel at the speed of this index.
pub const STATES: &str = "states";

impl OfOneModel for SweepRequest {
    const KIND: &'static Kind = &SWEEP;

    type Job = ResolvedSweep;

    fn model(&self) -> &str {
        &self.model
    }

    fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    fn resolve(self, GivenModel { facts, sensors }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_sweep(Self { sensors, ..self }, &facts)
    }
}

impl ResolvedJob for ResolvedSweep {
    fn kind(&self) -> &'static Kind {
        &SWEEP
    }

    fn text(&self) -> serde_json::Result<String> {
        kind::text(self)
    }

    fn as_posted(&self) -> serde_json::Result<Option<String>> {
        kind::text(&self.unrefined()).map(Some)
    }

    fn rounds(&self) -> u32 {
        self.speeds().rounds()
    }

    fn speeds(&self) -> u32 {
        self.speeds.count()
    }

    fn is_of_one_kind(&self) -> bool {
        self.is_of_one_kind()
    }

    fn chain(&self) -> Option<Vec<u32>> {
        self.chain()
    }

    fn scenes(&self) -> Vec<&ResolvedSweep> {
        vec![self]
    }

    fn choice(&self) -> Option<ToChoose<'_>> {
        self.is_sought().then_some(ToChoose::Setting(self))
    }

    fn records(&self) -> Recorded {
        let (stress, states) = (self.stress_outside().is_some(), self.records_states());
        Recorded { stress, states, ..Recorded::default() }
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let plan = planned(self, grounds, 0)?;
        let (facts, threads) = (&grounds.models[0].facts, grounds.capacity()?.threads);
        let estimate = plan.estimate.map(|all| measured::with_cost(all, self, facts, threads));
        let choice = grounds.choice.clone().and_then(|chosen| match chosen {
            Chosen::Setting(choice) => Some(choice),
            Chosen::Modes(_) => None,
        });
        let plan = SweepPlan { estimate, choice, placed_sensors: grounds.placed_sensors.clone(), ..plan };
        Plan::of(&plan, plan.estimate.clone())
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Speeds(self)
    }
}

/// Plan of a sweep of model `place` of a job.
pub(crate) fn planned(
    sweep: &ResolvedSweep,
    grounds: &Grounds,
    place: usize,
) -> serde_json::Result<SweepPlan> {
    let (model, Capacity { machine, costs, threads }) = (&grounds.models[place], grounds.capacity()?);
    let plan = plan_sweep(sweep, &model.facts, model.reduced.as_deref(), costs, *threads);
    Ok(SweepPlan { machine: Some(machine.clone()), ..plan })
}

impl Speeds for ResolvedSweep {
    fn speed(&self, index: u32) -> Result<(Cow<'_, ResolvedSweep>, u32), Vec<Violation>> {
        Ok((Cow::Borrowed(self), index))
    }

    fn kept(&self, found: SpeedResult, _index: u32) -> SpeedResult {
        found
    }

    fn may_grow(&self) -> bool {
        self.is_refined()
    }

    fn more(&self, points: &[Point], driven: &[DrivenCrossing]) -> Option<Arc<dyn ResolvedJob>> {
        refine(self, points, driven).map(|refined| Arc::new(refined) as Arc<dyn ResolvedJob>)
    }

    fn concluded(&self) -> Option<&ResolvedSweep> {
        Some(self)
    }
}
