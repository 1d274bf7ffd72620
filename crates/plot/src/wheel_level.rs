//! Level of the whole wheel over speed, with operating ranges, limits and critical speeds: the drawing by which a sweep is judged.

use super::axis::{label, significant};
use super::cells::{range, rpm};
use super::drawing::Drawing;
use super::heading;
use super::layer::{Area, Areas, Bars, Curve, Layer, Mark, Marks, Reach, Upright, Uprights};
use super::marks;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{group, rectangle, text};
use rubmap_analysis::result::{
    JudgedSpeed, LevelSpeed, LevelValue, LimitKind, PointStatus, RangeVerdict, Standing, SweepLevel,
};
use serde_json::json;

const LEFT: f64 = 92.0;
const SIZE: (f64, f64) = (1040.0, 400.0);

/// Room above the frame, with and without labels of critical speeds.
const ABOVE: [f64; 2] = [190.0, 26.0];

/// Relative difference up to which a speed counts as that of an end, as in verdicts: units are converted.
const SAME: f64 = 1e-9;

/// Fill of operating ranges, and of the separation around them.
const INSIDE: &str = "rgba(0, 114, 178, 0.22)";
const BESIDE: &str = "rgba(0, 114, 178, 0.10)";

/// Draws one quantity of the whole wheel over speed, without a choice the one that decides the verdict: operating ranges are shaded with their
/// separation, limits are lines, values have the colours of their standing and error bars where errors are known. Values in a range are filled.
pub fn wheel_level(level: &SweepLevel, quantity: Option<LimitKind>) -> Drawing<'static> {
    let quantity = quantity.unwrap_or_else(|| level.deciding());
    let verdict = &level.verdict;
    let all: Vec<(&LevelSpeed, &LevelValue)> =
        level.speeds.iter().filter_map(|speed| Some((speed, speed.value(quantity)?))).collect();
    let limit = level.limit(quantity);
    let title = format!("{} of the wheel over speed: {}", capital(quantity.words()), verdict.verdict);
    let origin = heading::origin(&verdict.settings.model, &verdict.version);
    let words = format!("{} of {} speeds · {origin}", all.len(), level.speeds.len());
    let sketch = Sketch::new("level", title, vec![words]).high(520);
    let sketch = sketch.meta("quantity", quantity.as_str());
    let unit = quantity.unit(&verdict.units);
    let unit = if unit.is_empty() { "share" } else { unit };
    let sketch = sketch.meta("units", json!({"x": "rpm", "y": unit}));
    if all.is_empty() {
        return sketch.nothing(nothing(level, quantity)).into();
    }
    let speeds: Vec<f64> = level.speeds.iter().map(|speed| speed.speed_rad_s).collect();
    let (slow, fast) = range(&speeds);
    let room = 0.015 * (fast - slow);
    let tops = all.iter().map(|(_, value)| value.value + value.error.unwrap_or(0.0));
    let highest = tops.chain(limit).filter(|top| top.is_finite()).fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.12 * highest } else { 1.0 };
    let y = Axis::linear(format!("{}, {unit}", quantity.words()), (0.0, top), 6.0);
    let x = Axis::speeds(((slow - room).max(0.0), fast + room), 9.0);
    let mut panel =
        Panel::new((LEFT, sketch.top() + ABOVE[usize::from(verdict.critical_speeds.is_empty())]), SIZE, x, y)
            .key_below();
    if verdict.ranges_given {
        add_ranges(&verdict.ranges, top, &mut panel);
    }
    let places = level.speeds.iter().map(|speed| {
        let value = speed.value(quantity)?.value;
        value.is_finite().then_some((rpm(speed.speed_rad_s), value))
    });
    panel
        .push(Curve::new("level", places, Pen::new(Colour::neutral("#9aa4ae"), Dash::Solid, 1.0)).unlisted());
    if let Some(limit) = limit {
        add_limit(limit, unit, &mut panel);
    }
    add_critical(&verdict.critical_speeds, &mut panel);
    add_values(&all, level, quantity, &mut panel);
    add_lost(level, &mut panel);
    let indices: Vec<u32> = level.speeds.iter().map(|speed| speed.index).collect();
    let rpms: Vec<f64> = speeds.iter().map(|speed| rpm(*speed)).collect();
    sketch.meta("speed_indices", indices).meta("speeds_rpm", rpms).with(panel).into()
}

/// Reason why there is nothing to draw of a quantity.
fn nothing(level: &SweepLevel, quantity: LimitKind) -> String {
    match quantity {
        _ if level.speeds.is_empty() => "no speed has finished yet".to_owned(),
        LimitKind::Utilisation => "utilisation needs recorded stress and strengths".to_owned(),
        LimitKind::ClearanceConsumption => "clearance consumption needs contact".to_owned(),
        LimitKind::TipMotion | LimitKind::NodeForce => format!("no {} is known", quantity.words()),
    }
}

