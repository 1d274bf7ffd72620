//! The Campbell diagram in the rotating frame.

use super::axis::ticks;
use super::cells::rpm;
use super::colour::ordinal;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::svg::{Element, document, group, line, polyline, text};
use super::{heading, marks};
use rubmap_analysis::result::{Campbell, Wave};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 780.0;
const CORNER: (f64, f64) = (84.0, 86.0);
const SIZE: (f64, f64) = (850.0, 606.0);

/// Engine orders beyond this crowd the corner of slow speeds; their rays and what they drive are left out.
const HIGHEST_ORDER: u32 = 30;

/// Line styles of the families; those beyond look like the last.
const DASHES: [&str; 4] = ["", "9 4", "2 3", "9 3 2 3"];

/// Draws natural frequencies over speed with engine orders and both kinds of crossings.
pub fn campbell(campbell: &Campbell) -> String {
    let diagram = diagram(campbell);
    let y_ticks = ticks(diagram.y.values, 10.0);
    let content = vec![
        heading(campbell),
        diagram.grid(&[], &y_ticks),
        engine_orders(campbell, &diagram),
        natural_frequencies(campbell, &diagram),
        crossings(campbell, &diagram),
        diagram.frame(),
        diagram.x_axis(&ticks(diagram.x.values, 10.0), "rotational speed Ω, rpm"),
        diagram.y_axis(&y_ticks, "natural frequency in the rotating frame, Hz", 62.0),
        legend(campbell, diagram.right() + 34.0),
    ];
    document("Campbell diagram", WIDTH, HEIGHT, content)
}

fn diagram(campbell: &Campbell) -> Diagram {
    let branches = campbell.branches();
    let frequencies = branches.iter().flat_map(|(_, table)| table.iter().flatten().flatten()).copied();
    let highest = frequencies.filter(|f| f.is_finite()).fold(0.0, f64::max);
    let speeds = campbell.speeds_rad_s.iter().map(|speed| rpm(*speed));
    let (slow, fast) =
        speeds.fold((f64::INFINITY, 0f64), |(slow, fast), speed| (slow.min(speed), fast.max(speed)));
    let speeds = if slow < fast { (slow, fast) } else { (0.0, f64::max(fast, 1.0)) };
    Diagram::new(CORNER, SIZE, speeds, (0.0, if highest > 0.0 { 1.06 * highest } else { 1.0 }))
}

/// Number of nodal diameters and of families.
fn counts(campbell: &Campbell) -> (usize, usize) {
    let first = campbell.frequencies_hz.first();
    let families = first.into_iter().flatten().map(Vec::len).max();
    (first.map_or(0, Vec::len), families.unwrap_or(0))
}

fn natural_frequencies(campbell: &Campbell, diagram: &Diagram) -> Element {
    let (harmonics, families) = counts(campbell);
    let mut curves = group();
    for (wave, table) in campbell.branches() {
        for (nodal_diameter, family) in (0..harmonics).flat_map(|i| (0..families).map(move |j| (i, j))) {
            let points = campbell.speeds_rad_s.iter().zip(table);
            let curve = polyline(points.map(|(speed, frequencies)| {
                let hz = frequencies.get(nodal_diameter)?.get(family)?;
                diagram.inside(rpm(*speed), *hz)
            }));
            let words = marks::mode(nodal_diameter as u32, family as u32 + 1, wave);
            curves = curves.child(
                curve
                    .set("stroke", ordinal(nodal_diameter, harmonics))
                    .set("stroke-width", stroke_width(wave))
                    .set("stroke-dasharray", DASHES[family.min(DASHES.len() - 1)])
                    .title(&words),
            );
        }
    }
    curves
}

fn stroke_width(wave: Option<Wave>) -> &'static str {
    if wave == Some(Wave::Forward) { "0.9" } else { "1.8" }
}

