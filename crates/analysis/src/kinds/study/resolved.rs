//! A convergence study as it is stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    AutoOr, Grid, Integration, Record, StudyIntegration, StudyRecord, StudyRequest, SweepDirection,
    SweepRequest,
};
use crate::resolved::sensor::ResolvedSensor;
use crate::resolved::speeds::ResolvedSpeeds;
use crate::resolved::sweep::ResolvedSweep;

/// Convergence study that was checked against its model; written as [`StudyRequest`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "StudyRequest")]
pub struct ResolvedStudy {
    /// Sweep whose speeds are the runs of the study; each run has knobs of its own.
    pub(crate) sweep: ResolvedSweep,
    pub(crate) grid: Grid,
    pub(crate) history_revolutions: u32,
}

impl ResolvedStudy {
    /// Reads a study that was resolved and stored before.
    ///
    /// # Errors
    /// Violations, if the study was never resolved.
    pub fn stored(written: StudyRequest) -> Result<Self, Vec<Violation>> {
        Ok(Self {
            sweep: ResolvedSweep::stored(written.sweep(), 0)?,
            grid: written.grid,
            history_revolutions: written.history_revolutions,
        })
    }

    /// Id of the model.
    pub fn model(&self) -> &str {
        &self.sweep.model
    }

    /// Speeds of the study.
    pub fn speeds(&self) -> &ResolvedSpeeds {
        &self.sweep.speeds
    }

    /// Sensors of the study; at least one.
    pub fn sensors(&self) -> &[ResolvedSensor] {
        &self.sweep.sensors
    }
}

impl StudyRequest {
    /// Sweep whose speeds are the runs of the study.
    pub(crate) fn sweep(&self) -> SweepRequest {
        SweepRequest {
            model: self.model.clone(),
            modes_per_speed: AutoOr::Auto,
            speeds: self.speeds.clone(),
            scene: self.scene.clone(),
            integration: Integration {
                revolutions: AutoOr::Fixed(self.integration.revolutions),
                ramp_revolutions: self.integration.ramp_revolutions,
                window_revolutions: self.integration.window_revolutions,
                steady: self.integration.steady,
                ..Integration::default()
            },
            sensors: self.sensors.clone(),
            max_engine_order: self.max_engine_order,
            peak_prominence: default_peak_prominence(),
            sweep: SweepDirection::Independent,
            refine: Some(false),
            reproducible: false,
            accuracy: None,
            budget: None,
            control_speeds: None,
            record: Record { stress: self.record.stress.clone(), ..Record::default() },
            fields: self.fields,
            operation: None,
            limits: None,
            blade_thickness: None,
        }
    }
}

impl From<ResolvedStudy> for StudyRequest {
    fn from(study: ResolvedStudy) -> Self {
        let sweep = study.sweep;
        let Integration { ramp_revolutions, window_revolutions, steady, .. } = sweep.integration;
        let revolutions = sweep.integration.revolutions();
        Self {
            model: sweep.model,
            speeds: sweep.speeds.lists().clone(),
            scene: sweep.scene.into(),
            grid: study.grid,
            integration: StudyIntegration { revolutions, ramp_revolutions, window_revolutions, steady },
            history_revolutions: study.history_revolutions,
            sensors: sweep.sensors.into_iter().map(Into::into).collect(),
            max_engine_order: sweep.max_engine_order,
            record: StudyRecord { stress: sweep.record.stress },
            fields: sweep.fields,
        }
    }
}
