//! Request of a fit, as users write it.

use std::collections::BTreeMap;

use rubmap_model::impeller::ImpellerRequest;
use serde::{Deserialize, Serialize};

use crate::error::FitError;

/// Request of a fit: a generated wheel, the parameters that may vary, and the frequencies that the wheel is to have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitRequest {
    /// Wheel as `rubmap generate --parameters` reads it: its values are the first starting point, and hold for all parameters that do not
    /// vary.
    #[serde(default)]
    pub wheel: ImpellerRequest,
    /// Lower and upper bound of every parameter that varies, by name, such as `rim_thickness` or `material.youngs_modulus`.
    pub vary: BTreeMap<String, [f64; 2]>,
    /// Unit of the targets.
    pub unit: Unit,
    /// Frequencies that the wheel is to have.
    pub targets: Vec<Target>,
    /// Number of starting points, 1 to 1000: the wheel's own values, then the best of the candidates.
    #[serde(default = "default_starts")]
    pub starts: usize,
    /// Number of candidates among which the starting points are chosen, at least `starts` and at most 1000: the wheel's own values and points of
    /// Sobol's sequence in the bounds.
    #[serde(default = "default_candidates")]
    pub candidates: usize,
    /// Seed of Sobol's sequence.
    #[serde(default)]
    pub seed: u32,
    /// Largest number of iterations of a search from one starting point, 1 to 1000.
    #[serde(default = "default_iterations")]
    pub iterations: usize,
    /// Relative difference up to which a target counts as met; twice its `error` unless given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

/// Unit of targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Frequencies in Hz, speeds in revolutions per minute.
    HzAndRpm,
    /// Frequencies and speeds in one common unknown unit, speeds in revolutions: f = nΩ where engine order n excites the mode. The size of the
    /// unit in Hz is fitted too.
    Free,
}

/// Natural frequency at a speed, in the rotating frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Nodal diameter, 0 to half of the number of sectors.
    pub nodal_diameter: usize,
    /// Family, from 1: rank of the mode in its nodal diameter at rest, followed from there to the target's speed by its shape.
    pub family: usize,
    /// Speed of rotation in the unit of the request, 0 or more.
    pub speed: f64,
    /// Natural frequency in the unit of the request, above 0.
    pub frequency: f64,
    /// Relative standard error of the frequency, above 0: the weight of the target is its inverse squared.
    #[serde(default = "default_error")]
    pub error: f64,
}

fn default_starts() -> usize {
    4
}

fn default_candidates() -> usize {
    16
}

fn default_iterations() -> usize {
    50
}

fn default_error() -> f64 {
    0.01
}

impl FitRequest {
    /// Reads a request from JSON.
    ///
    /// # Errors
    /// [`FitError::Syntax`] with the path of the field at fault.
    pub fn from_json(text: &str) -> Result<Self, FitError> {
        let reader = &mut serde_json::Deserializer::from_str(text);
        serde_path_to_error::deserialize(reader).map_err(|error| FitError::Syntax {
            field: Some(error.path().to_string()).filter(|path| path != ".").unwrap_or("request".to_owned()),
            message: error.inner().to_string(),
        })
    }
}