/// Adds the operating ranges with their names, and the separation beside them.
fn add_ranges(ranges: &[RangeVerdict], top: f64, panel: &mut Panel<'_>) {
    let (first, last) = panel.x.range;
    let seen = |from: f64, to: f64| (from.max(first), to.min(last));
    let ends = |range: &RangeVerdict| (rpm(range.from_rad_s), rpm(range.to_rad_s));
    let words = |range: &RangeVerdict| {
        let (from, to) = ends(range);
        let name = range.name.as_deref().unwrap_or_default();
        format!("{name}: {} to {} rpm, {}", label(from, 0), label(to, 0), range.verdict)
    };
    let area = |across: (f64, f64), words: String| {
        (across.0 < across.1).then_some(Area { across, upwards: Some((0.0, top)), words })
    };
    let inside = ranges.iter().filter_map(|range| {
        let (from, to) = ends(range);
        area(seen(from, to), words(range))
    });
    let beside = ranges.iter().filter(|range| range.separation_percent > 0.0).flat_map(|range| {
        let (from, to) = ends(range);
        let share = range.separation_percent / 100.0;
        let words =
            format!("within {} % of {}", range.separation_percent, range.name.as_deref().unwrap_or_default());
        [area(seen((1.0 - share) * from, from), words.clone()), area(seen(to, (1.0 + share) * to), words)]
    });
    for (name, areas, fill) in [
        ("separation asked", beside.flatten().collect::<Vec<Area>>(), BESIDE),
        ("operating range", inside.collect(), INSIDE),
    ] {
        if !areas.is_empty() {
            panel.wide_sample(rectangle(0.0, -6.0, 20.0, 12.0).set("fill", fill), 20.0, name);
        }
        panel.push(Areas { name, areas, fill: fill.to_owned(), class: "range" });
    }
    let named = |range: &RangeVerdict| {
        let (from, _) = seen(ends(range).0, ends(range).1);
        let name = range.name.clone().unwrap_or_default();
        Mark::new((from, 0.955 * top), words(range)).label(name)
    };
    let names: Vec<Mark> =
        ranges.iter().map(named).filter(|mark| panel.diagram.x.contains(mark.place.0)).collect();
    let drawn = names.iter().map(|mark| {
        let (x, y) = panel.diagram.point(mark.place.0, mark.place.1);
        text(x + 6.0, y + 4.0, "start", &mark.label)
            .set("class", "range")
            .set("fill", "#0b4f7d")
            .rimmed("white")
    });
    let drawn = group().children(drawn);
    panel.push(drawn);
    let look = Look::filled(Symbol::Circle, (0.1, 1.0), Colour::neutral("#0b4f7d"));
    let marks = Marks { has_texts: true, ..Marks::new("operating range", look, names) };
    panel.push(Layer::Shown(marks.unlisted()));
}

/// Adds the line of a limit.
fn add_limit(limit: f64, unit: &str, panel: &mut Panel<'_>) {
    let (first, last) = panel.x.range;
    let words = if unit == "share" { significant(limit) } else { format!("{} {unit}", significant(limit)) };
    let pen = Pen::new(Colour::warning(), Dash::Dashed, 2.0);
    let curve = Curve::new("limit", [Some((first, limit)), Some((last, limit))], pen).class("limit");
    let curve = curve.each(vec![format!("limit {words}"); 2]);
    panel.sample(curve.sample(), &format!("limit {words}"));
    panel.push(Curve { labels: vec![format!("limit {words}")], ..curve });
}

/// Adds lines at the critical speeds of the wheel, labelled with speed, engine order and nodal diameter.
fn add_critical(critical: &[JudgedSpeed], panel: &mut Panel<'_>) {
    for (is_resolved, name, dash) in
        [(true, "critical speed", Dash::Dashed), (false, "critical speed, peak not resolved", Dash::Sparse)]
    {
        let of = critical.iter().filter(|speed| (speed.resolved == Some(true)) == is_resolved);
        let line = |speed: &JudgedSpeed| {
            let more = speed.speed_error_rad_s.map(|error| format!(" ± {} rpm", significant(rpm(error))));
            Upright {
                x: rpm(speed.speed_rad_s),
                label: critical_words(speed),
                more: more.unwrap_or_default(),
            }
        };
        let pen = Pen::new(Colour::neutral("#5a6570"), dash, 1.2);
        let lines: Vec<Upright> = of.map(line).filter(|line| panel.diagram.x.contains(line.x)).collect();
        if !lines.is_empty() {
            panel.sample(pen.sample(), name);
        }
        let top = panel.diagram.top;
        panel.push(Uprights { name: name.to_owned(), lines, pen, top, class: "critical-speed" });
    }
}

