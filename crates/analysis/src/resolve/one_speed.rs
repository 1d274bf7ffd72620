//! One speed of a scene, as case studies and branches ask for it: a sweep that has no other.

use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    AutoOr, CaseSpeed, Integration, Record, Scene, Sensor, SpeedSet, Speeds, SweepDirection, SweepRequest,
};
use crate::resolve::resolve_sweep;
use crate::resolved::ResolvedSweep;

/// What is asked of the speed.
pub(super) struct OneSpeed {
    pub(super) model: String,
    pub(super) modes_per_speed: AutoOr,
    pub(super) speed: CaseSpeed,
    pub(super) scene: Scene,
    pub(super) integration: Integration,
    pub(super) sensors: Vec<Sensor>,
    pub(super) max_engine_order: u32,
    pub(super) fields: Option<bool>,
}

impl OneSpeed {
    /// Parses it and checks it against its model; what is wrong with the speed is said at `/speed/value`.
    pub(super) fn resolve(self, facts: &ModelFacts) -> Result<ResolvedSweep, Vec<Violation>> {
        let CaseSpeed { value, unit } = self.speed;
        let sweep = SweepRequest {
            model: self.model,
            modes_per_speed: self.modes_per_speed,
            speeds: Speeds::One(SpeedSet {
                from: None,
                to: None,
                count: None,
                values: Some(vec![value]),
                unit,
            }),
            scene: self.scene,
            integration: self.integration,
            sensors: self.sensors,
            max_engine_order: self.max_engine_order,
            peak_prominence: default_peak_prominence(),
            sweep: SweepDirection::Independent,
            refine: false,
            reproducible: false,
            accuracy: None,
            budget: None,
            control_speeds: None,
            record: Record::default(),
            fields: self.fields,
        };
        let at_its_field = |violation: Violation| match violation.pointer.strip_prefix("/speeds") {
            Some(_) => Violation { pointer: "/speed/value".to_owned(), ..violation },
            None => violation,
        };
        resolve_sweep(sweep, facts).map_err(|found| found.into_iter().map(at_its_field).collect())
    }
}
