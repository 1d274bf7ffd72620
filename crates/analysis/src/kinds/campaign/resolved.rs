//! A campaign as it is stored and run.

use serde::Serialize;
use serde_json::Value;

use crate::error::Violation;
use crate::kinds::campaign::distribution::Distribution;
use crate::request::{CampaignSettings, Change, Parameter, SweepRequest, Threshold};
use crate::resolved::sweep::ResolvedSweep;

/// Campaign: a sweep of which numbers vary, and its designs; written as [`CampaignSettings`]. A simulation is one speed of one model of one design;
/// simulations are counted design by design, so that designs which are added change no index.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "CampaignSettings")]
pub struct ResolvedCampaign {
    /// Sweep that is run for every design, with the scene before anything is changed.
    pub(crate) sweep: ResolvedSweep,
    /// Sweep that is run for every design with the model that is compared.
    pub(crate) compared: Option<ResolvedSweep>,
    /// Distributions of the parameters, one each; none for a parameter that is only listed.
    pub(crate) distributions: Vec<Option<Distribution>>,
    /// Settings as they were asked for. The scene is as it was written: pointers into it are those of the request.
    pub(crate) settings: CampaignSettings,
}

impl ResolvedCampaign {
    /// Reads a campaign that was resolved and stored before.
    ///
    /// # Errors
    /// Violations, if the campaign was never resolved.
    pub fn stored(settings: CampaignSettings) -> Result<Self, Vec<Violation>> {
        let sweep = ResolvedSweep::stored(settings.sweep.clone(), 0)?;
        let compared = settings.compared.clone().map(|sweep| ResolvedSweep::stored(sweep, 0)).transpose()?;
        let distributions = settings.parameters.iter().map(Distribution::of).collect::<Result<_, _>>()?;
        Ok(Self { sweep, compared, distributions, settings })
    }

    /// Sweep that is run for every design, before anything is changed.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// Sweeps of all models, that of the model that is compared last.
    pub fn sweeps(&self) -> impl Iterator<Item = &ResolvedSweep> {
        std::iter::once(&self.sweep).chain(&self.compared)
    }

    /// Sweep with the model that is compared, if one is.
    pub fn compared(&self) -> Option<&ResolvedSweep> {
        self.compared.as_ref()
    }

    /// Id of the model that is compared, if one is.
    pub fn compared_model(&self) -> Option<&str> {
        self.compared().map(ResolvedSweep::model)
    }

    /// Number of designs.
    pub fn designs(&self) -> usize {
        self.settings.designs.len()
    }

    /// Number of simulations of a design: one for every model and speed.
    fn simulations_each(&self) -> u32 {
        self.sweeps().count() as u32 * self.sweep.speeds.count()
    }

    /// Number of simulations of all designs.
    pub fn simulations(&self) -> u32 {
        self.designs() as u32 * self.simulations_each()
    }

    /// Largest number of designs, with those that are added for a threshold.
    pub fn designs_at_most(&self) -> u32 {
        self.settings.designs_at_most()
    }

    /// Largest number of simulations, with those of designs that are added for a threshold.
    pub fn simulations_at_most(&self) -> u32 {
        self.designs_at_most().saturating_mul(self.simulations_each())
    }

    /// Design of simulation `index`, whether it is of the model that is compared, and the index of its speed.
    pub(crate) fn place(&self, index: u32) -> (usize, bool, u32) {
        let (design, rest) = (index / self.simulations_each(), index % self.simulations_each());
        let speeds = self.sweep.speeds.count();
        (design as usize, rest / speeds > 0, rest % speeds)
    }

    /// Simulation `index`: the sweep of its design, and the index of its speed there.
    ///
    /// # Errors
    /// Violations of a design, if it was never checked against its model.
    pub fn simulation(&self, index: u32) -> Result<(ResolvedSweep, u32), Vec<Violation>> {
        let (design, is_compared, speed) = self.place(index);
        let settings = &self.settings;
        let sweep = settings.compared.as_ref().filter(|_| is_compared).unwrap_or(&settings.sweep);
        let sweep = changed(written(sweep)?, &settings.parameters, &settings.designs[design])?;
        Ok((ResolvedSweep::stored(sweep, 0)?, speed))
    }

    /// Index of the parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.settings.parameter(name)
    }

    /// Whether one parameter is all that varies: then the same value always gives the same result.
    pub(crate) fn varies_alone(&self) -> bool {
        self.settings.parameters.len() == 1
    }

    /// Name of the parameter whose threshold is asked for.
    pub fn threshold_parameter(&self) -> Option<&str> {
        Some(&self.settings.threshold.as_ref()?.parameter)
    }

    /// Threshold that is asked for, with the index of its parameter.
    pub(crate) fn threshold(&self) -> Option<(&Threshold, usize)> {
        let threshold = self.settings.threshold.as_ref()?;
        Some((threshold, self.parameter(&threshold.parameter)?))
    }

    /// Campaign with more designs.
    pub(crate) fn with_designs(&self, more: Vec<Vec<f64>>) -> Self {
        let mut longer = self.clone();
        longer.settings.added += more.len() as u32;
        longer.settings.designs.extend(more);
        longer
    }
}

impl From<ResolvedCampaign> for CampaignSettings {
    fn from(campaign: ResolvedCampaign) -> Self {
        campaign.settings
    }
}

