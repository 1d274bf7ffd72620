//! Differences of the compared model from the first one over speed: mean differences of severity with their intervals.

use super::axis::{significant, ticks};
use super::cells::rpm;
use super::colour::DISTINCT;
use super::diagram::Diagram;
use super::key::Flow;
use super::svg::{Element, group, line};
use rubmap_analysis::result::{Campaign, Comparison, Difference, DifferenceVerdict};

const HEIGHT: f64 = 170.0;

/// Verdicts in the order of the key, with their words and colours.
pub(super) const VERDICTS: [(DifferenceVerdict, &str, &str); 3] = [
    (DifferenceVerdict::Greater, "the compared model is more severe", DISTINCT[1]),
    (DifferenceVerdict::Smaller, "it is less severe", DISTINCT[0]),
    (DifferenceVerdict::Undecided, "no larger than its errors", "#808080"),
];

/// Known differences, each with its speed in rpm.
pub(super) fn known(comparison: &Comparison, speeds_rad_s: &[f64]) -> Vec<(f64, Difference)> {
    let speeds = speeds_rad_s.iter().zip(&comparison.by_speed);
    speeds.filter_map(|(speed, difference)| Some((rpm(*speed), (*difference)?))).collect()
}

/// Ends of a difference: its interval, or its mean where no interval is known.
pub(super) fn ends(of: &Difference) -> (f64, f64) {
    (of.from.unwrap_or(of.mean), of.to.unwrap_or(of.mean))
}

/// Words for a difference.
pub(super) fn told(speed_rpm: f64, of: &Difference) -> String {
    let between = match (of.from, of.to) {
        (Some(from), Some(to)) => format!(", between {} and {}", significant(from), significant(to)),
        _ => String::new(),
    };
    format!("{} rpm: {}{between}, {} pairs", significant(speed_rpm), significant(of.mean), of.pairs)
}

/// Diagram of the differences from `top` on, with the speeds `x` of the map above, and where it ends; nothing where nothing is compared.
pub(super) fn panel(
    of: &Campaign,
    (left, width, right): (f64, f64, f64),
    x: (f64, f64),
    top: f64,
) -> (Vec<Element>, f64) {
    let known = of.comparison.as_ref().map(|comparison| known(comparison, &of.speeds_rad_s));
    let known = known.unwrap_or_default();
    if known.is_empty() {
        return (Vec::new(), top);
    }
    let reach = known.iter().map(|(_, of)| ends(of));
    let (low, high) = reach.fold((0.0_f64, 0.0_f64), |(low, high), (from, to)| (low.min(from), high.max(to)));
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    let diagram = Diagram::new((left, top), (width, HEIGHT), x, (low - margin, high + margin));
    let y = ticks(diagram.y.values, 5.0);
    let mark = |(speed, of): &(f64, Difference)| {
        let colour = VERDICTS.iter().find(|(verdict, ..)| *verdict == of.verdict).map_or("", |one| one.2);
        let (from, to) = ends(of);
        let whisker = line(diagram.point(*speed, from), diagram.point(*speed, to));
        let (cx, cy) = diagram.point(*speed, of.mean);
        let dot = Element::new("circle").number("cx", cx).number("cy", cy).number("r", 3.2);
        group()
            .set("class", "difference")
            .child(whisker.set("stroke", colour).set("stroke-width", "1.6"))
            .child(dot.set("fill", colour))
            .title(&told(*speed, of))
    };
    let zero = line(diagram.point(x.0, 0.0), diagram.point(x.1, 0.0)).set("stroke", "#222222");
    let mut flow = Flow::new(left, right, diagram.bottom() + 66.0);
    for (verdict, words, colour) in VERDICTS {
        if known.iter().any(|(_, of)| of.verdict == verdict) {
            let dot = Element::new("circle").number("cx", 6.0).number("cy", 0.0).number("r", 3.2);
            flow = flow.entry(dot.set("fill", colour), 12.0, words);
        }
    }
    let bottom = flow.bottom() + 30.0;
    let content = vec![
        diagram.grid(&[], &y),
        zero,
        group().children(known.iter().map(mark)),
        diagram.frame(),
        diagram.x_axis(&ticks(diagram.x.values, 9.0), "rotational speed Ω, rpm"),
        diagram.y_axis(&y, "difference, compared less own", 80.0),
        flow.draw(),
    ];
    (content, bottom)
}
