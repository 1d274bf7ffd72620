//! Kind of a job: the interface that every kind implements for its requests and its jobs.

use std::any::Any;
use std::borrow::Cow;
use std::fmt::{Debug, Formatter};
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::document::Document;
use super::plan::{Grounds, Plan};
use crate::error::{AnalysisError, Violation};
use crate::model::{ModelFacts, ReducedSector};
use crate::monitor::Monitor;
use crate::request::Sensor;
use crate::resolved::{ResolvedCaseStudy, ResolvedModalAnalysis, ResolvedStudy, ResolvedSweep};
use crate::result::{Point, PointStatus, SpeedResult};
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Reader of a stored job, from its text and the number of rounds of a refinement.
pub type ReadStored = fn(&str, u32) -> Result<Arc<dyn ResolvedJob>, NotReadable>;

/// Kind of a job.
pub struct Kind {
    /// Name in requests, in answers and in the database, such as `run_up`.
    pub name: &'static str,
    /// Path to which its requests are posted.
    pub route: &'static str,
    /// Name of its two operations in the contract, after `create_` and `plan_`.
    pub operation: &'static str,
    /// Jobs of this kind in a few words, for a list of kinds.
    pub about: &'static str,
    /// Words of the contract on a request for such a job.
    pub create: Words,
    /// Words of the contract on a plan of such a job.
    pub plan: Words,
    /// Example of a request, as JSON.
    pub example: &'static str,
    /// Results of its jobs: relation, and path below that of the job.
    pub results: &'static [(&'static str, &'static str)],
    /// Units in which its jobs are computed, those of their [`Work`].
    pub units: Units,
    /// Reads a request.
    pub read: fn(&str) -> serde_json::Result<Box<dyn Asked>>,
    /// Reads a job that was resolved and stored before.
    pub stored: ReadStored,
    /// Schema of its requests.
    #[cfg(feature = "schema")]
    pub request: Shape,
    /// Schema of its resolved requests.
    #[cfg(feature = "schema")]
    pub resolved: Shape,
    /// Schema of its plans.
    #[cfg(feature = "schema")]
    pub planned: Shape,
}

impl Debug for Kind {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Kind {}

/// Units in which a job is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Units {
    /// Whole job: one task from beginning to end.
    Once,
    /// Speeds, each a task of its own.
    Speeds,
    /// Legs, one after the other.
    Legs,
    /// Model, which is made and kept.
    Model,
}

/// Words of the contract on one operation.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    /// Sentence that heads the operation.
    pub summary: &'static str,
    /// Description, if the summary does not say all.
    pub description: Option<&'static str>,
    /// Reasons for the status 422, where they are not those of all kinds.
    pub refused: Option<&'static str>,
}

impl Words {
    /// Words on an operation that is refused as those of other kinds are.
    pub const fn new(summary: &'static str, description: &'static str) -> Self {
        Self { summary, description: Some(description), refused: None }
    }

    /// Words on an operation of which the summary says all.
    pub const fn brief(summary: &'static str) -> Self {
        Self { summary, description: None, refused: None }
    }
}

/// Reason why a stored job cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NotReadable {
    /// Text that is no request of this kind.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// Request that breaks the rules which it met when it was resolved.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Unsound(Vec<Violation>),
}

/// Reads a request for [`Kind::read`].
///
/// # Errors
/// Text that is no such request.
pub fn read<R: Asked + DeserializeOwned + 'static>(text: &str) -> serde_json::Result<Box<dyn Asked>> {
    Ok(Box::new(serde_json::from_str::<R>(text)?))
}

/// Reads a stored job for [`Kind::stored`]: `resolve` makes the job of the request as it was written.
///
/// # Errors
/// Text that is no such request, or a request that breaks the rules.
pub(crate) fn stored<W: DeserializeOwned, J: ResolvedJob>(
    text: &str,
    resolve: impl FnOnce(W) -> Result<J, Vec<Violation>>,
) -> Result<Arc<dyn ResolvedJob>, NotReadable> {
    let written = serde_json::from_str(text)?;
    Ok(Arc::new(resolve(written).map_err(NotReadable::Unsound)?))
}

/// Model that a request names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedModel<'a> {
    /// Id of the model.
    pub id: &'a str,
    /// JSON pointer to where it is named.
    pub pointer: &'static str,
}