/// Words for a critical speed: speed, engine order, nodal diameter.
pub(super) fn critical_words(speed: &JudgedSpeed) -> String {
    let order = speed.engine_order.map_or_else(String::new, |order| format!(" · EO {}", marks::order(order)));
    let diameter = speed.nodal_diameter.map_or_else(String::new, |diameter| format!(" · ND {diameter}"));
    format!("{} rpm{order}{diameter}", label(rpm(speed.speed_rad_s), 0))
}

/// Standings in the order of the key, each with its words, symbol and colour.
const STANDINGS: [(Option<Standing>, &str, Symbol, &str); 5] = [
    (None, "no limit given", Symbol::Circle, "#0072b2"),
    (Some(Standing::Kept), "limit kept", Symbol::Circle, "#009e73"),
    (Some(Standing::Reached), "80 % of the limit reached", Symbol::Square, "#c98a00"),
    (Some(Standing::Open), "limit within the error, or error not known", Symbol::Diamond, "#7f8790"),
    (Some(Standing::Passed), "limit passed", Symbol::TriangleUp, "#c8311e"),
];

/// Adds the values in the colours of their standing: filled in a range, open outside.
fn add_values(
    all: &[(&LevelSpeed, &LevelValue)],
    level: &SweepLevel,
    quantity: LimitKind,
    panel: &mut Panel<'_>,
) {
    let ranges = &level.verdict.ranges;
    let is_near = |speed: f64| {
        ranges.iter().any(|range| {
            let share = range.separation_percent / 100.0;
            let lowest = (1.0 - share) * (1.0 - SAME) * range.from_rad_s;
            (lowest..=(1.0 + share) * (1.0 + SAME) * range.to_rad_s).contains(&speed)
        })
    };
    let unit = quantity.unit(&level.verdict.units);
    for (standing, words, symbol, colour) in STANDINGS {
        for is_inside in [true, false] {
            let of = || {
                let here =
                    all.iter().filter(|(_, value)| value.standing == standing && value.value.is_finite());
                here.filter(|(speed, _)| is_near(speed.speed_rad_s) == is_inside)
            };
            let mark = |(speed, value): &(&LevelSpeed, &LevelValue)| {
                let speed_rpm = rpm(speed.speed_rad_s);
                let error = reach(value).map_or_else(String::new, |Reach { below, above }| {
                    let ends = [value.value - below, value.value + above].map(significant);
                    format!(" ({} to {})", ends[0], ends[1])
                });
                let told = format!("{} rpm: {}{error} {unit}", label(speed_rpm, 0), significant(value.value));
                let stands = match (standing, value.error) {
                    (Some(Standing::Open), Some(_)) => "limit within the error",
                    (Some(Standing::Open), None) => "error not known",
                    _ => words,
                };
                let told = format!("{}, {stands}", told.trim_end());
                Mark { index: Some(speed.index as usize), ..Mark::new((speed_rpm, value.value), told) }
            };
            let look = if is_inside { Look::filled } else { Look::open };
            let look = look(symbol, (4.2, 9.0), Colour::of(colour));
            let lengths: Vec<Reach> =
                of().map(|(_, value)| reach(value).unwrap_or(Reach::even(f64::NAN))).collect();
            let has_errors = lengths.iter().any(|reach| reach.above.is_finite());
            let bars = has_errors.then(|| Bars { lengths, colour: Colour::of(colour), class: "error" });
            let name = if is_inside { words.to_owned() } else { format!("{words}, outside the ranges") };
            panel.marks(&name, Marks { bars, ..Marks::new(&name, look, of().map(mark)).class("level") });
        }
    }
}

/// Error bar of a value, if its error is known; 0 has a bar without length.
fn reach(value: &LevelValue) -> Option<Reach> {
    let error = value.error?;
    let relative = if value.value > 0.0 { error / value.value } else { 0.0 };
    Some(Reach::of_factor(value.value, relative))
}

/// Adds the speeds without values on the axis.
fn add_lost(level: &SweepLevel, panel: &mut Panel<'_>) {
    for (status, words) in [(PointStatus::Diverged, "motion diverged"), (PointStatus::Failed, "not computed")]
    {
        let of = level.speeds.iter().filter(|speed| speed.status == status);
        let mark = |speed: &LevelSpeed| {
            let place = rpm(speed.speed_rad_s);
            Mark {
                index: Some(speed.index as usize),
                ..Mark::new((place, 0.0), format!("{} rpm: {words}", label(place, 0)))
            }
        };
        let look = Look::open(Symbol::Cross, (4.5, 10.0), Colour::warning());
        panel.marks(words, Marks::new(words, look, of.map(mark)));
    }
}

/// Text with its first letter in upper case.
fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
