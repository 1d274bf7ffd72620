//! Checks of a request against its model, with defaults filled in: all violations at once, each at its JSON pointer.

use std::ops::RangeInclusive;

use crate::discretisation::most_samples;
use crate::effects::casing::check::{check_lobe_count, check_ramp, check_steps};
use crate::effects::coriolis;
use crate::error::Violation;
use crate::kinds::modal_analysis::backbones;
use crate::model::ModelFacts;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{
    Accuracy, AccuracyOf, AutoOr, Budget, Component, Integration, ModalAnalysisRequest, SchemeChoice,
    SweepDirection, SweepRequest,
};
use crate::resolved::sensor::{Along, Place};
use crate::resolved::{ResolvedModalAnalysis, ResolvedSensor, ResolvedSpeeds, ResolvedSweep};

use self::findings::Findings;

mod effects;
pub(crate) mod findings;
mod gauges;
pub(crate) mod limits;
mod operation;
pub(crate) mod plain_sweep;
pub(crate) mod recorded;
pub(crate) mod sensors;

/// Parses a sweep and checks it against its model; without sensors it takes the default ones.
pub fn resolve_sweep(request: SweepRequest, facts: &ModelFacts) -> Result<ResolvedSweep, Vec<Violation>> {
    let mut found = Findings::default();
    check_knobs(&mut found, &request);
    let mut sweep = ResolvedSweep::of(request, 0, &mut |violation| found.0.push(violation));
    check_controls(&mut found, &sweep);
    check_modes(&mut found, sweep.modes_per_speed());
    check_speeds(&mut found, &sweep.speeds, facts, sweep.scene.centrifugal_stiffening, false);
    effects::check_before_integration(&mut found, &sweep, facts);
    check_integration(&mut found, &sweep.integration, sweep.max_engine_order);
    found.require(
        (0.0..=1.0).contains(&sweep.peak_prominence),
        "/peak_prominence",
        "a share of the largest response, between 0 and 1",
    );
    check_steps(&mut found, &sweep);
    check_ramp(&mut found, &sweep);
    effects::check_after_integration(&mut found, &sweep, facts);
    if sweep.sensors.is_empty() {
        sweep.sensors = default_sensors(facts);
    }
    check_sensors(&mut found, &sweep.sensors, facts);
    // A limit of the utilisation says that stress is wanted.
    if sweep.limits.is_some_and(|limits| limits.utilisation.is_some()) && facts.mesh.is_some() {
        sweep.record.stress.get_or_insert_default();
    }
    operation::check_operation(&mut found, &sweep);
    if let Some(stress) = &mut sweep.record.stress {
        recorded::resolve_stress(&mut found, stress, "/record/stress", facts);
    }
    let needs = sweep.records_states() || sweep.record.stress.is_some();
    recorded::check_fields(&mut found, sweep.fields, needs);
    if found.0.is_empty() {
        check_memory(&mut found, &sweep, facts);
        if let Some(histories) = sweep.histories() {
            recorded::check_histories(&mut found, histories, "/record/histories", &sweep, facts);
        }
    }
    found.finish(sweep)
}

