//! Comparison of two models: paired differences of designs that were simulated with both.

use super::sensitivities::sensitivities;
use super::threshold::{CONFIDENCE, threshold};
use crate::digits::short;
use crate::request::DesignKind;
use crate::resolved::ResolvedCampaign;
use crate::result::{CampaignDesign, Comparison, DesignOutcome, Difference, DifferenceVerdict, LimitsMet};
use rubmap_numerics::paired_difference::{MeanError, paired_difference};
use rubmap_numerics::sensitivity_indices;

/// Comparison with the other model; none where no model is compared.
pub(super) fn comparison(asked: &ResolvedCampaign, designs: &[CampaignDesign]) -> Option<Comparison> {
    let model = asked.compared_model()?.to_owned();
    let others: Vec<&DesignOutcome> = designs.iter().filter_map(|design| design.compared.as_ref()).collect();
    let pairs: Vec<(&DesignOutcome, &DesignOutcome)> = independent(asked, designs)
        .filter_map(|design| Some((&design.outcome, design.compared.as_ref()?)))
        .collect();
    let settled_to = asked.sweep.integration.settled_to;
    let of = |number: &dyn Fn(&DesignOutcome) -> Option<f64>| {
        let both = |&(one, other): &(&DesignOutcome, &DesignOutcome)| Some((number(one)?, number(other)?));
        let both: Vec<(f64, f64)> = pairs.iter().filter_map(both).collect();
        difference(&both, settled_to)
    };
    let speeds = 0..asked.sweep.speeds.rad_s().len();
    let severity = of(&|outcome| outcome.severity);
    Some(Comparison {
        model,
        severity,
        by_speed: speeds.map(|speed| of(&|outcome| outcome.by_speed[speed])).collect(),
        limit: asked.settings.limit.map(|_| limits_met(&pairs)),
        sensitivities: sensitivities(asked, &others),
        threshold: threshold(asked, &others),
        message: words(severity.as_ref(), designs.len() - asked.settings.added as usize),
    })
}

/// Independent designs: without those added where results asked for them and those mixed of two others.
fn independent<'a>(
    asked: &ResolvedCampaign,
    designs: &'a [CampaignDesign],
) -> impl Iterator<Item = &'a CampaignDesign> {
    let laid_out = designs.len() - asked.settings.added as usize;
    let block = match asked.settings.design.kind {
        DesignKind::Indices => sensitivity_indices::block_len(asked.settings.parameters.len()),
        _ => 1,
    };
    let alone = move |place: usize| place.is_multiple_of(block) || (place + 1).is_multiple_of(block);
    designs[..laid_out].iter().enumerate().filter(move |(place, _)| alone(*place)).map(|(_, design)| design)
}

/// Mean difference of `pairs` of severities, the second less the first.
fn difference(pairs: &[(f64, f64)], settled_to: f64) -> Option<Difference> {
    let differences: Vec<f64> = pairs.iter().map(|(one, other)| other - one).collect();
    let found = paired_difference(&differences, CONFIDENCE)?;
    let sizes: f64 = pairs.iter().map(|(one, other)| one.abs() + other.abs()).sum();
    let resolution = settled_to * sizes / found.pairs as f64;
    let verdict = match found.error {
        Some(MeanError { interval: (from, _), .. }) if from > resolution => DifferenceVerdict::Greater,
        Some(MeanError { interval: (_, to), .. }) if to < -resolution => DifferenceVerdict::Smaller,
        _ => DifferenceVerdict::Undecided,
    };
    Some(Difference {
        pairs: found.pairs as u32,
        mean: found.mean,
        standard_error: found.error.map(|error| error.standard),
        from: found.error.map(|error| error.interval.0),
        to: found.error.map(|error| error.interval.1),
        resolution,
        verdict,
    })
}

fn limits_met(pairs: &[(&DesignOutcome, &DesignOutcome)]) -> LimitsMet {
    let mut met = LimitsMet::default();
    for (one, other) in pairs.iter().filter(|(one, other)| one.is_complete() && other.is_complete()) {
        match (one.meets_limit, other.meets_limit) {
            (Some(true), Some(true)) => met.both += 1,
            (Some(true), Some(false)) => met.only_model += 1,
            (Some(false), Some(true)) => met.only_compared += 1,
            (Some(false), Some(false)) => met.neither += 1,
            (None, _) | (_, None) => {}
        }
    }
    met
}

fn words(of: Option<&Difference>, laid_out: usize) -> String {
    let Some(&Difference { pairs, mean, from, to, resolution, verdict, .. }) = of else {
        return "no design is known with both models".to_owned();
    };
    let [mean, resolution] = [mean, resolution].map(short);
    let (Some(from), Some(to)) = (from.map(short), to.map(short)) else {
        return if laid_out == 1 {
            format!(
                "with the one design that there is, the difference is {mean}: let a number vary, such as a seed of mistuning, to learn \
                 whether it is more than chance"
            )
        } else {
            format!("with the one design that is known with both models so far, the difference is {mean}")
        };
    };
    let percent = 100.0 * CONFIDENCE;
    let known = format!("{mean}, between {from} and {to} with a confidence of {percent} % ({pairs} pairs)");
    match verdict {
        DifferenceVerdict::Greater => format!("the model that is compared is more severe, by {known}"),
        DifferenceVerdict::Smaller => format!("the model that is compared is less severe: {known}"),
        DifferenceVerdict::Undecided => format!(
            "the models do not differ by more than the errors of the difference, which is {known}; severities are known to {resolution}"
        ),
    }
}
