//! Rectangle of a map, and what its vertical axis means.

use super::cells::{Cell, extent, rpm};
use super::diagram::Diagram;
use super::frame::Frame;
use super::marks;
use super::window::Window;
use rubmap_analysis::effects::casing::shape::Shape;
use rubmap_analysis::request::Scene;
use rubmap_analysis::result::{Campbell, InteractionMap, Wave};

/// Share of the loudest amplitude below which amplitudes are shown as quiet.
pub(super) const QUIETEST: f64 = 1e-3;

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

/// Rectangle of a map, and the meaning of its vertical axis.
#[derive(Debug, Clone, Copy)]
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

    /// Point in the units of the axes of an engine order of the rotating frame at a speed, if it is in view; none in the fixed frame.
    pub(super) fn seen(&self, rpm: f64, order: f64) -> Option<(f64, f64)> {
        let place = (rpm, self.height(rpm, order));
        let inside = self.frame == Frame::Rotating && self.diagram.inside(place.0, place.1).is_some();
        inside.then_some(place)
    }

    /// Whether a corner of the diagram lies above the highest engine order, where there are no spectra.
    pub(super) fn reaches_beyond(&self, map: &InteractionMap) -> bool {
        let highest = map.engine_orders.last().copied().unwrap_or(0.0) + 0.5;
        self.order(self.diagram.y.values.1, self.diagram.x.values.0) > highest
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
