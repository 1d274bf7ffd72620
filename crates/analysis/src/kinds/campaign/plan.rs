//! Plan of a campaign: work and cost, before it runs.

use crate::resolved::ResolvedCampaign;
use crate::result::{CampaignPlan, CostRange, Estimate, SweepPlan};

/// Plans a campaign on `workers` threads from the plans of its scene before any change, with its model and with the compared one.
pub(crate) fn plan_campaign(
    campaign: &ResolvedCampaign,
    scene: SweepPlan,
    compared: Option<SweepPlan>,
    workers: usize,
) -> CampaignPlan {
    let designs = campaign.designs() as u32;
    let own = estimate(&scene, designs, workers);
    let other = compared.as_ref().map(|plan| estimate(plan, designs, workers));
    CampaignPlan {
        designs,
        designs_at_most: campaign.designs_at_most(),
        simulations: campaign.simulations(),
        reduction: scene.reduction,
        estimate: match other {
            None => own,
            Some(other) => own.zip(other).map(|(own, other)| side_by_side(own, other)),
        },
        settings: campaign.settings.clone(),
        scene,
        compared,
    }
}

/// Estimate of two models in one campaign: a worker may hold a speed of either, and both reduced wheels are kept.
fn side_by_side(one: Estimate, other: Estimate) -> Estimate {
    let wheel = |of: &Estimate| of.memory_bytes.saturating_sub(u64::from(of.workers) * of.speed_memory_bytes);
    let speed_memory_bytes = one.speed_memory_bytes.max(other.speed_memory_bytes);
    let memory_bytes = wheel(&one) + wheel(&other) + u64::from(one.workers) * speed_memory_bytes;
    Estimate { memory_bytes, speed_memory_bytes, ..one.followed_by(other) }
}

/// Estimate of `designs`, each as expensive as the planned sweep; speeds of all of them run side by side.
fn estimate(scene: &SweepPlan, designs: u32, workers: usize) -> Option<Estimate> {
    let one = scene.estimate.as_ref()?;
    let times = |range: CostRange, factor: f64| CostRange {
        free: factor * range.free,
        contact: factor * range.contact,
    };
    let computing_time_s = times(one.computing_time_s, designs.into());
    // Workers that are idle at the end of one sweep take speeds of the next design.
    let wall_time_s = times(computing_time_s, 1.0 / workers.max(1) as f64);
    Some(Estimate {
        steps: one.steps.saturating_mul(designs.into()),
        computing_time_s,
        wall_time_s: CostRange {
            free: wall_time_s.free.max(one.wall_time_s.free),
            contact: wall_time_s.contact.max(one.wall_time_s.contact),
        },
        ..one.clone()
    })
}
