//! Results of a campaign from all its speeds, finished or not.

use super::comparison::comparison;
use super::outcomes::designs_of;
use super::sensitivities::sensitivities;
use super::threshold::threshold;
use crate::resolved::ResolvedCampaign;
use crate::result::{Campaign, DesignOutcome, Point, Spent};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::revision::VERSION;

/// Results of a campaign from the simulations finished so far, in any order; the caller adds the plan.
pub fn campaign(asked: &ResolvedCampaign, units: &Units, points: &[Point]) -> Campaign {
    let designs = designs_of(asked, points);
    let own: Vec<&DesignOutcome> = designs.iter().map(|design| &design.outcome).collect();
    Campaign {
        speeds_rad_s: asked.sweep.speeds.rad_s().to_vec(),
        sensitivities: sensitivities(asked, &own),
        threshold: threshold(asked, &own),
        comparison: comparison(asked, &designs),
        designs,
        spent: Spent::on(points),
        plan: None,
        units: units.clone(),
        settings: asked.settings.clone(),
        version: VERSION.to_owned(),
    }
}