/// Writes a sweep as JSON, in which pointers lead to numbers.
pub(crate) fn written(sweep: &SweepRequest) -> Result<Value, Vec<Violation>> {
    serde_json::to_value(sweep).map_err(|error| vec![Violation::new("/scene", error.to_string())])
}

/// Puts these `values` of the parameters into the [`written`] `sweep`, each in its turn.
///
/// # Errors
/// Violation at the parameter that meets no number, or makes one that the field does not take.
pub(crate) fn changed(
    mut sweep: Value,
    parameters: &[Parameter],
    values: &[f64],
) -> Result<SweepRequest, Vec<Violation>> {
    let refused = |pointer: String, message: String| vec![Violation::new(pointer, message)];
    for (index, (parameter, &value)) in parameters.iter().zip(values).enumerate() {
        for (place, pointer) in parameter.at.iter().enumerate() {
            let number = sweep.pointer_mut(pointer).filter(|number| number.is_number());
            let Some(number) = number.filter(|_| pointer.starts_with("/scene/")) else {
                let message =
                    format!("the scene has no number at {pointer}: write one there, if only to be changed");
                return Err(refused(format!("/parameters/{index}/at/{place}"), message));
            };
            let before = number.as_f64().unwrap_or(f64::NAN);
            let after = match parameter.change {
                Change::Set => value,
                Change::Add => before + value,
                Change::Multiply => before * value,
            };
            *number = if number.is_f64() {
                Value::from(after)
            } else if after.fract() == 0.0 && (0.0..=(1u64 << 53) as f64).contains(&after) {
                Value::from(after as u64)
            } else {
                let message = format!(
                    "{pointer} is counted in whole numbers, and {after} is none: give the parameter \"distribution\": \"whole\""
                );
                return Err(refused(format!("/parameters/{index}"), message));
            };
        }
    }
    serde_json::from_value(sweep).map_err(|error| refused("/parameters".to_owned(), error.to_string()))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn settings(parameters: Value) -> CampaignSettings {
        let scene = json!({
            "damping": {"modal_ratio": 0.005}, "mistuning": {"spread": 0.01, "seed": 3},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.2}}
        });
        let sweep = json!({"model": "m", "scene": scene, "speeds": {"values": [1.0, 2.0], "unit": "hz"}});
        let settings = json!({
            "sweep": sweep, "parameters": parameters, "design": {"kind": "list"}, "severity": "amplitude", "designs": []
        });
        serde_json::from_value(settings).unwrap()
    }

    #[test]
    fn numbers_of_the_scene_are_changed_in_turn() {
        let settings = settings(json!([
            {"name": "clearance", "at": ["/scene/casing/clearance/leading", "/scene/casing/clearance/trailing"], "change": "add"},
            {"name": "leading", "at": ["/scene/casing/clearance/leading"], "change": "multiply"},
            {"name": "seed", "at": ["/scene/mistuning/seed"]},
        ]));
        let sweep = written(&settings.sweep).unwrap();
        let changed = |values: &[f64]| changed(sweep.clone(), &settings.parameters, values);
        let sweep = serde_json::to_value(changed(&[0.1, 2.0, 7.0]).unwrap()).unwrap();
        let at = |pointer: &str| sweep.pointer(pointer).unwrap();
        assert_eq!(at("/scene/casing/clearance/leading"), &json!(0.8));
        assert!((at("/scene/casing/clearance/trailing").as_f64().unwrap() - 0.3).abs() < 1e-15);
        assert_eq!(at("/scene/mistuning/seed"), &json!(7));
        let refused = changed(&[0.1, 2.0, 7.5]).unwrap_err();
        assert_eq!(refused[0].pointer, "/parameters/2");
    }

    #[test]
    fn only_numbers_of_the_scene_are_changed() {
        for pointer in ["/scene/casing", "/scene/friction/coefficient", "/max_engine_order", "scene", ""] {
            let settings = settings(json!([{"name": "p", "at": [pointer]}]));
            let sweep = written(&settings.sweep).unwrap();
            let refused = changed(sweep, &settings.parameters, &[1.0]).unwrap_err();
            assert_eq!(refused[0].pointer, "/parameters/0/at/0", "{pointer}");
        }
    }

    #[test]
    fn designs_that_are_added_change_no_index() {
        let parameters =
            json!([{"name": "damping", "at": ["/scene/damping/modal_ratio"], "from": 0.001, "to": 0.01}]);
        let campaign = ResolvedCampaign::stored(settings(parameters)).unwrap();
        let first = campaign.with_designs(vec![vec![0.001], vec![0.002]]);
        let longer = first.with_designs(vec![vec![0.003]]);
        assert_eq!((first.simulations(), longer.simulations()), (4, 6));
        for index in 0..4 {
            assert_eq!(first.simulation(index), longer.simulation(index));
        }
        let (sweep, speed) = longer.simulation(5).unwrap();
        assert_eq!((sweep.scene.damping.unwrap().modal_ratio, speed), (0.003, 1));
        let kept = serde_json::to_value(&longer).unwrap();
        assert_eq!(ResolvedCampaign::stored(serde_json::from_value(kept).unwrap()).unwrap(), longer);
    }
}
