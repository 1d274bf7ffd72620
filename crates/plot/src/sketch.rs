//! Description of a drawing, which two pens read: one writes SVG, the other a figure for Plotly.
//!
//! A sketch is made of panels, each with two axes and layers over each other. Values are in the units of the axes; lengths in units of the
//! drawing are for SVG alone. Layers enter the key of the drawing as they are added, and the legend of the figure under their names.

use serde::Serialize;
use serde_json::{Map, Value, json};

use super::axis::{Scale, decades, eighths, ticks};
use super::colour;
use super::diagram::Diagram;
use super::heading;
use super::key::MARK_WIDTH;
use super::layer::{Course, Curve, Layer, Marks};
use super::svg::Element;
use super::trace;

/// Description of a drawing.
#[derive(Debug)]
pub(super) struct Sketch<'a> {
    /// Kind of the figure, for programs.
    pub(super) kind: &'static str,
    pub(super) title: String,
    /// Paragraphs below the title.
    pub(super) paragraphs: Vec<String>,
    /// Warning below the paragraphs.
    pub(super) warning: Option<String>,
    /// Paragraphs that only the figure needs.
    pub(super) more: Vec<String>,
    /// Values for programs that show the figure.
    pub(super) meta: Map<String, Value>,
    /// Left edge of the heading in the drawing.
    pub(super) left: f64,
    /// Width of the drawing.
    pub(super) width: f64,
    /// Height of the figure, pixels.
    pub(super) high: usize,
    /// Panels, the first with the axes `x` and `y` of the figure.
    pub(super) panels: Vec<Panel<'a>>,
    /// Line below the keys of the drawing, drawn about y = 0.
    pub(super) foot: Option<Element>,
    /// Least height of the drawing.
    pub(super) least: f64,
    /// Note in the lower left corner of the drawing; a paragraph of the figure.
    pub(super) footnote: Option<String>,
    /// Message over the middle of the figure, whose axes have something to show all the same.
    pub(super) note: Option<String>,
    /// Message where there is nothing to draw.
    pub(super) nothing: Option<String>,
}

impl<'a> Sketch<'a> {
    /// Begins a sketch of this kind.
    pub(super) fn new(kind: &'static str, title: impl Into<String>, paragraphs: Vec<String>) -> Self {
        Self {
            kind,
            title: title.into(),
            paragraphs: paragraphs.into_iter().filter(|words| !words.is_empty()).collect(),
            warning: None,
            more: Vec::new(),
            meta: Map::new(),
            left: 92.0,
            width: 1180.0,
            high: 560,
            panels: Vec::new(),
            foot: None,
            least: 0.0,
            footnote: None,
            note: None,
            nothing: None,
        }
    }

    /// Sets the height of the figure, in pixels.
    pub(super) fn high(self, high: usize) -> Self {
        Self { high, ..self }
    }

    /// Sets a value for programs that show the figure.
    pub(super) fn meta(mut self, name: &str, value: impl Serialize) -> Self {
        self.meta.insert(name.to_owned(), json!(value));
        self
    }

    /// Height in the drawing at which the heading ends.
    pub(super) fn top(&self) -> f64 {
        heading::bottom(&self.paragraphs, self.warning.as_ref())
    }

    /// Adds a panel.
    pub(super) fn with(mut self, panel: Panel<'a>) -> Self {
        self.panels.push(panel);
        self
    }

    /// States that there is nothing to draw.
    pub(super) fn nothing(self, words: impl Into<String>) -> Self {
        Self { nothing: Some(words.into()), ..self }
    }
}

/// Range that an axis of the figure shows at first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Zoom {
    /// Range of the drawing.
    Same,
    /// Range of the values.
    Free,
    /// Range of the values, at the scale of the horizontal axis.
    OneScale,
    /// Range from zero to the largest value.
    FromZero,
}

/// Kind of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Linear,
    Logarithmic,
    /// Linear axis of rotational speeds.
    Speeds,
    /// Whole turn in degrees.
    Turn,
    /// Linear axis whose ticks are names.
    Names,
}

/// Axis of a panel.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) title: String,
    pub(super) range: (f64, f64),
    pub(super) kind: Kind,
    pub(super) zoom: Zoom,
    /// Ticks with their labels.
    pub(super) ticks: Vec<(f64, String)>,
    /// Title in the figure, where that differs.
    pub(super) short: Option<String>,
    /// Distance of the title of a vertical axis from the frame in the drawing.
    pub(super) away: f64,
}

/// Distance of the title of a vertical axis from the frame, unless it is set.
const AWAY: f64 = 68.0;

impl Axis {
    fn new(title: impl Into<String>, range: (f64, f64), kind: Kind, ticks: Vec<(f64, String)>) -> Self {
        Self { title: title.into(), range, kind, zoom: Zoom::Same, ticks, short: None, away: AWAY }
    }

