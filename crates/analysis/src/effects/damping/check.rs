//! Checks of damping ratios.

use super::request::Damping;
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, _: &ModelFacts) {
    let Some(Damping { modal_ratio, family_ratios, .. }) = &request.scene.damping else { return };
    let valid = |ratio: f64| (0.0..1.0).contains(&ratio);
    let message = "a damping ratio lies in [0, 1)";
    found.require(valid(*modal_ratio), "/scene/damping/modal_ratio", message);
    found.require(
        family_ratios.len() <= limits::FAMILIES as usize,
        "/scene/damping/family_ratios",
        format!("at most {} modal families", limits::FAMILIES),
    );
    for (index, &ratio) in family_ratios.iter().enumerate().take(limits::FAMILIES as usize) {
        found.require(valid(ratio), &format!("/scene/damping/family_ratios/{index}"), message);
    }
}
