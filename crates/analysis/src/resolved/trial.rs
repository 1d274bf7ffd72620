//! One speed at one setting, to be compared with others.

use serde::Serialize;

use crate::request::Setting;
use crate::resolved::sweep::ResolvedSweep;

/// Request for a trial. Two equal ones give the same numbers but for times.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrialRequest {
    /// A sweep of one speed with every knob fixed.
    pub(crate) sweep: ResolvedSweep,
    /// Revolutions from the start whose displacements are stored; 0 for none.
    pub(crate) history_revolutions: u32,
    /// Whether a twin that starts from a perturbed state runs beside it.
    pub(crate) twin: bool,
}

impl TrialRequest {
    /// Trial of `setting` at one speed of `request`, without what chooses settings, and without stress.
    pub fn new(request: &ResolvedSweep, speed_rad_s: f64, setting: Setting) -> Self {
        Self { sweep: request.one_speed(speed_rad_s, setting), history_revolutions: 0, twin: false }
    }

    /// Adds stress where `request` asks for it.
    #[must_use]
    pub(crate) fn with_stress_of(mut self, request: &ResolvedSweep) -> Self {
        self.sweep.record.stress = request.record.stress.clone();
        self
    }

    /// Sweep of one speed that the trial runs.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    pub(crate) fn speed_rad_s(&self) -> f64 {
        self.sweep.speeds.rad_s()[0]
    }
}
