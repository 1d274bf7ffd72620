//! Questions that are open in a range: what could hide a limit that is passed.

use super::coverage::NotCovered;
use super::evidence::Seen;
use super::hidden::{Maximum, wide_steps, widest_step};
use super::points::indices;
use super::sentence::{rpm, speeds as of_speeds};
use crate::effects::geometric_nonlinearity::request::Bending;
use crate::request::{AutoOr, SweepDirection};
use crate::resolved::ResolvedSweep;
use crate::result::{
    LimitKind, OpenKind, OpenQuestion, Point, RangeVerdict, Stability, Standing, StiffeningVerdict,
    ValidityMeasure, ValidityVerdict, Verdict, WheelCriticalSpeed,
};
use crate::span::Span;

/// Range with everything by which its open questions are found.
pub(super) struct RangeEvidence<'a> {
    pub(super) request: &'a ResolvedSweep,
    pub(super) span: &'a Span,
    pub(super) range: &'a RangeVerdict,
    /// Speeds inside the range or its separation that were completed.
    pub(super) completed: &'a [&'a Point],
    pub(super) seen: &'a Seen<'a>,
}

/// Questions that are open in a range.
pub(super) fn questions(evidence: &RangeEvidence) -> Vec<OpenQuestion> {
    let mut found = Vec::new();
    found.extend(evidence.not_covered());
    found.extend(evidence.beside_critical());
    found.extend(evidence.still());
    found.extend(evidence.without_result());
    found.extend(evidence.not_trusted());
    found.extend(evidence.moved_into_range());
    found.extend(evidence.of_peaks());
    for &(kind, allowed) in &evidence.seen.asked.limits {
        found.extend(evidence.of_limit(kind, allowed));
    }
    found
}

