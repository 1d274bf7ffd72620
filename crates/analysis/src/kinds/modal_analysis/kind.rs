//! Modal analyses: natural frequencies over speed, and the linear interaction criterion.

use std::sync::Arc;

use crate::error::{AnalysisError, Violation};
use crate::kinds::document::Document;
#[cfg(feature = "schema")]
use crate::kinds::kind::Shape;
use crate::kinds::kind::{
    self, GivenModel, Kind, OfOneModel, Once, Recorded, Reduction, ResolvedJob, ToChoose, Units, Words, Work,
};
use crate::kinds::modal_analysis::backbones::backbones;
use crate::kinds::modal_analysis::compute::modal_analysis;
use crate::kinds::plan::{Grounds, Plan};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::plan::plan_modal_analysis;
use crate::request::ModalAnalysisRequest;
use crate::resolve::resolve_modal_analysis;
use crate::resolved::ResolvedModalAnalysis;
use crate::result::{Chosen, ModalAnalysisPlan};

/// Natural frequencies over speeds.
pub static MODAL_ANALYSIS: Kind = Kind {
    name: "modal_analysis",
    route: "/v1/modal-analyses",
    operation: "modal_analysis",
    about: "Natural frequencies over speed, and the linear criterion",
    create: Words::brief("Compute natural frequencies over speed and the linear interaction criterion."),
    plan: Words::new(
        "Plan a modal analysis: what it would do and cost. Starts nothing.",
        "Takes the body of `POST /v1/modal-analyses` and answers at once.",
    ),
    example: include_str!("example.json"),
    results: &[("campbell", "/campbell"), ("interference", "/interference"), ("report", "/report")],
    units: Units::Once,
    read: kind::read::<ModalAnalysisRequest>,
    stored: |text, _| kind::stored(text, ResolvedModalAnalysis::stored),
    #[cfg(feature = "schema")]
    request: Shape::of::<ModalAnalysisRequest>(),
    #[cfg(feature = "schema")]
    resolved: Shape::of::<ModalAnalysisRequest>(),
    #[cfg(feature = "schema")]
    planned: Shape::of::<ModalAnalysisPlan>(),
};

/// Campbell diagram.
pub const CAMPBELL: Document<'static> = Document::only("campbell");

/// Backbone curves, where they are asked for.
pub const BACKBONES: Document<'static> = Document::only("backbones");

impl OfOneModel for ModalAnalysisRequest {
    const KIND: &'static Kind = &MODAL_ANALYSIS;

    type Job = ResolvedModalAnalysis;

    fn model(&self) -> &str {
        &self.model
    }

    fn resolve(self, GivenModel { facts, .. }: GivenModel) -> Result<Self::Job, Vec<Violation>> {
        resolve_modal_analysis(self, &facts)
    }
}

impl ResolvedJob for ResolvedModalAnalysis {
    fn kind(&self) -> &'static Kind {
        &MODAL_ANALYSIS
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
        self.speeds.count()
    }

    fn span_rad_s(&self) -> Option<[f64; 2]> {
        self.speeds.span_rad_s()
    }

    fn modes_per_speed(&self) -> Option<u32> {
        self.modes().given()
    }

    fn choice(&self) -> Option<ToChoose<'_>> {
        self.is_sought().then_some(ToChoose::Modes(self))
    }

    fn records(&self) -> Recorded {
        Recorded { backbones: self.backbones.is_some(), ..Recorded::default() }
    }

    fn plan(&self, grounds: &Grounds) -> serde_json::Result<Plan> {
        let model = &grounds.models[0];
        let plan = plan_modal_analysis(self, &model.facts, model.reduced.as_deref());
        let choice = grounds.choice.clone().and_then(|chosen| match chosen {
            Chosen::Modes(choice) => Some(choice),
            Chosen::Setting(_) => None,
        });
        Plan::of(&ModalAnalysisPlan { choice, ..plan }, None)
    }

    fn work(self: Arc<Self>) -> Work {
        Work::Once(self)
    }
}

impl Once for ResolvedModalAnalysis {
    fn reduction(&self) -> Reduction<'_> {
        Reduction {
            model: self.model(),
            modes_per_speed: self.modes_per_speed(),
            fields: self.fields(),
            bending: self.bending_coordinates(),
        }
    }

    fn compute(
        &self,
        reduced: &ReducedSector,
        monitor: &dyn Monitor,
    ) -> Result<serde_json::Result<Vec<(Document<'static>, String)>>, AnalysisError> {
        let campbell = modal_analysis(reduced, self, monitor)?;
        let curves = backbones(reduced, self, &campbell, monitor)?;
        let curves = curves.map(|curves| kind::text(&curves).map(|text| (BACKBONES, text)));
        let all = [Some(kind::text(&campbell).map(|text| (CAMPBELL, text))), curves];
        Ok(all.into_iter().flatten().collect())
    }
}