/// Parses a modal analysis and checks it against its model.
pub fn resolve_modal_analysis(
    request: ModalAnalysisRequest,
    facts: &ModelFacts,
) -> Result<ResolvedModalAnalysis, Vec<Violation>> {
    let mut found = Findings::default();
    let fixed = request.modes_per_speed != AutoOr::Auto;
    check_choice(&mut found, request.accuracy, request.budget, &[("/modes_per_speed", fixed)]);
    found.require(
        request.accuracy.is_none_or(|accuracy| accuracy.of == AccuracyOf::Response),
        "/accuracy/of",
        "a modal analysis has no stress: its error is that of its frequencies, so leave this away",
    );
    let mut request = ResolvedModalAnalysis::of(request, &mut |violation| found.0.push(violation));
    check_modes(&mut found, request.modes_per_speed());
    check_speeds(&mut found, &request.speeds, facts, facts.has_stiffening(), true);
    let families = 1..=limits::FAMILIES;
    found.require(
        families.contains(&request.families),
        "/families",
        format!("ask for 1 to {} modal families", limits::FAMILIES),
    );
    found.require(
        request.superharmonics.len() <= limits::SUPERHARMONICS,
        "/superharmonics",
        format!("at most {} superharmonic numbers", limits::SUPERHARMONICS),
    );
    found.require(
        (1..=limits::ENGINE_ORDER).contains(&request.max_engine_order),
        "/max_engine_order",
        format!("between 1 and {}", limits::ENGINE_ORDER),
    );
    for (index, n) in request.superharmonics.iter().enumerate().take(limits::SUPERHARMONICS) {
        found.require(
            (1..=limits::SUPERHARMONIC).contains(n),
            &format!("/superharmonics/{index}"),
            format!("a superharmonic number lies between 1 and {}", limits::SUPERHARMONIC),
        );
        found.require(
            !request.superharmonics[..index].contains(n),
            &format!("/superharmonics/{index}"),
            format!("{n} is in the list already"),
        );
    }
    check_lobe_count(&mut found, request.lobes, "/lobes");
    coriolis::check::check(&mut found, request.coriolis, "/coriolis", facts);
    let fields = request.fields;
    if let Some(asked) = &mut request.backbones {
        backbones::resolve(&mut found, asked, fields, facts);
    }
    found.finish(request)
}

/// Requires that the knobs of a sweep are either given or chosen.
pub(crate) fn check_knobs(found: &mut Findings, request: &SweepRequest) {
    let Integration { scheme, kept_modes, steps_per_revolution, .. } = request.integration;
    let fixed = [
        ("/modes_per_speed", request.modes_per_speed != AutoOr::Auto),
        ("/integration/scheme", scheme != SchemeChoice::Auto),
        ("/integration/kept_modes", kept_modes != AutoOr::Auto),
        ("/integration/steps_per_revolution", steps_per_revolution != AutoOr::Auto),
    ];
    check_choice(found, request.accuracy, request.budget, &fixed);
    found.require(
        request.record.stress.is_some()
            || request.accuracy.is_none_or(|accuracy| accuracy.of == AccuracyOf::Response),
        "/accuracy/of",
        "stress is judged where it is recorded: ask for it by \"record\": {\"stress\": {}}, which needs a model with a mesh",
    );
    found.require(
        (request.accuracy.is_none() && request.budget.is_none())
            || request.integration.window_revolutions >= 2,
        "/integration/window_revolutions",
        "an error is told from chance by comparing parts of the window: at least two revolutions",
    );
    found.require(
        request.budget.is_none() || request.refine != Some(true),
        "/refine",
        "how many speeds are added is not known beforehand, and a budget cannot be kept: set this to false, or ask for an accuracy",
    );
}

pub(crate) fn check_controls(found: &mut Findings, sweep: &ResolvedSweep) {
    found.require(
        sweep.control_speeds <= limits::CONTROL_SPEEDS,
        "/control_speeds",
        format!("at most {} speeds are simulated again", limits::CONTROL_SPEEDS),
    );
    found.require(
        sweep.control_speeds == 0 || sweep.sweep == SweepDirection::Independent,
        "/control_speeds",
        "a speed of a sweep up or down depends on all before it and cannot be simulated again alone: set this to 0",
    );
}

