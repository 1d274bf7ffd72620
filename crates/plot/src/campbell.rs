//! Campbell diagram in the rotating frame.

use super::axis::ticks;
use super::cells::{range, rpm};
use super::colour::ordinal;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::labels::Labels;
use super::svg::{Element, document, group, line, polyline, text};
use super::{heading, marks};
use rubmap_analysis::result::{Campbell, Crossing, DrivenCrossing, Table, Wave};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 760.0;
const CORNER: (f64, f64) = (84.0, 86.0);
const SIZE: (f64, f64) = (820.0, 606.0);

/// Highest engine order that is drawn: higher ones crowd the corner of slow speeds, so their rays and driven crossings are left out.
pub(super) const HIGHEST_ORDER: u32 = 30;

/// Line styles of the families; further families look like the last.
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
        diagram.frame(),
        crossings(campbell, &diagram),
        numbers(campbell, &diagram),
        diagram.x_axis(&ticks(diagram.x.values, 10.0), "rotational speed Ω, rpm"),
        diagram.y_axis(&y_ticks, "natural frequency in the rotating frame, Hz", 62.0),
        legend(campbell, &diagram, diagram.right() + 50.0),
    ];
    document("Campbell diagram", WIDTH, HEIGHT, content)
}

/// Empty Campbell diagram, with axes that hold all speeds and frequencies.
pub(super) fn diagram(campbell: &Campbell) -> Diagram {
    let branches = campbell.branches();
    let frequencies = branches.iter().flat_map(|(_, table)| table.iter().flatten().flatten()).copied();
    let highest = frequencies.filter(|f| f.is_finite()).fold(0.0, f64::max);
    let speeds = range(&campbell.speeds_rad_s);
    Diagram::new(CORNER, SIZE, speeds, (0.0, if highest > 0.0 { 1.06 * highest } else { 1.0 }))
}

/// Number of nodal diameters and of families.
pub(super) fn counts(campbell: &Campbell) -> (usize, usize) {
    let first = campbell.frequencies_hz.first();
    let families = first.into_iter().flatten().map(Vec::len).max();
    (first.map_or(0, Vec::len), families.unwrap_or(0))
}

/// Natural frequency of a mode over speed.
pub(super) struct Curve {
    pub(super) nodal_diameter: usize,
    /// Index of the family, from 0.
    pub(super) family: usize,
    pub(super) wave: Option<Wave>,
    /// Speed in rpm and frequency in Hz at each speed.
    pub(super) places: Vec<Option<(f64, f64)>>,
}

impl Curve {
    /// Words for the mode.
    pub(super) fn words(&self) -> String {
        marks::mode(self.nodal_diameter as u32, self.family as u32 + 1, self.wave)
    }
}

/// Natural frequencies of all modes over speed.
pub(super) fn curves(campbell: &Campbell) -> Vec<Curve> {
    let (harmonics, families) = counts(campbell);
    let mut curves = Vec::new();
    for (wave, table) in campbell.branches() {
        for (nodal_diameter, family) in (0..harmonics).flat_map(|i| (0..families).map(move |j| (i, j))) {
            let place = |(speed, frequencies): (&f64, &Vec<Vec<f64>>)| {
                Some((rpm(*speed), *frequencies.get(nodal_diameter)?.get(family)?))
            };
            let places = campbell.speeds_rad_s.iter().zip(table).map(place).collect();
            curves.push(Curve { nodal_diameter, family, wave, places });
        }
    }
    curves
}

fn natural_frequencies(campbell: &Campbell, diagram: &Diagram) -> Element {
    let (harmonics, _) = counts(campbell);
    let drawn = curves(campbell).into_iter().map(|curve| {
        let words = curve.words();
        polyline(curve.places.into_iter().map(|place| place.and_then(|(x, y)| diagram.inside(x, y))))
            .set("stroke", ordinal(curve.nodal_diameter, harmonics))
            .set("stroke-width", stroke_width(curve.wave))
            .set("stroke-dasharray", DASHES[curve.family.min(DASHES.len() - 1)])
            .title(&words)
    });
    group().children(drawn)
}

fn stroke_width(wave: Option<Wave>) -> &'static str {
    if wave == Some(Wave::Forward) { "0.9" } else { "1.8" }
}

