//! Requests for a package about which the user has said nothing: speeds and a casing in proportion to the wheel.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::{Value, json};

use super::report::rpm;
use super::requests::integration;
use crate::analysis::request::AutoOr;
use crate::analysis::run::ModelFacts;

/// Running clearance over the radius at which the tips lie. Of wheels with a radius of 100 to 200 mm it is 0.2 to 0.4 mm, which is
/// what machines have.
const CLEARANCE: f64 = 0.002;

/// Height of a lobe over the clearance, as in the form of the page: a twentieth of the clearance stands inside the tips at rest, so that they touch
/// twice a revolution and are pushed by a little.
const LOBE: f64 = 1.05;

/// Number of lobes of an ovalised casing.
const LOBES: u32 = 2;

/// Half-width of a lobe, rad.
const WIDTH_RAD: f64 = 0.35;

/// Modal damping ratio of a wheel of one piece in a gas.
const DAMPING: f64 = 0.005;

/// Lowest speed of the sweep over its highest.
const LOWEST: f64 = 1.0 / 3.0;

/// Engine order that meets the lowest natural frequency at the highest speed, where the package names none.
const LOWEST_ORDER: f64 = 3.0;

/// Significant digits of chosen numbers: whoever edits them wants numbers that one can read.
const DIGITS: i32 = 2;

/// Speeds of a sweep, and why these.
pub(super) struct Range {
    pub(super) from_rad_s: f64,
    pub(super) to_rad_s: f64,
    why: String,
}

impl Range {
    /// Range up to the highest speed at which the package has its stiffness; `None` if that is standstill.
    pub(super) fn of_package(facts: &ModelFacts) -> Option<Self> {
        let to_rad_s = facts.speeds_rad_s.last().copied().filter(|highest| *highest > 0.0)?;
        let why =
            "from a third of the highest speed at which the package has its stiffness up to it".to_owned();
        Some(Self { from_rad_s: LOWEST * to_rad_s, to_rad_s, why })
    }

    /// Range in which engine orders from [`LOWEST_ORDER`] on meet the lowest natural frequency, for a package without stiffness at speed.
    pub(super) fn of_frequency(lowest_hz: f64) -> Self {
        let to_rad_s = round(TAU * lowest_hz / LOWEST_ORDER);
        let why = format!(
            "the package has its stiffness at standstill only; engine orders {LOWEST_ORDER} to {} meet its lowest natural frequency, \
             {lowest_hz:.1} Hz, in this range",
            LOWEST_ORDER / LOWEST
        );
        Self { from_rad_s: LOWEST * to_rad_s, to_rad_s, why }
    }
}

/// Body of POST /v1/sweeps without its model, and the reasons for it in words.
pub(super) fn sweep(
    facts: &ModelFacts,
    radius: f64,
    range: &Range,
    speeds: u32,
    revolutions: AutoOr,
) -> (Value, String) {
    let clearance = round(CLEARANCE * radius);
    // One digit more than the clearance has, so that the lobe is higher.
    let amplitude = round_to(DIGITS + 1, LOBE * clearance);
    let [from, to] = [range.from_rad_s, range.to_rad_s].map(whole_rpm);
    let stiffening = facts.has_stiffening();
    let request = json!({
        "speeds": {"from": from, "to": to, "count": speeds, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": stiffening,
            "damping": {"modal_ratio": DAMPING},
            "casing": {
                "clearance": {"leading": clearance, "trailing": clearance},
                "lobes": {"count": LOBES, "amplitude": amplitude, "width_rad": WIDTH_RAD},
            },
            "contact": {},
        },
        "integration": integration(revolutions),
        "max_engine_order": 24,
    });
    let unit = &facts.units.length;
    let mut words = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        words,
        "chosen    speeds     {} to {} rpm: {}
          clearance  {clearance} {unit}: {} % of the radius at which the tips lie, {} {unit}, as machines of this size have
          casing     ovalised: {LOBES} lobes of {amplitude} {unit}, {LOBE} times the clearance, so that every tip is pushed {LOBES} times a revolution
          damping    {DAMPING} of critical, every mode
          stiffening {}
",
        from,
        to,
        range.why,
        100.0 * CLEARANCE,
        round_to(4, radius),
        if stiffening { "by rotation, as the package has it" } else { "none: the package has it at standstill only" },
    );
    (request, words)
}

