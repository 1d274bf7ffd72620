//! Case studies, held against what they are of.

use std::collections::BTreeSet;

use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::sweep::default_peak_prominence;
use crate::request::{
    CaseSpeed, CaseStudyRequest, HistoriesRequest, Record, RecordedQuantity, SpeedSet, Speeds,
    SweepDirection, SweepRequest,
};
use crate::resolve::findings::Findings;
use crate::resolve::recorded::{check_fields, check_histories, check_recorded, wanted};
use crate::resolve::resolve_sweep;
use crate::resolved::{ResolvedCaseStudy, ResolvedSweep};

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
        reproducible: false,
        accuracy: None,
        budget: None,
        control_speeds: None,
        record: Record::default(),
        fields: request.fields,
    };
    let at_its_field = |violation: Violation| match violation.pointer.strip_prefix("/speeds") {
        Some(_) => Violation { pointer: "/speed/value".to_owned(), ..violation },
        None => violation,
    };
    let sweep = resolve_sweep(sweep, facts)
        .map_err(|found| found.into_iter().map(at_its_field).collect::<Vec<_>>())?;
    let mut found = Findings::default();
    check_recorded(&mut found, &record, "/record", &sweep, facts);
    check_fields(&mut found, sweep.fields, record.wants(RecordedQuantity::State));
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
