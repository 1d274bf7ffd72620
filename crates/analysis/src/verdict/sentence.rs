//! Verdicts in words.

use crate::digits::{digits, grouped, percent};
use crate::resolved::ResolvedSweep;
use crate::result::{
    JudgedSpeed, JudgedValue, OpenKind, OpenQuestion, Position, RangeVerdict, SweepVerdict, VerdictWord,
    WorstValue,
};
use rubmap_wheel::dynamics::sector::Units;

/// Most reasons that a sentence names.
const MOST_REASONS: usize = 2;

/// Sentence of a verdict; one on a job that is `unfinished` says so.
pub(super) fn sentence(all: &SweepVerdict, request: &ResolvedSweep, unfinished: bool) -> String {
    let said = |range: &RangeVerdict| match all.verdict {
        VerdictWord::Act => act(range, all, request),
        VerdictWord::Undecided => undecided(range, all),
        VerdictWord::Watch => watch(range, all),
        VerdictWord::Clear => clear(all),
    };
    // The range that decides: of several, the one that is closest to a limit or farthest above it.
    let deciding = all.ranges.iter().filter(|range| range.verdict == all.verdict);
    let first = deciding.max_by(|a, b| {
        let diverged = |range: &RangeVerdict| !range.diverged.is_empty();
        diverged(a).cmp(&diverged(b)).then(largest_share(a).total_cmp(&largest_share(b)))
    });
    let mut text = first.map(said).unwrap_or_default();
    if !all.ranges_given {
        let whole = all.ranges.first();
        let (from, to) = whole.map_or((0.0, 0.0), |range| (range.from_rad_s, range.to_rad_s));
        text += &format!(
            " No operating range was given: the whole sweep, {} to {}, is judged.",
            rpm(from),
            rpm(to)
        );
    }
    if unfinished {
        text += " The job is not done yet.";
    }
    text
}

fn act(range: &RangeVerdict, all: &SweepVerdict, request: &ResolvedSweep) -> String {
    let place = place(range);
    if let Some(&index) = range.diverged.first().filter(|_| !request.scene.blades_stiffen()) {
        let speed = rpm(request.speeds.rad_s()[index as usize]);
        return format!("Act: {place}the motion at {speed} grows beyond all bounds.");
    }
    let Some(worst) = largest(range) else { return String::new() };
    let (value, limit) = (value(&worst.judged, &all.units), allowed(&worst.judged, &all.units));
    let above = percent(worst.judged.above_percent);
    let is_beyond = |open: &&OpenQuestion| {
        open.what == OpenKind::BeyondLinearTheory
            && open.range == range.name
            && open.speeds.contains(&worst.index)
    };
    let theory = match all.would_decide.iter().any(|open| is_beyond(&open)) {
        true if request.scene.geometric_nonlinearity.is_some() => {
            ", at a speed beyond what the scene simulates"
        }
        true => ", at a speed beyond linear theory",
        false => "",
    };
    let speed = rpm(worst.speed_rad_s);
    format!("Act: {place}at {speed} {value} passes its limit of {limit} by {above}{theory}.")
}

fn undecided(range: &RangeVerdict, all: &SweepVerdict) -> String {
    let concerns = |open: &&OpenQuestion| open.range.is_none() || open.range == range.name;
    let open: Vec<&OpenQuestion> = all.would_decide.iter().filter(concerns).collect();
    let mut reasons: Vec<&str> = open.iter().take(MOST_REASONS).map(|open| open.finding.as_str()).collect();
    let more = format!("{} more", open.len().saturating_sub(MOST_REASONS));
    if open.len() > MOST_REASONS {
        reasons.push(&more);
    }
    let known = match largest(range) {
        Some(worst) => {
            let (value, limit) = (value(&worst.judged, &all.units), allowed(&worst.judged, &all.units));
            let speed = rpm(worst.speed_rad_s);
            format!("no limit is passed for certain (closest: {value} at {speed}, limit {limit})")
        }
        None if open.iter().any(|open| open.what == OpenKind::NoLimit) => {
            "whether the motion is allowed cannot be said".to_owned()
        }
        None => "no value is known".to_owned(),
    };
    let remedy =
        open.first().map_or_else(String::new, |open| format!(" What would decide: {}.", open.remedy));
    format!("Undecided: {}{known}. Open: {}.{remedy}", place(range), reasons.join("; "))
}

