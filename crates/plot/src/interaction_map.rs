//! The interaction map: level and spectra over speed, engine-order lines, critical speeds, linear prediction.

use super::axis::{Scale, logarithmic_ticks, ticks};
use super::cells::{Cell, cells, extent, rpm};
use super::diagram::Diagram;
use super::svg::{Element, INK, document, group, line, polyline, rectangle, text, upright};
use super::{colour, heat, level, marks, settling_strip};
use rubmap_analysis::result::{
    Campbell, CriticalSpeed, CriticalSpeeds, InteractionMap, StiffeningVerdict, Verdict,
};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 985.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 946.0;
const LEVEL_TOP: f64 = 212.0;
const LEVEL_HEIGHT: f64 = 130.0;
const STRIP_TOP: f64 = 352.0;
const STRIP_HEIGHT: f64 = 9.0;
const MAP_TOP: f64 = 365.0;
const MAP_HEIGHT: f64 = 490.0;

/// Amplitudes below this share of the loudest are shown as quiet.
const QUIETEST: f64 = 1e-3;

/// Colour of what the numbers are not worth.
const WARNING: &str = "#b01f20";

/// Colour of natural frequencies and what lies on them.
const NATURAL: &str = "#7fd6ff";

/// What the map has upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VerticalAxis {
    /// Engine order: engine-order lines are horizontal, natural frequencies fall with speed.
    EngineOrder,
    /// Frequency: engine-order lines f = kΩ/2π rise with speed, natural frequencies hardly do.
    Frequency,
}

/// Draws an interaction map, with its critical speeds and the linear prediction where they are given.
///
/// Colour is the single-sided amplitude on a logarithmic scale of three decades; the mean is left out. Each spectral
/// line is drawn at least five units high, the loudest wins. Speeds without result are hatched.
pub fn interaction_map(
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    axis: VerticalAxis,
) -> String {
    let cells = cells(&map.speeds_rad_s);
    let level = level::diagram(map, &cells, (LEFT, LEVEL_TOP), (PLOT_WIDTH, LEVEL_HEIGHT));
    let view = View { axis, diagram: diagram(map, &cells, campbell, axis) };
    let mut content = vec![hatching(), heading(map)];
    content.push(level::draw(map, &cells, &level));
    content.push(settling_strip::strip(map, &cells, &level, STRIP_TOP, STRIP_HEIGHT));
    content.push(view.diagram.background("url(#missing)"));
    content.extend(view.missing(map, &cells));
    if let Some(loudest) = heat::loudest(map) {
        let bar = view.diagram.right() + 62.0;
        let places = (view.diagram.bottom(), view.diagram.top);
        let amplitudes = Scale::logarithmic((QUIETEST * loudest, loudest), places);
        content.push(heat::image(map, &cells, &view.diagram, &amplitudes, |y, rpm| view.order(y, rpm)));
        content.push(colour_bar(&amplitudes, bar, &map.units.length));
    }
    content.push(view.engine_orders(map));
    content.extend(campbell.map(|campbell| view.natural_frequencies(campbell)));
    if let Some(critical) = critical {
        content.push(view.crossings(critical));
        content.extend(critical_speeds(critical, &level));
    }
    content.push(level.frame());
    content.push(view.diagram.frame());
    content.extend(view.axes());
    content.push(key(map, critical, campbell));
    document(&title(map), WIDTH, HEIGHT, content)
}

fn diagram(map: &InteractionMap, cells: &[Cell], campbell: Option<&Campbell>, axis: VerticalAxis) -> Diagram {
    let highest_order = map.engine_orders.last().copied().filter(|order| *order > 0.0).unwrap_or(1.0);
    let speeds = extent(cells);
    let top = match axis {
        VerticalAxis::EngineOrder => highest_order + 0.5,
        VerticalAxis::Frequency => {
            // Full spectra at all speeds, and room above the natural frequencies.
            let branches = campbell.map(Campbell::branches).unwrap_or_default();
            let natural = branches.into_iter().flat_map(|(_, table)| table.iter().flatten().flatten());
            let wanted = natural.fold(highest_order * speeds.0 / 60.0, |top, hz| top.max(1.6 * hz));
            wanted.min(highest_order * speeds.1 / 60.0)
        }
    };
    Diagram::new((LEFT, MAP_TOP), (PLOT_WIDTH, MAP_HEIGHT), speeds, (0.0, top))
}

