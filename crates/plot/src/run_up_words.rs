//! Words of the drawings of run-ups.

use super::axis::{label, significant};
use super::cells::rpm;
use super::heading;
use rubmap_analysis::request::{AutoOr, RunUpSettings, RunUpSpeed};
use rubmap_analysis::result::{RunUp, RunUps};

/// Largest number of runs whose ends are stated.
const MOST_ENDS: usize = 3;

/// Word for how the speed changes.
pub(super) fn course(speed: &RunUpSpeed) -> &'static str {
    let speeds: Vec<f64> = match &speed.points {
        Some(points) => points.iter().map(|point| point.speed).collect(),
        None => speed.from.into_iter().chain(speed.to).collect(),
    };
    let all = |in_order: fn(&[f64]) -> bool| speeds.windows(2).all(in_order);
    if all(|pair| pair[0] <= pair[1]) {
        "run-up"
    } else if all(|pair| pair[0] >= pair[1]) {
        "run-down"
    } else {
        "run with a changing speed"
    }
}

/// Name of a run: its rate.
pub(super) fn name(run: &RunUp) -> String {
    run.rate_rad_s2.map_or_else(|| "run".to_owned(), |rate| format!("{} rad/s²", digits(rate)))
}

/// Formats a rate to three digits, without trailing zeros.
fn digits(rate: f64) -> String {
    let digits = significant(rate);
    if digits.contains('e') || !digits.contains('.') {
        return digits;
    }
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Words for a run, with its rate in rpm as well.
pub(super) fn long_name(run: &RunUp) -> String {
    match run.rate_rad_s2 {
        Some(rate) => format!("{} ({} rpm/s)", name(run), digits(rpm(rate))),
        None => name(run),
    }
}

/// Title: the course of the speed and the sensor.
pub(super) fn title(run_ups: &RunUps, sensor: usize) -> String {
    let what = match course(&run_ups.settings.speed) {
        "run-up" => "Run-ups",
        "run-down" => "Run-downs",
        _ => "Run with a changing speed",
    };
    match run_ups.sensors.get(sensor) {
        Some(sensor) => format!("{what}: {sensor}"),
        None => format!("{what}: no such sensor"),
    }
}

/// Paragraphs below the title: numbers of runs and frames, how fast one must pass, and how incomplete runs ended.
pub(super) fn words(run_ups: &RunUps) -> Vec<String> {
    let frames = run_ups.runs.iter().map(|run| run.frames.len()).sum();
    let mut words = vec![counted(run_ups.runs.len(), "run"), of_frames(frames, &run_ups.settings)];
    words.extend((!run_ups.complete).then(|| "still running, or stopped".to_owned()));
    words.push(heading::origin(&run_ups.settings.sweep.model, &run_ups.version));
    let passing = run_ups.passing.as_ref().map(|passing| {
        let unit = &run_ups.units.length;
        format!(
            "largest displacement at any sector, limit {} {unit}: {}",
            significant(passing.limit),
            passing.message
        )
    });
    let ends = ends(run_ups);
    [Some(words.join(" · ")), passing, (!ends.is_empty()).then_some(ends)].into_iter().flatten().collect()
}

/// Words for a number of frames and their length.
pub(super) fn of_frames(frames: usize, settings: &RunUpSettings) -> String {
    let frames = counted(frames, "frame");
    match settings.frame_revolutions {
        AutoOr::Fixed(1) => format!("{frames} of a revolution"),
        AutoOr::Fixed(revolutions) => format!("{frames} of {revolutions} revolutions"),
        AutoOr::Auto => frames,
    }
}

pub(super) fn counted(count: usize, what: &str) -> String {
    format!("{} {what}{}", label(count as f64, 0), if count == 1 { "" } else { "s" })
}

fn ends(run_ups: &RunUps) -> String {
    let told = |run: &RunUp| {
        let message = run.end.as_ref()?.message.as_ref()?;
        Some(format!("{}: {message}", name(run)))
    };
    let mut words: Vec<String> = run_ups.runs.iter().filter_map(told).collect();
    let more = words.len().saturating_sub(MOST_ENDS);
    words.truncate(MOST_ENDS);
    words.extend(
        (more > 0).then(|| format!("and {} of which something must be known", counted(more, "more run"))),
    );
    words.join(" · ")
}
