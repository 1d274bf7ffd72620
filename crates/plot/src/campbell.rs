//! Campbell diagram in the rotating frame.

use super::axis::{label, significant};
use super::cells::{range, rpm};
use super::drawing::Drawing;
use super::layer::{Curve, Mark, Marks, Stroke};
use super::sketch::{Axis, Panel, Sketch, Stand};
use super::style::{Colour, DASHES, Dash, Look, Pen, Symbol};
use super::svg::{Element, group, line, text};
use super::{heading, marks};
use rubmap_analysis::result::{Campbell, Course, Table, Veering, Wave};

/// Highest engine order that is drawn: higher ones crowd the corner of slow speeds, so their rays and driven crossings are left out.
const HIGHEST_ORDER: u32 = 30;

/// Largest number of families that a key names.
pub(super) const NAMED: usize = 16;

/// Natural frequencies over speed, those of a family in one colour and under one name, with engine orders and both kinds of crossings.
pub fn campbell(campbell: &Campbell) -> Drawing<'_> {
    let frequencies = campbell.branches();
    let frequencies = frequencies.iter().flat_map(|(_, table)| table.iter().flatten().flatten()).copied();
    let highest = frequencies.filter(|f| f.is_finite()).fold(0.0, f64::max);
    let x = Axis::speeds(range(&campbell.speeds_rad_s), 10.0);
    let upwards = (0.0, if highest > 0.0 { 1.06 * highest } else { 1.0 });
    let y = Axis::linear("natural frequency in the rotating frame, Hz", upwards, 10.0);
    let sketch = begin("campbell", "Campbell diagram", campbell).high(600);
    let mut panel = Panel::new((92.0, 86.0), (812.0, 606.0), x, y);
    // The numbers of the lines are between.
    panel.stand = Stand::Beside(50.0);
    let rays = rays(campbell, &panel);
    panel.layers.extend(rays.into_iter().map(Into::into));
    curves(campbell, &mut panel);
    if drawn_orders(campbell) >= campbell.settings.lobes.max(1) {
        panel.sample(ray_pen(true).sample(), &excited_words(campbell));
    }
    if drawn_orders(campbell) > 0 && campbell.settings.lobes > 1 {
        panel.sample(ray_pen(false).sample(), "other engine orders");
    }
    veerings(campbell, &mut panel);
    crossings(campbell, &mut panel);
    let numbers = numbers(campbell, &panel);
    panel.push(numbers);
    sketch.with(panel).into()
}

