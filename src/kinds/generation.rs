//! Generation of a model from parameters, as a kind of job.

use std::sync::Arc;

use serde::ser::Error;
use serde::{Deserialize, Serialize};

use crate::analysis::error::Violation;
use crate::analysis::kinds::kind::{
    self, Asked, GivenModel, Kind, NamedModel, ResolvedJob, Resolving, Shape, Units, Words, Work,
};
use crate::analysis::kinds::plan::{Grounds, Plan};
use crate::impeller::{GenerationPlan, ImpellerError, ImpellerParameters, ImpellerRequest, plan_generation};

/// Models generated from parameters.
pub static MODEL_GENERATION: Kind = Kind {
    name: "model_generation",
    route: "/v1/models",
    operation: "model_generation",
    about: "A model from the parameters of the generator",
    // The contract describes this route where packages are uploaded to it, too.
    create: Words::brief("Generate a model."),
    plan: Words::brief("Plan the generation of a model: what it would make and cost. Starts nothing."),
    example: include_str!("example.json"),
    results: &[],
    units: Units::Model,
    read: kind::read::<GenerationRequest>,
    stored: |text, _| Ok(Arc::new(serde_json::from_str::<Generation>(text)?)),
    request: Shape::of::<ImpellerRequest>(),
    resolved: Shape::of::<ImpellerParameters>(),
    planned: Shape::of::<GenerationPlan>(),
};

/// Request for a model.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
struct GenerationRequest(ImpellerRequest);

/// Model to generate, by parameters within their ranges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Generation {
    /// Parameters of the generator.
    pub parameters: ImpellerParameters,
}

impl Asked for GenerationRequest {
    fn kind(&self) -> &'static Kind {
        &MODEL_GENERATION
    }

    fn models(&self) -> Vec<NamedModel<'_>> {
        Vec::new()
    }

    fn resolve(self: Box<Self>, _models: Vec<GivenModel>) -> Result<Resolving, Vec<Violation>> {
        let refused = |error: ImpellerError| vec![violation(&error)];
        let parameters = self.0.resolve().map_err(refused)?;
        plan_generation(&parameters).map_err(refused)?;
        Ok(Resolving::Done(Arc::new(Generation { parameters })))
    }
}

impl ResolvedJob for Generation {
    fn kind(&self) -> &'static Kind {
        &MODEL_GENERATION
    }

    fn text(&self) -> serde_json::Result<String> {
        serde_json::to_string(self)
    }

    fn as_posted(&self) -> serde_json::Result<Option<String>> {
        self.text().map(Some)
    }

    fn models(&self) -> Vec<&str> {
        Vec::new()
    }

    fn speeds(&self) -> u32 {
        0
    }

    fn modes_per_speed(&self) -> Option<u32> {
        None
    }

    fn plan(&self, _grounds: &Grounds) -> serde_json::Result<Plan> {
        // Parameters that give no model were refused when the request was resolved.
        let plan = plan_generation(&self.parameters).map_err(serde_json::Error::custom)?;
        Plan::of(&plan, None)
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Model
    }
}

/// Violation for refused parameters of the generator, at the field.
fn violation(error: &ImpellerError) -> Violation {
    let at = |field: &str, message: String| Violation::new(format!("/{}", field.replace('.', "/")), message);
    match error {
        ImpellerError::Parameter { field, value, requirement } => {
            at(field, format!("{value}: {requirement}"))
        }
        ImpellerError::Field { field, problem } => at(field, problem.to_string()),
        other => Violation::new("", other.to_string()),
    }
}
