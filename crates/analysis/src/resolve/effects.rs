//! Checks of the effects that a scene names, and of their combination.

use super::findings::Findings;
use crate::effects::effect::{Acts, Break, Chain, Check};
use crate::effects::symmetry;
use crate::effects::table::{EFFECTS, named};
use crate::model::ModelFacts;
use crate::request::SweepDirection;
use crate::resolved::{ResolvedSweep, Scene};

/// Checks the effects that describe the wheel and its casing.
pub(super) fn check_before_integration(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    for effect in EFFECTS {
        if let Check::First(check) = effect.check {
            check(found, request, facts);
        }
    }
}

/// Checks all other effects, and the requirements of effects on each other.
pub(super) fn check_after_integration(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    check_contact_is_there(found, &request.scene);
    for effect in EFFECTS {
        if let Check::Then(check) = effect.check {
            check(found, request, facts);
        }
    }
    symmetry::check::check(found, request, facts);
    check_chain(found, request);
}

/// Refuses scenes whose speeds cannot start from the end of the neighbouring speed, in a sweep up or down.
fn check_chain(found: &mut Findings, request: &ResolvedSweep) {
    if request.sweep == SweepDirection::Independent {
        return;
    }
    found.require(
        !request.refine,
        "/refine",
        "speeds that are added later have no place in a sweep up or down, where each starts from the end of its neighbour: \
         leave refine away, or make the speeds independent",
    );
    let anew = EFFECTS.iter().filter_map(|effect| match &effect.chain {
        Chain::Anew(anew) => Some(anew),
        Chain::GoesOn | Chain::Moves(_) => None,
    });
    let moves = EFFECTS.iter().filter_map(|effect| match &effect.chain {
        Chain::Moves(moves) => Some(moves),
        Chain::GoesOn | Chain::Anew(_) => None,
    });
    for Break { what, when, why } in anew.chain(moves) {
        found.require(
            !when(request),
            "/sweep",
            format!("a scene with {what} cannot go on where the neighbouring speed ended: {why}"),
        );
    }
}

/// Requires contact for effects on contact.
fn check_contact_is_there(found: &mut Findings, scene: &Scene) {
    let is_there = scene.contact.is_some() && scene.casing.is_some();
    for effect in named(scene).filter(|effect| effect.acts == Acts::AtContact) {
        found.require(
            is_there,
            &format!("/scene/{}", effect.name),
            "this effect is one of contact: add /scene/contact and /scene/casing",
        );
    }
}
