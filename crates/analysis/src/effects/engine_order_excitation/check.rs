//! Checks of forces at engine orders.

use super::request::EngineOrderExcitation;
use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

const MOST_FORCE: f64 = 1e30;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    for (index, excitation) in request.scene.engine_order_excitation.iter().enumerate() {
        check_one(found, excitation, index, request.max_engine_order, facts);
    }
}

fn check_one(
    found: &mut Findings,
    e: &EngineOrderExcitation,
    index: usize,
    max_engine_order: u32,
    facts: &ModelFacts,
) {
    let at = format!("/scene/engine_order_excitation/{index}");
    found.require(
        (1..=max_engine_order).contains(&e.order),
        &format!("{at}/order"),
        format!(
            "the order of a force lies between 1 and the highest of the spectra, max_engine_order {max_engine_order}, which \
             would fold it onto others"
        ),
    );
    found.require(
        !e.contact_nodes.is_empty() && e.contact_nodes.len() <= facts.contact_nodes as usize,
        &format!("{at}/contact_nodes"),
        "name at least one contact node, each once",
    );
    for (place, &node) in e.contact_nodes.iter().enumerate().take(facts.contact_nodes as usize) {
        let pointer = format!("{at}/contact_nodes/{place}");
        found.require(
            node < facts.contact_nodes,
            &pointer,
            format!("the model has contact nodes 0 to {}", facts.contact_nodes.saturating_sub(1)),
        );
        found.require(
            !e.contact_nodes[..place].contains(&node),
            &pointer,
            format!("{node} is in the list already"),
        );
    }
    found.require(
        e.amplitude.is_finite() && e.amplitude.abs() <= MOST_FORCE,
        &format!("{at}/amplitude"),
        format!("an amplitude is a force of at most {:e}", MOST_FORCE),
    );
    found.require(
        e.phase_rad.abs() <= limits::PHASE_RAD,
        &format!("{at}/phase_rad"),
        format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
    );
}