/// The map's rectangle and what its vertical axis means.
struct View {
    axis: VerticalAxis,
    diagram: Diagram,
}

impl View {
    /// Engine order at a height of the axis.
    fn order(&self, y: f64, rpm: f64) -> f64 {
        match self.axis {
            VerticalAxis::EngineOrder => y,
            VerticalAxis::Frequency if rpm > 0.0 => y * 60.0 / rpm,
            VerticalAxis::Frequency => 0.0,
        }
    }

    /// Place of an engine order at a speed, if it is in the drawing.
    fn place(&self, rpm: f64, order: f64) -> Option<(f64, f64)> {
        let y = match self.axis {
            VerticalAxis::EngineOrder => order,
            VerticalAxis::Frequency => order * rpm / 60.0,
        };
        self.diagram.inside(rpm, y)
    }

    /// Transparent areas over the hatching of speeds without result, to say which they are.
    fn missing<'a>(
        &'a self,
        map: &'a InteractionMap,
        cells: &'a [Cell],
    ) -> impl Iterator<Item = Element> + 'a {
        let without = |cell: &&Cell| map.amplitude.get(cell.index).is_none_or(Option::is_none);
        cells.iter().filter(without).map(|cell| {
            let (from, to) = (self.diagram.x.place(cell.from), self.diagram.x.place(cell.to));
            let point = map.points.iter().find(|point| point.index as usize == cell.index);
            let reason = point.and_then(|point| point.message.as_deref()).unwrap_or("no result");
            rectangle(from, MAP_TOP, to - from, MAP_HEIGHT)
                .set("class", "missing")
                .set("fill", "white")
                .set("fill-opacity", "0")
                .title(&format!("{:.0} rpm: {reason}", cell.rpm))
        })
    }

    /// Lines of whole engine orders, labelled at the right; multiples of the lobe count stand out.
    fn engine_orders(&self, map: &InteractionMap) -> Element {
        let lobes = map.settings.scene.casing.as_ref().and_then(|casing| casing.lobes.as_ref());
        let lobes = lobes.map_or(1, |lobes| lobes.count.max(1));
        let highest = map.engine_orders.last().map_or(0, |order| order.floor() as u32);
        let rows = highest.div_ceil(30).max(1);
        let (slow, fast) = self.diagram.x.values;
        let mut lines = group();
        for order in (1..=highest).filter(|order| order.is_multiple_of(rows) || order.is_multiple_of(lobes)) {
            let k = f64::from(order);
            let ends = match self.axis {
                VerticalAxis::EngineOrder => ((slow, k), (fast, k)),
                VerticalAxis::Frequency => ((slow, k * slow / 60.0), (fast, k * fast / 60.0)),
            };
            let Some([from, to]) = self.diagram.clipped(ends.0, ends.1) else { continue };
            let excited = order.is_multiple_of(lobes);
            let end = self.diagram.point(to.0, to.1);
            lines = lines.child(
                line(self.diagram.point(from.0, from.1), end)
                    .set("stroke", "white")
                    .set("stroke-opacity", if excited { "0.30" } else { "0.14" })
                    .set("stroke-width", "0.8")
                    .set("stroke-dasharray", if excited { "" } else { "2 3" }),
            );
            if excited || 14 * highest < MAP_HEIGHT as u32 {
                let leaves_above = end.0 < self.diagram.right() - 0.5;
                let (x, y, anchor) = if leaves_above {
                    (end.0 - 8.0, end.1 + 15.0, "end")
                } else {
                    (end.0 + 6.0, end.1 + 4.0, "start")
                };
                let label = text(x, y, anchor, &order.to_string())
                    .set("font-size", "11")
                    .set("font-weight", if excited { "bold" } else { "normal" });
                let colours = if leaves_above { ["white", "#aaaaaa"] } else { [INK, "#888888"] };
                lines = lines.child(label.set("fill", colours[usize::from(!excited)]));
            }
        }
        let title = upright(
            self.diagram.right() + 40.0,
            MAP_TOP + 0.5 * MAP_HEIGHT,
            "middle",
            "engine order k, f = kΩ/2π",
        );
        lines.child(title)
    }

    /// Natural frequencies in the rotating frame.
    fn natural_frequencies(&self, campbell: &Campbell) -> Element {
        let harmonics = campbell.frequencies_hz.first().map_or(0, Vec::len);
        let mut curves =
            group().set("stroke", NATURAL).set("stroke-opacity", "0.55").set("stroke-width", "0.9");
        for (wave, table) in campbell.branches() {
            let families = |i: usize| (0..campbell.frequencies_hz[0][i].len()).map(move |j| (i, j));
            for (nodal_diameter, family) in (0..harmonics).flat_map(families) {
                let points = campbell.speeds_rad_s.iter().zip(table);
                let curve = polyline(points.map(|(speed, frequencies)| {
                    let hz = frequencies.get(nodal_diameter)?.get(family)?;
                    let rpm = rpm(*speed);
                    (rpm > 0.0).then_some(())?;
                    self.place(rpm, hz * 60.0 / rpm)
                }));
                let words = marks::mode(nodal_diameter as u32, family as u32 + 1, wave);
                curves = curves.child(curve.title(&words));
            }
        }
        curves
    }

    /// Where the linear criterion and the lobes' engine orders meet natural frequencies.
    fn crossings(&self, critical: &CriticalSpeeds) -> Element {
        let linear = critical.linear_crossings.iter().filter_map(|crossing| {
            let order = f64::from(crossing.nodal_diameter * crossing.superharmonic);
            Some(marks::linear(self.place(rpm(crossing.speed_rad_s), order)?, "white", crossing))
        });
        let driven = critical.driven_crossings.iter().filter_map(|crossing| {
            let place = self.place(rpm(crossing.speed_rad_s), f64::from(crossing.engine_order))?;
            Some(marks::driven(place, NATURAL, "black", crossing))
        });
        group().children(linear).children(driven)
    }

    fn axes(&self) -> [Element; 2] {
        let x = self.diagram.x_axis(&ticks(self.diagram.x.values, 9.0), "rotational speed Ω, rpm");
        let y = match self.axis {
            VerticalAxis::EngineOrder => {
                self.diagram.y_axis(&ticks(self.diagram.y.values, 12.0), "engine order k", 58.0)
            }
            VerticalAxis::Frequency => self.diagram.y_axis(
                &ticks(self.diagram.y.values, 10.0),
                "frequency (rotating frame), Hz",
                64.0,
            ),
        };
        [x, y]
    }
}

