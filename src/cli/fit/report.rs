//! Result of a fit in words and tables.

use std::fmt::Write;
use std::path::Path;

use rubmap_fit::{Bound, FitResult, StartResult, TargetResult, VariableResult};

/// Weighted root mean square below which ends are equally good: a hundredth of the targets' errors.
const AS_GOOD: f64 = 0.01;

/// Distance of two ends in a parameter, as a fraction of its bounds, above which they are different wheels.
const ELSEWHERE: f64 = 0.01;

/// Least modal assurance at which a shape counts as that of the start.
const ALIKE: f64 = 0.5;

/// Table of the targets, then of the unknowns.
pub(super) fn table(result: &FitResult) -> String {
    let mut text = String::from(
        "\nnodal                                               difference   rank  shape of\n\
         diameter  family       speed      target       found          %         the start\n",
    );
    // Writing to a string cannot fail.
    for row in &result.targets {
        let TargetResult { nodal_diameter, family, speed, frequency, found, difference_percent, .. } = row;
        let _ = writeln!(
            text,
            "{nodal_diameter:>8} {family:>7} {speed:>11.5} {frequency:>11.5} {found:>11.5} {difference_percent:>10.3} {:>6} {:>9}{}",
            row.rank,
            row.assurance.map_or_else(|| "-".to_owned(), |assurance| format!("{assurance:.3}")),
            remark(row),
        );
    }
    text.push('\n');
    for VariableResult { name, value, standard_deviation, bounds, at } in &result.unknowns {
        let is_wide = |deviation: f64| bounds.is_some_and(|[low, high]| deviation > high - low);
        let known = match standard_deviation {
            Some(deviation) if is_wide(*deviation) => {
                format!("± {deviation:.1e}, wider than its bounds: the targets leave it open")
            }
            Some(deviation) => format!("± {deviation:.2e}"),
            None => "not determined by the targets".to_owned(),
        };
        let at = match at {
            Some(Bound::Low) => ", at its lower bound",
            Some(Bound::High) => ", at its upper bound",
            None => "",
        };
        let unit = if name == "unit" { " Hz" } else { "" };
        let _ = writeln!(text, "{name:<28} {:>14}{unit} {known}{at}", number(*value));
    }
    text
}

/// Number with seven digits, however large or small.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) {
        let before = value.abs().max(1.0).log10() as usize;
        format!("{value:.*}", 6usize.saturating_sub(before))
    } else {
        format!("{value:.6e}")
    }
}

/// Ends of other searches that are as good as the best one, at other values: the targets do not decide between them.
fn as_good(result: &FitResult) -> Option<String> {
    let best = result.starts.get(result.best_start)?;
    let good = 1.1 * best.weighted_rms?.max(AS_GOOD);
    let is_elsewhere = |to: &[f64]| {
        let pairs = to.iter().zip(best.to.iter().flatten()).zip(&result.unknowns);
        pairs
            .filter_map(|((a, b), unknown)| unknown.bounds.map(|[low, high]| (a - b).abs() / (high - low)))
            .any(|apart| apart > ELSEWHERE)
    };
    let other = |(index, start): (usize, &StartResult)| {
        let to = start.to.as_ref().filter(|to| is_elsewhere(to))?;
        let named = result.unknowns.iter().zip(to);
        let values: Vec<String> =
            named.map(|(of, &value)| format!("{} {}", of.name, number(value))).collect();
        (start.weighted_rms? <= good).then(|| {
            format!("the search from starting point {} ended as well at {}", index + 1, values.join(", "))
        })
    };
    let others: Vec<String> = result.starts.iter().enumerate().filter_map(other).collect();
    (!others.is_empty()).then(|| format!("The targets do not decide: {}.\n", others.join("; ")))
}

fn remark(row: &TargetResult) -> String {
    let mut remark = String::new();
    if !row.met {
        let _ = write!(remark, "  missed by more than {} %", row.tolerance_percent);
    }
    if let Some(rank) = row.rank_by_shape.filter(|&rank| rank != row.rank) {
        let _ = write!(remark, "  order changed: the start's shape has rank {rank}");
    } else if row.assurance.is_some_and(|assurance| assurance < ALIKE) {
        remark.push_str("  another shape than at the start");
    }
    remark
}

/// Sentences on the result as a whole.
pub(super) fn closing(result: &FitResult, folder: &Path) -> String {
    let missed = result.targets.iter().filter(|row| !row.met).count();
    let verdict = match missed {
        0 => format!("All {} targets are met", result.targets.len()),
        _ => format!("{missed} of {} targets are not met", result.targets.len()),
    };
    let mut text = format!(
        "{verdict}: {:.3} % in the root mean square, {:.3} % at most. Starting point {} of {} came closest.\n",
        result.rms_percent,
        result.largest_percent,
        result.best_start + 1,
        result.starts.len(),
    );
    let unused: Vec<&String> = result.starts.iter().filter_map(|start| start.failure.as_ref()).collect();
    if let Some(first) = unused.first() {
        let _ =
            writeln!(text, "{} starting points could not be used; the first of them: {first}.", unused.len());
    }
    text.push_str(&as_good(result).unwrap_or_default());
    if let (Some(first), Some(last)) = (result.singular_values.first(), result.singular_values.last()) {
        let _ = writeln!(
            text,
            "The targets determine the best known combination of unknowns {} times better than the least known one.",
            times(first / last)
        );
    }
    if result.above_top_speed {
        text.push_str(
            "Some speeds are above `top_speed_rad_s` of the wheel: raise it to that of the fastest target before the package is used there.\n",
        );
    }
    let _ = writeln!(text, "{}", folder.join("parameters.json").display());
    text
}

fn times(ratio: f64) -> String {
    if ratio < 1e4 { format!("{ratio:.1}") } else { format!("{ratio:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_seven_digits_whatever_their_size() {
        let numbers = [4.43e-9, 0.0123456789, 9.4206012, 113_997.751_764, 1.13997751764e11, -25.0, 0.0];
        let expected =
            ["4.430000e-9", "0.012346", "9.420601", "113997.8", "1.139978e11", "-25.00000", "0.000000"];
        assert_eq!(numbers.map(number), expected);
    }
}