/// Highest engine order that has a ray: that of the highest crossing, at most [`HIGHEST_ORDER`].
fn drawn_orders(campbell: &Campbell) -> u32 {
    let driven = campbell.driven_crossings.iter().map(|crossing| crossing.engine_order);
    let linear = campbell.crossings.iter().map(|crossing| crossing.nodal_diameter * crossing.superharmonic);
    driven.chain(linear).max().unwrap_or(0).min(HIGHEST_ORDER)
}

/// Ray f = kΩ/2π of engine order k within the diagram.
pub(super) struct Ray {
    pub(super) order: u32,
    /// Whether the lobes excite the engine order.
    pub(super) excited: bool,
    /// Whether the ray has its number: the lobes excite it and there is room.
    pub(super) numbered: bool,
    /// Ends of the ray, where it enters and where it leaves the diagram, in rpm and Hz.
    pub(super) ends: [(f64, f64); 2],
}

/// Rays of all engine orders up to the highest one with a crossing.
pub(super) fn rays(campbell: &Campbell, diagram: &Diagram) -> Vec<Ray> {
    let lobes = campbell.settings.lobes.max(1);
    let (slow, fast) = diagram.x.values;
    let mut last = (f64::NAN, f64::NAN);
    let ray = |order: u32| {
        let slope = f64::from(order) / 60.0;
        let ends = diagram.clipped((slow, slope * slow), (fast, slope * fast))?;
        let excited = order.is_multiple_of(lobes);
        let to = diagram.point(ends[1].0, ends[1].1);
        let crowded = (to.0 - last.0).abs() < 18.0 && (to.1 - last.1).abs() < 13.0;
        if excited && !crowded {
            last = to;
        }
        Some(Ray { order, excited, numbered: excited && !crowded, ends })
    };
    (1..=drawn_orders(campbell)).filter_map(ray).collect()
}

/// Draws the rays of the engine orders: those that the lobes excite darker, with their numbers where they leave the diagram.
fn engine_orders(campbell: &Campbell, diagram: &Diagram) -> Element {
    let mut rays = group();
    for Ray { order, excited, numbered, ends } in self::rays(campbell, diagram) {
        let [from, to] = ends.map(|(x, y)| diagram.point(x, y));
        let ray = line(from, to).set("stroke", if excited { "#777777" } else { "#cccccc" });
        rays = rays.child(ray.set("stroke-width", if excited { "1" } else { "0.8" }));
        if numbered {
            let (x, y, anchor) = if to.1 <= diagram.top + 0.5 {
                (to.0, to.1 - 6.0, "middle")
            } else {
                // The numbers of the natural frequencies are right of the frame.
                (to.0 - 12.0, to.1 - 4.0, "end")
            };
            let label = text(x, y, anchor, &format!("{order}")).set("font-size", "11").set("fill", "#555555");
            rays = rays.child(label.rimmed("white"));
        }
    }
    rays
}

/// Nodal diameters at the right ends of the natural frequencies, moved apart where lines are close; none where there is no room for all.
fn numbers(campbell: &Campbell, diagram: &Diagram) -> Element {
    const SPACING: f64 = 12.0;
    let (harmonics, families) = counts(campbell);
    let last = |table: &Table, i: usize, j: usize| {
        let hz = *table.last()?.get(i)?.get(j)?;
        Some((diagram.inside(diagram.x.values.1, hz)?.1, i))
    };
    let modes = || (0..harmonics).flat_map(|i| (0..families).map(move |j| (i, j)));
    let branches = campbell.branches();
    let mut ends: Vec<(f64, usize)> =
        branches.iter().flat_map(|(_, table)| modes().filter_map(move |(i, j)| last(table, i, j))).collect();
    if ends.len() as f64 * SPACING > diagram.height {
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
    let right = diagram.right();
    group().set("class", "numbers").children(ends.into_iter().zip(heights).map(|((end, i), height)| {
        let colour = ordinal(i, harmonics);
        let lead = line((right, end), (right + 14.0, height)).set("stroke", &colour);
        let number = text(right + 18.0, height + 4.0, "start", &i.to_string()).set("fill", colour);
        group()
            .child(lead.set("stroke-width", "0.8"))
            .child(number.set("font-size", "11").set("font-weight", "bold"))
    }))
}

/// Crossings that the lobes drive, up to [`HIGHEST_ORDER`] and within the diagram, with their positions.
pub(super) fn driven<'a>(
    campbell: &'a Campbell,
    diagram: &'a Diagram,
) -> impl Iterator<Item = (&'a DrivenCrossing, (f64, f64))> {
    let few = campbell.driven_crossings.iter().filter(|crossing| crossing.engine_order <= HIGHEST_ORDER);
    few.filter_map(|crossing| {
        Some((crossing, diagram.inside(rpm(crossing.speed_rad_s), crossing.frequency_hz)?))
    })
}

