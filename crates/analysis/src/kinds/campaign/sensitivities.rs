//! Sensitivity indices: share of the variance of the severity that each parameter accounts for.

use crate::request::DesignKind;
use crate::resolved::ResolvedCampaign;
use crate::result::{DesignOutcome, ParameterSensitivity, Sensitivities};
use rubmap_numerics::sensitivity_indices::{self, Indices};

/// Sensitivity indices from the outcomes of designs with one model; none for designs that are not laid out for them.
pub(super) fn sensitivities(asked: &ResolvedCampaign, outcomes: &[&DesignOutcome]) -> Option<Sensitivities> {
    if asked.settings.design.kind != DesignKind::Indices {
        return None;
    }
    let parameters = &asked.settings.parameters;
    let blocks = asked.settings.design.size.unwrap_or(0) as usize;
    // Added designs belong to no block.
    let first = &outcomes[..blocks * sensitivity_indices::block_len(parameters.len())];
    let severities: Vec<Option<f64>> = first.iter().map(|outcome| outcome.severity).collect();
    let found = sensitivity_indices::decompose(&severities, parameters.len())?;
    let named = |(name, Indices { first_order, total }): (String, &Indices)| ParameterSensitivity {
        parameter: name,
        first_order: first_order.value,
        first_order_error: first_order.standard_error,
        total: total.value,
        total_error: total.standard_error,
    };
    let names = parameters.iter().map(|parameter| parameter.name.clone());
    Some(Sensitivities {
        mean: found.mean,
        variance: found.variance,
        blocks: found.blocks as u32,
        parameters: names.zip(&found.inputs).map(named).collect(),
    })
}
