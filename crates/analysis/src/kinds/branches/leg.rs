//! Legs of a branch job: each follows the branches some points further.

use super::course::{Course, FoundFlip, Stretch, UnderWay};
use super::crests::{Crests, Passed};
use super::events::{At, Event, Events};
use super::family::Scenes;
use super::kept::KeptTold;
use super::told::{Told, carried, tell};
use crate::error::{AnalysisError, Violation};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::not_runnable::NotRunnable;
use crate::request::AutoOr;
use crate::resolved::ResolvedBranches;
use crate::result::{
    Bifurcation, BifurcationKind, BranchEnd, BranchLeg, BranchMaximum, BranchPoint, BranchesHead, Track,
};
use rubmap_wheel::dynamics::steady::branch::correct::Found;
use rubmap_wheel::dynamics::steady::branch::follow::{Front, Step};
use rubmap_wheel::dynamics::steady::branch::{Branch, Lap, Lost, Motion};
use rubmap_wheel::dynamics::steady::periodic::NotFound;
use rubmap_wheel::dynamics::steady::response::{Response, Sought};
use rubmap_wheel::revision::VERSION;
use rubmap_wheel::vectors::vectors;

/// Number of points of a leg: at most these are lost when the service dies.
const POINTS: usize = 5;

/// Longest period, in passages over a lobe, up to which period doublings are followed.
const LONGEST: u32 = 8;

/// Largest distance of a flip from the last point of a branch of doubled period, in steps between its last two points, at which the branch
/// joins there.
const AT_FLIP: f64 = 2.0;

/// Relative distance up to which a multiplier that passes 1 belongs to a fold.
const AT_FOLD: f64 = 1e-3;

/// Computes the leg after `course`, or the first one; returns it with the next course, none when nothing is left to follow. Deterministic,
/// on the calling thread.
///
/// # Errors
/// Cancellation; a refusal where there is nothing to follow.
pub(crate) fn branch_leg(
    sector: &ReducedSector,
    asked: &ResolvedBranches,
    course: Option<Course>,
    monitor: &dyn Monitor,
) -> Result<(BranchLeg, Option<Course>), AnalysisError> {
    let scenes = Scenes::new(sector, asked).map_err(|reason| refused("/along", &reason))?;
    let go_on = || !monitor.is_cancelled();
    let Course { under_way, mut waiting, mut branches, flips: mut known } = match course {
        Some(course) => course,
        None => {
            monitor.progress(0.0, "seeking a periodic response");
            begin(&scenes, asked, &go_on)?
        }
    };
    let UnderWay { stretch, points, mut last, crests, pending } = under_way;
    let of_branch = known.iter().filter(|known| known.branch == stretch.track.branch);
    let known_flips = of_branch.map(|known| known.flip.clone()).collect();
    let mut walk = Walk { points, crests, pending, known_flips, ..Walk::new(&scenes, asked, &stretch) };
    let branch =
        Branch { family: &scenes, lap: walk.lap, span: asked.along.to - asked.along.from, go_on: &go_on };
    let end = walk.go(&branch, &mut last, monitor)?;
    let Walk { front, points, found, mut bifurcations, maxima, flips, crests, pending, passed, .. } = walk;
    let found_flips = bifurcations.iter().filter(|found| found.kind == BifurcationKind::Flip);
    known.extend(found_flips.map(|flip| FoundFlip { branch: stretch.track.branch, flip: flip.clone() }));
    if let Some(other) = waiting.iter_mut().find(|other| other.continues(&stretch)) {
        other.go_on_from(passed);
    }
    for Event { bifurcation, motion, grows, lobe_passages, passages } in flips {
        let track = Track {
            branch: branches,
            lobe_passages: Some(2 * lobe_passages),
            doubles: Some((stretch.track.branch, bifurcation.value)),
        };
        branches += 1;
        let stretch = Stretch::new(track, Some(2 * passages), &Front::aside(motion, grows));
        waiting.insert(0, Stretch { flip_error: bifurcation.error, ..stretch });
    }
    if matches!(end, Some(BranchEnd::Joins)) {
        waiting.retain(|other| !stretch.doubles_as(other) || !is_at(&branch, &front, &other.start()));
    }
    let (track, backwards) = (stretch.track.clone(), stretch.backwards);
    let under_way = if end.is_none() {
        let stretch = Stretch { front: (&front).into(), ..stretch };
        Some(UnderWay { stretch, points, last, crests, pending })
    } else {
        bifurcations.extend(pending);
        waiting.pop().map(UnderWay::new)
    };
    let head = head(&scenes, sector, asked);
    let is_last = under_way.is_none();
    let leg = BranchLeg { head, track, backwards, points: found, bifurcations, maxima, end, is_last };
    Ok((leg, under_way.map(|under_way| Course { under_way, waiting, branches, flips: known })))
}