/// Crossings of the linear criterion within the diagram, with their positions.
pub(super) fn linear<'a>(
    campbell: &'a Campbell,
    diagram: &'a Diagram,
) -> impl Iterator<Item = (&'a Crossing, (f64, f64))> {
    campbell.crossings.iter().filter_map(|crossing| {
        Some((crossing, diagram.inside(rpm(crossing.speed_rad_s), crossing.frequency_hz)?))
    })
}

/// Draws crossings of the linear criterion and driven ones, with (i, j, n) and (i, j) where there is room.
fn crossings(campbell: &Campbell, diagram: &Diagram) -> Element {
    let mut labels = Labels::inside(diagram);
    let places =
        linear(campbell, diagram).map(|found| found.1).chain(driven(campbell, diagram).map(|found| found.1));
    places.for_each(|place| labels.keep_off(place, 4.0));
    let mut drawn = group();
    let mut named = |mark: Element, place: (f64, f64), words: &str| {
        let label = labels.beside(place, 5.0, words, 10.5).map(|label| label.rimmed("white"));
        group().child(mark).children(label)
    };
    for (crossing, place) in linear(campbell, diagram) {
        let mark = marks::linear(place, "black", crossing);
        drawn = drawn.child(named(mark, place, &marks::triple(crossing)));
    }
    for (crossing, place) in driven(campbell, diagram) {
        let mark = marks::driven(place, "#d62728", "white", crossing);
        drawn = drawn.child(named(mark, place, &marks::pair(crossing)));
    }
    drawn
}

/// Paragraphs below the title: modes per speed, lobes, model, and a warning about K(Ω) if there is one.
pub(super) fn words(campbell: &Campbell) -> Vec<String> {
    let settings = &campbell.settings;
    let model: String = settings.model.chars().take(12).collect();
    let words = format!(
        "{} modes per speed · {} lobes · model {model} · rubmap {}",
        campbell.reduction.modes_per_speed, settings.lobes, campbell.version
    );
    let warning = campbell.reduction.stiffening.verdict.warning().map(str::to_owned);
    [words].into_iter().chain(warning).collect()
}

fn heading(campbell: &Campbell) -> Element {
    heading::heading(CORNER.0, "Campbell diagram", &words(campbell)).0
}

/// Words for the engine orders of the lobes.
pub(super) fn excited_words(campbell: &Campbell) -> String {
    let lobes = campbell.settings.lobes.max(1);
    if drawn_orders(campbell) >= 2 * lobes {
        format!("engine order {lobes}, {}, …", 2 * lobes)
    } else {
        format!("engine order {lobes}")
    }
}

fn legend(campbell: &Campbell, diagram: &Diagram, x: f64) -> Element {
    /// Largest number of nodal diameters that the key names; more are named at the ends of their lines only.
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
    if harmonics > 0 {
        key = key.note("numbers at the lines: nodal diameters");
    }
    let orders = drawn_orders(campbell);
    let lobes = campbell.settings.lobes.max(1);
    if orders >= lobes {
        key = key.row(stroke("#777777".to_owned(), ""), &excited_words(campbell));
    }
    if orders > 0 && lobes > 1 {
        key = key.row(stroke("#cccccc".to_owned(), ""), "other engine orders");
    }
    if driven(campbell, diagram).next().is_some() {
        let words = format!("driven, k ≤ {HIGHEST_ORDER}: (i, j)");
        key = key.row(marks::diamond((16.0, 0.0), "#d62728", "white"), &words);
    }
    if linear(campbell, diagram).next().is_some() {
        let ring = marks::ring((16.0, 0.0), "black");
        key = key.row(ring, "linear criterion (i, j, n)");
    }
    key.draw()
}
