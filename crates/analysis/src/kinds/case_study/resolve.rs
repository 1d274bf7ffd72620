//! Case studies, checked against their model or their sweep.

use std::collections::BTreeSet;

use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::{CaseStudyRequest, HistoriesRequest, RecordedQuantity};
use crate::resolve::findings::Findings;
use crate::resolve::plain_sweep::{PlainSweep, one};
use crate::resolve::recorded::{check_fields, check_histories, check_recorded, wanted};
use crate::resolved::{ResolvedCaseStudy, ResolvedSweep};

/// Parses a case study and checks it against its model.
pub(crate) fn resolve_case_study(
    request: CaseStudyRequest,
    facts: &ModelFacts,
) -> Result<ResolvedCaseStudy, Vec<Violation>> {
    let record = request.record;
    let sweep = PlainSweep {
        model: request.model,
        modes_per_speed: request.modes_per_speed,
        speeds: one(request.speed),
        scene: request.scene,
        integration: request.integration,
        sensors: request.sensors,
        max_engine_order: request.max_engine_order,
        fields: request.fields,
    }
    .resolve(facts, "/speed/value")?;
    let mut found = Findings::default();
    check_recorded(&mut found, &record, "/record", &sweep, facts);
    check_fields(&mut found, sweep.fields, record.wants(RecordedQuantity::State));
    found.finish(ResolvedCaseStudy { sweep, speeds: vec![0], record })
}

/// Case study of speeds of a sweep that has ended; `critical` are the indices of its critical speeds.
pub(crate) fn histories_of(
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
