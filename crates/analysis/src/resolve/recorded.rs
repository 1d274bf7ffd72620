//! Recording of a sweep, checked against the sweep.

use std::collections::{BTreeMap, BTreeSet};

use crate::discretisation::most_samples;
use crate::model::ModelFacts;
use crate::request::{AutoOr, HistoriesRequest, HistorySpeeds, Recorded, RecordedQuantity, StressRequest};
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;
use rubmap_numerics::sector_fourier::harmonic_count;
use rubmap_solid::material::GivenStrengths;
use rubmap_wheel::dynamics::integrate::Revolutions;

/// Most numbers of the histories of one speed, and most speeds with histories: they are stored as text.
const MOST_NUMBERS: usize = 1 << 23;
const MOST_SPEEDS: usize = 100;

/// Most element sets with strengths, most of them that a message names, and longest source.
const MOST_SETS: usize = 1000;
const MOST_NAMED: usize = 10;
const LONGEST_SOURCE: usize = 200;

/// Indices of the speeds of which histories are asked for.
pub(crate) fn wanted(request: &HistoriesRequest, critical: &BTreeSet<u32>) -> Vec<u32> {
    match &request.speeds {
        HistorySpeeds::Critical => critical.iter().copied().take(MOST_SPEEDS).collect(),
        HistorySpeeds::Indices(indices) => indices.clone(),
    }
}

/// Checks the histories that a sweep asks for, at `pointer`.
pub(crate) fn check_histories(
    found: &mut Findings,
    request: &HistoriesRequest,
    pointer: &str,
    sweep: &ResolvedSweep,
    facts: &ModelFacts,
) {
    if let HistorySpeeds::Indices(indices) = &request.speeds {
        let at = format!("{pointer}/speeds");
        found.require(
            (1..=MOST_SPEEDS).contains(&indices.len()),
            &at,
            format!("histories are kept of 1 to {MOST_SPEEDS} speeds"),
        );
        let speeds = sweep.speeds.count();
        for (place, index) in indices.iter().enumerate().take(MOST_SPEEDS) {
            let at = format!("{at}/{place}");
            found.require(
                *index < speeds,
                &at,
                format!("the sweep has speeds 0 to {}", speeds.saturating_sub(1)),
            );
            let again = indices[..place].contains(index);
            found.require(!again, &at, format!("{index} is in the list already"));
        }
    }
    check_recorded(found, &request.recorded(), pointer, sweep, facts);
}

pub(crate) fn check_recorded(
    found: &mut Findings,
    record: &Recorded,
    pointer: &str,
    sweep: &ResolvedSweep,
    facts: &ModelFacts,
) {
    let run = sweep.integration.revolutions();
    let (from, to) = revolutions(record, sweep);
    let at = format!("{pointer}/revolutions");
    let message = match sweep.integration.revolutions {
        AutoOr::Fixed(_) => {
            format!("the run has {run} revolutions: name where recording begins and ends, such as [0, {run}]")
        }
        AutoOr::Auto => format!(
            "the run has at most {run} revolutions, which integration.most_revolutions says: name where recording begins and ends, \
             such as [0, {run}]"
        ),
    };
    found.require(from < to && to <= run as usize, &at, message);
    if !(from < to && to <= run as usize) {
        return;
    }
    for (place, quantity) in record.quantities.iter().enumerate() {
        let again = record.quantities[..place].contains(quantity);
        found.require(!again, &format!("{pointer}/quantities/{place}"), "is in the list already");
    }
    let sectors = facts.sectors as usize;
    let unknowns =
        3 * facts.contact_nodes as usize + facts.speeds_rad_s.len() * sweep.modes_per_speed() as usize;
    let state = 2 * harmonic_count(sectors) * unknowns.min(facts.own_dofs as usize);
    let lines = lines(record, sweep, sectors * facts.contact_nodes as usize, state);
    let samples = most_samples(sweep, sectors).saturating_mul(to - from);
    let numbers = samples.saturating_mul(lines);
    found.require(
        numbers <= MOST_NUMBERS,
        &at,
        format!(
            "{lines} histories of up to {samples} samples are {numbers} numbers a speed, more than {MOST_NUMBERS}: record fewer \
             revolutions, quantities or sensors"
        ),
    );
}

/// Refuses to leave out the rows of the basis that a recording `needs`.
pub(crate) fn check_fields(found: &mut Findings, fields: Option<bool>, needs: bool) {
    found.require(
        !needs || fields != Some(false),
        "/fields",
        "stress and states are made of these rows: leave this away, or record neither",
    );
}

/// Excluded radius of stress about contact nodes, in distances of neighbouring ones: at a distance of their spacing, the difference between
/// a row of point forces and a distributed force has died out (Saint-Venant).
const EXCLUDED_SPACINGS: f64 = 1.0;

