//! Request for a sweep.

use serde::{Deserialize, Serialize};

use crate::request::accuracy::{Accuracy, Budget};
use crate::request::auto_or::AutoOr;
use crate::request::integration::Integration;
use crate::request::omit::is_false;
use crate::request::operation::{Limits, Operation};
use crate::request::record::Record;
use crate::request::scene::Scene;
use crate::request::sensor::Sensor;
use crate::request::speeds::Speeds;

/// A sweep of contact simulations over rotational speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct SweepRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter: the accuracy dial k. `"auto"` is what `accuracy` or
    /// `budget` chooses, without them 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// Speeds to simulate, in the order given.
    pub speeds: Speeds,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: Integration,
    /// Sensors at which the response is recorded; default: along the contact normal at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 1_000))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of spectra and map.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Least prominence of a critical speed, as a share of the sensor's largest response at any speed: a peak that rises by less
    /// above the higher one of the valleys beside it is neither listed nor refined. 0 for every peak.
    #[serde(default = "default_peak_prominence")]
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 1))]
    pub peak_prominence: f64,
    /// State that each speed starts from.
    #[serde(default, skip_serializing_if = "SweepDirection::is_independent")]
    pub sweep: SweepDirection,
    /// Whether speeds are added around critical speeds, of the wheel and of any sensor, until the response on both sides of
    /// every peak is resolved: when all speeds are finished, the intervals beside a peak that is not `resolved` are halved,
    /// again and again. At most as many speeds are added as were asked for, or 50 if those were fewer, in operating ranges
    /// before elsewhere. They follow the
    /// others in `speeds`, one list a round. An end of the range is not refined, and no sweep up or down. Default: true
    /// from 20 speeds on; false for fewer, for a sweep up or down, and where a `budget` is to be kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refine: Option<bool>,
    /// Whether all speeds are computed on processors with one kind of vector instructions, that of the processor that begins, whichever machines take
    /// part: another kind may round differently. Speeds of a sweep up or down always are.
    #[serde(default, skip_serializing_if = "is_false")]
    pub reproducible: bool,
    /// Accuracy to reach, in place of the knobs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Budget of time to keep to, in place of the knobs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Number of speeds that are simulated again at a finer setting once all are finished, to estimate the error of every speed from; default: 5 with
    /// `accuracy`, `budget` or `limits`, otherwise 0. Fewer if the sweep has fewer; none in a sweep up or down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(maximum = 100))]
    pub control_speeds: Option<u32>,
    /// Recordings beside spectra.
    #[serde(default, skip_serializing_if = "Record::is_nothing")]
    pub record: Record,
    /// Whether the rows of the reduction's basis at all nodes are stored, from which modes, fields and stress are made: `true` reduces once more if
    /// they are not stored, `false` leaves them out where this job has to reduce, which saves their disk. Default: stored where this job has to
    /// reduce, if there is room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<bool>,
    /// Operation of the machine, by which the verdict says what lies inside its ranges of speed; without it the whole sweep is judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operation: Option<Operation>,
    /// Limits that the response must keep, by which the verdict is made; without any it is at best undecided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<Limits>,
    /// Thickness of the blade at its tip, in the model's unit of length, by which linear theory is checked in place of the mesh's: for models without
    /// elements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blade_thickness: Option<f64>,
}

/// State that each speed of a sweep starts from. A response with several branches shows the one that it is led along.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SweepDirection {
    /// Rest, or the state that the scene says; speeds are computed side by side.
    #[default]
    Independent,
    /// End of the next slower speed; one speed is computed after the other.
    Up,
    /// End of the next faster speed; one speed is computed after the other.
    Down,
}

impl SweepDirection {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
    fn is_independent(&self) -> bool {
        *self == Self::Independent
    }

    /// Order in which `speeds_rad_s`, given by index, follow each other; none if each is on its own. Equal ones follow in the order given.
    pub fn chain(self, speeds_rad_s: &[f64]) -> Option<Vec<u32>> {
        let speed = |index: &u32| speeds_rad_s[*index as usize];
        let mut order: Vec<u32> = (0..speeds_rad_s.len() as u32).collect();
        match self {
            Self::Independent => return None,
            Self::Up => order.sort_by(|a, b| speed(a).total_cmp(&speed(b))),
            Self::Down => order.sort_by(|a, b| speed(b).total_cmp(&speed(a))),
        }
        Some(order)
    }
}

pub(crate) fn default_max_engine_order() -> u32 {
    24
}

/// Default of `peak_prominence`: tenths of the largest peak are what a designer looks at.
pub(crate) fn default_peak_prominence() -> f64 {
    0.1
}
