//! Rectangle of a map: amplitudes, and the lines and marks that lie over them.

use super::axis::Scale;
use super::cells::{Cell, extent, rpm};
use super::colour::on_dark;
use super::diagram::Diagram;
use super::frame::Frame;
use super::key::Flow;
use super::labels::Labels;
use super::svg::{Element, group, line, polyline, rectangle, text};
use super::window::Window;
use super::{hatching, heat, marks};
use rubmap_analysis::effects::casing::shape::Shape;
use rubmap_analysis::request::Scene;
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap, Wave};

/// Share of the loudest amplitude below which amplitudes are shown as quiet.
pub(super) const QUIETEST: f64 = 1e-3;

/// Fill of the crossings that the lobes drive.
pub(super) const DRIVEN: &str = "#ff9d5c";

/// Quantity on the vertical axis of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VerticalAxis {
    /// Engine order: engine-order lines are horizontal, natural frequencies fall with speed.
    EngineOrder,
    /// Frequency: engine-order lines f = kΩ/2π rise with speed, natural frequencies hardly do.
    Frequency,
}

/// Line of an engine order, from the slowest to the fastest speed at which it is visible: points in the units of the axes.
pub(super) struct OrderLine {
    pub(super) order: u32,
    /// Whether the lobes excite the engine order.
    pub(super) excited: bool,
    pub(super) ends: [(f64, f64); 2],
}

/// Natural frequency of a mode over speed, as it lies in a map.
pub(super) struct Natural {
    pub(super) nodal_diameter: usize,
    /// Index of the family, from 0.
    pub(super) family: usize,
    pub(super) wave: Option<Wave>,
    /// Points at each speed, in the units of the axes.
    pub(super) places: Vec<Option<(f64, f64)>>,
}

impl Natural {
    /// Words for the mode.
    pub(super) fn words(&self) -> String {
        marks::mode(self.nodal_diameter as u32, self.family as u32 + 1, self.wave)
    }
}

/// Engine order, and the position where its line leaves the diagram.
pub(super) type End = (u32, (f64, f64));

/// Rectangle of a map, and the meaning of its vertical axis.
#[derive(Debug)]
pub(super) struct View {
    pub(super) axis: VerticalAxis,
    /// Frame in which the engine orders and frequencies of the vertical axis are measured.
    pub(super) frame: Frame,
    pub(super) diagram: Diagram,
}

impl View {
    /// Lays out the part of a map that lies in the window, within a rectangle of the drawing.
    pub(super) fn new(
        map: &InteractionMap,
        cells: &[Cell],
        campbell: Option<&Campbell>,
        (axis, frame): (VerticalAxis, Frame),
        window: &Window,
        (corner, size): ((f64, f64), (f64, f64)),
    ) -> Self {
        let highest_order = map.engine_orders.last().copied().filter(|order| *order > 0.0).unwrap_or(1.0);
        let speeds = window.speeds(extent(cells));
        let orders = window.orders((0.0, highest_order + 0.5));
        let upwards = match axis {
            VerticalAxis::EngineOrder => orders,
            VerticalAxis::Frequency if window.engine_orders.is_some() => {
                (orders.0 * speeds.0 / 60.0, orders.1 * speeds.1 / 60.0)
            }
            VerticalAxis::Frequency => {
                // The axis holds full spectra at all speeds, and room above the natural frequencies.
                let branches = campbell.map(Campbell::branches).unwrap_or_default();
                let natural = branches.into_iter().flat_map(|(_, table)| table.iter().flatten().flatten());
                let wanted = natural.fold(highest_order * speeds.0 / 60.0, |top, hz| top.max(1.6 * hz));
                (0.0, wanted.min(highest_order * speeds.1 / 60.0))
            }
        };
        let upwards = if upwards.0 < upwards.1 { upwards } else { (0.0, 1.0) };
        Self { axis, frame, diagram: Diagram::new(corner, size, speeds, upwards) }
    }

