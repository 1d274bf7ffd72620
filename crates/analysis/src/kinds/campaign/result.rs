//! Result and plan of a campaign.

use serde::{Deserialize, Serialize};

use crate::request::{CampaignSettings, Severity};
use crate::result::plan::{Estimate, ReductionState, Spent, SweepPlan};
use crate::result::stress::stress_unit;
use rubmap_wheel::dynamics::sector::Units;

/// Result of a campaign as far as it has come: all designs, and what they say together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Campaign {
    /// Speeds of every design, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Outcome of every design, in the order of `settings.designs`.
    pub designs: Vec<CampaignDesign>,
    /// Share of the variance of the severity that each parameter accounts for; with a design of kind `indices`, once three blocks are complete.
    /// Absent where nothing varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<Sensitivities>,
    /// Value of a parameter from which on the limit is met with the probability asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<CampaignThreshold>,
    /// Difference between the severities with the model that is compared and with that of the campaign.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comparison: Option<Comparison>,
    /// Expected cost of the designs of `design`; absent before they are queued.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// Cost of the finished simulations.
    pub spent: Spent,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: CampaignSettings,
    /// Version of the code.
    pub version: String,
}

/// One design of a campaign and its outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignDesign {
    /// Index of the design.
    pub index: u32,
    /// Values of the parameters in this design.
    pub values: Vec<f64>,
    /// Outcome of the design with the model of the campaign.
    #[serde(flatten)]
    pub outcome: DesignOutcome,
    /// Outcome of the design with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<DesignOutcome>,
}

/// Outcome of a design over its speeds, with one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct DesignOutcome {
    /// Number of speeds that are finished, however they ended.
    pub finished: u32,
    /// Number of finished speeds that diverged.
    pub diverged: u32,
    /// Number of finished speeds that could not be integrated.
    pub failed: u32,
    /// Number of finished speeds whose motion had not settled at the end of their revolutions, so that its final level is unknown.
    #[serde(default)]
    pub not_settled: u32,
    /// Reason for which one of the failed speeds failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Severity by speed; null where it is not known.
    pub by_speed: Vec<Option<f64>>,
    /// Largest severity of all speeds, once the severity of every speed is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub severity: Option<f64>,
    /// Speed of the largest severity, rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_speed_rad_s: Option<f64>,
    /// Whether the design meets the limit, as soon as that is known: it does not if the limit is exceeded at one speed, or one speed diverged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meets_limit: Option<bool>,
}

/// Share of the variance of the severity that each parameter accounts for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Sensitivities {
    /// Mean of the severity.
    pub mean: f64,
    /// Variance of the severity.
    pub variance: f64,
    /// Number of blocks of designs that the indices rest on: those of which every severity is known.
    pub blocks: u32,
    /// Indices of every parameter.
    pub parameters: Vec<ParameterSensitivity>,
}

/// Sobol's indices of one parameter with their standard errors, from the jackknife over blocks. The errors assume independent blocks; with Sobol
/// points they tend to be smaller. Estimates may be a little below 0 or above 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ParameterSensitivity {
    /// Name of the parameter.
    pub parameter: String,
    /// First-order index: share of the variance that would vanish, on average, if the parameter were known.
    pub first_order: f64,
    /// Standard error of `first_order`.
    pub first_order_error: f64,
    /// Total index: share of the variance that would remain, on average, if all other parameters were known: what this one does alone and with
    /// others.
    pub total: f64,
    /// Standard error of `total`.
    pub total_error: f64,
}

/// Value of a parameter from which on the limit is met with a probability, whatever the other parameters are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignThreshold {
    /// Name of the parameter.
    pub parameter: String,
    /// Probability with which the limit is met.
    pub probability: f64,
    /// Value of the parameter at which the limit is met with `probability`; absent where the designs do not determine it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Lower end of the interval in which the true value lies with a confidence of 95 %, two-sided; absent where the designs do not bound it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Upper end of the interval in which the true value lies with a confidence of 95 %, two-sided; absent where the designs do not bound it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Mean of the thresholds of single designs, at which half of the designs meet the limit; absent where the designs that meet it and those that do
    /// not lie apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Standard deviation of the thresholds of single designs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_deviation: Option<f64>,
    /// Whether `value` is known as well as was asked for; absent if nothing was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub met_within: Option<bool>,
    /// Number of designs of which it is known whether they meet the limit.
    pub decided: u32,
    /// Shares of the designs that meet the limit, in up to ten groups of neighbouring designs, ascending in the parameter.
    pub shares: Vec<ThresholdShare>,
    /// Threshold in words.
    pub message: String,
}