/// Body of POST /v1/modal-analyses for natural frequencies from standstill to the `highest` speed, rad/s.
pub(super) fn modal_analysis(highest: f64, lobes: u32) -> Value {
    json!({
        "families": 2,
        "superharmonics": [1, 2, 3],
        "lobes": lobes,
        "speeds": {"from": 0, "to": highest, "count": 39, "unit": "rad_s"},
    })
}

/// Number of lobes that a request for a sweep names.
pub(super) fn lobes_of(request: &Value) -> u32 {
    let count = request.pointer("/scene/casing/lobes/count").and_then(Value::as_u64);
    count.and_then(|count| count.try_into().ok()).unwrap_or(LOBES)
}

/// Speed in rpm, rounded down to a whole number, as nothing is known beyond the highest speed; below 100 rpm as it is.
fn whole_rpm(speed_rad_s: f64) -> f64 {
    let rpm = rpm(speed_rad_s);
    if rpm < 100.0 { rpm } else { rpm.floor() }
}

fn round(value: f64) -> f64 {
    round_to(DIGITS, value)
}

/// Rounds to so many significant digits, but loses no digit before the point.
fn round_to(digits: i32, value: f64) -> f64 {
    let decimals = digits - 1 - value.abs().log10().floor() as i32;
    // The number is written and read, so that it is the nearest to what one reads.
    format!("{value:.*}", decimals.max(0) as usize).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::sector::Units;

    fn facts(speeds_rad_s: Vec<f64>) -> ModelFacts {
        let unit = String::new;
        ModelFacts {
            name: unit(),
            sectors: 9,
            contact_nodes: 4,
            own_dofs: 300,
            speeds_rad_s,
            units: Units { length: "mm".to_owned(), force: unit(), time: unit(), mass: unit() },
            gyroscopic: false,
            contact_radius: Some(123.4),
            stiffening: None,
            contact_spacing: None,
            mesh: None,
            in_si: None,
            digits: None,
            warnings: Vec::new(),
            found: Vec::new(),
        }
    }

    #[test]
    fn what_is_chosen_is_in_proportion_to_the_wheel() {
        let facts = facts(vec![0.0, 1500.0, 3000.0]);
        let range = Range::of_package(&facts).unwrap();
        assert_eq!((range.from_rad_s, range.to_rad_s), (1000.0, 3000.0));
        let (request, words) = sweep(&facts, 123.4, &range, 10, AutoOr::Fixed(20));
        assert_eq!(request["scene"]["casing"]["clearance"]["leading"], 0.25);
        assert_eq!(request["scene"]["casing"]["lobes"]["amplitude"], 0.263);
        assert!(words.contains("9549 to 28647 rpm") && words.contains("0.25 mm: 0.2 %"), "{words}");
        assert_eq!(lobes_of(&request), LOBES);
        assert_eq!(request["integration"]["revolutions"], 20);
        assert_eq!(request["integration"]["window_revolutions"], 8);
        let (request, _) = sweep(&facts, 123.4, &range, 10, AutoOr::Auto);
        assert_eq!(request["integration"]["revolutions"], "auto");
    }

    #[test]
    fn without_stiffness_at_speed_the_lowest_frequency_says_where_to_look() {
        let facts = facts(vec![0.0]);
        assert!(Range::of_package(&facts).is_none());
        let range = Range::of_frequency(900.0);
        // Engine order 3 at the top, 9 at the bottom.
        assert!(
            (range.to_rad_s / (TAU * 300.0) - 1.0).abs() < 0.05
                && (range.from_rad_s * 3.0 - range.to_rad_s).abs() < 1e-9
        );
    }

    #[test]
    fn numbers_are_short_in_any_unit() {
        for (value, short) in [(0.2468, 0.25), (2.468e-4, 2.5e-4), (1884.9, 1885.0), (0.0999, 0.1)] {
            assert_eq!(round(value), short);
        }
    }
}
