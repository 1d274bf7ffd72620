//! A modal analysis as it is stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::families::FamiliesBy;
use crate::request::{BackbonesRequest, ModalAnalysisRequest};
use crate::resolved::knobs::Modes;
use crate::resolved::speeds::ResolvedSpeeds;

/// Modal analysis that was checked against its model; written as [`ModalAnalysisRequest`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "ModalAnalysisRequest")]
pub struct ResolvedModalAnalysis {
    pub(crate) model: String,
    pub(crate) modes: Modes,
    pub(crate) families: u32,
    pub(crate) families_by: FamiliesBy,
    pub(crate) superharmonics: Vec<u32>,
    pub(crate) lobes: u32,
    pub(crate) max_engine_order: u32,
    pub(crate) coriolis: bool,
    pub(crate) speeds: ResolvedSpeeds,
    pub(crate) backbones: Option<BackbonesRequest>,
    pub(crate) fields: Option<bool>,
}

impl ResolvedModalAnalysis {
    /// Resolves `asked` without checking it against a model; `refuse` is given the violations of its speeds.
    pub(crate) fn of(asked: ModalAnalysisRequest, refuse: &mut dyn FnMut(Violation)) -> Self {
        let speeds = ResolvedSpeeds::of(asked.speeds, 0).unwrap_or_else(|violations| {
            violations.into_iter().for_each(refuse);
            ResolvedSpeeds::none()
        });
        Self {
            model: asked.model,
            modes: Modes::of(asked.modes_per_speed, asked.accuracy, asked.budget),
            families: asked.families,
            families_by: asked.families_by,
            superharmonics: asked.superharmonics,
            lobes: asked.lobes,
            max_engine_order: asked.max_engine_order,
            coriolis: asked.coriolis,
            speeds,
            backbones: asked.backbones,
            fields: asked.fields,
        }
    }

    /// Reads a modal analysis that was resolved and stored before.
    ///
    /// # Errors
    /// Violations, if the analysis was never resolved.
    pub fn stored(written: ModalAnalysisRequest) -> Result<Self, Vec<Violation>> {
        let mut found = Vec::new();
        let resolved = Self::of(written, &mut |violation| found.push(violation));
        if found.is_empty() { Ok(resolved) } else { Err(found) }
    }

    /// Id of the model.
    pub fn model(&self) -> &str {
        &self.model
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k: given, or still to be chosen.
    pub fn modes(&self) -> Modes {
        self.modes
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k; the default while they are sought.
    pub fn modes_per_speed(&self) -> u32 {
        self.modes.or_usual()
    }

    /// Whether k has still to be chosen.
    pub fn is_sought(&self) -> bool {
        self.modes.given().is_none()
    }

    /// Speeds of the diagram.
    pub fn speeds(&self) -> &ResolvedSpeeds {
        &self.speeds
    }

    /// Number of coordinates in which blades bend far; none without backbone curves.
    pub fn bending_coordinates(&self) -> Option<u32> {
        self.backbones.as_ref().map(|asked| asked.coordinates)
    }

    /// Whether the rows of the reduction's basis must be stored, must not, or are stored where the analysis reduces.
    pub fn fields(&self) -> Option<bool> {
        self.fields
    }

    /// Modal analysis with so many modes per stiffness speed and nodal diameter.
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
            families_by: analysis.families_by,
            superharmonics: analysis.superharmonics,
            lobes: analysis.lobes,
            max_engine_order: analysis.max_engine_order,
            coriolis: analysis.coriolis,
            speeds: analysis.speeds.lists().clone(),
            backbones: analysis.backbones,
            accuracy,
            budget,
            fields: analysis.fields,
        }
    }
}
