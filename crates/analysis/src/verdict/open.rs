//! Questions that are open in a range: what could hide a limit that is passed.

use super::limit::Asked;
use super::points::{Finished, indices};
use super::range::Span;
use super::sentence::{rpm, speeds as of_speeds};
use crate::request::{AutoOr, SweepDirection};
use crate::resolved::ResolvedSweep;
use crate::result::{
    LimitKind, OpenKind, OpenQuestion, Point, RangeVerdict, Standing, StiffeningVerdict, ValidityVerdict,
    Verdict, WheelCriticalSpeed,
};
use rubmap_wheel::response::critical_speed::RESOLVED_SHARE;

/// Largest step between neighbouring speeds, as a share of the higher one, by which a range counts as covered: a mode's critical speeds at engine
/// orders 20 and 21 are as far apart, so a wider step passes over whole critical speeds.
const WIDEST_STEP: f64 = 0.05;

/// Facts about a range by which questions are found.
pub(super) struct Ground<'a> {
    pub(super) request: &'a ResolvedSweep,
    pub(super) span: &'a Span,
    pub(super) range: &'a RangeVerdict,
    pub(super) finished: &'a Finished<'a>,
    /// Speeds inside the range or its separation that were completed.
    pub(super) completed: &'a [&'a Point],
    pub(super) peaks: &'a [WheelCriticalSpeed],
    pub(super) asked: &'a Asked,
}

/// Questions that are open in a range.
pub(super) fn questions(ground: &Ground) -> Vec<OpenQuestion> {
    let mut found = Vec::new();
    found.extend(ground.not_covered());
    found.extend(ground.without_result());
    found.extend(ground.not_trusted());
    found.extend(ground.of_peaks());
    for &(kind, allowed) in &ground.asked.limits {
        found.extend(ground.of_limit(kind, allowed));
    }
    found
}

