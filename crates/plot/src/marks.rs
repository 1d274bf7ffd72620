//! Marks: critical speeds, linear and driven crossings.

use super::axis::{label, significant};
use super::cells::rpm;
use super::svg::{Element, line, upright};
use rubmap_analysis::result::{CriticalSpeed, Crossing, DrivenCrossing, Verdict, Wave};

/// Least distance between upright labels.
const LABEL_SPACING: f64 = 15.0;

/// Dashes of a critical speed whose peak is not resolved.
pub(super) const UNRESOLVED: &str = "1.5 4";

/// Mark of a crossing of the linear criterion: an open circle.
pub(super) fn linear((x, y): (f64, f64), stroke: &str, crossing: &Crossing) -> Element {
    ring((x, y), stroke).title(&linear_words(crossing))
}

/// Words for a crossing of the linear criterion.
pub(super) fn linear_words(crossing: &Crossing) -> String {
    format!(
        "linear criterion (i, j, n) = {}: {} rpm, {} Hz",
        triple(crossing),
        label(rpm(crossing.speed_rad_s), 0),
        significant(crossing.frequency_hz)
    )
}

/// Open circle.
pub(super) fn ring((x, y): (f64, f64), stroke: &str) -> Element {
    Element::new("circle")
        .number("cx", x)
        .number("cy", y)
        .number("r", 4.5)
        .set("fill", "none")
        .set("stroke", stroke)
        .set("stroke-width", "1.5")
}

/// Label (i, j, n) of a crossing of the linear criterion.
pub(super) fn triple(crossing: &Crossing) -> String {
    format!("({}, {}, {})", crossing.nodal_diameter, crossing.family, crossing.superharmonic)
}

/// Label (i, j) of a driven crossing.
pub(super) fn pair(crossing: &DrivenCrossing) -> String {
    format!("({}, {})", crossing.nodal_diameter, crossing.family)
}

/// Mark of a crossing that the lobes can drive: a filled diamond.
pub(super) fn driven((x, y): (f64, f64), fill: &str, stroke: &str, crossing: &DrivenCrossing) -> Element {
    diamond((x, y), fill, stroke).title(&driven_words(crossing))
}

/// Words for a crossing that the lobes can drive.
pub(super) fn driven_words(crossing: &DrivenCrossing) -> String {
    let DrivenCrossing { nodal_diameter, family, engine_order: k, wave, .. } = *crossing;
    format!(
        "driven: engine order {k}, {}: {} rpm, {} Hz",
        mode(nodal_diameter, family, wave),
        label(rpm(crossing.speed_rad_s), 0),
        significant(crossing.frequency_hz)
    )
}

/// Words for a mode.
pub(super) fn mode(nodal_diameter: u32, family: u32, wave: Option<Wave>) -> String {
    let direction = match wave {
        None => "",
        Some(Wave::Forward) => ", forward wave",
        Some(Wave::Backward) => ", backward wave",
    };
    format!("nodal diameter {nodal_diameter}, family {family}{direction}")
}

/// Diamond-shaped mark.
pub(super) fn diamond((x, y): (f64, f64), fill: &str, stroke: &str) -> Element {
    Element::new("path")
        .set(
            "d",
            format!(
                "M{:.2} {y:.2}L{x:.2} {:.2}L{:.2} {y:.2}L{x:.2} {:.2}Z",
                x - 5.0,
                y - 6.0,
                x + 5.0,
                y + 6.0
            ),
        )
        .set("fill", fill)
        .set("stroke", stroke)
}

/// Draws dashed lines from `top` to `bottom` at the critical speeds, `x` in the drawing, each with its speed above; dotted where the speeds
/// of the sweep do not resolve the peak. With `said`, utilisations replace the engine orders in the labels.
pub(super) fn critical(
    speeds: &[(f64, &CriticalSpeed)],
    right: f64,
    (top, bottom): (f64, f64),
    said: bool,
) -> Vec<Element> {
    let places: Vec<_> = speeds.iter().map(|(x, _)| *x).collect();
    let labels = spread(&places, right);
    let mut out = Vec::new();
    for ((x, speed), label_x) in speeds.iter().zip(labels) {
        let words = critical_words(speed, said);
        let (dashes, title) =
            (if speed.resolved { "7 4" } else { UNRESOLVED }, format!("{words}{}", known_to(speed)));
        out.push(
            line((*x, top), (*x, bottom))
                .set("class", "critical-speed")
                .set("stroke", "#d62728")
                .set("stroke-width", "1.2")
                .set("stroke-dasharray", dashes)
                .title(&title),
        );
        out.push(line((label_x, top - 12.0), (*x, top)).set("stroke", "#d62728"));
        out.push(
            upright(label_x + 4.5, top - 16.0, "start", &words).set("fill", "#b01f20").set("font-size", "12"),
        );
    }
    out
}

/// Words for a critical speed; with its utilisation where that is `said` and known, otherwise with its engine order.
pub(super) fn critical_words(speed: &CriticalSpeed, said: bool) -> String {
    format!(
        "{} rpm{}{}",
        label(rpm(speed.speed_rad_s), 0),
        // Only one of utilisation and engine order has room.
        if said && speed.utilisation.is_some() {
            utilisation(speed)
        } else {
            format!(" · EO {}", engine_order(speed))
        },
        if speed.settling != Verdict::NotSettled { "" } else { " *" }
    )
}

/// Error of a critical speed, in words that follow it.
pub(super) fn known_to(speed: &CriticalSpeed) -> String {
    if speed.on_branch {
        format!(", a maximum on a branch, known to {} rpm", significant(rpm(speed.speed_error_rad_s)))
    } else if speed.resolved {
        format!(", known to {} rpm", significant(rpm(speed.speed_error_rad_s)))
    } else {
        ": not resolved by the speeds of the sweep, the peak may be higher".to_owned()
    }
}

/// Words for the engine order of the largest amplitude at a critical speed.
pub(super) fn engine_order(speed: &CriticalSpeed) -> String {
    speed.dominant_engine_order.map_or_else(|| "–".to_owned(), order)
}

/// Utilisation at a critical speed, in words that follow others.
pub(super) fn utilisation(speed: &CriticalSpeed) -> String {
    speed.utilisation.map_or_else(String::new, |used| format!(" · U {}", significant(used)))
}

/// Formats an engine order without needless decimals.
pub(super) fn order(value: f64) -> String {
    if (value - value.round()).abs() < 1e-6 { label(value, 0) } else { label(value, 2) }
}

/// Moves ascending positions apart, none beyond `right` as long as there is room.
pub(super) fn spread(places: &[f64], right: f64) -> Vec<f64> {
    let mut out = places.to_vec();
    for i in 1..out.len() {
        out[i] = out[i].max(out[i - 1] + LABEL_SPACING);
    }
    let mut limit = right;
    for place in out.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - LABEL_SPACING;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_distance() {
        let places = spread(&[10.0, 12.0, 14.0, 90.0, 99.0], 100.0);
        assert_eq!(places, [10.0, 25.0, 40.0, 85.0, 100.0]);
        assert!(spread(&[], 1.0).is_empty());
    }

    #[test]
    fn engine_orders_read_well() {
        assert_eq!([8.0, 7.95, 0.5].map(order), ["8", "7.95", "0.50"]);
    }
}
