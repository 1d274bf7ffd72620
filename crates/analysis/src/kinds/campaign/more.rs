//! Designs that a campaign adds: points go where the answer is undecided.

use super::designs::added;
use super::outcomes::designs_of;
use super::threshold::{answer, cases};
use crate::resolved::{Distribution, ResolvedCampaign};
use crate::result::Point;

/// Extends the campaign by a batch of designs, from the `points` of all simulations; none where its threshold is as accurate as was asked
/// for, where nothing tells where it lies, and where no more designs are allowed.
///
/// The parameter of the threshold takes values evenly spaced over the interval in which the designs so far do not decide whether the limit
/// is met with the probability, within its range; if the first designs all lie on one side, one batch covers the whole range. The other
/// parameters continue along a Sobol sequence in their distributions. Each batch depends on nothing but the results before it. No batch
/// follows one without any complete design.
pub(crate) fn more_designs(campaign: &ResolvedCampaign, points: &[Point]) -> Option<ResolvedCampaign> {
    let (threshold, within) = campaign.settings.sought()?;
    let index = campaign.settings.parameter(&threshold.parameter)?;
    let distributions: Vec<&Distribution> = campaign.distributions.iter().flatten().collect();
    let designs = designs_of(campaign, points);
    let own: Vec<_> = designs.iter().map(|design| &design.outcome).collect();
    let found = answer(&cases(campaign, &own, index), threshold, campaign.varies_alone());
    let (from, to) = distributions.get(index)?.range();
    let is_first = campaign.settings.added == 0;
    let open = found.open.or(is_first.then_some((from, to)));
    let (low, high) = open.map(|(low, high)| (low.max(from), high.min(to)))?;
    let there_are = campaign.designs();
    let last = &own[there_are - (threshold.batch.min(campaign.settings.added) as usize)..];
    if found.is_crossed_again || !is_first && !last.iter().any(|outcome| outcome.is_complete()) {
        return None;
    }
    let count = (threshold.batch as usize).min((threshold.most_designs as usize).saturating_sub(there_are));
    if found.is_within(within) || high <= low || count == 0 {
        return None;
    }
    let seed = campaign.settings.design.seed.unwrap_or(0);
    let design = |place: usize| {
        let mut values = added(there_are + place, seed, &distributions);
        values[index] = low + (high - low) * (place as f64 + 0.5) / count as f64;
        values
    };
    Some(campaign.with_designs((0..count).map(design).collect()))
}