impl<'a> NamedModel<'a> {
    /// Model named in the field `model`.
    pub fn own(id: &'a str) -> Self {
        Self { id, pointer: "/model" }
    }
}

/// Model that a request is resolved against.
#[derive(Debug, Clone)]
pub struct GivenModel {
    /// Facts of the model.
    pub facts: ModelFacts,
    /// Sensors asked for, placed at nodes of this model.
    pub sensors: Vec<Sensor>,
}

/// Request for a job, as it came.
pub trait Asked: Debug + Send {
    /// Kind of the job.
    fn kind(&self) -> &'static Kind;

    /// Models that it computes from.
    fn models(&self) -> Vec<NamedModel<'_>>;

    /// Sensors, to be placed at nodes of the models.
    fn sensors(&self) -> &[Sensor] {
        &[]
    }

    /// Resolves the request against its models.
    ///
    /// # Errors
    /// All violations at once.
    fn resolve(self: Box<Self>, models: Vec<GivenModel>) -> Result<Resolving, Vec<Violation>>;
}

/// Request for a job that computes from one model.
pub trait OfOneModel: Debug + Send + 'static {
    /// Kind of the job.
    const KIND: &'static Kind;

    /// Resolved request.
    type Job: ResolvedJob;

    /// Id of the model.
    fn model(&self) -> &str;

    /// Sensors, to be placed at nodes of the model.
    fn sensors(&self) -> &[Sensor] {
        &[]
    }

    /// Resolves the request against its model.
    ///
    /// # Errors
    /// All violations at once.
    fn resolve(self, model: GivenModel) -> Result<Self::Job, Vec<Violation>>;
}

impl<R: OfOneModel> Asked for R {
    fn kind(&self) -> &'static Kind {
        R::KIND
    }

    fn models(&self) -> Vec<NamedModel<'_>> {
        vec![NamedModel::own(self.model())]
    }

    fn sensors(&self) -> &[Sensor] {
        self.sensors()
    }

    fn resolve(self: Box<Self>, models: Vec<GivenModel>) -> Result<Resolving, Vec<Violation>> {
        Ok(Resolving::Done(Arc::new((*self).resolve(first(&mut models.into_iter())?)?)))
    }
}

/// State of a request that is being resolved.
#[derive(Debug)]
pub enum Resolving {
    /// Job, all of it checked.
    Done(Arc<dyn ResolvedJob>),
    /// Job that takes long to check.
    Unfinished(Box<dyn Unchecked>),
}

/// Job that is checked piece by piece, so that other requests have their turn in between.
pub trait Unchecked: Debug + Send {
    /// Checks the next piece.
    ///
    /// # Errors
    /// All violations, with the last piece.
    fn check(self: Box<Self>) -> Result<Resolving, Vec<Violation>>;
}

/// Parts of a result that only some jobs record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Recorded {
    /// Stress of every speed.
    pub stress: bool,
    /// States of the whole wheel.
    pub states: bool,
    /// Backbone curves.
    pub backbones: bool,
}

/// Job: a request that was checked against its models, with every default filled in.
pub trait ResolvedJob: Any + Debug + Send + Sync {
    /// Kind of the job.
    fn kind(&self) -> &'static Kind;

    /// Resolved request as JSON, from which [`Kind::stored`] reads the job.
    ///
    /// # Errors
    /// If it cannot be written, which is a defect.
    fn text(&self) -> serde_json::Result<String>;

    /// Resolved request as answers show it, as JSON.
    ///
    /// # Errors
    /// If it cannot be written, which is a defect.
    fn shown(&self) -> serde_json::Result<String> {
        self.text()
    }

    /// Resolved request as one that can be posted, if it is one; for jobs of earlier versions, which kept no other.
    ///
    /// # Errors
    /// If it cannot be written, which is a defect.
    fn as_posted(&self) -> serde_json::Result<Option<String>> {
        Ok(None)
    }

    /// Rounds of a refinement that its speeds have.
    fn rounds(&self) -> u32 {
        0
    }

    /// Ids of the models that it computes from, those of its scenes; one that is compared comes last.
    fn models(&self) -> Vec<&str> {
        self.scenes().into_iter().map(ResolvedSweep::model).collect()
    }

    /// Number of speeds by now, of all designs together; each run of a run-up counts as one.
    fn speeds(&self) -> u32;