/// Rays f = kΩ/2π for every order that a crossing needs, those of the lobes darker, labelled where they leave.
fn engine_orders(campbell: &Campbell, diagram: &Diagram) -> Element {
    let lobes = campbell.settings.lobes.max(1);
    let driven = campbell.driven_crossings.iter().map(|crossing| crossing.engine_order);
    let linear = campbell.crossings.iter().map(|crossing| crossing.nodal_diameter * crossing.superharmonic);
    let highest = driven.chain(linear).max().unwrap_or(0).min(HIGHEST_ORDER);
    let mut rays = group();
    let mut last_label = (f64::NAN, f64::NAN);
    for order in 1..=highest {
        let (slow, fast) = diagram.x.values;
        let slope = f64::from(order) / 60.0;
        let Some([from, to]) = diagram.clipped((slow, slope * slow), (fast, slope * fast)) else { continue };
        let excited = order.is_multiple_of(lobes);
        let (from, to) = (diagram.point(from.0, from.1), diagram.point(to.0, to.1));
        let ray = line(from, to).set("stroke", if excited { "#777777" } else { "#cccccc" });
        rays = rays.child(ray.set("stroke-width", if excited { "1" } else { "0.8" }));
        let crowded = (to.0 - last_label.0).abs() < 18.0 && (to.1 - last_label.1).abs() < 13.0;
        if excited && !crowded {
            let (x, y, anchor) = if to.1 <= diagram.top + 0.5 {
                (to.0, to.1 - 6.0, "middle")
            } else {
                (to.0 + 6.0, to.1 + 4.0, "start")
            };
            rays = rays
                .child(text(x, y, anchor, &format!("{order}")).set("font-size", "11").set("fill", "#555555"));
            last_label = to;
        }
    }
    rays
}

fn crossings(campbell: &Campbell, diagram: &Diagram) -> Element {
    let linear = campbell.crossings.iter().filter_map(|crossing| {
        let place = diagram.inside(rpm(crossing.speed_rad_s), crossing.frequency_hz)?;
        Some(marks::linear(place, "black", crossing))
    });
    let driven = campbell.driven_crossings.iter().filter(|crossing| crossing.engine_order <= HIGHEST_ORDER);
    let driven = driven.filter_map(|crossing| {
        let place = diagram.inside(rpm(crossing.speed_rad_s), crossing.frequency_hz)?;
        Some(marks::driven(place, "#d62728", "white", crossing))
    });
    group().children(linear).children(driven)
}

fn heading(campbell: &Campbell) -> Element {
    let settings = &campbell.settings;
    let model: String = settings.model.chars().take(12).collect();
    let words = format!(
        "{} modes per speed · {} lobes · model {model} · rubmap {}",
        campbell.reduction.modes_per_speed, settings.lobes, campbell.version
    );
    let warning = campbell.reduction.stiffening.verdict.warning().map(str::to_owned);
    let paragraphs: Vec<String> = [words].into_iter().chain(warning).collect();
    heading::heading(CORNER.0, "Campbell diagram", &paragraphs).0
}

fn legend(campbell: &Campbell, x: f64) -> Element {
    /// More nodal diameters than this are named at the ends only.
    const MOST: usize = 16;
    let (harmonics, families) = counts(campbell);
    let mut key = Key::new(x, CORNER.1 + 8.0);
    let stroke = |colour: String, dashes: &str| {
        let stroke = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", colour).set("stroke-width", "1.8");
        stroke.set("stroke-dasharray", dashes)
    };
    for nodal_diameter in (0..harmonics).filter(|i| harmonics <= MOST || *i == 0 || i + 1 == harmonics) {
        let words = format!("nodal diameter {nodal_diameter}");
        key = key.row(stroke(ordinal(nodal_diameter, harmonics), ""), &words);
    }
    for (family, dashes) in DASHES.iter().enumerate().take(families) {
        key = key.row(stroke("#444444".to_owned(), dashes), &format!("family {}", family + 1));
    }
    let directions = [("forward waves", Wave::Forward), ("backward waves", Wave::Backward)];
    for (words, wave) in directions.into_iter().filter(|_| campbell.waves.is_some()) {
        let mark = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", "#444444");
        let mark = mark.set("stroke-width", stroke_width(Some(wave)));
        key = key.row(mark, words);
    }
    let lobes = campbell.settings.lobes;
    key = key.row(stroke("#777777".to_owned(), ""), &format!("engine order {lobes}, {}, …", 2 * lobes));
    key = key.row(stroke("#cccccc".to_owned(), ""), "other engine orders");
    key = key.row(
        marks::diamond((16.0, 0.0), "#d62728", "white"),
        &format!("driven by lobes, k ≤ {HIGHEST_ORDER}"),
    );
    let ring = Element::new("circle").number("cx", 16.0).number("r", 4.5).set("fill", "none");
    key = key.row(ring.set("stroke", "black").set("stroke-width", "1.5"), "linear criterion");
    key.draw()
}
