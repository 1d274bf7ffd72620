//! Rate at which a critical speed must be passed.

use crate::digits::short;
use crate::result::{PassingRate, RunUp, RunUpEnd};

/// Passing rate from runs of several rates that have all ended. A run that was not completed counts as exceeding the limit. Lengths are in
/// `unit`.
pub(super) fn passing(limit: f64, unit: &str, runs: &[RunUp]) -> Option<PassingRate> {
    let largest =
        |end: &RunUpEnd| end.largest.iter().fold(0.0f64, |most, largest| most.max(largest.displacement));
    let mut found: Vec<(f64, Option<f64>)> = runs
        .iter()
        .filter_map(|run| {
            Some((run.rate_rad_s2?, run.end.as_ref().filter(|end| end.is_complete()).map(largest)))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let keeps = |largest: Option<f64>| largest.is_some_and(|largest| largest <= limit);
    let lost = found.iter().filter(|(_, largest)| largest.is_none()).count();
    if found.is_empty() {
        return None;
    }
    let below = found.iter().rposition(|(_, largest)| !keeps(*largest)).map_or(0, |last| last + 1);
    let enough = found.get(below).copied();
    let too_slow = below.checked_sub(1).map(|slower| found[slower]);
    let about = match (enough, too_slow) {
        (Some((fast, Some(low))), Some((slow, Some(high)))) => {
            let share = (high / limit).ln() / (high / low.max(f64::MIN_POSITIVE)).ln();
            Some((slow.ln() + share * (fast / slow).ln()).exp())
        }
        _ => None,
    };
    let mut message = match (enough, too_slow) {
        (Some((fast, _)), Some((slow, _))) => {
            let about = about.map_or_else(String::new, |about| format!(", about {},", short(about)));
            format!(
                "the limit is kept from a rate between {} and {} rad/s²{about} on",
                short(slow),
                short(fast)
            )
        }
        (Some((fast, _)), None) => {
            format!("the slowest rate of all, {} rad/s², keeps the limit", short(fast))
        }
        (None, Some((_, Some(most)))) => {
            format!(
                "no rate keeps the limit from which on all do: the fastest goes to {} {unit}",
                short(most)
            )
        }
        (None, _) => "the fastest run did not come to its end".to_owned(),
    };
    if found[..below].iter().any(|(_, largest)| keeps(*largest)) {
        message.push_str("; a slower one keeps it too, but not all between");
    }
    if lost > 0 {
        message.push_str(&format!("; {lost} of the runs did not come to their end, which keeps no limit"));
    }
    Some(PassingRate {
        limit,
        enough_rad_s2: enough.map(|(rate, _)| rate),
        too_slow_rad_s2: too_slow.map(|(rate, _)| rate),
        about_rad_s2: about,
        message,
    })
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    /// Runs with these rates and largest displacements; none for a run that diverged.
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

    /// Peak that falls with the square root of the rate, in no order: 1 mm at 100 rad/s², so 0.5 mm at 400.
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
        // A slower run that swings less than a faster one; one that diverged between two that keep the limit.
        let mixed =
            passing(0.6, "mm", &runs(&[(1.0, Some(0.5)), (2.0, Some(0.7)), (4.0, Some(0.2))])).unwrap();
        assert_eq!((mixed.enough_rad_s2, mixed.too_slow_rad_s2), (Some(4.0), Some(2.0)));
        assert!(mixed.message.contains("a slower one keeps it too"), "{}", mixed.message);
        let lost = passing(0.6, "mm", &runs(&[(1.0, Some(0.5)), (2.0, None), (4.0, Some(0.2))])).unwrap();
        assert_eq!(
            (lost.enough_rad_s2, lost.too_slow_rad_s2, lost.about_rad_s2),
            (Some(4.0), Some(2.0), None)
        );
        assert!(lost.message.contains("1 of the runs did not come to their end"), "{}", lost.message);
        let last = passing(0.6, "mm", &runs(&[(1.0, Some(0.5)), (2.0, None)])).unwrap();
        assert_eq!(last.enough_rad_s2, None);
        let none = passing(1.0, "mm", &runs(&[(1.0, None)])).unwrap();
        assert_eq!((none.enough_rad_s2, none.too_slow_rad_s2), (None, Some(1.0)));
        assert_eq!(passing(1.0, "mm", &[]), None);
    }
}