/// Seeks the first response and begins the branch through it, to both sides.
fn begin(
    scenes: &Scenes<'_>,
    asked: &ResolvedBranches,
    go_on: &dyn Fn() -> bool,
) -> Result<Course, AnalysisError> {
    let Sought { response, .. } = scenes.seek(go_on).map_err(|reason| refused("/speed", &reason))?;
    let state = match response {
        Ok(Response { start, .. }) => start,
        Err(NotFound::Cancelled) => return Err(AnalysisError::Cancelled),
        Err(reason) => {
            let message = format!("{reason}; begin at another speed, or with more damping and follow that");
            return Err(AnalysisError::Refused(vec![Violation::new("/speed", message)]));
        }
    };
    let (start, span) = (asked.start(), asked.along.to - asked.along.from);
    let stretch = |backwards: bool| {
        let sign = if backwards { -1.0 } else { 1.0 };
        let front = Front::new(Motion { value: start, state: state.clone() }, span, sign);
        let track = Track { branch: 0, lobe_passages: None, doubles: None };
        Stretch { backwards, tells_start: false, ..Stretch::new(track, None, &front) }
    };
    // Towards larger values first, if there are any; where it begins is told once.
    let (is_least, is_most) = (start <= asked.along.from, start >= asked.along.to);
    let under_way = UnderWay::new(Stretch { tells_start: true, ..stretch(is_most) });
    let waiting = if is_least || is_most { Vec::new() } else { vec![stretch(true)] };
    Ok(Course { under_way, waiting, branches: 1, flips: Vec::new() })
}

fn refused(pointer: &str, reason: &NotRunnable) -> AnalysisError {
    AnalysisError::Refused(vec![Violation::new(pointer, reason.to_string())])
}

fn head(scenes: &Scenes<'_>, sector: &ReducedSector, asked: &ResolvedBranches) -> BranchesHead {
    let setting = scenes.setting();
    BranchesHead {
        parameter: asked.along.parameter,
        sensors: asked.sweep.sensors.iter().copied().map(Into::into).collect(),
        scheme: setting.scheme,
        kept_modes: match setting.kept_modes {
            AutoOr::Fixed(kept) => Some(kept),
            AutoOr::Auto => None,
        },
        steps_per_revolution: setting.steps_per_revolution,
        units: sector.units.clone(),
        settings: asked.clone().into(),
        version: VERSION.to_owned(),
        vectors: vectors(),
    }
}

/// Flip at which a branch of doubled period begins.
#[derive(Clone, Copy)]
struct FlipStart {
    value: f64,
    /// Largest distance of the flip from `value`.
    error: f64,
}

/// Leg that is being computed.
struct Walk<'a> {
    scenes: &'a Scenes<'a>,
    asked: &'a ResolvedBranches,
    lap: Lap,
    tells_start: bool,
    branch: u32,
    /// Flip at which a branch of doubled period begins.
    flip: Option<FlipStart>,
    /// Flips of the branch found by earlier legs.
    known_flips: Vec<Bifurcation>,
    doubles: bool,
    front: Front,
    /// Number of points of the stretch, without its beginning.
    points: u32,
    found: Vec<BranchPoint>,
    bifurcations: Vec<Bifurcation>,
    maxima: Vec<BranchMaximum>,
    flips: Vec<Event>,
    crests: Crests,
    /// Multiplier that passed 1 before the last point.
    pending: Option<Bifurcation>,
    /// Points of this leg, without the beginning of the stretch.
    passed: Vec<Passed>,
    joins: bool,
}

