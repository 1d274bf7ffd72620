//! Checks of the effects that a scene names, and of which go together.

use super::findings::{Findings, between, check_reach};
use super::limits;
use crate::effects::flexible_casing;
use crate::model::ModelFacts;
use crate::request::{
    CasingMode, EngineOrderExcitation, Initial, InitialWave, Orbit, Probe, Ring, SchemeChoice,
    SweepDirection, Symmetry,
};
use crate::resolve::contact_effects::{check_abradable, check_friction};
use crate::resolved::{FlexibleCasing, Mistuning, ResolvedSweep, Scene, WavesOf};
use crate::symmetry::repeats;
use rubmap_wheel::dynamics::mistuning::LARGEST_DEVIATION;

pub(super) fn check_effects(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let scene = &request.scene;
    check_contact_is_there(found, scene);
    if let Some(friction) = &scene.friction {
        check_friction(found, friction);
    }
    if let Some(abradable) = &scene.abradable {
        check_abradable(found, abradable, &request.integration, facts);
    }
    if let Some(casing) = &scene.flexible_casing {
        check_flexible_casing(found, casing, request);
    }
    if let Some(mistuning) = &scene.mistuning {
        check_mistuning(found, mistuning, facts);
    }
    for (index, excitation) in scene.engine_order_excitation.iter().enumerate() {
        check_excitation(found, excitation, index, request.max_engine_order, facts);
    }
    if let Some(orbit) = &scene.orbit {
        check_orbit(found, orbit, facts);
    }
    if let Some(initial) = &scene.initial {
        check_initial(found, initial, facts);
        // Without contact the response is linear and may be of any size.
        if scene.contact.is_some() {
            check_reach(found, initial.amplitude, "/scene/initial/amplitude", facts);
        }
    }
    check_symmetry(found, request, facts);
    check_chain(found, request);
}

/// What a speed cannot take over from its neighbour.
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
    let scene = &request.scene;
    let turns = scene
        .orbit
        .as_ref()
        .map_or(0.0, |orbit| orbit.whirl_ratio * f64::from(request.integration.revolutions));
    let jumps = [
        ("abradable", scene.abradable.is_some(), "its coating is new at every speed"),
        ("flexible_casing", scene.flexible_casing.is_some(), "its casing is at rest when a speed begins"),
        ("symmetry: probe", scene.symmetry == Symmetry::Probe, "its asymmetry is one of the start"),
        ("orbit", turns.fract() != 0.0, "its axis would jump, for whirl_ratio × revolutions is not whole"),
    ];
    for (effect, jumps, why) in jumps {
        found.require(
            !jumps,
            "/sweep",
            format!("a scene with {effect} cannot go on where the neighbouring speed ended: {why}"),
        );
    }
}

/// Effects on contact need one.
fn check_contact_is_there(found: &mut Findings, scene: &Scene) {
    let named = [
        ("friction", scene.friction.is_some()),
        ("abradable", scene.abradable.is_some()),
        ("flexible_casing", scene.flexible_casing.is_some()),
        ("orbit", scene.orbit.is_some()),
    ];
    for (effect, named) in named {
        found.require(
            !named || (scene.contact.is_some() && scene.casing.is_some()),
            &format!("/scene/{effect}"),
            "this effect is one of contact: add /scene/contact and /scene/casing",
        );
    }
}

fn check_flexible_casing(found: &mut Findings, casing: &FlexibleCasing, request: &ResolvedSweep) {
    const AT: &str = "/scene/flexible_casing";
    let FlexibleCasing { waves, damping_ratio } = casing;
    found.require(
        (0.0..1.0).contains(damping_ratio),
        &format!("{AT}/damping_ratio"),
        "a damping ratio lies in [0, 1)",
    );
    let mut bounded = true;
    match waves {
        WavesOf::Ring(ring) => {
            check_ring(found, ring);
            // A ring of as many waves as a number can say would fill the memory before it is refused.
            bounded = ring.n_max <= limits::CASING_WAVES;
        }
        WavesOf::Modes(modes) => check_modes(found, modes),
    }
    if bounded {
        found.require(
            flexible_casing(casing).waves.iter().all(|wave| limits::CASING_OMEGA.contains(&wave.omega)),
            AT,
            format!(
                "natural frequencies of a casing lie {} rad/s: check its numbers and units",
                between(&limits::CASING_OMEGA)
            ),
        );
    }
    found.require(
        request.integration.scheme != SchemeChoice::MasslessBoundary,
        AT,
        "an elastic casing has mass where it is touched, which massless_boundary leaves no room for: take the scheme \
         exact_modal, central_differences or auto",
    );
}

fn check_ring(found: &mut Findings, ring: &Ring) {
    const AT: &str = "/scene/flexible_casing/ring";
    let Ring { radius, modulus, density, area, second_moment, n_max } = *ring;
    let numbers = [
        ("radius", radius),
        ("modulus", modulus),
        ("density", density),
        ("area", area),
        ("second_moment", second_moment),
    ];
    for (field, value) in numbers {
        found.require(
            limits::LENGTH.contains(&value),
            &format!("{AT}/{field}"),
            format!("this lies {}, unlike {value}", between(&limits::LENGTH)),
        );
    }
    found.require(
        n_max <= limits::CASING_WAVES,
        &format!("{AT}/n_max"),
        format!("at most {} nodal diameters of the casing", limits::CASING_WAVES),
    );
}