impl Ground<'_> {
    fn question(&self, what: OpenKind, speeds: Vec<u32>, finding: String, remedy: &str) -> OpenQuestion {
        OpenQuestion { what, range: self.span.name.clone(), speeds, finding, remedy: remedy.to_owned() }
    }

    /// Question about `speeds`, if there are any.
    fn about(&self, what: OpenKind, speeds: &[u32], finding: &str, remedy: &str) -> Option<OpenQuestion> {
        let finding = format!("{} {finding}", self.named(speeds));
        (!speeds.is_empty()).then(|| self.question(what, speeds.to_vec(), finding, remedy))
    }

    /// Number of these speeds in words, and the first of them.
    fn named(&self, speeds: &[u32]) -> String {
        let all = self.request.speeds.rad_s();
        of_speeds(&speeds.iter().map(|&index| all[index as usize]).collect::<Vec<_>>())
    }

    /// Indices of the completed speeds of which `holds` is true.
    fn those(&self, holds: impl Fn(&Point) -> bool) -> Vec<u32> {
        indices(self.completed.iter().copied().filter(|point| holds(point)))
    }

    /// Question about stretches of the range that no speed of the sweep covers. A sweep without ranges covers itself.
    fn not_covered(&self) -> Option<OpenQuestion> {
        self.span.name.as_ref()?;
        let ascending = self.request.speeds.ascending();
        let (lowest, highest) = (self.span.lowest(), self.span.highest());
        let (first, last) = (ascending.first().copied()?, ascending.last().copied()?);
        let mut bare: Vec<(f64, f64)> = Vec::new();
        if first > lowest && !self.same(first, lowest) {
            bare.push((lowest, first.min(highest)));
        }
        let wide = |pair: &&[f64]| pair[1] - pair[0] > WIDEST_STEP * pair[1];
        let within = |pair: &[f64]| (pair[0].max(lowest), pair[1].min(highest));
        bare.extend(ascending.windows(2).filter(wide).map(within).filter(|(from, to)| from < to));
        if last < highest && !self.same(last, highest) {
            bare.push((last.max(lowest), highest));
        }
        if bare.is_empty() && !ascending.iter().any(|&speed| self.span.contains(speed)) {
            bare.push((self.span.from, self.span.to));
        }
        let &(from, to) = bare.first()?;
        let more = match bare.len() {
            1 => String::new(),
            several => format!(", and {} more stretches", several - 1),
        };
        let finding = format!("no speeds were asked for from {} to {}{more}", rpm(from), rpm(to));
        let remedy = "ask for `speeds` over the whole range and its separation, in steps of at most 5 %";
        Some(self.question(OpenKind::RangeNotCovered, Vec::new(), finding, remedy))
    }

    /// Whether a speed is that of an end, up to the conversion of units.
    fn same(&self, speed: f64, end: f64) -> bool {
        (speed - end).abs() <= 1e-8 * end.abs()
    }

    fn without_result(&self) -> impl Iterator<Item = OpenQuestion> {
        let missing = self.about(
            OpenKind::SpeedsMissing,
            &self.range.missing,
            "without a result yet",
            "wait until the job has ended; if it has, post its request again",
        );
        let failed = self.about(
            OpenKind::SpeedsFailed,
            &self.range.failed,
            "that could not be computed",
            "read the reason in `message` of these speeds, and ask for speeds close beside them",
        );
        missing.into_iter().chain(failed)
    }

    fn not_trusted(&self) -> impl Iterator<Item = OpenQuestion> {
        let unsettled = self.those(|point| {
            point.settling.as_ref().is_none_or(|settling| settling.verdict == Verdict::NotSettled)
        });
        let longer = match self.request.integration.revolutions {
            AutoOr::Auto => "march longer: raise `integration.most_revolutions`",
            AutoOr::Fixed(_) => "march until the motion repeats: `integration.revolutions` of \"auto\"",
        };
        let unsound = self.those(|point| point.stiffening == Some(StiffeningVerdict::Unsound));
        let of_theory =
            |wanted: ValidityVerdict| self.those(|point| point.validity_verdict() == Some(wanted));
        let unchecked = of_theory(ValidityVerdict::NotChecked);
        let beyond = of_theory(ValidityVerdict::Beyond);
        [
            self.about(OpenKind::NotSettled, &unsettled, "whose motion has not settled", longer),
            self.about(
                OpenKind::UnsoundStiffness,
                &unsound,
                "that rest on an unsound K(Ω)",
                "give stiffness matrices of the undeformed geometry; `stiffening` of the model says what is wrong",
            ),
            self.about(
                OpenKind::BeyondLinearTheory,
                &beyond,
                "beyond linear theory",
                "a geometrically non-linear calculation at these speeds, or a scene with smaller motions",
            ),
            self.about(
                OpenKind::LinearTheoryNotChecked,
                &unchecked,
                "where linear theory could not be checked",
                "the elements of the mesh in the package, or the thickness of the blade at its tip: `blade_thickness`",
            ),
        ]
        .into_iter()
        .flatten()
    }

    /// Question about peaks whose top may lie in the range and is not resolved.
    fn of_peaks(&self) -> Option<OpenQuestion> {
        let ascending = self.request.speeds.ascending();
        let ends = [ascending.first().copied(), ascending.last().copied()];
        let hides = |peak: &&WheelCriticalSpeed| !peak.resolved && self.may_hide(peak, ends);
        let mut speeds: Vec<u32> = self.peaks.iter().filter(hides).map(|peak| peak.index).collect();
        speeds.sort_unstable();
        let remedy = if self.request.refine {
            "ask for finer speeds around these peaks, and beyond an end of the sweep"
        } else {
            "`refine` of true, or finer speeds around these peaks, and beyond an end of the sweep"
        };
        self.about(OpenKind::PeakUnresolved, &speeds, "whose peak is not resolved", remedy)
    }

    /// Whether the top of an unresolved peak may lie in the range: between the completed speeds beside it. At an end of the sweep the response
    /// must fall at once for a top to hide beside it.
    fn may_hide(&self, peak: &WheelCriticalSpeed, ends: [Option<f64>; 2]) -> bool {
        let [below, above] = self.finished.beside(peak.speed_rad_s);
        let is_high = |point: &Point| point.tip.is_some_and(|tip| tip.rms >= RESOLVED_SHARE * peak.tip.rms);
        let is_end = ends.contains(&Some(peak.speed_rad_s));
        if is_end && below.xor(above).is_some_and(is_high) {
            return false;
        }
        let from = below.map_or(peak.speed_rad_s, |point| point.speed_rad_s);
        let to = above.map_or(peak.speed_rad_s, |point| point.speed_rad_s);
        from <= self.span.highest() && to >= self.span.lowest()
    }

    /// Questions about the values of one limit.
    fn of_limit(&self, kind: LimitKind, allowed: f64) -> impl Iterator<Item = OpenQuestion> {
        let judged = |point: &Point| self.asked.judged(point, kind, allowed);
        let open = |known: bool| {
            self.those(|point| {
                judged(point).is_some_and(|judged| {
                    judged.standing == Standing::Open && judged.error.is_some() == known
                })
            })
        };
        let words = kind.words();
        let (across, unsure) = (open(true), open(false));
        let unknown = self.those(|point| judged(point).is_none());
        let awaited = (self.asked.awaits_errors(self.request, kind) && unsure.is_empty()).then(|| {
            let finding = format!("the control runs that tell the error of the {words} are not done");
            self.question(OpenKind::ErrorUnknown, Vec::new(), finding, "wait until the job has ended")
        });
        [
            self.about(
                OpenKind::ErrorAcrossLimit,
                &across,
                &format!("where the limit of the {words} lies within the error"),
                "a smaller error: ask for an `accuracy` with a smaller `target`",
            ),
            self.about(
                OpenKind::ErrorUnknown,
                &unsure,
                &format!("where the {words} is within 20 % of its limit and no error is known"),
                self.control(kind),
            ),
            self.about(
                OpenKind::ValueUnknown,
                &unknown,
                &format!("where the {words} is not known"),
                remedy_of_unknown(kind),
            ),
            awaited,
        ]
        .into_iter()
        .flatten()
    }

    /// Way to an error of a quantity.
    fn control(&self, kind: LimitKind) -> &'static str {
        if kind == LimitKind::NodeForce {
            "no control run tells the error of a node's force: compare with a sweep at twice the steps and modes"
        } else if self.request.sweep != SweepDirection::Independent {
            "a sweep up or down has no control runs: compare with a sweep at twice the steps and modes"
        } else {
            "control runs: `control_speeds`"
        }
    }
}

fn remedy_of_unknown(kind: LimitKind) -> &'static str {
    match kind {
        LimitKind::ClearanceConsumption => {
            "a scene with contact and running clearances above 0, or a limit of the tip motion instead"
        }
        LimitKind::Utilisation => {
            "strengths: fatigue and ultimate strength of the materials of the model's mesh; where stress itself is missing, `message` of the \
             speed says why"
        }
        LimitKind::TipMotion | LimitKind::NodeForce => {
            "an earlier version computed these speeds: post the request again"
        }
    }
}