impl<'a> Walk<'a> {
    /// Begins a leg of `stretch`, of which nothing is done yet.
    fn new(scenes: &'a Scenes<'a>, asked: &'a ResolvedBranches, stretch: &Stretch) -> Self {
        let doubles = stretch.track.doubles;
        Self {
            scenes,
            asked,
            lap: stretch.passages.map_or(Lap::Symmetric, |passages| Lap::Lobes(passages as usize)),
            tells_start: stretch.tells_start,
            branch: stretch.track.branch,
            flip: doubles.map(|(_, value)| FlipStart { value, error: stretch.flip_error }),
            known_flips: Vec::new(),
            doubles: asked.doubled,
            front: (&stretch.front).into(),
            points: 0,
            found: Vec::new(),
            bifurcations: Vec::new(),
            maxima: Vec::new(),
            flips: Vec::new(),
            crests: Crests::default(),
            pending: None,
            passed: Vec::new(),
            joins: false,
        }
    }

    /// Follows the branch; returns why it ends, if it does.
    fn go(
        &mut self,
        branch: &Branch<'_>,
        kept_last: &mut Option<KeptTold>,
        monitor: &dyn Monitor,
    ) -> Result<Option<BranchEnd>, AnalysisError> {
        let mut last = match kept_last {
            Some(kept) => Told::from(&*kept),
            None => match self.start(branch) {
                Ok(told) => told,
                Err(lost) => return end(lost).map(Some),
            },
        };
        let range = (self.asked.along.from, self.asked.along.to);
        let ended = loop {
            if self.found.len() >= POINTS {
                break None;
            }
            if self.points >= self.asked.most_points {
                break Some(BranchEnd::MostPoints);
            }
            self.say(monitor);
            let step = match branch.next(&mut self.front, range) {
                Ok(step) => step,
                Err(lost) => break Some(end(lost)?),
            };
            let (found, is_edge) = match step {
                Step::Point(found) => (found, false),
                Step::Edge(found) => (found, true),
            };
            let told = match self.look(branch, &last, &found) {
                Ok(told) => told,
                Err(lost) => break Some(end(lost)?),
            };
            self.points += 1;
            if self.points == 2 {
                self.begin_at_flip(branch, &found.motion);
            }
            self.found.push(told.point(&found, self.scenes.speed(found.motion.value)));
            self.front.move_to(found.motion);
            last = told;
            if self.joins {
                break Some(BranchEnd::Joins);
            }
            if is_edge {
                break Some(BranchEnd::LeavesRange);
            }
        };
        *kept_last = Some((&last).into());
        Ok(ended)
    }

    /// Computes the result at the beginning of the stretch.
    fn start(&mut self, branch: &Branch<'_>) -> Result<Told, Lost> {
        let motion = self.front.last.clone();
        let told = tell(self.scenes, branch, &motion, &motion.state)?;
        self.crests.pass(Passed::new(&motion, &told));
        if self.tells_start {
            let found = Found { residual: branch.off(&motion)?, motion, steps: 0, revolutions: 0.0 };
            self.found.push(told.point(&found, self.scenes.speed(found.motion.value)));
        }
        Ok(told)
    }

    /// Computes the result at a new point, and the events on the way to it.
    fn look(&mut self, branch: &Branch<'_>, last: &Told, found: &Found) -> Result<Told, Lost> {
        let motion = &found.motion;
        let hint = carried(self.scenes, &last.disturbances, self.front.last.value, motion.value)?;
        let told = tell(self.scenes, branch, motion, &hint)?;
        let events = Events { scenes: self.scenes, branch };
        let here = At { motion, told: &told };
        let there = At { motion: &self.front.last, told: last };
        let fold = match &self.front.before {
            Some(before) => events.fold([before, &self.front.last, motion])?,
            None => None,
        };
        let passed = Passed::new(motion, &told);
        self.passed.push(passed.clone());
        self.maxima.extend(events.maxima(self.crests.pass(passed))?);
        self.joins = told.passages < self.passages() || self.has_crossed(branch, motion)?;
        let pending = self.pending.take();
        if let Some((bifurcation, _)) = fold.filter(|(fold, _)| !self.joins && !self.is_at_its_flip(fold)) {
            let is_same = |other: &Bifurcation| {
                (other.value - bifurcation.value).abs() <= AT_FOLD * bifurcation.value.abs()
            };
            self.bifurcations.extend(pending.filter(|pending| !is_same(pending)));
            self.bifurcations.push(bifurcation);
            return Ok(told);
        }
        self.bifurcations.extend(pending);
        // Where a branch of doubled period begins and joins, the stability is that of the one that it doubles.
        if self.joins || last.passages < self.passages() {
            return Ok(told);
        }
        let Some(event) = events.change(there, here)? else { return Ok(told) };
        match event.bifurcation.kind {
            BifurcationKind::Branching => self.pending = Some(event.bifurcation),
            kind => {
                let mut others = self.bifurcations.iter().chain(&self.known_flips);
                let again = others.any(|other| other.is_same_as(&event.bifurcation));
                self.bifurcations.push(event.bifurcation.clone());
                if !again && kind == BifurcationKind::Flip && self.doubles && 2 * event.passages <= LONGEST {
                    self.flips.push(event);
                }
            }
        }
        Ok(told)
    }

