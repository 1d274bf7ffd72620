//! Speeds of a scene for case studies, branches and run-ups: a sweep without refinement, accuracy and recording.

use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    AutoOr, CaseSpeed, Integration, Record, Scene, Sensor, SpeedSet, SpeedUnit, Speeds, SweepDirection,
    SweepRequest,
};
use crate::resolve::resolve_sweep;
use crate::resolved::ResolvedSweep;

/// Part of a request that asks for speeds of a scene.
pub(crate) struct PlainSweep {
    pub(crate) model: String,
    pub(crate) modes_per_speed: AutoOr,
    pub(crate) speeds: SpeedSet,
    pub(crate) scene: Scene,
    pub(crate) integration: Integration,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) max_engine_order: u32,
    pub(crate) fields: Option<bool>,
}

impl PlainSweep {
    /// Parses the sweep and checks it against its model; violations of the speeds are reported at `at`, the field that they came from.
    pub(crate) fn resolve(self, facts: &ModelFacts, at: &str) -> Result<ResolvedSweep, Vec<Violation>> {
        let sweep = SweepRequest {
            model: self.model,
            modes_per_speed: self.modes_per_speed,
            speeds: Speeds::One(self.speeds),
            scene: self.scene,
            integration: self.integration,
            sensors: self.sensors,
            max_engine_order: self.max_engine_order,
            peak_prominence: default_peak_prominence(),
            sweep: SweepDirection::Independent,
            refine: Some(false),
            reproducible: false,
            accuracy: None,
            budget: None,
            control_speeds: None,
            record: Record::default(),
            fields: self.fields,
            operation: None,
            limits: None,
            blade_thickness: None,
        };
        let at_its_field = |violation: Violation| match violation.pointer.strip_prefix("/speeds") {
            Some(_) => Violation { pointer: at.to_owned(), ..violation },
            None => violation,
        };
        resolve_sweep(sweep, facts).map_err(|found| found.into_iter().map(at_its_field).collect())
    }
}

/// Set of the given speeds.
pub(crate) fn values(values: Vec<f64>, unit: SpeedUnit) -> SpeedSet {
    SpeedSet { from: None, to: None, count: None, values: Some(values), unit }
}

/// Set of a single speed.
pub(crate) fn one(speed: CaseSpeed) -> SpeedSet {
    values(vec![speed.value], speed.unit)
}