fn watch(range: &RangeVerdict, all: &SweepVerdict) -> String {
    let separation = range.separation_percent;
    let near = match (range.critical_inside, range.critical_within_separation) {
        (0, 0) => "no critical speed is near".to_owned(),
        (0, beside) => {
            let beside = critical(beside, Position::WithinSeparation, range, all);
            format!("{beside} within {separation} % of its ends")
        }
        (inside, 0) => format!("{} inside", critical(inside, Position::Inside, range, all)),
        (inside, beside) => {
            let inside = critical(inside, Position::Inside, range, all);
            format!("{inside} inside, {beside} more within {separation} % of its ends")
        }
    };
    format!("Watch: {}every limit is kept, {near}; {}.", place(range), closest(range, all))
}

fn clear(all: &SweepVerdict) -> String {
    let which = match all.ranges.len() {
        1 => all.ranges.first().map(place).unwrap_or_default(),
        several => format!("in all {several} operating ranges "),
    };
    let closest_range = all.ranges.iter().max_by(|a, b| largest_share(a).total_cmp(&largest_share(b)));
    let closest = closest_range.map(|range| closest(range, all)).unwrap_or_default();
    format!("Clear: {which}every limit is kept and no critical speed is near; {closest}.")
}

/// Value that is closest to its limit.
fn closest(range: &RangeVerdict, all: &SweepVerdict) -> String {
    largest(range).map_or_else(String::new, |worst| {
        let (value, limit) = (value(&worst.judged, &all.units), allowed(&worst.judged, &all.units));
        let below = percent(-worst.judged.above_percent);
        format!("closest is {value} at {}, {below} below its limit of {limit}", rpm(worst.speed_rad_s))
    })
}

/// Beginning of a sentence about a range.
fn place(range: &RangeVerdict) -> String {
    let ends = (rpm_number(range.from_rad_s), rpm(range.to_rad_s));
    match &range.name {
        Some(name) => format!("in range \"{name}\" ({} to {}) ", ends.0, ends.1),
        None => String::new(),
    }
}

/// Worst value of a range: one that passes its limit before one that does not, then the one that is largest over its limit.
fn largest(range: &RangeVerdict) -> Option<&WorstValue> {
    range.limits.iter().max_by(|a, b| a.judged.concern(&b.judged))
}

fn largest_share(range: &RangeVerdict) -> f64 {
    largest(range).map_or(0.0, |worst| worst.judged.share())
}

/// Value with its name, its error and their unit.
fn value(judged: &JudgedValue, units: &Units) -> String {
    let text = format!("{} of {} {}", judged.limit.words(), judged.known_words(), judged.limit.unit(units));
    text.trim_end().to_owned()
}

/// Limit of a value with its unit.
fn allowed(judged: &JudgedValue, units: &Units) -> String {
    format!("{} {}", digits(judged.allowed), judged.limit.unit(units)).trim_end().to_owned()
}

/// Critical speeds at a position of a range in words, with the most severe of them.
fn critical(count: u32, position: Position, range: &RangeVerdict, all: &SweepVerdict) -> String {
    let is_there = |speed: &&JudgedSpeed| {
        let here = speed.ranges.iter().find(|place| Some(&place.range) == range.name.as_ref());
        here.is_none_or(|place| place.position == position)
    };
    let most_severe = all.critical_speeds.iter().find(is_there).map_or(0.0, |speed| speed.speed_rad_s);
    match count {
        1 => format!("a critical speed ({}) lies", rpm(most_severe)),
        several => format!("{several} critical speeds (the most severe at {}) lie", rpm(most_severe)),
    }
}

/// Number of speeds in words, with the first of them.
pub(super) fn speeds(all_rad_s: &[f64]) -> String {
    match all_rad_s {
        [] => "no speed".to_owned(),
        [one] => format!("1 speed ({})", rpm(*one)),
        [first, rest @ ..] => format!("{} speeds ({} and others)", rest.len() + 1, rpm(*first)),
    }
}

/// Speed in revolutions per minute, with its unit.
pub(super) fn rpm(speed_rad_s: f64) -> String {
    format!("{} rpm", rpm_number(speed_rad_s))
}

/// Speed in revolutions per minute, in groups of three digits; with decimals where it is small.
pub(crate) fn rpm_number(speed_rad_s: f64) -> String {
    let rpm = speed_rad_s * 60.0 / std::f64::consts::TAU;
    if rpm < 100.0 {
        return digits(rpm);
    }
    grouped(rpm)
}
