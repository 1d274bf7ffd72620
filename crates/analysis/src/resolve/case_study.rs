//! Case studies and the histories of sweeps, held against what they are of.

use std::collections::BTreeSet;

use crate::discretisation::most_samples;
use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    CaseSpeed, CaseStudyRequest, HistoriesRequest, HistorySpeeds, Record, Recorded, RecordedQuantity,
    SpeedSet, Speeds, SweepDirection, SweepRequest,
};
use crate::resolve::findings::Findings;
use crate::resolve::resolve_sweep;
use crate::resolved::{ResolvedCaseStudy, ResolvedSweep};

/// Most numbers of the histories of one speed, and most speeds with histories: they are kept as text.
const MOST_NUMBERS: usize = 1 << 23;
const MOST_SPEEDS: usize = 100;

/// Parses a case study and checks it against its model.
pub fn resolve_case_study(
    request: CaseStudyRequest,
    facts: &ModelFacts,
) -> Result<ResolvedCaseStudy, Vec<Violation>> {
    let CaseSpeed { value, unit } = request.speed;
    let record = request.record;
    let sweep = SweepRequest {
        model: request.model,
        modes_per_speed: request.modes_per_speed,
        speeds: Speeds::One(SpeedSet { from: None, to: None, count: None, values: Some(vec![value]), unit }),
        scene: request.scene,
        integration: request.integration,
        sensors: request.sensors,
        max_engine_order: request.max_engine_order,
        peak_prominence: default_peak_prominence(),
        sweep: SweepDirection::Independent,
        refine: false,
        accuracy: None,
        budget: None,
        control_speeds: None,
        record: Record::default(),
    };
    let at_its_field = |violation: Violation| match violation.pointer.strip_prefix("/speeds") {
        Some(_) => Violation { pointer: "/speed/value".to_owned(), ..violation },
        None => violation,
    };
    let sweep = resolve_sweep(sweep, facts)
        .map_err(|found| found.into_iter().map(at_its_field).collect::<Vec<_>>())?;
    let mut found = Findings::default();
    check_recorded(&mut found, &record, "/record", &sweep, facts);
    found.finish(ResolvedCaseStudy { sweep, speeds: vec![0], record })
}

/// The case study of speeds of a sweep that has ended; `critical` are the indices of its critical speeds.
pub fn histories_of(
    sweep: &ResolvedSweep,
    request: &HistoriesRequest,
    critical: &BTreeSet<u32>,
    facts: &ModelFacts,
) -> Result<ResolvedCaseStudy, Vec<Violation>> {
    let mut found = Findings::default();
    check_histories(&mut found, request, "", sweep, facts);
    let speeds: Vec<u32> = wanted(request, critical);
    found.require(
        !speeds.is_empty(),
        "/speeds",
        "the sweep has no critical speed: name speeds by their indices",
    );
    found.finish(ResolvedCaseStudy { sweep: sweep.clone(), speeds, record: request.recorded() })
}

/// Indices of the speeds that histories are asked of.
pub(crate) fn wanted(request: &HistoriesRequest, critical: &BTreeSet<u32>) -> Vec<u32> {
    match &request.speeds {
        HistorySpeeds::Critical => critical.iter().copied().take(MOST_SPEEDS).collect(),
        HistorySpeeds::Indices(indices) => indices.clone(),
    }
}

/// Checks the histories that a sweep asks for, at `pointer`.
pub(super) fn check_histories(
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

fn check_recorded(
    found: &mut Findings,
    record: &Recorded,
    pointer: &str,
    sweep: &ResolvedSweep,
    facts: &ModelFacts,
) {
    let run = sweep.integration.revolutions;
    let [from, to] = revolutions(record, sweep);
    let at = format!("{pointer}/revolutions");
    let message =
        format!("the run has {run} revolutions: name where recording begins and ends, such as [0, {run}]");
    found.require(from < to && to <= run, &at, message);
    if !(from < to && to <= run) {
        return;
    }
    for (place, quantity) in record.quantities.iter().enumerate() {
        let again = record.quantities[..place].contains(quantity);
        found.require(!again, &format!("{pointer}/quantities/{place}"), "is in the list already");
    }
    let (sensors, sectors) = (sweep.sensors.len(), facts.sectors as usize);
    let of = |quantity, numbers: usize| if record.wants(quantity) { numbers } else { 0 };
    let pairs = sectors * facts.contact_nodes as usize;
    let lines = of(RecordedQuantity::Displacement, sensors)
        + of(RecordedQuantity::Velocity, sensors)
        + of(RecordedQuantity::ContactForce, pairs)
        + of(RecordedQuantity::Contact, 2)
        + of(RecordedQuantity::Energy, 8);
    let samples = most_samples(sweep, sectors).saturating_mul(to.saturating_sub(from) as usize);
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

/// Where recording begins and ends: the window, if nothing else is asked for.
pub(crate) fn revolutions(record: &Recorded, sweep: &ResolvedSweep) -> [u32; 2] {
    let run = sweep.integration.revolutions;
    record.revolutions.unwrap_or([run.saturating_sub(sweep.integration.window_revolutions), run])
}