/// Begins a sketch of a Campbell diagram.
pub(super) fn begin(kind: &'static str, title: &str, campbell: &Campbell) -> Sketch<'static> {
    let settings = &campbell.settings;
    let origin = heading::origin(&settings.model, &campbell.version);
    let by = if campbell.followed.is_some() { "shape" } else { "rank" };
    let words = format!(
        "{} modes per speed · {} lobes · families by {by} · {origin}",
        campbell.reduction.modes_per_speed, settings.lobes
    );
    let warning = campbell.reduction.stiffening.verdict.warning().map(str::to_owned);
    let sketch = Sketch::new(kind, title, [words].into_iter().chain(warning).collect());
    let speeds: Vec<f64> = campbell.speeds_rad_s.iter().map(|speed| rpm(*speed)).collect();
    sketch.meta("units", serde_json::json!({"x": "rpm", "y": "Hz"})).meta("speeds_rpm", speeds)
}

/// Number of nodal diameters and of families.
fn counts(campbell: &Campbell) -> (usize, usize) {
    let first = campbell.frequencies_hz.first();
    let families = first.into_iter().flatten().map(Vec::len).max();
    (first.map_or(0, Vec::len), families.unwrap_or(0))
}

fn width(wave: Option<Wave>) -> f64 {
    if wave == Some(Wave::Forward) { 0.9 } else { 1.8 }
}

/// Adds the natural frequencies of all modes: colours show the family, dashes the nodal diameter, forward waves are thin.
fn curves(campbell: &Campbell, panel: &mut Panel) {
    let (harmonics, families) = counts(campbell);
    for (wave, table) in campbell.branches() {
        for (i, j) in (0..harmonics).flat_map(|i| (0..families).map(move |j| (i, j))) {
            let place = |(speed, frequencies): (&f64, &Vec<Vec<f64>>)| {
                Some((rpm(*speed), *frequencies.get(i)?.get(j)?))
            };
            let places = campbell.speeds_rad_s.iter().zip(table).map(place);
            let pen = Pen::new(Colour::family(j, families), Dash::nth(i), width(wave));
            let words = marks::mode(i as u32, j as u32 + 1, wave);
            let curve = Curve::new(&family(j), places, pen).title(&words);
            panel.push(curve.over(words, "%{x:.0f} rpm, %{y:.1f} Hz"));
        }
    }
    name_families(families, panel);
    for first in 0..harmonics.min(DASHES) {
        let alike = (first..harmonics).step_by(DASHES).map(|i| i.to_string()).collect::<Vec<_>>();
        let pen = Pen::new(Colour::neutral("#444444"), Dash::nth(first), 1.8);
        explained(panel, pen, &format!("nodal diameter {}", alike.join(", ")));
    }
    if campbell.waves.is_some() {
        for (wave, words) in [(Wave::Forward, "forward waves"), (Wave::Backward, "backward waves")] {
            explained(panel, Pen::new(Colour::neutral("#444444"), Dash::Solid, width(Some(wave))), words);
        }
    }
    if harmonics > 0 {
        panel.note("numbers at the lines: nodal diameters");
    }
}

/// Name of the family with this index.
pub(super) fn family(index: usize) -> String {
    format!("family {}", index + 1)
}

/// Adds the colours of families to the key of the drawing; the legend of the figure has their curves.
pub(super) fn name_families(families: usize, panel: &mut Panel) {
    for index in (0..families).filter(|index| families <= NAMED || *index == 0 || index + 1 == families) {
        let pen = Pen::new(Colour::family(index, families), Dash::Solid, 1.8);
        panel.sample(pen.sample(), &family(index));
    }
}

/// Adds a pen to the key of the drawing, and to the legend of the figure by a curve without points.
pub(super) fn explained(panel: &mut Panel, pen: Pen, words: &str) {
    panel.sample(pen.sample(), words);
    panel.push(Curve::new(words, [None, None], pen));
}

/// Adds the places where followed families veer or cross.
fn veerings(campbell: &Campbell, panel: &mut Panel) {
    let all = campbell.followed.iter().flat_map(|followed| &followed.veerings);
    let marks = all.map(|found| {
        let Veering { nodal_diameter: i, families: [a, b], speed_rad_s, frequency_hz, .. } = *found;
        let apart = format!("{} Hz apart", significant(found.distance_hz));
        let course = match found.course {
            Course::Crosses => "cross".to_owned(),
            Course::Exchanges => format!("veer, {apart}, and exchange their shapes"),
            Course::Stays => format!("veer, {apart}, and stay on their branches"),
        };
        let place = format!("{} rpm, {} Hz", label(rpm(speed_rad_s), 0), significant(frequency_hz));
        Mark::new(
            (rpm(speed_rad_s), frequency_hz),
            format!("nodal diameter {i}: families {a} and {b} {course}: {place}"),
        )
    });
    let look = Look::open(Symbol::Square, (5.0, 11.0), Colour::neutral("#444444"));
    panel.marks("families veer or cross", Marks::new("families veer or cross", look, marks));
}

/// Highest engine order that has a ray: that of the highest crossing, at most [`HIGHEST_ORDER`].
fn drawn_orders(campbell: &Campbell) -> u32 {
    let driven = campbell.driven_crossings.iter().map(|crossing| crossing.engine_order);
    let linear = campbell.crossings.iter().map(|crossing| crossing.nodal_diameter * crossing.superharmonic);
    driven.chain(linear).max().unwrap_or(0).min(HIGHEST_ORDER)
}

fn ray_pen(is_excited: bool) -> Pen {
    match is_excited {
        true => Pen::new(Colour::neutral("#777777"), Dash::Solid, 1.0),
        false => {
            Pen::new(Colour { paper: "#cccccc".to_owned(), screen: "#b0b0b0".to_owned() }, Dash::Solid, 0.8)
        }
    }
}

/// Rays f = kΩ/2π of all engine orders up to the highest one with a crossing; those that the lobes excite with their numbers, where there
/// is room.
fn rays(campbell: &Campbell, panel: &Panel) -> Vec<Curve> {
    let lobes = campbell.settings.lobes.max(1);
    let (slow, fast) = panel.x.range;
    let mut last = (f64::NAN, f64::NAN);
    let (mut strokes, mut numbers) = ([Vec::new(), Vec::new()], Vec::new());
    for order in 1..=drawn_orders(campbell) {
        let slope = f64::from(order) / 60.0;
        let Some(ends) = panel.diagram.clipped((slow, slope * slow), (fast, slope * fast)) else { continue };
        let is_excited = order.is_multiple_of(lobes);
        let stroke = Stroke { places: ends.map(Some).to_vec(), title: String::new() };
        strokes[usize::from(is_excited)].push(stroke);
        if is_excited {
            let to = panel.diagram.point(ends[1].0, ends[1].1);
            let is_crowded = (to.0 - last.0).abs() < 18.0 && (to.1 - last.1).abs() < 13.0;
            last = if is_crowded { last } else { to };
            numbers.push(if is_crowded { String::new() } else { order.to_string() });
        }
    }
    let [others, excited] = strokes;
    let others = Curve::of("other engine orders", others, ray_pen(false));
    let excited = Curve { labels: numbers, ..Curve::of(&excited_words(campbell), excited, ray_pen(true)) };
    [others, excited].into_iter().filter(|curve| !curve.strokes.is_empty()).collect()
}

/// Nodal diameters at the right ends of the natural frequencies, moved apart where lines are close; none where there is no room for all.
fn numbers(campbell: &Campbell, panel: &Panel) -> Element {
    const SPACING: f64 = 12.0;
    let (harmonics, families) = counts(campbell);
    let last = |table: &Table, i: usize, j: usize| {
        let hz = *table.last()?.get(i)?.get(j)?;
        Some((panel.diagram.inside(panel.x.range.1, hz)?.1, (i, j)))
    };
    let modes = || (0..harmonics).flat_map(|i| (0..families).map(move |j| (i, j)));
    let branches = campbell.branches();
    let mut ends: Vec<(f64, (usize, usize))> =
        branches.iter().flat_map(|(_, table)| modes().filter_map(move |(i, j)| last(table, i, j))).collect();
    if ends.len() as f64 * SPACING > panel.diagram.height {
        return group();
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut heights: Vec<f64> = ends.iter().map(|(y, _)| *y).collect();
    for _ in 0..60 {
        // Neighbours push each other away, each by half the missing distance.
        for pair in 1..heights.len() {
            let lack = SPACING - (heights[pair] - heights[pair - 1]);
            if lack > 0.0 {
                heights[pair - 1] -= 0.5 * lack;
                heights[pair] += 0.5 * lack;
            }
        }
    }
    let right = panel.diagram.right();
    group().set("class", "numbers").children(ends.into_iter().zip(heights).map(|((end, (i, j)), height)| {
        let colour = Colour::family(j, families).paper;
        let lead = line((right, end), (right + 14.0, height)).set("stroke", &colour);
        let number = text(right + 18.0, height + 4.0, "start", &i.to_string()).set("fill", colour);
        group()
            .child(lead.set("stroke-width", "0.8"))
            .child(number.set("font-size", "11").set("font-weight", "bold"))
    }))
}

/// Adds crossings of the linear criterion and those that the lobes drive, with (i, j, n) and (i, j).
fn crossings(campbell: &Campbell, panel: &mut Panel) {
    let inside = |mark: &Mark| panel.diagram.inside(mark.place.0, mark.place.1).is_some();
    let linear = campbell.crossings.iter().map(|found| {
        let mark = Mark::new((rpm(found.speed_rad_s), found.frequency_hz), marks::linear_words(found));
        mark.label(marks::triple(found))
    });
    let few = campbell.driven_crossings.iter().filter(|crossing| crossing.engine_order <= HIGHEST_ORDER);
    let driven = few.map(|found| {
        let mark = Mark::new((rpm(found.speed_rad_s), found.frequency_hz), marks::driven_words(found));
        mark.label(format!(
            "EO {}, i {}, {} rpm",
            found.engine_order,
            found.nodal_diameter,
            label(rpm(found.speed_rad_s), 0)
        ))
    });
    let ring = Look::open(Symbol::Circle, (4.5, 10.0), Colour::neutral("black"));
    let linear = Marks::new("linear (i, j, n)", ring, linear.filter(inside));
    let diamond = Look::filled(Symbol::Diamond, (4.4, 10.0), Colour::warning());
    let driven = Marks::new(&format!("driven, k ≤ {HIGHEST_ORDER}"), diamond, driven.filter(inside));
    panel.marks(&format!("driven, EO k ≤ {HIGHEST_ORDER}, on i"), driven);
    panel.marks("linear criterion (i, j, n)", linear);
}

/// Words for the engine orders of the lobes.
fn excited_words(campbell: &Campbell) -> String {
    let lobes = campbell.settings.lobes.max(1);
    if drawn_orders(campbell) >= 2 * lobes {
        format!("engine order {lobes}, {}, …", 2 * lobes)
    } else {
        format!("engine order {lobes}")
    }
}