fn critical_speeds(critical: &CriticalSpeeds, level: &Diagram) -> Vec<Element> {
    let mut shown: Vec<(f64, &CriticalSpeed)> =
        critical.critical_speeds.iter().map(|speed| (level.x.place(rpm(speed.speed_rad_s)), speed)).collect();
    shown.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks::critical(&shown, level.right(), LEVEL_TOP, MAP_TOP + MAP_HEIGHT)
}

fn colour_bar(amplitudes: &Scale, left: f64, unit: &str) -> Element {
    const WIDTH: f64 = 16.0;
    const STOPS: u32 = 32;
    let stops = (0..=STOPS).map(|i| {
        let share = f64::from(i) / f64::from(STOPS);
        let colour = colour::hex(colour::amplitude(share));
        Element::new("stop").number("offset", share).set("stop-color", colour)
    });
    let gradient = Element::new("linearGradient")
        .set("id", "amplitude")
        .set("x1", "0")
        .set("x2", "0")
        .set("y1", "1")
        .set("y2", "0")
        .children(stops);
    let marks = logarithmic_ticks(amplitudes.values).into_iter().flat_map(|(value, label)| {
        let y = amplitudes.place(value);
        let tick = line((left + WIDTH, y), (left + WIDTH + 4.0, y)).set("stroke", INK);
        [tick, text(left + WIDTH + 7.0, y + 4.0, "start", &label).set("font-size", "11")]
    });
    let title = upright(left + 66.0, MAP_TOP + 0.5 * MAP_HEIGHT, "middle", &format!("amplitude, {unit}"));
    group()
        .child(Element::new("defs").child(gradient))
        .child(rectangle(left, MAP_TOP, WIDTH, MAP_HEIGHT).set("fill", "url(#amplitude)").set("stroke", INK))
        .children(marks)
        .child(title.set("font-size", "14"))
}