/// Requires either a target or a budget, and none of the knobs (JSON pointer, whether it is given) that it chooses.
pub(crate) fn check_choice(
    found: &mut Findings,
    accuracy: Option<Accuracy>,
    budget: Option<Budget>,
    knobs: &[(&str, bool)],
) {
    if let Some(Accuracy { target, .. }) = accuracy {
        found.require(
            limits::TARGET.contains(&target),
            "/accuracy/target",
            format!("a relative error between {:e} and {}", limits::TARGET.start(), limits::TARGET.end()),
        );
    }
    let times = [
        ("/accuracy/seconds", accuracy.map(|accuracy| accuracy.seconds)),
        ("/budget/seconds", budget.map(|budget| budget.seconds)),
    ];
    for (pointer, seconds) in times {
        found.require(
            seconds.is_none_or(|seconds| limits::SECONDS.contains(&seconds)),
            pointer,
            format!("a time between {} and {:e} s", limits::SECONDS.start(), limits::SECONDS.end()),
        );
    }
    found.require(accuracy.is_none() || budget.is_none(), "/budget", "give either an accuracy or a budget");
    for (pointer, given) in knobs {
        let chosen = if accuracy.is_some() { "accuracy" } else { "budget" };
        found.require(
            !given || (accuracy.is_none() && budget.is_none()),
            pointer,
            format!("this is chosen for the {chosen} asked for: leave one of the two away"),
        );
    }
}

pub(crate) fn check_modes(found: &mut Findings, modes_per_speed: u32) {
    found.require(
        (1..=limits::MODES_PER_SPEED).contains(&modes_per_speed),
        "/modes_per_speed",
        format!("between 1 and {} fixed-interface modes are kept per speed", limits::MODES_PER_SPEED),
    );
}

pub(crate) fn check_speeds(
    found: &mut Findings,
    speeds: &ResolvedSpeeds,
    facts: &ModelFacts,
    stiffening: bool,
    campbell: bool,
) {
    found.0.extend(speeds.lists().implausible());
    for (pointer, speeds_rad_s) in speeds.by_list() {
        found.require(
            campbell || speeds_rad_s.iter().all(|&omega| omega > 0.0),
            &pointer,
            "a contact simulation needs a speed above 0: its clock is the revolution",
        );
        found.require(
            !campbell || speeds_rad_s.windows(2).all(|pair| pair[0] < pair[1]),
            &pointer,
            "the speeds of a Campbell diagram ascend",
        );
        found.require(
            !stiffening || speeds_rad_s.iter().all(|&omega| facts.stiffness_reaches(omega)),
            &pointer,
            facts.not_extrapolated(),
        );
    }
}

/// Range of the relative change at which a motion counts as repeating: at least above round-off, at most what the verdict on its window
/// asks for.
const UNSETTLED: RangeInclusive<f64> = 1e-12..=1e-2;

/// Field that gives the largest length of a run.
pub(crate) fn revolutions_field(integration: &Integration) -> &'static str {
    match integration.revolutions {
        AutoOr::Fixed(_) => "revolutions",
        AutoOr::Auto => "most_revolutions",
    }
}

pub(crate) fn check_integration(found: &mut Findings, integration: &Integration, max_engine_order: u32) {
    let Integration {
        scheme,
        kept_modes,
        steps_per_revolution,
        revolutions: asked,
        most_revolutions,
        settled_to,
        ramp_revolutions,
        window_revolutions,
        steady: _,
    } = *integration;
    let (revolutions, field) = (integration.revolutions(), revolutions_field(integration));
    if let AutoOr::Fixed(kept) = kept_modes {
        found.require(
            scheme == SchemeChoice::MasslessBoundary,
            "/integration/kept_modes",
            "only the scheme massless_boundary leaves modes out: name it, or leave kept_modes away",
        );
        found.require(
            kept >= 1,
            "/integration/kept_modes",
            "at least one mode per nodal diameter is integrated",
        );
    }
    if let AutoOr::Fixed(steps) = steps_per_revolution {
        found.require(
            (1..=MOST_STEPS).contains(&steps),
            "/integration/steps_per_revolution",
            format!("between 1 and {MOST_STEPS} steps"),
        );
        found.require(
            u64::from(steps) > 2 * u64::from(max_engine_order),
            "/integration/steps_per_revolution",
            format!("engine order {max_engine_order} needs more than twice as many steps per revolution"),
        );
    }
    found.require(
        asked == AutoOr::Auto || (1..=limits::REVOLUTIONS).contains(&revolutions),
        "/integration/revolutions",
        format!("\"auto\", or between 1 and {} revolutions", limits::REVOLUTIONS),
    );
    found.require(
        (1..=limits::REVOLUTIONS).contains(&most_revolutions),
        "/integration/most_revolutions",
        format!("between 1 and {} revolutions", limits::REVOLUTIONS),
    );
    found.require(
        UNSETTLED.contains(&settled_to),
        "/integration/settled_to",
        format!("a share between {:e} and {}", UNSETTLED.start(), UNSETTLED.end()),
    );
    found.require(
        (1..=revolutions).contains(&window_revolutions),
        "/integration/window_revolutions",
        format!("the window is part of the run: between 1 and {revolutions} revolutions ({field})"),
    );
    found.require(
        ramp_revolutions.is_finite() && ramp_revolutions >= 0.0,
        "/integration/ramp_revolutions",
        "a ramp lasts a finite number of revolutions ≥ 0",
    );
    found.require(
        f64::from(revolutions) >= ramp_revolutions + f64::from(window_revolutions),
        "/integration/window_revolutions",
        format!(
            "the window would begin before the restriction is fully grown: {ramp_revolutions} revolutions of ramp \
             and {window_revolutions} of window need more than {revolutions} ({field})"
        ),
    );
    found.require(
        (1..=limits::ENGINE_ORDER).contains(&max_engine_order),
        "/max_engine_order",
        format!("between 1 and {}", limits::ENGINE_ORDER),
    );
}