fn check_modes(found: &mut Findings, modes: &[CasingMode]) {
    const AT: &str = "/scene/flexible_casing/modes";
    for (index, mode) in modes.iter().enumerate().take(2 * limits::CASING_WAVES as usize) {
        let CasingMode { nodal_diameter, frequency_hz, modal_mass } = mode;
        found.require(
            limits::LENGTH.contains(frequency_hz),
            &format!("{AT}/{index}/frequency_hz"),
            format!("a natural frequency lies {}", between(&limits::LENGTH)),
        );
        found.require(
            limits::LENGTH.contains(modal_mass),
            &format!("{AT}/{index}/modal_mass"),
            format!("a modal mass lies {}", between(&limits::LENGTH)),
        );
        found.require(
            *nodal_diameter <= limits::CASING_WAVES,
            &format!("{AT}/{index}/nodal_diameter"),
            format!("at most {}", limits::CASING_WAVES),
        );
    }
    found.require(
        (1..=limits::CASING_WAVES as usize).contains(&modes.len()),
        AT,
        format!("between 1 and {} modes", limits::CASING_WAVES),
    );
}

fn check_mistuning(found: &mut Findings, mistuning: &Mistuning, facts: &ModelFacts) {
    const AT: &str = "/scene/mistuning";
    match mistuning {
        Mistuning::Given(deviations) => {
            found.require(
                deviations.len() == facts.sectors as usize,
                &format!("{AT}/deviations"),
                format!("the wheel has {} sectors, not {}", facts.sectors, deviations.len()),
            );
            for (index, delta) in deviations.iter().enumerate().take(facts.sectors as usize) {
                found.require(
                    delta.abs() <= LARGEST_DEVIATION,
                    &format!("{AT}/deviations/{index}"),
                    format!("a sector deviates by at most {LARGEST_DEVIATION} of the stiffness"),
                );
            }
        }
        Mistuning::Drawn { spread, .. } => found.require(
            (0.0..=limits::SPREAD).contains(spread),
            &format!("{AT}/spread"),
            format!("a spread lies between 0 and {}", limits::SPREAD),
        ),
    }
}

fn check_excitation(
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
        e.amplitude.is_finite() && e.amplitude.abs() <= limits::FORCE,
        &format!("{at}/amplitude"),
        format!("an amplitude is a force of at most {:e}", limits::FORCE),
    );
    found.require(
        e.phase_rad.abs() <= limits::PHASE_RAD,
        &format!("{at}/phase_rad"),
        format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
    );
}

fn check_orbit(found: &mut Findings, orbit: &Orbit, facts: &ModelFacts) {
    found.require(
        orbit.radius == 0.0 || limits::LENGTH.contains(&orbit.radius),
        "/scene/orbit/radius",
        format!("the radius is 0 or a length {}", between(&limits::LENGTH)),
    );
    check_reach(found, orbit.radius, "/scene/orbit/radius", facts);
    found.require(
        orbit.whirl_ratio.abs() <= limits::WHIRL_RATIO,
        "/scene/orbit/whirl_ratio",
        format!("whirl is at most {} times as fast as the rotation", limits::WHIRL_RATIO),
    );
    found.require(
        orbit.phase_rad.abs() <= limits::PHASE_RAD,
        "/scene/orbit/phase_rad",
        format!("the phase is an angle of at most {} rad", limits::PHASE_RAD),
    );
}

fn check_initial(found: &mut Findings, initial: &Initial, facts: &ModelFacts) {
    const AT: &str = "/scene/initial";
    found.require(
        initial.nodal_diameter <= facts.sectors / 2,
        &format!("{AT}/nodal_diameter"),
        format!("the wheel has nodal diameters 0 to {}", facts.sectors / 2),
    );
    found.require(
        (1..=limits::FAMILIES).contains(&initial.family),
        &format!("{AT}/family"),
        format!("modal families are counted from 1 to {}", limits::FAMILIES),
    );
    found.require(
        limits::LENGTH.contains(&initial.amplitude),
        &format!("{AT}/amplitude"),
        format!("an amplitude is a length {}", between(&limits::LENGTH)),
    );
    let single = initial.nodal_diameter == 0 || 2 * initial.nodal_diameter == facts.sectors;
    found.require(
        initial.wave == InitialWave::Standing || !single,
        &format!("{AT}/wave"),
        format!("modes of nodal diameter {} can only stand", initial.nodal_diameter),
    );
}

/// What exact symmetry and the probe of it ask of the rest.
fn check_symmetry(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let scene = &request.scene;
    if let Some(Probe { amplitude, .. }) = &scene.probe {
        found.require(
            scene.symmetry == Symmetry::Probe,
            "/scene/probe",
            "this belongs to `\"symmetry\": \"probe\"`",
        );
        found.require(
            (1e-12..=1e-3).contains(amplitude),
            "/scene/probe/amplitude",
            "the asymmetry is 1e-12 to 1e-3 of the smallest clearance",
        );
    }
    if scene.symmetry == Symmetry::Full {
        return;
    }
    let broken_by = [
        ("mistuning", scene.mistuning.is_some(), "sectors of different stiffness"),
        ("orbit", scene.orbit.is_some(), "an axis off the casing's"),
    ];
    for (effect, named, what) in broken_by {
        found.require(
            !named,
            "/scene/symmetry",
            format!(
                "the scene repeats nothing around the wheel: {what} (/scene/{effect}) break the symmetry"
            ),
        );
    }
    let repeats = repeats(scene, facts.sectors);
    found.require(
        repeats > 1,
        "/scene/symmetry",
        "the scene repeats nothing around the wheel: the numbers of sectors and lobes, the engine orders and the \
         initial nodal diameter have no common divisor",
    );
    if scene.symmetry == Symmetry::Exact {
        found.require(
            scene.abradable.is_none(),
            "/scene/symmetry",
            "rods of an abradable coating are worn by all blades: take `full` or `probe`",
        );
    }
    found.require(
        scene.symmetry != Symmetry::Probe || scene.initial.is_none(),
        "/scene/initial",
        "the probe starts from its own asymmetry",
    );
}