    /// Linear axis with about `wanted` ticks.
    pub(super) fn linear(title: impl Into<String>, range: (f64, f64), wanted: f64) -> Self {
        Self::new(title, range, Kind::Linear, ticks(range, wanted))
    }

    /// Logarithmic axis of positive values with at most `most` ticks, or one for each power of ten.
    pub(super) fn logarithmic(title: impl Into<String>, range: (f64, f64), most: usize) -> Self {
        Self::new(title, range, Kind::Logarithmic, decades(range, most))
    }

    /// Axis of rotational speeds.
    pub(super) fn speeds(range: (f64, f64), wanted: f64) -> Self {
        Self { kind: Kind::Speeds, ..Self::linear("rotational speed Ω, rpm", range, wanted) }
    }

    /// Axis of a whole turn, in degrees.
    pub(super) fn turn(title: impl Into<String>) -> Self {
        Self::new(title, (0.0, 360.0), Kind::Turn, eighths())
    }

    /// Axis with a name at every tick.
    pub(super) fn names(title: impl Into<String>, range: (f64, f64), ticks: Vec<(f64, String)>) -> Self {
        Self::new(title, range, Kind::Names, ticks)
    }

    /// Lets the figure show the range of its values, with one scale for both axes of the panel.
    pub(super) fn one_scale(self) -> Self {
        Self { zoom: Zoom::OneScale, ..self }
    }

    /// Lets the figure show its values from zero on.
    pub(super) fn with_zero(self) -> Self {
        Self { zoom: Zoom::FromZero, ..self }
    }

    /// Sets the ticks in the drawing.
    pub(super) fn ticks(self, ticks: Vec<(f64, String)>) -> Self {
        Self { ticks, ..self }
    }

    /// Sets the title in the figure.
    pub(super) fn short(self, title: &str) -> Self {
        Self { short: Some(title.to_owned()), ..self }
    }

    /// Sets the distance of the title of a vertical axis from the frame in the drawing.
    pub(super) fn away(self, away: f64) -> Self {
        Self { away, ..self }
    }

    /// Lets the figure show the range of its values.
    pub(super) fn free(self) -> Self {
        Self { zoom: Zoom::Free, ..self }
    }

    fn scale(&self, places: (f64, f64)) -> Scale {
        let scale = if self.kind == Kind::Logarithmic { Scale::logarithmic } else { Scale::linear };
        scale(self.range, places)
    }
}

/// Row of a key: a sample with its words, or words alone.
#[derive(Debug)]
pub(super) enum Row {
    /// Sample, drawn about y = 0 from x = 0 to its width, and its words.
    Sample { sample: Element, width: f64, words: String },
    /// Heading over the rows that follow.
    Heading(String),
    /// Note about the rows above.
    Note(String),
}

/// Place of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stand {
    /// Rows beside the panel, at this distance.
    Beside(f64),
    /// Entries side by side below the panel.
    Below,
}

/// Scale of colours with its title.
#[derive(Debug, Clone)]
pub(super) struct Ramp {
    pub(super) title: String,
    pub(super) range: (f64, f64),
    pub(super) is_logarithmic: bool,
    /// Distance of the bar from the frame in the drawing; none where the drawing has no bar.
    pub(super) beside: Option<f64>,
    /// Colour of a share of the range.
    pub(super) colour: fn(f64) -> [u8; 3],
}

/// Rectangle with axes and layers.
#[derive(Debug)]
pub(super) struct Panel<'a> {
    /// Name above the panel.
    pub(super) name: Option<String>,
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// Frame in the drawing.
    pub(super) diagram: Diagram,
    /// Whether the panel has a horizontal axis of its own, which others do not share.
    pub(super) is_apart: bool,
    /// Vertical extent in the figure, as shares of its height.
    pub(super) domain: Option<[f64; 2]>,
    /// Horizontal extent in the figure of one of several panels side by side, whose axes move together and which share a bar of colours.
    pub(super) across: Option<[f64; 2]>,
    /// Layers, later ones over earlier ones.
    pub(super) layers: Vec<Layer<'a>>,
    /// Rows of the key, and where it stands.
    pub(super) key: Vec<Row>,
    pub(super) stand: Stand,
    /// Colours of cells and marks.
    pub(super) ramp: Option<Ramp>,
    /// Labels of heights at the right edge of the figure, with their title; the drawing has its own.
    pub(super) right: (&'static str, Vec<(f64, String)>),
    /// Whether the figure alone has the panel.
    pub(super) is_shown_only: bool,
}

impl<'a> Panel<'a> {
    /// Begins a panel with a frame of this corner and size in the drawing.
    pub(super) fn new((left, top): (f64, f64), (width, height): (f64, f64), x: Axis, y: Axis) -> Self {
        let (across, upwards) = (x.scale((left, left + width)), y.scale((top + height, top)));
        let diagram = Diagram { left, top, width, height, x: across, y: upwards };
        Self {
            name: None,
            x,
            y,
            diagram,
            is_apart: false,
            domain: None,
            across: None,
            layers: Vec::new(),
            key: Vec::new(),
            stand: Stand::Beside(30.0),
            ramp: None,
            right: ("", Vec::new()),
            is_shown_only: false,
        }
    }

