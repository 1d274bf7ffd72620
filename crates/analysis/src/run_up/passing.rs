//! How fast one must pass a critical speed.

use crate::digits::short;
use crate::result::{PassingRate, RunUp};

/// From runs of several rates that have all ended, those that came to their end; none where nothing could be said. Lengths are in `unit`.
pub(super) fn passing(limit: f64, unit: &str, runs: &[RunUp]) -> Option<PassingRate> {
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
            let about = about.map_or_else(String::new, |about| format!(", about {},", short(about)));
            format!(
                "the limit is kept from a rate between {} and {} rad/s²{about} on",
                short(slow),
                short(*fast)
            )
        }
        (Some((fast, _)), None) => {
            format!("the slowest rate of all, {} rad/s², keeps the limit", short(*fast))
        }
        (None, _) => format!("no rate keeps the limit: the fastest goes to {} {unit}", short(*fastest)),
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

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    /// Runs of these rates and largest displacements; none of a run that diverged.
    fn runs(of: &[(f64, Option<f64>)]) -> Vec<RunUp> {
        let run = |(number, (rate, largest)): (usize, &(f64, Option<f64>))| {
            let status = if largest.is_some() { "completed" } else { "diverged" };
            let largest: Vec<Value> = (largest.iter())
                .map(|largest| json!({"displacement": largest, "time_s": 0.1, "speed_rad_s": 1.0}))
                .collect();
            let end = json!({"status": status, "largest": largest, "revolutions": 1.0, "steps": 1, "segments": 1,
                "largest_angle_error_rad": 0.0, "largest_energy": 1.0, "energy_residual": 0.0, "stiffening_work": 0.0,
                "transfer_loss": 0.0, "contact_share": 0.0, "euler_share": 0.0, "wall_time_s": 0.0});
            let run =
                json!({"run": number, "rate_rad_s2": rate, "order_step": 0.125, "frames": [], "end": end});
            serde_json::from_value(run).unwrap()
        };
        of.iter().enumerate().map(run).collect()
    }

    /// A peak that falls with the square root of the rate, in no order: 1 mm at 100 rad/s², so 0.5 mm at 400.
    #[test]
    fn the_rate_lies_where_the_law_of_the_peak_has_it() {
        let of = |rate: f64| (rate, Some((100.0 / rate).sqrt()));
        let found = passing(0.5, "mm", &runs(&[of(1000.0), of(100.0), of(250.0)])).unwrap();
        assert_eq!((found.enough_rad_s2, found.too_slow_rad_s2), (Some(1000.0), Some(250.0)));
        assert!((found.about_rad_s2.unwrap() - 400.0).abs() < 1e-9, "{found:?}");
        assert!(found.message.contains("between 250 and 1000 rad/s², about 400, on"), "{}", found.message);
    }

    #[test]
    fn what_is_not_known_is_not_said() {
        let all = passing(2.0, "mm", &runs(&[(1.0, Some(1.0)), (2.0, Some(0.5))])).unwrap();
        assert_eq!((all.enough_rad_s2, all.too_slow_rad_s2, all.about_rad_s2), (Some(1.0), None, None));
        let none = passing(0.1, "mm", &runs(&[(1.0, Some(1.0)), (2.0, Some(0.5))])).unwrap();
        assert_eq!((none.enough_rad_s2, none.about_rad_s2), (None, None));
        assert!(none.message.ends_with("goes to 0.5 mm"), "{}", none.message);
        // A slower run that swings less than a faster one, and one that says nothing.
        let mixed =
            passing(0.6, "mm", &runs(&[(1.0, Some(0.5)), (2.0, Some(0.7)), (3.0, None), (4.0, Some(0.2))]))
                .unwrap();
        assert_eq!((mixed.enough_rad_s2, mixed.too_slow_rad_s2), (Some(4.0), Some(2.0)));
        assert!(
            mixed.message.contains("a slower one keeps it too") && mixed.message.contains("1 of the runs")
        );
        assert_eq!(passing(1.0, "mm", &runs(&[(1.0, None)])), None);
    }
}