/// The fill of speeds without result.
fn hatching() -> Element {
    let pattern = Element::new("pattern")
        .set("id", "missing")
        .set("width", "8")
        .set("height", "8")
        .set("patternUnits", "userSpaceOnUse")
        .set("patternTransform", "rotate(45)")
        .child(rectangle(0.0, 0.0, 8.0, 8.0).set("fill", "#e9e9e9"))
        .child(rectangle(0.0, 0.0, 3.0, 8.0).set("fill", "#b5b5b5"));
    Element::new("defs").child(pattern)
}

fn title(map: &InteractionMap) -> String {
    let nodal_diameter = map.nodal_diameter.map(|i| format!(", nodal diameter {i} only")).unwrap_or_default();
    format!("Interaction map: {}{nodal_diameter}", map.sensor)
}

fn heading(map: &InteractionMap) -> Element {
    let settings = &map.settings;
    let computed = map.amplitude.iter().flatten().count();
    let mut words = vec![format!("{computed} of {} speeds", map.speeds_rad_s.len())];
    let integration = &settings.integration;
    words.push(format!(
        "{} revolutions, the last {} shown",
        integration.revolutions, integration.window_revolutions
    ));
    if let Some(damping) = &settings.scene.damping {
        words.push(format!("modal damping {} %", 100.0 * damping.modal_ratio));
    }
    if let Some(lobes) = settings.scene.casing.as_ref().and_then(|casing| casing.lobes.as_ref()) {
        words.push(format!("{} lobes of {} {}", lobes.count, lobes.amplitude, map.units.length));
    }
    if settings.scene.contact.is_none() {
        words.push("no contact".to_owned());
    }
    let warning = map.stiffening.and_then(StiffeningVerdict::warning);
    let model: String = settings.model.chars().take(12).collect();
    let origin = format!("model {model} · rubmap {}", map.version);
    group()
        .child(text(LEFT, 30.0, "start", &title(map)).set("font-size", "18").set("font-weight", "bold"))
        .child(text(LEFT, 51.0, "start", &words.join(" · ")).set("fill", "#555555"))
        .children(warning.map(|words| text(LEFT, 68.0, "start", words).set("fill", WARNING)))
        .child(
            text(WIDTH - 16.0, HEIGHT - 10.0, "end", &origin).set("fill", "#999999").set("font-size", "10"),
        )
}

/// What the marks mean, below the map.
fn key(map: &InteractionMap, critical: Option<&CriticalSpeeds>, campbell: Option<&Campbell>) -> Element {
    let (first, second) = (HEIGHT - 56.0, HEIGHT - 31.0);
    let dark = || rectangle(-8.0, -8.0, 16.0, 16.0).set("fill", "black");
    let mut entries = Vec::new();
    if let Some(critical) = critical {
        let dashes = line((-8.0, 0.0), (8.0, 0.0)).set("stroke", "#d62728").set("stroke-dasharray", "6 3");
        let unsettled = critical.critical_speeds.iter().any(|speed| speed.settling == Verdict::NotSettled);
        let words = if unsettled { "critical speed (* not settled)" } else { "critical speed" };
        entries.push((dashes.set("stroke-width", "1.5"), words));
        if critical.critical_speeds.iter().any(|speed| !speed.resolved) {
            let dots = line((-8.0, 0.0), (8.0, 0.0)).set("stroke", "#d62728").set("stroke-width", "1.5");
            entries.push((dots.set("stroke-dasharray", marks::UNRESOLVED), "peak not resolved"));
        }
        entries.push((
            group().child(marks::diamond((0.0, 0.0), NATURAL, "black")),
            "crossing that the lobes drive",
        ));
        let ring = Element::new("circle").number("r", 4.5).set("fill", "none").set("stroke", "white");
        let ring = group().child(dark()).child(ring.set("stroke-width", "1.5"));
        entries.push((ring, "linear criterion (i, j, n) at k = i·n"));
    }
    if campbell.is_some() {
        let curve = line((-8.0, -4.0), (8.0, 4.0)).set("stroke", NATURAL);
        entries.push((group().child(dark()).child(curve), "natural frequencies"));
    }
    let mut key = group().child(settling_strip::legend(map, LEFT, second));
    let mut x = LEFT + 8.0;
    for (mark, words) in entries {
        key = key.child(mark.set("transform", format!("translate({x:.1} {:.1})", first - 4.5))).child(text(
            x + 15.0,
            first,
            "start",
            words,
        ));
        x += 50.0 + 6.7 * words.chars().count() as f64;
    }
    key
}