impl RangeEvidence<'_> {
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

    /// Question about stretches of the range, or of a sweep without ranges, that no speed of the sweep covers.
    fn not_covered(&self) -> Option<OpenQuestion> {
        let NotCovered { finding, remedy } = NotCovered::of(self.request, self.span)?;
        Some(self.question(OpenKind::RangeNotCovered, Vec::new(), finding, remedy))
    }

    fn without_result(&self) -> impl Iterator<Item = OpenQuestion> {
        let missing =
            self.about(OpenKind::SpeedsMissing, &self.range.missing, "without a result yet", self.wait());
        let failed = self.about(
            OpenKind::SpeedsFailed,
            &self.range.failed,
            "that could not be computed",
            if self.request.scene.blades_stiffen() {
                "read the reason (`message` of these speeds), and ask for speeds close beside them or a scene with smaller motions"
            } else {
                "read the reason (`message` of these speeds), and ask for speeds close beside them"
            },
        );
        let none_completed =
            self.completed.is_empty() && !(self.range.failed.is_empty() && self.range.diverged.is_empty());
        // Refinement, control runs and measured validity are still to come.
        let unended = self.range.missing.is_empty() && self.seen.driven.is_none() && !none_completed;
        let unended = unended.then(|| {
            let finding = match self.seen.unfinished {
                true => "the job may still add speeds and estimate errors",
                false => "the job ended before speeds were added and errors estimated",
            };
            self.question(OpenKind::SpeedsMissing, Vec::new(), finding.to_owned(), self.wait())
        });
        missing.into_iter().chain(failed).chain(unended)
    }

    /// Remedy where results are still to come.
    fn wait(&self) -> &'static str {
        match self.seen.unfinished {
            true => "wait until the job is done, and continue it if it is paused",
            false => "post its request again: the job was cancelled or failed",
        }
    }

    fn not_trusted(&self) -> impl Iterator<Item = OpenQuestion> {
        let unsettled = self.those(|point| {
            point.settling.as_ref().is_none_or(|settling| settling.verdict == Verdict::NotSettled)
        });
        let unstable = self.those(|point| {
            let steady = point.steady.as_ref().filter(|steady| steady.taken);
            steady.is_some_and(|steady| {
                !matches!(steady.stability, Some(Stability::Stable | Stability::Narrow))
            })
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
                OpenKind::NotSettled,
                &unstable,
                "whose periodic response is not known to be stable, so that no machine may show it",
                "march there: `integration.steady` of \"auto\"",
            ),
            self.about(
                OpenKind::UnsoundStiffness,
                &unsound,
                "that rest on an unsound K(Ω)",
                "give stiffness matrices of the undeformed geometry; `stiffening` of the model says what is wrong",
            ),
            self.about(
                OpenKind::BeyondLinearTheory,
                &beyond,
                if self.request.scene.geometric_nonlinearity.is_some() {
                    "beyond what the scene simulates"
                } else {
                    "beyond linear theory"
                },
                self.beyond_linear_theory(),
            ),
            self.about(
                OpenKind::BeyondLinearTheory,
                if self.request.scene.blades_stiffen() { &self.range.diverged } else { &[] },
                "where blades bent farther than their energy of fourth order may hold",
                "a scene with smaller motions",
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

    /// Question about critical speeds outside the range that stiffer or softer blades may have in it. A frequency changes by half the excess
    /// energy; the side is left open, since limits are on its size.
    fn moved_into_range(&self) -> Option<OpenQuestion> {
        if self.request.scene.blades_stiffen() {
            return None;
        }
        let excess = |point: &Point| {
            let mut checks = point.validity.iter().flat_map(|validity| &validity.checks);
            let energy = checks.find(|check| check.what == ValidityMeasure::ExcessEnergy)?;
            energy.is_doubtful().then_some(energy.value)
        };
        let may_be_in = |peak: &&WheelCriticalSpeed| {
            let point = self.seen.finished.points.iter().find(|point| point.index == peak.index);
            let moved = 0.5 * point.and_then(excess).unwrap_or(0.0);
            let (from, to) = (peak.speed_rad_s * (1.0 - moved), peak.speed_rad_s * (1.0 + moved));
            !self.span.reaches(peak.speed_rad_s) && from <= self.span.highest() && to >= self.span.lowest()
        };
        let mut speeds: Vec<u32> = self.seen.peaks.iter().filter(may_be_in).map(|peak| peak.index).collect();
        speeds.sort_unstable();
        self.about(
            OpenKind::BeyondLinearTheory,
            &speeds,
            "beside the range, critical by linear theory, whose excess energy may move the peak into it",
            if self.request.scene.friction.is_some() {
                "a separation that reaches the peak: `separation_percent`"
            } else {
                "a geometrically non-linear calculation: `scene.geometric_nonlinearity.include` of \"full\"; or a separation that reaches the peak"
            },
        )
    }

    /// Remedy where linear theory ends. Blades that bend far help where their bending was measured, which takes a mesh.
    fn beyond_linear_theory(&self) -> &'static str {
        let is_beyond = |of: &[ValidityMeasure]| {
            let validities = self.completed.iter().filter_map(|point| point.validity.as_ref());
            let mut checks = validities.flat_map(|validity| &validity.checks);
            checks.any(|check| of.contains(&check.what) && check.verdict() == ValidityVerdict::Beyond)
        };
        let is_bending = is_beyond(&[ValidityMeasure::ExcessEnergy, ValidityMeasure::SecondOrderGap]);
        let scene = &self.request.scene;
        match scene.geometric_nonlinearity.as_ref().map(|of| of.include) {
            None if !is_bending => "a scene with smaller motions",
            None if scene.friction.is_some() => {
                "a scene with smaller motions; beside friction, blades that bend far cannot be computed"
            }
            None => {
                "a geometrically non-linear calculation: `scene.geometric_nonlinearity`; or a scene with smaller motions"
            }
            Some(_) if is_beyond(&[ValidityMeasure::OutsideCoordinates]) => {
                "more `scene.geometric_nonlinearity.coordinates`, or a scene with smaller motions"
            }
            Some(Bending::Kinematics) if is_bending => {
                "stiffening of the blades, too: `scene.geometric_nonlinearity.include` of \"full\"; or a scene with smaller motions"
            }
            Some(_) => "a scene with smaller motions",
        }
    }

    /// Question about peaks whose top may lie in the range and is not resolved.
    fn of_peaks(&self) -> Option<OpenQuestion> {
        let hides = |maximum: &&Maximum| maximum.may_lie_in(self.span, self.request, self.seen.finished);
        let mut speeds: Vec<u32> =
            self.seen.maxima.iter().filter(hides).map(|maximum| maximum.index).collect();
        speeds.sort_unstable();
        let remedy = if self.request.refine {
            "ask for finer speeds around these peaks, and beyond an end of the sweep"
        } else {
            "`refine` of true, or finer speeds around these peaks, and beyond an end of the sweep"
        };
        self.about(OpenKind::PeakUnresolved, &speeds, "whose peak is not resolved", remedy)
    }

    /// Question about linear critical speeds in the range beside which steps are wide.
    fn beside_critical(&self) -> Option<OpenQuestion> {
        let wide = wide_steps(self.request, self.span, self.seen.driven?);
        let first = wide.first()?.crossing;
        let mut several: Vec<f64> = wide.iter().map(|step| step.crossing.speed_rad_s).collect();
        several.dedup();
        let more = match several.len() {
            1 => String::new(),
            several => format!(", and beside {} more", several - 1),
        };
        let widest = wide.iter().map(|step| 1.0 - step.from / step.to).fold(0.0, f64::max);
        let finding = format!(
            "a step of {:.1} % between speeds beside the linear critical speed at {} (engine order {}, nodal diameter {}){more}",
            100.0 * widest,
            rpm(first.speed_rad_s),
            first.engine_order,
            first.nodal_diameter,
        );
        let refine = if self.request.refine { "" } else { "`refine` of true, or " };
        let remedy =
            format!("{refine}`speeds` in steps of at most {:.1} % there", 100.0 * widest_step(self.request));
        Some(self.question(OpenKind::RangeNotCovered, Vec::new(), finding, &remedy))
    }

    /// Question where nothing touches and nothing else moves the wheel: such a sweep tells nothing about contact.
    fn still(&self) -> Option<OpenQuestion> {
        let touches = |point: &Point| point.contact.as_ref().is_some_and(|contact| contact.peak_force > 0.0);
        let is_still = self.request.scene.engine_order_excitation.is_empty()
            && !self.completed.is_empty()
            && !self.completed.iter().any(|point| touches(point));
        is_still.then(|| {
            self.question(
                OpenKind::NothingTouches,
                Vec::new(),
                "no tip touches the casing at any of its speeds, and no force moves the wheel".to_owned(),
                "lobes that reach the tips or a smaller clearance, or forces: `engine_order_excitation`",
            )
        })
    }

    /// Questions about the values of one limit.
    fn of_limit(&self, kind: LimitKind, allowed: f64) -> impl Iterator<Item = OpenQuestion> {
        let judged = |point: &Point| self.seen.asked.judged(point, kind, allowed);
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
        let awaited = (self.seen.asked.awaits_errors(self.request, kind) && unsure.is_empty()).then(|| {
            let finding = format!("the control runs that tell the error of the {words} are not done");
            self.question(OpenKind::ErrorUnknown, Vec::new(), finding, self.wait())
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

    /// Remedy where the error of a quantity is not known.
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
        LimitKind::ClearanceConsumption => "a scene with contact, or a limit of the tip motion instead",
        LimitKind::Utilisation => {
            "strengths: fatigue and ultimate strength of the materials of the model's mesh; where stress itself is missing, `message` of the \
             speed says why"
        }
        LimitKind::TipMotion | LimitKind::NodeForce => {
            "post the request again: an earlier version, which did not record it, computed these speeds"
        }
    }
}
