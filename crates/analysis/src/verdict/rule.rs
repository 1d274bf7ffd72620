//! Rule of the verdict on one range.

use super::evidence::Seen;
use super::limit::Asked;
use super::open::{RangeEvidence, questions};
use super::points::{indices, is_completed};
use crate::resolved::ResolvedSweep;
use crate::result::{
    LimitKind, OpenQuestion, Point, PointStatus, Position, RangeVerdict, Standing, VerdictWord, WorstValue,
};
use crate::span::Span;

/// Verdict on a range with the questions that are open in it.
#[derive(Debug)]
pub(super) struct Judged {
    pub(super) range: RangeVerdict,
    pub(super) open: Vec<OpenQuestion>,
}

/// Judges a range: `act` where a limit is passed or a motion diverged whose blades do not stiffen, otherwise `undecided` where something is open, otherwise `watch` where a
/// critical speed is near or a limit reached, otherwise `clear`. A stricter limit and a wider range only add to what makes `act`.
pub(super) fn judge(request: &ResolvedSweep, span: &Span, seen: &Seen<'_>) -> Judged {
    let Seen { finished, peaks, asked, .. } = *seen;
    let speeds = request.speeds.rad_s();
    let near: Vec<&Point> = finished.points.iter().filter(|point| span.reaches(point.speed_rad_s)).collect();
    let completed: Vec<&Point> = near.iter().copied().filter(|point| is_completed(point)).collect();
    let ended = |status: PointStatus| indices(near.iter().copied().filter(|point| point.status == status));
    let missing: Vec<u32> = (0..request.speeds.count())
        .filter(|&index| span.reaches(speeds[index as usize]))
        .filter(|index| !finished.indices.contains(index))
        .collect();
    let at = |wanted: Position| {
        peaks.iter().filter(|peak| span.position(peak.speed_rad_s) == wanted).count() as u32
    };
    let mut range = RangeVerdict {
        name: span.name.clone(),
        verdict: VerdictWord::Clear,
        from_rad_s: span.from,
        to_rad_s: span.to,
        separation_percent: span.separation_percent,
        speeds: completed.len() as u32,
        missing,
        failed: ended(PointStatus::Failed),
        diverged: ended(PointStatus::Diverged),
        limits: asked
            .limits
            .iter()
            .filter_map(|&(kind, allowed)| worst(&completed, asked, kind, allowed))
            .collect(),
        critical_inside: at(Position::Inside),
        critical_within_separation: at(Position::WithinSeparation),
    };
    let evidence = RangeEvidence { request, span, range: &range, completed: &completed, seen };
    let open = questions(&evidence);
    range.verdict = word(&range, &completed, asked, request, !open.is_empty());
    Judged { range, open }
}

/// Verdict on a range in a word. Where blades stiffen, a motion without bounds may be that of their energy, which is of fourth order.
fn word(
    range: &RangeVerdict,
    completed: &[&Point],
    asked: &Asked,
    request: &ResolvedSweep,
    is_open: bool,
) -> VerdictWord {
    // Every value counts, not only the largest: errors differ from speed to speed.
    let any = |wanted: Standing| {
        let has = |point: &&Point| asked.values(point).iter().any(|judged| judged.standing == wanted);
        completed.iter().any(has)
    };
    if (!range.diverged.is_empty() && !request.scene.blades_stiffen()) || any(Standing::Passed) {
        VerdictWord::Act
    } else if is_open || asked.limits.is_empty() {
        VerdictWord::Undecided
    } else if range.critical_inside + range.critical_within_separation > 0 || any(Standing::Reached) {
        VerdictWord::Watch
    } else {
        VerdictWord::Clear
    }
}

/// Worst value of a limit: one that passes it before one that may, then the largest; none where no value is known.
fn worst(completed: &[&Point], asked: &Asked, kind: LimitKind, allowed: f64) -> Option<WorstValue> {
    let of = |point: &&Point| {
        let judged = asked.judged(point, kind, allowed)?;
        Some(WorstValue { index: point.index, speed_rad_s: point.speed_rad_s, judged })
    };
    completed.iter().filter_map(of).max_by(|a, b| a.judged.concern(&b.judged))
}
