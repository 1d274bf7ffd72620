//! A modal analysis as it is stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::ModalAnalysisRequest;
use crate::resolved::knobs::Modes;
use crate::resolved::speeds::ResolvedSpeeds;

/// A modal analysis that was checked against its model; see [`ModalAnalysisRequest`], as which it is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "ModalAnalysisRequest")]
pub struct ResolvedModalAnalysis {
    pub(crate) model: String,
    pub(crate) modes: Modes,
    pub(crate) families: u32,
    pub(crate) superharmonics: Vec<u32>,
    pub(crate) lobes: u32,
    pub(crate) max_engine_order: u32,
    pub(crate) coriolis: bool,
    pub(crate) speeds: ResolvedSpeeds,
    pub(crate) fields: Option<bool>,
}

impl ResolvedModalAnalysis {
    /// What `asked` says; `refuse` hears of what is wrong with its speeds. Nothing is held against a model.
    pub(crate) fn of(asked: ModalAnalysisRequest, refuse: &mut dyn FnMut(Violation)) -> Self {
        let speeds = ResolvedSpeeds::of(asked.speeds, 0).unwrap_or_else(|violations| {
            violations.into_iter().for_each(refuse);
            ResolvedSpeeds::none()
        });
        Self {
            model: asked.model,
            modes: Modes::of(asked.modes_per_speed, asked.accuracy, asked.budget),
            families: asked.families,
            superharmonics: asked.superharmonics,
            lobes: asked.lobes,
            max_engine_order: asked.max_engine_order,
            coriolis: asked.coriolis,
            speeds,
            fields: asked.fields,
        }
    }

    /// Reads again what was resolved before.
    ///
    /// # Errors
    /// What is wrong with it, if it was not.
    pub fn stored(written: ModalAnalysisRequest) -> Result<Self, Vec<Violation>> {
        let mut found = Vec::new();
        let resolved = Self::of(written, &mut |violation| found.push(violation));
        if found.is_empty() { Ok(resolved) } else { Err(found) }
    }

    /// Id of its model.
    pub fn model(&self) -> &str {
        &self.model
    }

    /// How k is set.
    pub fn modes(&self) -> Modes {
        self.modes
    }

    /// k; the usual one while it is sought.
    pub fn modes_per_speed(&self) -> u32 {
        self.modes.or_usual()
    }

    /// Whether k has still to be chosen.
    pub fn is_sought(&self) -> bool {
        self.modes.given().is_none()
    }

    /// Its speeds.
    pub fn speeds(&self) -> &ResolvedSpeeds {
        &self.speeds
    }

    /// As of a sweep: whether rows of the reduction's basis must be beside it, must not, or are kept where it reduces.
    pub fn fields(&self) -> Option<bool> {
        self.fields
    }

    /// With k.
    pub(crate) fn at(&self, modes_per_speed: u32) -> Self {
        Self { modes: Modes::Given(modes_per_speed), ..self.clone() }
    }
}

impl From<ResolvedModalAnalysis> for ModalAnalysisRequest {
    fn from(analysis: ResolvedModalAnalysis) -> Self {
        let (modes_per_speed, accuracy, budget) = analysis.modes.fields();
        Self {
            model: analysis.model,
            modes_per_speed,
            families: analysis.families,
            superharmonics: analysis.superharmonics,
            lobes: analysis.lobes,
            max_engine_order: analysis.max_engine_order,
            coriolis: analysis.coriolis,
            speeds: analysis.speeds.lists().clone(),
            accuracy,
            budget,
            fields: analysis.fields,
        }
    }
}