    /// Title of the vertical axis.
    pub(super) fn axis_words(&self) -> &'static str {
        match (self.axis, self.frame) {
            (VerticalAxis::EngineOrder, Frame::Rotating) => "engine order k",
            (VerticalAxis::EngineOrder, Frame::Fixed) => {
                "multiple of the rotational frequency in the fixed frame"
            }
            (VerticalAxis::Frequency, Frame::Rotating) => "frequency (rotating frame), Hz",
            (VerticalAxis::Frequency, Frame::Fixed) => "frequency (fixed frame), Hz",
        }
    }

    /// Engine order at a height of the axis.
    pub(super) fn order(&self, y: f64, rpm: f64) -> f64 {
        match self.axis {
            VerticalAxis::EngineOrder => y,
            VerticalAxis::Frequency if rpm > 0.0 => y * 60.0 / rpm,
            VerticalAxis::Frequency => 0.0,
        }
    }

    /// Height of an engine order at a speed.
    pub(super) fn height(&self, rpm: f64, order: f64) -> f64 {
        match self.axis {
            VerticalAxis::EngineOrder => order,
            VerticalAxis::Frequency => order * rpm / 60.0,
        }
    }

    /// Position in the drawing of an engine order of the rotating frame at a speed, if it is in view; none in the fixed frame, which shows
    /// it at two other orders.
    fn place(&self, rpm: f64, order: f64) -> Option<(f64, f64)> {
        self.seen(rpm, order).and_then(|(rpm, height)| self.diagram.inside(rpm, height))
    }

    /// Point in the units of the axes of an engine order of the rotating frame at a speed, if it is in view; none in the fixed frame.
    pub(super) fn seen(&self, rpm: f64, order: f64) -> Option<(f64, f64)> {
        let place = (rpm, self.height(rpm, order));
        let inside = self.frame == Frame::Rotating && self.diagram.inside(place.0, place.1).is_some();
        inside.then_some(place)
    }

    /// Draws the amplitudes over hatching, with transparent areas that name the speeds without a result.
    pub(super) fn amplitudes(&self, map: &InteractionMap, cells: &[Cell], loudest: Option<f64>) -> Element {
        let without = |cell: &&Cell| is_missing(map, cell);
        let missing = cells.iter().filter(without).filter_map(|cell| {
            let (low, high) = self.diagram.x.values;
            let (from, to) = (cell.from.max(low), cell.to.min(high));
            let (left, right) = (self.diagram.x.place(from), self.diagram.x.place(to));
            let area = rectangle(left, self.diagram.top, right - left, self.diagram.height);
            let area = area.set("class", "missing").set("fill", "white").set("fill-opacity", "0");
            (from < to).then(|| area.title(&missing_words(map, cell)))
        });
        // A map without motion is as quiet as the colours go.
        let amplitudes = self.scale(loudest.unwrap_or(1.0));
        let image = heat::image(map, cells, &self.diagram, &amplitudes, |y, rpm| self.order(y, rpm));
        group().child(self.diagram.background(hatching::FILL)).children(missing).child(image)
    }

    /// Whether a corner of the diagram lies above the highest engine order, where there are no spectra.
    pub(super) fn reaches_beyond(&self, map: &InteractionMap) -> bool {
        let highest = map.engine_orders.last().copied().unwrap_or(0.0) + 0.5;
        self.order(self.diagram.y.values.1, self.diagram.x.values.0) > highest
    }

    /// Colour scale, as high as the diagram.
    pub(super) fn scale(&self, loudest: f64) -> Scale {
        Scale::logarithmic((QUIETEST * loudest, loudest), (self.diagram.bottom(), self.diagram.top))
    }

    /// Lines of whole engine orders; of many only some, but all that the lobes excite. None in the fixed frame.
    pub(super) fn order_lines(&self, map: &InteractionMap) -> Vec<OrderLine> {
        if self.frame == Frame::Fixed {
            return Vec::new();
        }
        let lobes = lobes(map);
        let highest = map.engine_orders.last().map_or(0, |order| order.floor() as u32);
        let span = match self.axis {
            VerticalAxis::EngineOrder => (self.diagram.y.values.1 - self.diagram.y.values.0).ceil() as u32,
            VerticalAxis::Frequency => highest,
        };
        let rows = span.div_ceil(30).max(1);
        let (slow, fast) = self.diagram.x.values;
        let shown = (1..=highest).filter(|order| order.is_multiple_of(rows) || order.is_multiple_of(lobes));
        let line = |order: u32| {
            let k = f64::from(order);
            let ends = self.diagram.clipped((slow, self.height(slow, k)), (fast, self.height(fast, k)))?;
            Some(OrderLine { order, excited: order.is_multiple_of(lobes), ends })
        };
        shown.filter_map(line).collect()
    }

    /// Draws the lines of engine orders, dotted, or solid for multiples of the lobe count, and returns where each leaves the diagram.
    pub(super) fn engine_orders(&self, map: &InteractionMap) -> (Element, Vec<End>) {
        let (mut lines, mut ends) = (group(), Vec::new());
        for OrderLine { order, excited, ends: places } in self.order_lines(map) {
            let [from, to] = places.map(|(x, y)| self.diagram.point(x, y));
            lines = lines.child(order_line(from, to, excited).set("class", "engine-order"));
            ends.push((order, to));
        }
        (lines, ends)
    }

    /// Adds the lines of engine orders to a key.
    pub(super) fn explained(mut flow: Flow, map: &InteractionMap, ends: &[End]) -> Flow {
        let lobes = lobes(map);
        let stroke = |excited: bool| {
            let dark = rectangle(0.0, -8.0, 30.0, 16.0).set("fill", "#101010");
            group().child(dark).child(order_line((3.0, 0.0), (27.0, 0.0), excited))
        };
        if lobes > 1 && ends.iter().any(|(order, _)| order.is_multiple_of(lobes)) {
            flow = flow.entry(stroke(true), 30.0, "multiples of the lobe count");
        }
        let words = if lobes > 1 { "other engine orders" } else { "engine orders" };
        if ends.iter().any(|(order, _)| lobes == 1 || !order.is_multiple_of(lobes)) {
            flow = flow.entry(stroke(lobes == 1), 30.0, words);
        }
        flow
    }

    /// Natural frequencies in the rotating frame.
    pub(super) fn natural(&self, campbell: &Campbell) -> Vec<Natural> {
        let harmonics = campbell.frequencies_hz.first().map_or(0, Vec::len);
        let mut found = Vec::new();
        for (wave, table) in campbell.branches() {
            let families = |i: usize| (0..campbell.frequencies_hz[0][i].len()).map(move |j| (i, j));
            for (nodal_diameter, family) in (0..harmonics).flat_map(families) {
                let place = |(speed, frequencies): (&f64, &Vec<Vec<f64>>)| {
                    let hz = frequencies.get(nodal_diameter)?.get(family)?;
                    let rpm = rpm(*speed);
                    (rpm > 0.0).then(|| (rpm, self.height(rpm, hz * 60.0 / rpm)))
                };
                let places = campbell.speeds_rad_s.iter().zip(table).map(place).collect();
                found.push(Natural { nodal_diameter, family, wave, places });
            }
        }
        found
    }

    /// Draws the natural frequencies, a colour and a number for each nodal diameter.
    pub(super) fn natural_frequencies(&self, campbell: &Campbell, labels: &mut Labels) -> Element {
        let harmonics = campbell.frequencies_hz.first().map_or(0, Vec::len);
        let (mut curves, mut words) = (group().set("class", "natural"), group());
        for natural in self.natural(campbell) {
            let places = natural.places.iter().map(|place| place.map(|(x, y)| self.diagram.point(x, y)));
            let places: Vec<_> = places.collect();
            let colour = on_dark(natural.nodal_diameter, harmonics);
            let inside = |place: &&(f64, f64)| self.diagram.encloses(**place);
            let seen: Vec<(f64, f64)> = places.iter().flatten().filter(inside).copied().collect();
            let stretches = [0.97, 0.85, 0.7, 0.5, 0.3, 0.1, 0.03];
            let tried = stretches.map(|share| seen.get((share * seen.len() as f64) as usize).copied());
            let number = natural.nodal_diameter.to_string();
            let number = labels.at_first(tried.into_iter().flatten(), &number, 11.0);
            words =
                words
                    .children(number.map(|label| {
                        label.set("fill", &colour).set("font-weight", "bold").rimmed("#101010")
                    }));
            curves = curves.child(
                polyline(places)
                    .set("stroke", colour)
                    .set("stroke-opacity", "0.85")
                    .set("stroke-width", "1")
                    .title(&natural.words()),
            );
        }
        let region = format!("view-{:.0}-{:.0}", self.diagram.left, self.diagram.top);
        let clipped = curves.set("clip-path", format!("url(#{region})"));
        group().child(self.diagram.region(&region)).child(clipped).child(words)
    }

    /// Draws the crossings of natural frequencies with the linear criterion and with the lobes' engine orders, with (i, j, n) and (i, j)
    /// where there is room.
    pub(super) fn crossings(&self, critical: &CriticalSpeeds, labels: &mut Labels) -> Element {
        let mut found = Vec::new();
        for crossing in &critical.linear_crossings {
            let order = f64::from(crossing.nodal_diameter * crossing.superharmonic);
            let Some(place) = self.place(rpm(crossing.speed_rad_s), order) else { continue };
            found.push((place, marks::linear(place, "white", crossing), marks::triple(crossing)));
        }
        for crossing in &critical.driven_crossings {
            let k = f64::from(crossing.engine_order);
            let Some(place) = self.place(rpm(crossing.speed_rad_s), k) else { continue };
            found.push((place, marks::driven(place, DRIVEN, "black", crossing), marks::pair(crossing)));
        }
        for (place, ..) in &found {
            labels.keep_off(*place, 4.0);
        }
        let mut drawn = group();
        for (place, mark, words) in found {
            let label = labels.beside(place, 5.0, &words, 10.5);
            drawn =
                drawn.child(mark).children(label.map(|label| label.set("fill", "white").rimmed("#101010")));
        }
        drawn
    }

    /// Whether [`crossings`](Self::crossings) has marks of the linear criterion, and whether it has marks of driven crossings.
    pub(super) fn has_crossings(&self, critical: &CriticalSpeeds) -> (bool, bool) {
        let linear = critical.linear_crossings.iter().any(|crossing| {
            let order = f64::from(crossing.nodal_diameter * crossing.superharmonic);
            self.place(rpm(crossing.speed_rad_s), order).is_some()
        });
        let driven = critical.driven_crossings.iter().any(|crossing| {
            self.place(rpm(crossing.speed_rad_s), f64::from(crossing.engine_order)).is_some()
        });
        (linear, driven)
    }

    /// Labels of engine orders that leave through the top, inside the diagram.
    pub(super) fn label_inside(end: (f64, f64), order: u32, excited: bool) -> Element {
        text(end.0 - 8.0, end.1 + 15.0, "end", &order.to_string())
            .set("font-size", "11")
            .set("font-weight", if excited { "bold" } else { "normal" })
            .set("fill", if excited { "white" } else { "#cccccc" })
            .rimmed("#101010")
    }
}