    /// Largest number of speeds that the job may reach, as far as it is known.
    fn speeds_at_most(&self) -> u32 {
        self.speeds()
    }

    /// Number `modes_per_speed` of the reduction that the results rest on, that of its first scene, if there is one and it is known.
    fn modes_per_speed(&self) -> Option<u32> {
        self.scenes().first().and_then(|scene| scene.modes().given())
    }

    /// Whether the whole job must be computed on processors with one kind of vectors.
    fn is_of_one_kind(&self) -> bool {
        false
    }

    /// Speeds in the order in which each starts from the end of the one before; `None` where each is on its own.
    fn chain(&self) -> Option<Vec<u32>> {
        None
    }

    /// Scenes that it integrates, one for each model, as sweeps: each is checked against the reduction of its model.
    fn scenes(&self) -> Vec<&ResolvedSweep> {
        Vec::new()
    }

    /// Scene that the job is about, as a sweep, if it has one.
    fn scene(&self) -> Option<&ResolvedSweep> {
        self.scenes().into_iter().next()
    }

    /// Lowest and highest speed that the job is about, rad/s.
    fn span_rad_s(&self) -> Option<[f64; 2]> {
        self.scene()?.speeds().span_rad_s()
    }

    /// Settings that the job leaves to the service.
    fn choice(&self) -> Option<ToChoose<'_>> {
        None
    }

    /// Parts of the results that only some jobs record.
    fn records(&self) -> Recorded {
        Recorded::default()
    }

    /// Plan of the job: work and cost.
    ///
    /// # Errors
    /// If it cannot be written, which is a defect.
    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan>;

    /// Work of the job.
    fn work(self: Arc<Self>) -> Work;
}

impl dyn ResolvedJob {
    /// Job as one of the kind whose resolved request is `R`; `None` if it is of another kind.
    pub fn get<R: ResolvedJob>(&self) -> Option<&R> {
        (self as &dyn Any).downcast_ref()
    }
}

/// Settings that the service chooses for a job.
#[derive(Debug, Clone, Copy)]
pub enum ToChoose<'a> {
    /// Modes, steps and scheme of a sweep, by pilot runs.
    Setting(&'a ResolvedSweep),
    /// Modes of a modal analysis, by reductions.
    Modes(&'a ResolvedModalAnalysis),
}

/// Work of a job, which the service runs.
#[derive(Clone)]
pub enum Work {
    /// One computation on one reduction.
    Once(Arc<dyn Once>),
    /// Runs that are compared at the end; runs that other jobs stored are not repeated.
    Trials(Arc<ResolvedStudy>),
    /// Speeds of which everything is recorded, side by side.
    Recorded(Arc<ResolvedCaseStudy>),
    /// Speeds, each a task of its own.
    Speeds(Arc<dyn Speeds>),
    /// Legs, one after the other.
    Legs(Arc<dyn Legs>),
    /// Model of the generator, which is made and kept.
    Model,
}

impl Work {
    /// Units in which the work is done.
    pub fn units(&self) -> Units {
        match self {
            Self::Once(_) | Self::Trials(_) | Self::Recorded(_) => Units::Once,
            Self::Speeds(_) => Units::Speeds,
            Self::Legs(_) => Units::Legs,
            Self::Model => Units::Model,
        }
    }
}

/// Reduction that a job rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reduction<'a> {
    /// Id of the model.
    pub model: &'a str,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// Whether the rows of its basis must be stored, must not, or are stored where the job reduces.
    pub fields: Option<bool>,
    /// Number of coordinates in which second-order bending is wanted.
    pub bending: Option<u32>,
}

/// Job that is one computation.
pub trait Once: Send + Sync {
    /// Reduction that it computes on.
    fn reduction(&self) -> Reduction<'_>;

