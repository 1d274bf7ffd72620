//! Marks: critical speeds, linear and driven crossings.

use super::axis::{label, significant};
use super::cells::rpm;
use super::svg::Element;
use rubmap_analysis::result::{CriticalSpeed, Crossing, DrivenCrossing, Verdict, Wave};

/// Least distance between upright labels.
const LABEL_SPACING: f64 = 15.0;

/// Fill of crossings that the lobes drive.
pub(super) const DRIVEN: &str = "#ff9d5c";

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
