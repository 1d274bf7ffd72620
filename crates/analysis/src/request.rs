//! What a user asks for: a sweep of contact simulations or a modal analysis, and what makes a request sound.

use serde::{Deserialize, Serialize};

use super::auto_or::AutoOr;
use super::scene::{Scene, is_false};
use super::speeds::Speeds;

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
    /// Where the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 64))]
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
    /// Where each speed starts from.
    #[serde(default, skip_serializing_if = "SweepDirection::is_independent")]
    pub sweep: SweepDirection,
    /// Whether speeds are added around critical speeds, of any sensor, until the response on both sides of every peak is
    /// resolved: when all speeds are finished, the intervals beside a peak that is not `resolved` are halved, again and
    /// again. At most as many speeds are added as were asked for, or 50 if those were fewer. They follow the others in
    /// `speeds`, one list a round. An end of the range is not refined, and no sweep up or down.
    #[serde(default, skip_serializing_if = "is_false")]
    pub refine: bool,
    /// An accuracy to reach in place of the knobs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// A time to keep in place of the knobs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// How many speeds are simulated again at a finer setting once all are finished, to estimate the error of every speed from;
    /// default: 5 with `accuracy` or `budget`, otherwise 0. Fewer if the sweep has fewer; none of a sweep up or down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(maximum = 100))]
    pub control_speeds: Option<u32>,
}

impl SweepRequest {
    /// k of a resolved request.
    pub fn modes(&self) -> u32 {
        self.modes_per_speed.or(DEFAULT_MODES_PER_SPEED)
    }

    /// Whether pilot runs choose the knobs.
    pub fn chooses(&self) -> bool {
        self.accuracy.is_some() || self.budget.is_some()
    }

    /// Whether they have still to do so.
    pub fn unchosen(&self) -> bool {
        self.chooses() && self.modes_per_speed == AutoOr::Auto
    }

    /// Speeds that are simulated again.
    pub fn controls(&self) -> usize {
        let wanted = self.chooses() && self.sweep == SweepDirection::Independent;
        self.control_speeds.map_or(if wanted { DEFAULT_CONTROL_SPEEDS } else { 0 }, |n| n as usize)
    }
}

/// An accuracy to reach.
///
/// Of a sweep: the error of the steady response at the pilot speeds, that is the largest over the sensors of the error of its root
/// mean square and, where trajectories can be compared, of the error of its lines at integer engine orders (root of the sum of
/// squares), both relative to the largest sensor's. Of a modal analysis: the largest relative error of the ten lowest natural
/// frequencies of any nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// Relative error.
    #[cfg_attr(feature = "schema", schema(minimum = 1e-9, maximum = 0.5))]
    pub target: f64,
}

/// A time to keep.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Wall time of the whole job on an otherwise idle machine, s: reductions that are not stored, pilot runs, all speeds and
    /// those that are simulated again.
    #[cfg_attr(feature = "schema", schema(minimum = 1.0, maximum = 1e7))]
    pub seconds: f64,
}

/// Where each speed of a sweep starts from. A response with several branches shows the one that it is led along.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SweepDirection {
    /// From rest, or what the scene says; speeds are computed side by side.
    #[default]
    Independent,
    /// From the end of the next slower speed; one speed is computed after the other.
    Up,
    /// From the end of the next faster speed; one speed is computed after the other.
    Down,
}

impl SweepDirection {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
    fn is_independent(&self) -> bool {
        *self == Self::Independent
    }

