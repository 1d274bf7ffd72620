//! Stress over the speeds of a sweep.

use serde::{Deserialize, Serialize};

use crate::request::SweepRequest;
use crate::result::point::Point;
use crate::result::stress::{PointStress, Strengths, StressCycle};
use crate::result::validity::Validity;
use rubmap_wheel::dynamics::sector::Units;

/// Stress of the speeds of a sweep, and the strengths of the materials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SweepStress {
    /// The speeds whose stress was recorded, in the order of the request.
    pub speeds: Vec<SpeedStress>,
    /// Strengths of the material of each element set.
    pub strengths: Vec<Strengths>,
    /// Units of the model; stress is force over length².
    pub units: Units,
    /// The whole request as resolved.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// Stress of one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedStress {
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Stress and margin.
    pub stress: PointStress,
    /// Whether linear theory holds at the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validity: Option<Validity>,
}

impl SpeedStress {
    /// Takes the stress of a speed; none if it has none.
    pub fn of(point: &Point) -> Option<Self> {
        Some(Self {
            index: point.index,
            speed_rad_s: point.speed_rad_s,
            stress: point.stress.clone()?,
            validity: point.validity.clone(),
        })
    }
}

impl SweepStress {
    /// Every cycle with its speed.
    pub fn cycles(&self) -> impl Iterator<Item = (&SpeedStress, &StressCycle)> {
        self.speeds.iter().flat_map(|speed| speed.stress.cycles.iter().map(move |cycle| (speed, cycle)))
    }

    /// Every cycle with its speed, the most utilised first, then by descending alternating stress.
    pub fn ranked(&self) -> Vec<(&SpeedStress, &StressCycle)> {
        let mut cycles: Vec<_> = self.cycles().collect();
        let rank = |cycle: &StressCycle| cycle.utilisation.filter(|used| used.is_finite()).unwrap_or(-1.0);
        cycles.sort_by(|(_, a), (_, b)| {
            rank(b).total_cmp(&rank(a)).then(b.alternating.total_cmp(&a.alternating))
        });
        cycles
    }
}