/// Limits the memory of a speed: displacement over the whole run, and Fourier coordinates of all sectors over the window.
pub(crate) fn check_memory(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let sectors = facts.sectors as usize;
    let (revolutions, window_revolutions) =
        (request.integration.revolutions(), request.integration.window_revolutions);
    let per_sensor = revolutions as usize + window_revolutions as usize * sectors;
    let nodes = facts.contact_nodes as usize;
    // A disc of friction has three by three numbers for one, the three of gaps by themselves, and the one.
    let most = if request.scene.has_disc() { limits::DELASSUS / 13 } else { limits::DELASSUS };
    found.require(
        sectors * nodes * nodes <= most,
        "/model",
        format!(
            "{sectors} sectors with {nodes} contact nodes each are more than contact can be solved for: keep sectors × \
             nodes² below {most}"
        ),
    );
    let recorded =
        most_samples(request, sectors).saturating_mul(per_sensor).saturating_mul(request.sensors.len());
    found.require(
        recorded <= limits::RECORDED,
        &format!("/integration/{}", revolutions_field(&request.integration)),
        format!(
            "{} sensors over {revolutions} revolutions with a window of {window_revolutions} would record {recorded} \
             numbers at every speed, more than {}: shorten the run or the window, ask for fewer sensors or lower \
             engine orders, or choose steps_per_revolution with small divisors",
            request.sensors.len(),
            limits::RECORDED
        ),
    );
}

pub(crate) fn default_sensors(facts: &ModelFacts) -> Vec<ResolvedSensor> {
    let along = Along::Component(Component::Normal);
    let at = |contact_node| ResolvedSensor { place: Place::Contact(contact_node), sector: 0, along };
    match facts.contact_nodes {
        0 | 1 => vec![at(0)],
        nodes => vec![at(0), at(nodes - 1)],
    }
}

pub(crate) fn check_sensors(found: &mut Findings, sensors: &[ResolvedSensor], facts: &ModelFacts) {
    found.require(
        sensors.len() <= limits::SENSORS,
        "/sensors",
        format!("at most {} sensors in one sweep", limits::SENSORS),
    );
    for (index, sensor) in sensors.iter().enumerate() {
        found.require(
            !matches!(sensor.place, Place::Contact(node) if node >= facts.contact_nodes),
            &format!("/sensors/{index}/contact_node"),
            format!("the model has contact nodes 0 to {}", facts.contact_nodes.saturating_sub(1)),
        );
        found.require(
            sensor.sector < facts.sectors,
            &format!("/sensors/{index}/sector"),
            format!("the wheel has sectors 0 to {}", facts.sectors.saturating_sub(1)),
        );
    }
}
