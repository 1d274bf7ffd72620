//! Result of a fit in words and tables.

use std::fmt::Write;
use std::path::Path;

use rubmap_fit::{Bound, FitResult, TargetResult, VariableResult};

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
            "{nodal_diameter:>8} {family:>7} {speed:>11.5} {frequency:>11.5} {found:>11.5} {difference_percent:>10.3} {:>6} {:>9.3}{}",
            row.rank,
            row.assurance,
            remark(row),
        );
    }
    text.push('\n');
    for VariableResult { name, value, standard_deviation, at } in &result.unknowns {
        let known = match standard_deviation {
            Some(deviation) if *deviation > value.abs() => {
                format!("± {deviation:.1e}, hardly determined by the targets")
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
        let _ = writeln!(text, "{name:<28} {value:>12.6}{unit} {known}{at}");
    }
    text
}

fn remark(row: &TargetResult) -> String {
    let mut remark = String::new();
    if !row.met {
        let _ = write!(remark, "  missed by more than {} %", row.tolerance_percent);
    }
    if row.rank_by_shape != row.rank {
        let _ = write!(remark, "  order changed: the start's shape has rank {}", row.rank_by_shape);
    } else if row.assurance < ALIKE {
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