    /// Whether a fold is within the error of the flip where the branch begins: such a branch begins beside itself.
    fn is_at_its_flip(&self, fold: &Bifurcation) -> bool {
        self.flip.is_some_and(|flip| (fold.value - flip.value).abs() <= flip.error + fold.error)
    }

    /// Moves the beginning of a branch of doubled period to where its amplitude is zero, within the error of the flip, by a parabola
    /// through its first two points, the last of which is `second`. Leaves it where it is if they cannot be computed.
    fn begin_at_flip(&mut self, branch: &Branch<'_>, second: &Motion) {
        let (Some(FlipStart { value, error }), Lap::Lobes(lobes)) = (self.flip, self.lap) else { return };
        let Some(start) = self.found.first_mut().filter(|start| start.value == value) else { return };
        let single = Branch { lap: Lap::Lobes(lobes / 2), ..*branch };
        let first = &self.front.last;
        let (Ok(a), Ok(b)) = (single.off(first), single.off(second)) else { return };
        let (a, b) = (a * a, b * b);
        let zero = first.value - a * (second.value - first.value) / (b - a);
        if (zero - value).abs() <= error {
            (start.value, start.speed_rad_s) = (zero, self.scenes.speed(zero));
        }
    }

    /// Passages over a lobe after which motions of a doubled branch repeat; 0 for other branches.
    fn passages(&self) -> u32 {
        match self.lap {
            Lap::Symmetric => 0,
            Lap::Lobes(lobes) => lobes as u32,
        }
    }

    /// Whether a branch of doubled period has crossed the one that it doubles since its last point: beyond that it is itself once more,
    /// half a period later, and the changes over half a period have the opposite sign.
    fn has_crossed(&self, branch: &Branch<'_>, motion: &Motion) -> Result<bool, Lost> {
        let Lap::Lobes(lobes) = self.lap else { return Ok(false) };
        // Branches begin where nothing changes.
        if self.front.before.is_none() {
            return Ok(false);
        }
        Branch { lap: Lap::Lobes(lobes / 2), ..*branch }.turns_about(&self.front.last, motion)
    }

    /// Reports progress: the share of the range that the first branch has covered.
    fn say(&self, monitor: &dyn Monitor) {
        let (along, start) = (self.asked.along, self.asked.start());
        let value = self.front.last.value;
        let backwards = self.front.first.value < 0.0;
        let seen = match (self.branch, backwards) {
            (0, false) => value - start,
            (0, true) => along.to - value,
            _ => along.to - along.from,
        };
        let words = format!("branch {}, {} points, at {:.6}", self.branch + 1, self.points, value);
        monitor.progress((seen / (along.to - along.from)).clamp(0.0, 1.0), &words);
    }
}

/// Whether a branch that joins another one between its last two points does so at `flip`.
fn is_at(branch: &Branch<'_>, front: &Front, flip: &Motion) -> bool {
    let Some(before) = &front.before else { return false };
    let away = |from: &Motion| branch.distance(&front.last, from);
    matches!((away(before), away(flip)), (Ok(step), Ok(away)) if away <= AT_FLIP * step)
}

/// End of a branch that was lost, with the reason.
fn end(lost: Lost) -> Result<BranchEnd, AnalysisError> {
    match lost {
        Lost::Cancelled => Err(AnalysisError::Cancelled),
        lost => Ok(BranchEnd::Lost { reason: lost.to_string() }),
    }
}