/// Checks stress that a sweep asks for, at `pointer`, and fills in its excluded radius.
pub(crate) fn resolve_stress(
    found: &mut Findings,
    request: &mut StressRequest,
    pointer: &str,
    facts: &ModelFacts,
) {
    found.require(
        facts.mesh.is_some(),
        pointer,
        "this model has no mesh: stress needs elements and materials, which a package gives as `mesh`",
    );
    check_strengths(found, &request.strengths, pointer, facts);
    let at = format!("{pointer}/excluded_radius");
    let usual = facts.contact_spacing.map(|spacing| EXCLUDED_SPACINGS * spacing);
    request.excluded_radius = request.excluded_radius.or(usual);
    match request.excluded_radius {
        Some(radius) => {
            found.require(radius.is_finite() && radius >= 0.0, &at, "a finite length ≥ 0");
        }
        None => found.require(
            facts.mesh.is_none(),
            &at,
            "say how far from its only contact node stress may be claimed: about two elements",
        ),
    }
}

/// Checks strengths given by the names of element sets.
fn check_strengths(
    found: &mut Findings,
    given: &BTreeMap<String, GivenStrengths>,
    pointer: &str,
    facts: &ModelFacts,
) {
    let known: Vec<&str> =
        facts.mesh.iter().flat_map(|mesh| &mesh.sets).map(|set| set.set.as_str()).collect();
    for (name, strengths) in given.iter().take(MOST_SETS) {
        let at = format!("{pointer}/strengths/{}", name.replace('~', "~0").replace('/', "~1"));
        if !known.is_empty() && !known.contains(&name.as_str()) {
            let first: Vec<&str> = known.iter().copied().take(MOST_NAMED).collect();
            found.require(false, &at, format!("the mesh has no such set; it has {}", first.join(", ")));
        }
        let GivenStrengths { yield_strength, ultimate_strength, fatigue_strength } = strengths;
        let fatigue = fatigue_strength.as_ref().map(|fatigue| fatigue.amplitude);
        for (field, value) in [
            ("yield_strength", *yield_strength),
            ("ultimate_strength", *ultimate_strength),
            ("fatigue_strength/amplitude", fatigue),
        ] {
            found.require(
                value.is_none_or(|value| value > 0.0 && value.is_finite()),
                &format!("{at}/{field}"),
                "a strength is a finite stress above 0",
            );
        }
        for (field, value) in [("yield_strength", *yield_strength), ("fatigue_strength/amplitude", fatigue)] {
            found.require(
                value.zip(*ultimate_strength).is_none_or(|(value, ultimate)| value <= ultimate),
                &format!("{at}/{field}"),
                "nothing is stronger than the ultimate strength",
            );
        }
        found.require(
            fatigue_strength
                .as_ref()
                .is_none_or(|fatigue| (1..=LONGEST_SOURCE).contains(&fatigue.source.trim().chars().count())),
            &format!("{at}/fatigue_strength/source"),
            format!("say in 1 to {LONGEST_SOURCE} characters where the strength is from: a handbook, a test"),
        );
    }
    found.require(
        given.len() <= MOST_SETS,
        &format!("{pointer}/strengths"),
        format!("at most {MOST_SETS} sets"),
    );
}

/// Revolutions to be recorded: those asked for, otherwise the window, or only the last revolution where states are recorded, which are
/// large.
pub(crate) fn asked(record: &Recorded, sweep: &ResolvedSweep) -> Revolutions {
    let last = if record.wants(RecordedQuantity::State) { 1 } else { sweep.integration.window_revolutions };
    match record.revolutions {
        Some([from, to]) => Revolutions::Between(from as usize, to as usize),
        None => Revolutions::Last(last as usize),
    }
}

/// Recorded revolutions, from and to, of the longest possible run.
pub(crate) fn revolutions(record: &Recorded, sweep: &ResolvedSweep) -> (usize, usize) {
    asked(record, sweep).of(sweep.integration.revolutions() as usize, None)
}

/// Number of histories of one speed, for this number of pairs of a contact node and a blade and of numbers of a state.
pub(crate) fn lines(record: &Recorded, sweep: &ResolvedSweep, pairs: usize, state: usize) -> usize {
    let of = |quantity, numbers: usize| if record.wants(quantity) { numbers } else { 0 };
    of(RecordedQuantity::Displacement, sweep.sensors.len())
        + of(RecordedQuantity::Velocity, sweep.sensors.len())
        + of(RecordedQuantity::ContactForce, pairs)
        + of(RecordedQuantity::Contact, 2)
        + of(RecordedQuantity::Energy, 8)
        + of(RecordedQuantity::State, state)
}
