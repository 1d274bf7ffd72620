//! How fast one must pass a critical speed.

use crate::result::{PassingRate, RunUp};

/// From runs of several rates that have all ended, those that came to their end; none where nothing could be said.
pub(super) fn passing(limit: f64, runs: &[RunUp]) -> Option<PassingRate> {
    let mut found: Vec<(f64, f64)> = runs
        .iter()
        .filter_map(|run| {
            let end = run.end.as_ref().filter(|end| end.is_complete())?;
            let largest = end.largest.iter().fold(0.0f64, |most, largest| most.max(largest.displacement));
            Some((run.rate_rad_s2?, largest))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (_, fastest) = found.last()?;
    let below = found.iter().rposition(|(_, largest)| *largest > limit).map_or(0, |last| last + 1);
    let enough = found.get(below);
    let too_slow = below.checked_sub(1).map(|slower| found[slower]);
    let about = enough.zip(too_slow).map(|(fast, slow)| {
        let share = (slow.1 / limit).ln() / (slow.1 / fast.1.max(f64::MIN_POSITIVE)).ln();
        (slow.0.ln() + share * (fast.0 / slow.0).ln()).exp()
    });
    let lost = runs.len() - found.len();
    let mut message = match (enough, too_slow) {
        (Some((fast, _)), Some((slow, _))) => {
            format!("the limit is kept from a rate between {slow:.4} and {fast:.4} rad/s² on")
        }
        (Some((fast, _)), None) => format!("the slowest rate of all, {fast:.4} rad/s², keeps the limit"),
        (None, _) => format!("no rate keeps the limit: the fastest goes to {fastest:.4e}"),
    };
    let kept: Vec<bool> = found.iter().map(|(_, largest)| *largest <= limit).collect();
    if kept[..below].iter().any(|kept| *kept) {
        message.push_str("; a slower one keeps it too, but not all between");
    }
    if lost > 0 {
        message.push_str(&format!("; {lost} of the runs did not come to their end and say nothing"));
    }
    Some(PassingRate {
        limit,
        enough_rad_s2: enough.map(|(rate, _)| *rate),
        too_slow_rad_s2: too_slow.map(|(rate, _)| rate),
        about_rad_s2: about,
        message,
    })
}
