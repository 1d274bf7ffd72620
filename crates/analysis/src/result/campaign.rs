//! What a campaign says.

use serde::{Deserialize, Serialize};

use crate::request::{CampaignSettings, Severity};
use crate::result::plan::{Estimate, ReductionState, Spent, SweepPlan};
use crate::result::stress::stress_unit;
use rubmap_wheel::dynamics::sector::Units;

/// All designs of a campaign and what they say together, as far as it has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Campaign {
    /// Speeds of every design, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// One per design, in the order of `settings.designs`.
    pub designs: Vec<CampaignDesign>,
    /// How much of the variance of the severity each parameter accounts for; of `indices`, once three blocks are complete. Absent where
    /// nothing varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<Sensitivities>,
    /// Where the limit is met with the probability asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<CampaignThreshold>,
    /// How the model that is compared differs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comparison: Option<Comparison>,
    /// What the designs of `design` were expected to cost; absent before they are queued.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// What the finished simulations have cost.
    pub spent: Spent,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: CampaignSettings,
    /// Version of the code.
    pub version: String,
}

/// One design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignDesign {
    /// Index of the design.
    pub index: u32,
    /// The values of its parameters.
    pub values: Vec<f64>,
    /// What the speeds of the model say of it.
    #[serde(flatten)]
    pub outcome: DesignOutcome,
    /// The same of the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<DesignOutcome>,
}

/// What the speeds of a design say, with one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct DesignOutcome {
    /// Speeds that are finished, however they ended.
    pub finished: u32,
    /// Those of them that diverged.
    pub diverged: u32,
    /// Those of them that could not be integrated.
    pub failed: u32,
    /// Those of them that had not settled at the end of their revolutions, so that nobody knows what they would come to.
    #[serde(default)]
    pub not_settled: u32,
    /// Why one of those that failed did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Severity by speed; null where it is not known.
    pub by_speed: Vec<Option<f64>>,
    /// The largest of them, once all are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub severity: Option<f64>,
    /// The speed where it is, rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_speed_rad_s: Option<f64>,
    /// Whether it meets the limit, as soon as that is known: not if it is exceeded at one speed, or one diverged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meets_limit: Option<bool>,
}

/// How much of the variance of the severity each parameter accounts for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Sensitivities {
    /// Mean of the severity.
    pub mean: f64,
    /// Its variance.
    pub variance: f64,
    /// Blocks of designs that they rest on: those of which every severity is known.
    pub blocks: u32,
    /// One per parameter.
    pub parameters: Vec<ParameterSensitivity>,
}

/// Sobol's indices of one parameter with their standard errors, from the jackknife over blocks. The errors take blocks for independent; with
/// Sobol points they tend to be smaller. Estimates may be a little below 0 or above 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ParameterSensitivity {
    /// Its name.
    pub parameter: String,
    /// Share of the variance that would be gone, on average, if the parameter were known.
    pub first_order: f64,
    /// Its standard error.
    pub first_order_error: f64,
    /// Share that would be left, on average, if all others were known: it alone and with others.
    pub total: f64,
    /// Its standard error.
    pub total_error: f64,
}

/// Where a parameter meets the limit with a probability, whatever the others are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignThreshold {
    /// The parameter.
    pub parameter: String,
    /// The probability.
    pub probability: f64,
    /// The value of the parameter; absent where designs tell none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// The true value is no less than this, with a confidence of 95 % both ways; absent where nothing bounds it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Nor more than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Mean of the thresholds of single designs, at which half of them meet the limit; absent where they lie apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Their standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_deviation: Option<f64>,
    /// Whether the value is known as well as was asked for, if that was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub met_within: Option<bool>,
    /// Designs of which it is known whether they meet the limit.
    pub decided: u32,
    /// Of up to ten groups of neighbouring designs how many meet the limit, ascending in the parameter.
    pub shares: Vec<ThresholdShare>,
    /// What it is, in words.
    pub message: String,
}

/// Neighbouring designs and how many of them meet the limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ThresholdShare {
    /// Smallest value of the parameter.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// So many designs.
    pub designs: u32,
    /// So many of them meet the limit.
    pub met: u32,
    /// Share that the fitted curve expects to; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<f64>,
}