/// Draws the straight line of an engine order: solid if the lobes excite it, otherwise dotted.
fn order_line(from: (f64, f64), to: (f64, f64), excited: bool) -> Element {
    order_stroke(line(from, to), excited)
}

/// Draws a line of any shape in the style of an engine order.
pub(super) fn order_stroke(course: Element, excited: bool) -> Element {
    course
        .set("stroke", "white")
        .set("stroke-opacity", if excited { "0.45" } else { "0.6" })
        .set("stroke-width", if excited { "0.9" } else { "1" })
        .set("stroke-dasharray", if excited { "" } else { "1.5 5" })
}

/// Whether a speed has no amplitudes.
pub(super) fn is_missing(map: &InteractionMap, cell: &Cell) -> bool {
    map.amplitude.get(cell.index).is_none_or(Option::is_none)
}

/// Reason why a speed has no amplitudes, in words.
pub(super) fn missing_words(map: &InteractionMap, cell: &Cell) -> String {
    let point = map.points.iter().find(|point| point.index as usize == cell.index);
    let reason = point.and_then(|point| point.message.as_deref()).unwrap_or("no result");
    format!("{:.0} rpm: {reason}", cell.rpm)
}

/// Number of times that the casing of a map repeats over the circumference.
pub(super) fn lobes(map: &InteractionMap) -> u32 {
    lobes_of(&map.settings.scene)
}

/// Number of times that the casing of a scene repeats over the circumference, its lobes if they are equal; at least 1.
pub(super) fn lobes_of(scene: &Scene) -> u32 {
    scene.casing.as_ref().and_then(|casing| Shape::of(casing).repeats()).unwrap_or(1)
}