    /// Computes the documents of the result. The inner error is that of writing them as JSON.
    ///
    /// # Errors
    /// Cancellation, or a model that cannot be evaluated.
    fn compute(
        &self,
        reduced: &ReducedSector,
        monitor: &dyn Monitor,
    ) -> Result<serde_json::Result<Vec<(Document<'static>, String)>>, AnalysisError>;
}

/// Job whose speeds are tasks of their own.
pub trait Speeds: Send + Sync {
    /// Sweep that speed `index` of the job belongs to, and its index there.
    ///
    /// # Errors
    /// Violations of a design that was never checked.
    fn speed(&self, index: u32) -> Result<(Cow<'_, ResolvedSweep>, u32), Vec<Violation>>;

    /// Part of the result of speed `index` that is stored, from the whole.
    fn kept(&self, found: SpeedResult, index: u32) -> SpeedResult;

    /// Whether speeds may be added.
    fn may_grow(&self) -> bool;

    /// Job with more speeds, if the finished ones call for some, with the linear critical speeds that the scene can drive.
    fn more(&self, points: &[Point], driven: &[DrivenCrossing]) -> Option<Arc<dyn ResolvedJob>>;

    /// Sweep whose critical speeds conclude the job, if any do.
    fn concluded(&self) -> Option<&ResolvedSweep>;
}

/// Names of the documents of legs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LegNames {
    /// Document of a leg.
    pub leg: &'static str,
    /// Document of the course, the state from which the next leg continues, while there is one.
    pub course: &'static str,
    /// Document beside a leg, if there is one.
    pub beside: Option<&'static str>,
}

/// Leg of a job, to be stored.
#[derive(Debug)]
pub struct Leg {
    /// Leg as JSON.
    pub text: String,
    /// Document beside it as JSON.
    pub beside: Option<String>,
    /// Status with which a run ended, if this is its last leg.
    pub ended: Option<PointStatus>,
    /// State from which the next leg continues as JSON; `None` after the last.
    pub course: Option<String>,
}

/// Job that is computed leg by leg, each with all that the next one needs.
pub trait Legs: Send + Sync {
    /// Names of its documents.
    fn names(&self) -> LegNames;

    /// Scene that it is computed on.
    fn scene(&self) -> &ResolvedSweep;

    /// Whether the Euler force must be known.
    fn has_euler_force(&self) -> bool {
        false
    }

    /// Memory that a leg takes, bytes.
    fn memory(&self, reduced: &ReducedSector) -> u64;

    /// Computes the next leg, from the course after the one before it. The inner error is that of reading and writing JSON.
    ///
    /// # Errors
    /// Cancellation, or a request that cannot be met.
    fn leg(
        &self,
        reduced: &ReducedSector,
        course: Option<&str>,
        monitor: &dyn Monitor,
    ) -> Result<serde_json::Result<Leg>, AnalysisError>;
}

/// Computes a leg for [`Legs::leg`]: `further` takes the course after the leg before, `written` writes the leg.
///
/// # Errors
/// Errors of `further`.
pub(crate) fn next_leg<C: Serialize + DeserializeOwned, L>(
    course: Option<&str>,
    further: impl FnOnce(Option<C>) -> Result<(L, Option<C>), AnalysisError>,
    written: impl FnOnce(&L) -> serde_json::Result<Leg>,
) -> Result<serde_json::Result<Leg>, AnalysisError> {
    let course = match course.map(serde_json::from_str).transpose() {
        Ok(course) => course,
        Err(error) => return Ok(Err(error)),
    };
    let (leg, next) = further(course)?;
    let text = || Ok(Leg { course: next.as_ref().map(text).transpose()?, ..written(&leg)? });
    Ok(text())
}

/// First of the models that a request is resolved against.
///
/// # Errors
/// If there is none, which is a defect of the caller.
pub(crate) fn first(models: &mut impl Iterator<Item = GivenModel>) -> Result<GivenModel, Vec<Violation>> {
    models.next().ok_or_else(|| vec![Violation::new("/model", "a model is missing")])
}

/// JSON text of a resolved request.
pub(crate) fn text(resolved: &impl Serialize) -> serde_json::Result<String> {
    serde_json::to_string(resolved)
}

/// Schema of a type that goes over the wire.
#[cfg(feature = "schema")]
#[derive(Clone, Copy)]
pub struct Shape {
    /// Name of the type in the contract.
    pub name: fn() -> Cow<'static, str>,
    /// Schema of the type.
    pub schema: fn() -> utoipa::openapi::RefOr<utoipa::openapi::Schema>,
    /// Adds the schemas of the types within it.
    pub nested: fn(&mut Vec<(String, utoipa::openapi::RefOr<utoipa::openapi::Schema>)>),
}

#[cfg(feature = "schema")]
impl Shape {
    /// Schema of `T`.
    pub const fn of<T: utoipa::ToSchema>() -> Self {
        Self { name: T::name, schema: T::schema, nested: T::schemas }
    }
}
