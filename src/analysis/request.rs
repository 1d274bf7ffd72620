//! What a user asks for: a sweep of contact simulations or a modal analysis, and what makes a request sound.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::auto_or::AutoOr;
use super::error::Violation;
use super::scene::Scene;

/// A sweep of contact simulations over rotational speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepRequest {
    /// Id of an uploaded model.
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter: the accuracy dial k.
    #[serde(default = "default_modes_per_speed")]
    #[schema(minimum = 1, maximum = 500)]
    pub modes_per_speed: u32,
    /// Speeds to simulate.
    pub speeds: Speeds,
    /// Effects of the simulation.
    pub scene: Scene,
    /// Time integration.
    #[serde(default)]
    pub integration: Integration,
    /// Where the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    pub sensors: Vec<Sensor>,
    /// Highest engine order of spectra and map.
    #[serde(default = "default_max_engine_order")]
    pub max_engine_order: u32,
}

/// Natural frequencies over speed and the linear interaction criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ModalAnalysisRequest {
    /// Id of an uploaded model.
    pub model: String,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    #[serde(default = "default_modes_per_speed")]
    #[schema(minimum = 1, maximum = 500)]
    pub modes_per_speed: u32,
    /// Modal families (frequencies per nodal diameter) to report.
    #[serde(default = "default_families")]
    pub families: u32,
    /// Superharmonic numbers n of the linear criterion f = i·n·Ω/2π.
    #[serde(default = "default_superharmonics")]
    pub superharmonics: Vec<u32>,
    /// Lobe count of the casing that can drive the wheel.
    #[serde(default = "default_lobes")]
    pub lobes: u32,
    /// Highest engine order of the driven crossings.
    #[serde(default = "default_max_engine_order")]
    pub max_engine_order: u32,
    /// Speeds of the Campbell diagram, in ascending order.
    pub speeds: Speeds,
}

fn default_modes_per_speed() -> u32 {
    20
}

fn default_max_engine_order() -> u32 {
    24
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

/// Rotational speeds: evenly spaced `from`–`to` with `count`, or a list of `values`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Speeds {
    /// First speed of the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last speed of the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Number of speeds in the range, both ends included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
    /// Explicit speeds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<f64>>,
    /// Unit of the numbers above.
    pub unit: SpeedUnit,
}

/// Unit of a rotational speed on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpeedUnit {
    /// Radians per second.
    RadS,
    /// Revolutions per minute.
    Rpm,
    /// Revolutions per second.
    Hz,
}

impl SpeedUnit {
    fn rad_s(self) -> f64 {
        use std::f64::consts::TAU;
        match self {
            Self::RadS => 1.0,
            Self::Rpm => TAU / 60.0,
            Self::Hz => TAU,
        }
    }
}

/// Speeds beyond this, in rad/s, are typing errors.
pub const HIGHEST_SPEED: f64 = 1e7;

/// Largest number of speeds in one job.
pub const MAX_SPEEDS: usize = 10_000;

impl Speeds {
    /// The speeds in rad/s, in the order given.
    pub fn resolve(&self) -> Result<Vec<f64>, Vec<Violation>> {
        let at = |field: &str, message: &str| vec![Violation::new(format!("/speeds{field}"), message)];
        let speeds = match (&self.values, self.from, self.to, self.count) {
            (Some(values), None, None, None) => values.clone(),
            (None, Some(from), Some(to), Some(count)) => match count {
                0 => return Err(at("/count", "at least one speed is needed")),
                1 if from != to => {
                    return Err(at("/count", "one speed cannot span from and to; give count ≥ 2"));
                }
                1 => vec![from],
                _ if count as usize > MAX_SPEEDS => {
                    return Err(at("/count", &format!("at most {MAX_SPEEDS} speeds in one job")));
                }
                _ => {
                    let last = f64::from(count - 1);
                    (0..count).map(|i| from + (to - from) * (f64::from(i) / last)).collect()
                }
            },
            _ => return Err(at("", "give either `from`, `to` and `count`, or `values`")),
        };
        if speeds.is_empty() {
            return Err(at("/values", "at least one speed is needed"));
        }
        if speeds.len() > MAX_SPEEDS {
            return Err(at("/values", &format!("at most {MAX_SPEEDS} speeds in one job")));
        }
        let in_rad_s: Vec<f64> = speeds.iter().map(|v| v * self.unit.rad_s()).collect();
        match in_rad_s.iter().position(|speed| !(0.0..=HIGHEST_SPEED).contains(speed)) {
            Some(bad) => {
                let field = if self.values.is_some() { format!("/values/{bad}") } else { String::new() };
                let message =
                    format!("a speed lies between 0 and {HIGHEST_SPEED:e} rad/s, unlike {}", speeds[bad]);
                Err(at(&field, &message))
            }
            None => Ok(in_rad_s),
        }
    }
}

/// Settings of the time integration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// How time is stepped.
    pub scheme: SchemeChoice,
    /// Modes per nodal diameter that `massless_boundary` integrates, or `"auto"` for as many as the step carries.
    pub kept_modes: AutoOr,
    /// Time steps per revolution, or `"auto"` for a safe number at each speed.
    pub steps_per_revolution: AutoOr,
    /// Revolutions to simulate.
    pub revolutions: u32,
    /// Revolutions over which the restriction grows from zero to its full height.
    pub ramp_revolutions: f64,
    /// Revolutions at the end of the run that spectra are computed from.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
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

/// A displacement recorded during a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
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