    /// Leaves the panel out of the drawing.
    pub(super) fn shown_only(self) -> Self {
        Self { is_shown_only: true, ..self }
    }

    /// Sets the labels of heights at the right edge of the figure.
    pub(super) fn right(self, title: &'static str, labels: Vec<(f64, String)>) -> Self {
        Self { right: (title, labels), ..self }
    }

    /// Gives the panel a horizontal axis of its own.
    pub(super) fn apart(self) -> Self {
        Self { is_apart: true, ..self }
    }

    /// Lets the key stand below the panel.
    pub(super) fn key_below(self) -> Self {
        Self { stand: Stand::Below, ..self }
    }

    /// Sets the colours of cells and marks.
    pub(super) fn ramp(
        self,
        title: impl Into<String>,
        range: (f64, f64),
        colour: fn(f64) -> [u8; 3],
    ) -> Self {
        let ramp = Ramp { title: title.into(), range, is_logarithmic: false, beside: Some(26.0), colour };
        Self { ramp: Some(ramp), ..self }
    }

    /// Sets the colours of amplitudes, and the distance of their bar from the frame in the drawing, if there is one.
    pub(super) fn amplitudes(self, title: impl Into<String>, range: (f64, f64), beside: Option<f64>) -> Self {
        let (title, colour) = (title.into(), colour::amplitude);
        Self { ramp: Some(Ramp { title, range, is_logarithmic: true, beside, colour }), ..self }
    }

    /// Sets the extents in the figure of one of several panels side by side, each with axes of its own.
    pub(super) fn aside(self, across: [f64; 2], upwards: [f64; 2]) -> Self {
        Self { across: Some(across), domain: Some(upwards), is_apart: true, ..self }
    }

    /// Sets the vertical extent in the figure.
    pub(super) fn domain(self, low: f64, high: f64) -> Self {
        Self { domain: Some([low, high]), ..self }
    }

    /// Adds a layer without a row in the key; marks, upright lines and areas only if there are any.
    pub(super) fn push(&mut self, layer: impl Into<Layer<'a>>) {
        let layer = layer.into();
        let is_empty = match &layer {
            Layer::Marks(marks) | Layer::Shown(marks) => marks.marks.is_empty(),
            Layer::Uprights(uprights) => uprights.lines.is_empty(),
            Layer::Areas(areas) => areas.areas.is_empty(),
            Layer::Curve(_) | Layer::Cells(_) | Layer::Heat(_) | Layer::Drawn(_) => false,
        };
        if !is_empty {
            self.layers.push(layer);
        }
    }

    /// Adds marks, and their row in the key under these words; neither if there are none.
    pub(super) fn marks(&mut self, words: &str, marks: Marks) {
        if !marks.marks.is_empty() {
            self.sample(marks.sample(), words);
            self.push(marks);
        }
    }

    /// Adds histories, and their rows in the key under their names, of many only the first and the last; returns whether some are bands.
    pub(super) fn histories(&mut self, histories: Vec<Curve>) -> bool {
        /// Largest number of histories that the key names.
        const MOST: usize = 16;
        let width = |curve: &Curve| {
            let mut ends = curve.strokes.iter().flat_map(|stroke| &stroke.places).flatten();
            let first = ends.next().map_or(0.0, |place| self.diagram.x.place(place.0));
            ends.next_back().map_or(0.0, |place| self.diagram.x.place(place.0) - first)
        };
        let samples = |curve: &Curve| curve.strokes.iter().map(|stroke| stroke.places.len()).sum();
        let has_bands = histories.iter().any(|curve| trace::is_band(samples(curve), width(curve)));
        let count = histories.len();
        for (index, curve) in histories.into_iter().enumerate() {
            if count > 1 && (count <= MOST || index == 0 || index + 1 == count) {
                self.sample(trace::sample(&curve.pen, has_bands, count > 2), &curve.name);
            }
            self.push(curve.course(Course::History));
        }
        has_bands
    }

    /// Adds a row to the key.
    pub(super) fn sample(&mut self, sample: Element, words: &str) {
        self.wide_sample(sample, MARK_WIDTH, words);
    }

    /// Adds a row whose sample has this width to the key, which stands below the panel.
    pub(super) fn wide_sample(&mut self, sample: Element, width: f64, words: &str) {
        self.key.push(Row::Sample { sample, width, words: words.to_owned() });
    }

    /// Adds a heading to the key.
    pub(super) fn heading(&mut self, words: &str) {
        self.key.push(Row::Heading(words.to_owned()));
    }

    /// Adds a note to the key.
    pub(super) fn note(&mut self, words: &str) {
        self.key.push(Row::Note(words.to_owned()));
    }
}