/// Group of designs with neighbouring values of a parameter, and how many of them meet the limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ThresholdShare {
    /// Smallest value of the parameter in the group.
    pub from: f64,
    /// Largest value of the parameter in the group.
    pub to: f64,
    /// Number of designs in the group.
    pub designs: u32,
    /// Number of designs in the group that meet the limit.
    pub met: u32,
    /// Share of the group that meets the limit by the fitted curve; absent without a curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<f64>,
}

/// Difference between another model and that of the campaign: severity with the other model less severity with the campaign's, design by design.
/// Designs that depend on others, those added for a threshold and the mixed ones of `indices`, are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Comparison {
    /// Id of the model that is compared.
    pub model: String,
    /// Difference of the severities, the largest of all speeds each; absent until those of a design are known with both models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub severity: Option<Difference>,
    /// Difference of the severities at every speed; null where no design is known with both models.
    pub by_speed: Vec<Option<Difference>>,
    /// Numbers of designs that meet the limit with both models, one or neither, of those for which that is known with both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<LimitsMet>,
    /// Sensitivities with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<Sensitivities>,
    /// Threshold with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<CampaignThreshold>,
    /// Comparison in words.
    pub message: String,
}

/// Mean difference of the pairs of severities of two models, and whether it is larger than its errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Difference {
    /// Number of designs that are known with both models.
    pub pairs: u32,
    /// Mean of the differences.
    pub mean: f64,
    /// Standard error of the mean difference; absent for a single pair.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// Lower end of the interval in which the mean over all designs that could have been drawn lies with a confidence of 95 %, two-sided (Student's
    /// t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Upper end of the interval in which the mean over all designs that could have been drawn lies with a confidence of 95 %, two-sided (Student's
    /// t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Best accuracy to which severities are known: `settled_to` of their mean, of both models together. A smaller difference cannot be distinguished
    /// from none.
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
    /// The model that is compared is less severe.
    Smaller,
    /// No difference is shown: the interval reaches to within the resolution of 0, or there is no interval.
    Undecided,
}

/// Numbers of designs that meet the limit, by the model with which they meet it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LimitsMet {
    /// Number of designs that meet the limit with both models.
    pub both: u32,
    /// Number of designs that meet the limit only with the model of the campaign.
    pub only_model: u32,
    /// Number of designs that meet the limit only with the model that is compared.
    pub only_compared: u32,
    /// Number of designs that meet the limit with neither model.
    pub neither: u32,
}

/// Plan of a campaign: what it will simulate, and the cost of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CampaignPlan {
    /// Number of designs of `design`.
    pub designs: u32,
    /// Largest number of designs, with those that are added to decide on a threshold.
    pub designs_at_most: u32,
    /// Number of simulations of `designs`: one for every design, model and speed.
    pub simulations: u32,
    /// Whether the reduction that all simulations rest on is stored.
    pub reduction: ReductionState,
    /// Cost of `simulations`, each as expensive as that of the scene before anything is changed; absent until all reductions are stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    /// Plan of the scene before anything is changed.
    pub scene: SweepPlan,
    /// Plan of the scene before anything is changed, with the model that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<SweepPlan>,
    /// The whole request as resolved, with the values of all designs.
    pub settings: CampaignSettings,
}

impl DesignOutcome {
    /// Whether all speeds of the design are finished and known. Of other designs it can only be known that they exceed the limit: counting them would
    /// favour designs that do.
    pub(crate) fn is_complete(&self) -> bool {
        self.finished as usize == self.by_speed.len() && self.failed + self.not_settled == 0
    }
}

impl Campaign {
    /// Outcomes of all designs with the model that is compared; empty where no model is compared.
    pub fn compared(&self) -> Vec<&DesignOutcome> {
        self.designs.iter().filter_map(|design| design.compared.as_ref()).collect()
    }

    /// Map of a parameter over speed: its values in ascending order, each with the largest severity by speed of the designs that have it. None at a
    /// speed where nothing is known.
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

/// Name of the column of severities in tables: which severity, and in which unit.
pub fn severity_column(severity: Severity, units: &Units) -> String {
    let unit = severity_unit(severity, units);
    if unit.is_empty() { severity.as_str().to_owned() } else { format!("{}_{unit}", severity.as_str()) }
}

/// Unit of a severity, for a model with these units; empty for a ratio.
pub fn severity_unit(severity: Severity, units: &Units) -> String {
    match severity {
        Severity::Amplitude | Severity::Tip | Severity::Wear => units.length.clone(),
        Severity::ContactForce => units.force.clone(),
        Severity::Stress => stress_unit(units),
        Severity::Utilisation => String::new(),
    }
}
