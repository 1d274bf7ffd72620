//! Differences of the compared model from the first one over speed: mean differences of severity with their intervals.

use super::axis::significant;
use super::cells::rpm;
use super::colour::DISTINCT;
use super::layer::{Bars, Mark, Marks, Reach};
use super::sketch::{Axis, Panel};
use super::style::{Colour, Look, Symbol};
use super::svg::line;
use rubmap_analysis::result::{Campaign, Comparison, Difference, DifferenceVerdict};

const HEIGHT: f64 = 170.0;

/// Verdicts in the order of the key, with their words and colours.
const VERDICTS: [(DifferenceVerdict, &str, &str); 3] = [
    (DifferenceVerdict::Greater, "the compared model is more severe", DISTINCT[1]),
    (DifferenceVerdict::Smaller, "it is less severe", DISTINCT[0]),
    (DifferenceVerdict::Undecided, "no larger than its errors", "#808080"),
];

/// Known differences, each with its speed in rpm.
fn known(comparison: &Comparison, speeds_rad_s: &[f64]) -> Vec<(f64, Difference)> {
    let speeds = speeds_rad_s.iter().zip(&comparison.by_speed);
    speeds.filter_map(|(speed, difference)| Some((rpm(*speed), (*difference)?))).collect()
}

/// Ends of a difference: its interval, or its mean where no interval is known.
fn ends(of: &Difference) -> (f64, f64) {
    (of.from.unwrap_or(of.mean), of.to.unwrap_or(of.mean))
}

/// Words for a difference.
fn told(speed_rpm: f64, of: &Difference) -> String {
    let between = match (of.from, of.to) {
        (Some(from), Some(to)) => format!(", between {} and {}", significant(from), significant(to)),
        _ => String::new(),
    };
    format!("{} rpm: {}{between}, {} pairs", significant(speed_rpm), significant(of.mean), of.pairs)
}

/// Panel of the differences with the speeds `x` of the map above; none where nothing is compared.
pub(super) fn panel(
    of: &Campaign,
    (corner, width): ((f64, f64), f64),
    x: (f64, f64),
    severity: &str,
) -> Option<Panel<'static>> {
    let known = known(of.comparison.as_ref()?, &of.speeds_rad_s);
    let reach = known.iter().map(|(_, of)| ends(of));
    let (low, high) = reach.fold((0.0_f64, 0.0_f64), |(low, high), (from, to)| (low.min(from), high.max(to)));
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    let y = Axis::linear(
        format!("difference, compared less own: {severity}"),
        (low - margin, high + margin),
        5.0,
    )
    .free();
    let panel = Panel::new(corner, (width, HEIGHT), Axis::speeds(x, 9.0), y);
    let mut panel = panel.apart().key_below();
    let zero = panel.diagram.y.place(0.0);
    panel.push(line((panel.diagram.left, zero), (panel.diagram.right(), zero)).set("stroke", "#222222"));
    for (verdict, words, colour) in VERDICTS {
        let here: Vec<&(f64, Difference)> = known.iter().filter(|(_, of)| of.verdict == verdict).collect();
        let marks = here.iter().map(|(speed, of)| Mark::new((*speed, of.mean), told(*speed, of)));
        let look = Look::filled(Symbol::Circle, (3.2, 7.0), Colour::of(colour));
        let lengths = here.iter().map(|(_, of)| Reach::even(ends(of).1 - of.mean)).collect();
        let bars = Bars { lengths, colour: Colour::of(colour), class: "error" };
        let marks = Marks::new(words, look, marks).class("difference");
        panel.marks(words, Marks { bars: Some(bars), ..marks });
    }
    (!known.is_empty()).then_some(panel)
}