    /// In which order `speeds_rad_s`, given by index, follow each other; none if each is on its own. Equal ones follow in the
    /// order given.
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

/// Natural frequencies over speed and the linear interaction criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ModalAnalysisRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter. `"auto"` is what `accuracy` or `budget` chooses, without
    /// them 20.
    #[serde(default)]
    pub modes_per_speed: AutoOr,
    /// Modal families (frequencies per nodal diameter) to report.
    #[serde(default = "default_families")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub families: u32,
    /// Superharmonic numbers n of the linear criterion f = i·n·Ω/2π.
    #[serde(default = "default_superharmonics")]
    #[cfg_attr(feature = "schema", schema(max_items = 16))]
    pub superharmonics: Vec<u32>,
    /// Lobe count of the casing that can drive the wheel.
    #[serde(default = "default_lobes")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub lobes: u32,
    /// Highest engine order of the driven crossings.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
    /// Coriolis forces through the package's gyroscopic matrix: the frequencies of waves that travel with and against the
    /// rotation, which then cross engine orders in their place.
    #[serde(default, skip_serializing_if = "is_false")]
    pub coriolis: bool,
    /// Speeds of the Campbell diagram: every range and list ascends, several are merged.
    pub speeds: Speeds,
    /// An accuracy to reach in place of `modes_per_speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// A time to keep in place of `modes_per_speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
}

impl ModalAnalysisRequest {
    /// k of a resolved request.
    pub fn modes(&self) -> u32 {
        self.modes_per_speed.or(DEFAULT_MODES_PER_SPEED)
    }

    /// Whether the reductions themselves choose `modes_per_speed`.
    pub(super) fn chooses(&self) -> bool {
        self.accuracy.is_some() || self.budget.is_some()
    }

    /// Whether they have still to do so.
    pub fn unchosen(&self) -> bool {
        self.chooses() && self.modes_per_speed == AutoOr::Auto
    }
}

/// k where nobody says otherwise.
pub(super) const DEFAULT_MODES_PER_SPEED: u32 = 20;

/// Control runs where the service chooses the knobs.
const DEFAULT_CONTROL_SPEEDS: usize = 5;

fn default_max_engine_order() -> u32 {
    24
}

/// Tenths of the largest peak are what a designer looks at.
pub(super) fn default_peak_prominence() -> f64 {
    0.1
}

fn default_families() -> u32 {
    2
}

fn default_superharmonics() -> Vec<u32> {
    vec![1, 2, 3]
}

fn default_lobes() -> u32 {
    2
}

/// Settings of the time integration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// How time is stepped.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, or `"auto"` for as many as the step carries.
    pub kept_modes: AutoOr,
    /// Time steps per revolution, or `"auto"` for a safe number at each speed.
    pub steps_per_revolution: AutoOr,
    /// Revolutions to simulate.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub revolutions: u32,
    /// Revolutions over which the restriction grows from zero to its full height.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub ramp_revolutions: f64,
    /// Revolutions at the end of the run that spectra are computed from.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub window_revolutions: u32,
}

impl Default for Integration {
    fn default() -> Self {
        Self {
            scheme: SchemeChoice::Auto,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: AutoOr::Auto,
            revolutions: 50,
            ramp_revolutions: 1.0,
            window_revolutions: 20,
        }
    }
}

/// How time is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum SchemeChoice {
    /// Chosen at each speed, with the step; the result says what and why.
    Auto,
    /// The paper's central differences (Eqs 8–10); the stiffest mode bounds the step.
    CentralDifferences,
    /// The exact propagator of every mode; the contact sets the step.
    ExactModal,
    /// The lowest modes carry the mass, the boundary follows statically; nothing is lost at a closing.
    MasslessBoundary,
}

impl SchemeChoice {
    /// The word on the wire.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::CentralDifferences => "central_differences",
            Self::ExactModal => "exact_modal",
            Self::MasslessBoundary => "massless_boundary",
        }
    }
}

/// A displacement recorded during a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Contact node, counted from the leading edge from 0.
    pub contact_node: u32,
    /// Sector, counted from 0.
    #[serde(default)]
    pub sector: u32,
    /// Displacement component.
    pub component: Component,
}

/// Displacement component at a contact node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Component {
    /// Outward from the axis.
    Radial,
    /// Towards +θ, the direction of rotation.
    Tangential,
    /// Along the axis.
    Axial,
    /// Along the node's outward contact normal.
    Normal,
}
