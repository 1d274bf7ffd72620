//! Which designs a campaign lacks: points go where the answer is undecided.

use super::designs::quantiles;
use super::outcomes::designs_of;
use super::threshold::{answer, cases};
use crate::resolved::{Distribution, ResolvedCampaign};
use crate::result::Point;
use rubmap_numerics::sampling::sobol_point;

/// The campaign with the designs that it lacks, from the `points` of all simulations; none where its threshold is known as well as was asked
/// for, where nothing tells where it lies, and where no more designs are allowed.
///
/// The parameter of the threshold takes values evenly spaced over the interval in which the designs leave open whether the limit is met
/// with the probability, within its range; the others go on along a Sobol sequence in their distributions. Each batch depends on nothing but
/// the results before it.
pub fn more_designs(campaign: &ResolvedCampaign, points: &[Point]) -> Option<ResolvedCampaign> {
    let (threshold, index) = campaign.threshold()?;
    let within = threshold.within?;
    let distributions: Vec<&Distribution> = campaign.distributions.iter().flatten().collect();
    let designs = designs_of(campaign, points);
    let own: Vec<_> = designs.iter().map(|design| &design.outcome).collect();
    let found = answer(&cases(campaign, &own, index), threshold, campaign.varies_alone());
    let (from, to) = distributions.get(index)?.range();
    let (low, high) = found.open.map(|(low, high)| (low.max(from), high.min(to)))?;
    let there_are = campaign.designs();
    let count = (threshold.batch as usize).min((threshold.most_designs as usize).saturating_sub(there_are));
    if found.is_within(within) || high <= low || count == 0 {
        return None;
    }
    let seed = campaign.settings.design.seed.unwrap_or(0);
    let design = |place: usize| {
        let point = sobol_point(there_are + place, distributions.len(), seed);
        let mut values = quantiles(&point, distributions.iter().copied());
        values[index] = low + (high - low) * (place as f64 + 0.5) / count as f64;
        values
    };
    Some(campaign.with_designs((0..count).map(design).collect()))
}
