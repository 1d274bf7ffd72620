//! Errors of runs against finer ones.

use serde::{Deserialize, Serialize};

use crate::request::Setting;
use crate::result::steady::SteadyReport;

/// Differences between a run and a finer one, relative to the finer one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Errors {
    /// Error of the displacement over the first revolutions: root mean square of the difference over that of the displacement, all sensors together.
    /// Absent where no history was stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub history: Option<f64>,
    /// Error of the steady amplitude: the largest difference of a sensor's root mean square over the window, relative to the largest sensor's.
    pub amplitude: f64,
    /// Standard error of `amplitude` where the response does not repeat: its level varies from part to part of the window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_spread: Option<f64>,
    /// Error of the peaks at integer engine orders: the largest root sum of squares over a sensor's differences, relative to the largest sensor's
    /// peaks. Absent where a response does not repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub engine_orders: Option<f64>,
    /// Error of the contact impulse over the whole run; over the window where a run ended by itself or was solved for. Absent without impulse.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impulse: Option<f64>,
    /// Error of the largest von Mises stress; absent where none was recorded. It converges more slowly with the modes than displacement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<f64>,
}

impl Errors {
    /// Error of one quantity, if it is known.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::History => self.history,
            Quantity::Amplitude => Some(self.amplitude),
            Quantity::EngineOrders => self.engine_orders,
            Quantity::Impulse => self.impulse,
            Quantity::Stress => self.stress,
        }
    }

    /// Error by which a run is judged on a Pareto front: that of one quantity, but no less than its standard error, if it has one.
    pub fn judged(&self, quantity: Quantity) -> Option<f64> {
        let error = self.of(quantity)?;
        Some(match quantity {
            Quantity::Amplitude => error.max(self.amplitude_spread.unwrap_or(0.0)),
            Quantity::History | Quantity::EngineOrders | Quantity::Impulse | Quantity::Stress => error,
        })
    }
}

/// Quantity of interest, of which an error is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Displacement over the first revolutions.
    History,
    /// Steady amplitude.
    Amplitude,
    /// Peaks at integer engine orders.
    EngineOrders,
    /// Contact impulse.
    Impulse,
    /// Largest von Mises stress.
    Stress,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 5] =
        [Self::History, Self::Amplitude, Self::EngineOrders, Self::Impulse, Self::Stress];

    /// Name of the quantity on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::History => "history",
            Self::Amplitude => "amplitude",
            Self::EngineOrders => "engine_orders",
            Self::Impulse => "impulse",
            Self::Stress => "stress",
        }
    }
}

/// Estimated errors of the speeds of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ErrorEstimate {
    /// Speeds that were simulated again: half of them at the most prominent peaks of the response, the others evenly spread.
    pub controls: Vec<Control>,
    /// Estimated errors, one per completed speed, in the order of the request, unless a control run at or beside the speed ended early, or one beside it does not
    /// repeat.
    pub points: Vec<PointError>,
    /// Largest estimated error of `points`; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest: Option<f64>,
    /// Largest `estimated_stress_error` of `points`; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_of_stress: Option<f64>,
    /// Whether all completed speeds are known to be within the accuracy that was asked for, if one was; absent where the modes could
    /// not be refined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target_met: Option<bool>,
    /// Meaning of the estimates, in words.
    pub message: String,
}

impl ErrorEstimate {
    /// Estimated error of speed `index`, if there is one.
    pub fn of(&self, index: u32) -> Option<f64> {
        self.points.iter().find(|point| point.index == index).map(|point| point.estimated_error)
    }
}

/// A speed that was simulated again at a finer setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Control {
    /// Index of the speed in the request.
    pub index: u32,
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Finer setting of the control run.
    pub setting: Setting,
    /// The periodic response of the finer run; absent unless the request's `integration.steady` asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadyReport>,
    /// Differences between the run and the finer one; absent where the finer run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub differences: Option<Errors>,
    /// Estimated relative error of the steady response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimated_error: Option<f64>,
    /// Estimated relative error of the largest von Mises stress; absent where it was not recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimated_stress_error: Option<f64>,
    /// Reason for which the finer run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
}

/// Estimated error of one speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PointError {
    /// Index of the speed in the request.
    pub index: u32,
    /// Relative error of the steady response.
    pub estimated_error: f64,
    /// Relative error of the largest von Mises stress; absent where it was not recorded, or no control run gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimated_stress_error: Option<f64>,
    /// Whether this speed was simulated again itself; otherwise its errors are the larger ones of the nearest speeds on either side that were.
    pub controlled: bool,
}