/// How another model differs from that of the campaign: its severity less that of the campaign's model, design by design. Designs that lean on
/// others, those added for a threshold and the mixed ones of `indices`, are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Comparison {
    /// Id of the model that is compared.
    pub model: String,
    /// The difference of the severities, the largest of all speeds each; absent until those of a design are known with both models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub severity: Option<Difference>,
    /// The same at every speed; null where no design is known with both.
    pub by_speed: Vec<Option<Difference>>,
    /// Designs of which it is known with both models whether they meet the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<LimitsMet>,
    /// Sensitivities with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<Sensitivities>,
    /// Where the limit is met with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<CampaignThreshold>,
    /// What it comes to, in words.
    pub message: String,
}

/// Differences of pairs, and whether they are larger than their errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Difference {
    /// Designs that are known with both models.
    pub pairs: u32,
    /// Mean of the differences.
    pub mean: f64,
    /// Its standard error; of one pair there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// The mean over all designs that could have been drawn is no less than this, with a confidence of 95 % both ways (Student's t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Nor more than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// What severities are known to at best: `settled_to` of their mean, of both models together. No smaller difference is told from none.
    pub resolution: f64,
    /// Whether the difference is larger than its errors.
    pub verdict: DifferenceVerdict,
}

/// Whether a difference is larger than its errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum DifferenceVerdict {
    /// The model that is compared is more severe.
    Greater,
    /// It is less severe.
    Smaller,
    /// The interval reaches to within the resolution of 0, or there is none.
    Undecided,
}

/// How many designs meet the limit with which model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LimitsMet {
    /// With both.
    pub both: u32,
    /// Only with the model of the campaign.
    pub only_model: u32,
    /// Only with the model that is compared.
    pub only_compared: u32,
    /// With neither.
    pub neither: u32,
}

/// What a campaign will do and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignPlan {
    /// Designs of `design`.
    pub designs: u32,
    /// Designs there are at most, with those that are added to decide on a threshold.
    pub designs_at_most: u32,
    /// Simulations of `designs`: one for every design, model and speed.
    pub simulations: u32,
    /// Whether the reduction that all rest on is there.
    pub reduction: ReductionState,
    /// Cost of `simulations`, each as dear as that of the scene before anything is changed; absent until all reductions are stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// The plan of that scene.
    pub scene: SweepPlan,
    /// Its plan with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<SweepPlan>,
    /// The whole request as resolved, with the values of all designs.
    pub settings: CampaignSettings,
}

impl DesignOutcome {
    /// Whether all its speeds are finished and known. Of others only that they exceed a limit can be known, so that those would count that do.
    pub(crate) fn is_complete(&self) -> bool {
        self.finished as usize == self.by_speed.len() && self.failed + self.not_settled == 0
    }
}

impl Campaign {
    /// What the model that is compared says of all designs; nothing where there is none.
    pub fn compared(&self) -> Vec<&DesignOutcome> {
        self.designs.iter().filter_map(|design| design.compared.as_ref()).collect()
    }

    /// The map of a parameter over speed: its values in ascending order, each with the largest severity by speed of the designs that have
    /// it. None of a speed where nothing is known.
    pub fn map(&self, parameter: usize) -> Vec<(f64, Vec<Option<f64>>)> {
        let value = |design: &&CampaignDesign| design.values.get(parameter).copied().unwrap_or(f64::NAN);
        let mut designs: Vec<&CampaignDesign> = self.designs.iter().collect();
        designs.sort_by(|a, b| value(a).total_cmp(&value(b)));
        let alike = designs.chunk_by(|a, b| value(a) == value(b));
        let worst = |designs: &[&CampaignDesign], speed: usize| {
            designs.iter().filter_map(|design| design.outcome.by_speed[speed]).max_by(f64::total_cmp)
        };
        let speeds = self.speeds_rad_s.len();
        alike
            .map(|designs| (value(&designs[0]), (0..speeds).map(|speed| worst(designs, speed)).collect()))
            .collect()
    }
}

/// The column of severities in tables: what they are and in what unit.
pub fn severity_column(severity: Severity, units: &Units) -> String {
    let unit = severity_unit(severity, units);
    if unit.is_empty() { severity.as_str().to_owned() } else { format!("{}_{unit}", severity.as_str()) }
}

/// What a severity is measured in, of a model with these units; empty for a ratio.
pub fn severity_unit(severity: Severity, units: &Units) -> String {
    match severity {
        Severity::Amplitude | Severity::Tip | Severity::Wear => units.length.clone(),
        Severity::ContactForce => units.force.clone(),
        Severity::Stress => stress_unit(units),
        Severity::Utilisation => String::new(),
    }
}
