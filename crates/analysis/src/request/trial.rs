//! One speed at one setting, to be compared with others.

use serde::{Deserialize, Serialize};

use crate::request::auto_or::AutoOr;
use crate::request::integration::SchemeChoice;
use crate::request::speeds::{SpeedSet, SpeedUnit, Speeds};
use crate::request::sweep::{SweepDirection, SweepRequest, default_peak_prominence};

/// The knobs that accuracy and time depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Setting {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// How time is stepped.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates.
    pub kept_modes: AutoOr,
    /// Time steps per revolution.
    pub steps_per_revolution: u32,
}

/// What a trial runs. Two equal ones give the same numbers but for times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialRequest {
    /// A resolved sweep of one speed with every knob fixed.
    pub sweep: SweepRequest,
    /// Revolutions from the start whose displacements are kept; 0 for none.
    pub history_revolutions: u32,
    /// Whether a twin that starts from a perturbed state runs beside it.
    pub twin: bool,
}

impl TrialRequest {
    /// `setting` at one speed of `request`, without what chooses settings.
    pub fn new(request: &SweepRequest, speed_rad_s: f64, setting: Setting) -> Self {
        let mut sweep = setting.on(request);
        sweep.speeds = Speeds::One(SpeedSet {
            from: None,
            to: None,
            count: None,
            values: Some(vec![speed_rad_s]),
            unit: SpeedUnit::RadS,
            added: false,
        });
        (sweep.accuracy, sweep.budget, sweep.control_speeds) = (None, None, None);
        sweep.sweep = SweepDirection::Independent;
        (sweep.refine, sweep.peak_prominence) = (false, default_peak_prominence());
        Self { sweep, history_revolutions: 0, twin: false }
    }
}
