//! Layers of a sketch: curves, marks and cells, and what one of the pens alone has.

use super::heat::Heat;
use super::key::MARK_WIDTH;
use super::style::{Colour, Dash, Look, Pen};
use super::svg::{Element, rectangle};

/// Point in the units of the axes.
pub(super) type Place = (f64, f64);

/// Layer of a panel.
#[derive(Debug)]
pub(super) enum Layer<'a> {
    Curve(Curve),
    Marks(Marks),
    Uprights(Uprights),
    Areas(Areas),
    Cells(Cells),
    Heat(Heat<'a>),
    /// Elements of the drawing that the figure does not have.
    Drawn(Element),
    /// Marks of the figure that the drawing does not have.
    Shown(Marks),
}

impl From<Curve> for Layer<'_> {
    fn from(curve: Curve) -> Self {
        Self::Curve(curve)
    }
}

impl From<Marks> for Layer<'_> {
    fn from(marks: Marks) -> Self {
        Self::Marks(marks)
    }
}

impl From<Uprights> for Layer<'_> {
    fn from(uprights: Uprights) -> Self {
        Self::Uprights(uprights)
    }
}

impl From<Areas> for Layer<'_> {
    fn from(areas: Areas) -> Self {
        Self::Areas(areas)
    }
}

impl<'a> From<Heat<'a>> for Layer<'a> {
    fn from(heat: Heat<'a>) -> Self {
        Self::Heat(heat)
    }
}

impl From<Cells> for Layer<'_> {
    fn from(cells: Cells) -> Self {
        Self::Cells(cells)
    }
}

impl From<Element> for Layer<'_> {
    fn from(drawn: Element) -> Self {
        Self::Drawn(drawn)
    }
}

/// Text under the pointer on a curve of the figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Hover {
    /// No words.
    Nothing,
    /// Words, and Plotly's template for the point below them.
    Template(String, String),
    /// Words of every point, stroke after stroke.
    Each(Vec<String>),
}

/// Course of a curve from one point to the next, and outside the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Course {
    /// Straight; points outside the frame interrupt it.
    Straight,
    /// Straight, and cut off at the frame.
    Cut,
    /// Across, then down: the best value so far.
    Steps,
    /// Samples of a history: where they are too dense for a line, the band that they fill.
    History,
}

/// Path of a curve in the drawing, with its title; all strokes of a curve are one trace of the figure.
#[derive(Debug, Clone)]
pub(super) struct Stroke {
    /// Points; a missing one is a gap.
    pub(super) places: Vec<Option<Place>>,
    /// Title in the drawing, if there is one.
    pub(super) title: String,
}

/// Curve: one trace of the figure, and in the drawing a path for each stroke.
#[derive(Debug)]
pub(super) struct Curve {
    /// Name in the legend of the figure; curves of one name are shown and hidden together.
    pub(super) name: String,
    pub(super) strokes: Vec<Stroke>,
    pub(super) pen: Pen,
    pub(super) course: Course,
    pub(super) hover: Hover,
    /// Words at the end of every stroke.
    pub(super) labels: Vec<String>,
    /// Whether the drawing has words of its own in the place of the labels.
    pub(super) has_texts: bool,
    /// Error bars at the points in the figure.
    pub(super) errors: Vec<Reach>,
    /// Marks at all points.
    pub(super) look: Option<Look>,
    /// Class in the drawing.
    pub(super) class: &'static str,
    /// Opacity; 1 unless something below shows through.
    pub(super) opacity: f64,
    /// Whether the closed lines of the strokes bound an area, with holes in it where they run the other way round.
    pub(super) is_area: bool,
    /// Whether the legend of the figure names the curve.
    pub(super) is_listed: bool,
    /// Group of the legend whose curves are shown and hidden together, where that is not the name.
    pub(super) group: Option<String>,
}

impl Curve {
    /// Curve of one stroke.
    pub(super) fn new(name: &str, places: impl IntoIterator<Item = Option<Place>>, pen: Pen) -> Self {
        Self::of(name, [Stroke { places: places.into_iter().collect(), title: String::new() }], pen)
    }

    /// Curve of these strokes.
    pub(super) fn of(name: &str, strokes: impl IntoIterator<Item = Stroke>, pen: Pen) -> Self {
        Self {
            name: name.to_owned(),
            strokes: strokes.into_iter().collect(),
            pen,
            course: Course::Straight,
            hover: Hover::Nothing,
            labels: Vec::new(),
            has_texts: false,
            errors: Vec::new(),
            look: None,
            class: "",
            opacity: 1.0,
            is_area: false,
            is_listed: true,
            group: None,
        }
    }

    /// Sets the group of the legend.
    pub(super) fn group(self, group: String) -> Self {
        Self { group: Some(group), ..self }
    }

    /// Makes the closed lines of the strokes the border of an area.
    pub(super) fn area(self) -> Self {
        Self { is_area: true, ..self }
    }

    /// Sets the title of all strokes in the drawing.
    pub(super) fn title(mut self, title: &str) -> Self {
        self.strokes.iter_mut().for_each(|stroke| stroke.title = title.to_owned());
        self
    }

    /// Sets the course between points.
    pub(super) fn course(self, course: Course) -> Self {
        Self { course, ..self }
    }

    /// Sets the class in the drawing.
    pub(super) fn class(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// Sets the words under the pointer: these, and below them a template for the point.
    pub(super) fn over(self, words: impl Into<String>, point: impl Into<String>) -> Self {
        Self { hover: Hover::Template(words.into(), point.into()), ..self }
    }

    /// Sets the words of every point under the pointer.
    pub(super) fn each(self, words: Vec<String>) -> Self {
        Self { hover: Hover::Each(words), ..self }
    }

    /// Leaves the curve out of the legend of the figure.
    pub(super) fn unlisted(self) -> Self {
        Self { is_listed: false, ..self }
    }

    /// Sample of the curve in a key.
    pub(super) fn sample(&self) -> Element {
        self.pen.sample()
    }
}

/// Mark with its words.
#[derive(Debug, Clone)]
pub(super) struct Mark {
    pub(super) place: Place,
    /// Words under the pointer.
    pub(super) words: String,
    /// Words of the figure that follow the others.
    pub(super) more: String,
    /// Label beside the mark in the drawing, where there is room.
    pub(super) label: String,
    /// Radius in the drawing, where it differs from that of the others.
    pub(super) radius: Option<f64>,
    /// Colour in the drawing, where it differs from that of the others.
    pub(super) colour: Option<String>,
    /// Index of the result, for programs that show the figure.
    pub(super) index: Option<usize>,
}

impl Mark {
    /// Mark with its words.
    pub(super) fn new(place: Place, words: String) -> Self {
        let (more, label) = (String::new(), String::new());
        Self { place, words, more, label, radius: None, colour: None, index: None }
    }

    /// Sets the label beside the mark.
    pub(super) fn label(self, label: String) -> Self {
        Self { label, ..self }
    }
}

/// Lengths of an error bar below and above its mark, or to its left and right; not numbers where a mark has no bar.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    pub(super) below: f64,
    pub(super) above: f64,
}

impl Reach {
    /// Bar that is as long on one side as on the other.
    pub(super) fn even(length: f64) -> Self {
        Self { below: length, above: length }
    }

    /// Bar from v/(1 + e) to v (1 + e) for a value v and its relative error e, as verdicts have it: it never ends below 0.
    pub(super) fn of_factor(value: f64, relative_error: f64) -> Self {
        Self { below: value - value / (1.0 + relative_error), above: value * relative_error }
    }

    /// Whether the bar is as long on one side as on the other, or absent.
    pub(super) fn is_even(&self) -> bool {
        self.below.total_cmp(&self.above).is_eq()
    }
}

/// Error bars of marks.
#[derive(Debug, Clone)]
pub(super) struct Bars {
    /// Lengths of the bar of every mark.
    pub(super) lengths: Vec<Reach>,
    pub(super) colour: Colour,
    /// Class in the drawing.
    pub(super) class: &'static str,
}

/// Marks of one name.
#[derive(Debug)]
pub(super) struct Marks {
    /// Name in the legend of the figure; layers of one name are shown and hidden together.
    pub(super) name: String,
    pub(super) marks: Vec<Mark>,
    pub(super) look: Look,
    /// Horizontal and vertical error bars.
    pub(super) across: Option<Bars>,
    pub(super) bars: Option<Bars>,
    /// Whether every mark stands on a stem from the foot of the panel, and whether the stems are dashed.
    pub(super) stems: Option<Dash>,
    /// Height in the drawing of bars from zero to the marks, which they replace there.
    pub(super) beam: Option<f64>,
    /// Values that colour the marks of the figure on the panel's ramp.
    pub(super) values: Vec<f64>,
    /// Whether the figure writes the labels beside the marks.
    pub(super) has_texts: bool,
    /// Class in the drawing.
    pub(super) class: &'static str,
    /// Whether the legend of the figure names the marks.
    pub(super) is_listed: bool,
}

impl Marks {
    /// Marks of one name and look.
    pub(super) fn new(name: &str, look: Look, marks: impl IntoIterator<Item = Mark>) -> Self {
        let (name, marks) = (name.to_owned(), marks.into_iter().collect());
        Self {
            name,
            marks,
            look,
            across: None,
            bars: None,
            stems: None,
            beam: None,
            values: Vec::new(),
            has_texts: false,
            class: "",
            is_listed: true,
        }
    }

    /// Sets the class in the drawing.
    pub(super) fn class(self, class: &'static str) -> Self {
        Self { class, ..self }
    }

    /// Sample of the marks in a key.
    pub(super) fn sample(&self) -> Element {
        match self.beam {
            Some(_) => rectangle(0.0, -5.0, MARK_WIDTH, 10.0).set("fill", &self.look.colour.paper),
            None => self.look.sample(),
        }
    }

    /// Leaves the marks out of the legend of the figure.
    pub(super) fn unlisted(self) -> Self {
        Self { is_listed: false, ..self }
    }
}

/// Line at a value of the horizontal axis.
#[derive(Debug)]
pub(super) struct Upright {
    pub(super) x: f64,
    /// Label above the line in the drawing.
    pub(super) label: String,
    /// Words that follow the label in the title of the line.
    pub(super) more: String,
}

/// Lines of one name at values of the horizontal axis. In the drawing they begin above the panel, so that panels over it have them too.
#[derive(Debug)]
pub(super) struct Uprights {
    /// Name in the legend of the figure.
    pub(super) name: String,
    pub(super) lines: Vec<Upright>,
    pub(super) pen: Pen,
    /// Height in the drawing at which the lines begin.
    pub(super) top: f64,
    /// Class in the drawing.
    pub(super) class: &'static str,
}

/// Rectangle with words under the pointer.
#[derive(Debug)]
pub(super) struct Area {
    pub(super) across: (f64, f64),
    /// Vertical extent; none for a strip along the upper edge of the panel: outside it in the drawing, inside it in the figure.
    pub(super) upwards: Option<(f64, f64)>,
    pub(super) words: String,
}

/// Rectangles of one name and colour.
#[derive(Debug)]
pub(super) struct Areas {
    /// Name in the legend of the figure.
    pub(super) name: &'static str,
    pub(super) areas: Vec<Area>,
    pub(super) fill: String,
    /// Class in the drawing.
    pub(super) class: &'static str,
}

/// Column or row of cells: its extent and the value in its middle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Band {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) value: f64,
}

/// Cells in the colours of the panel's ramp.
#[derive(Debug)]
pub(super) struct Cells {
    pub(super) columns: Vec<Band>,
    pub(super) rows: Vec<Band>,
    /// Values as `[row][column]`; none where there is no result.
    pub(super) values: Vec<Vec<Option<f64>>>,
    /// Plotly's templates for the words of a cell, line by line.
    pub(super) hover: Vec<String>,
    /// Whether columns are speeds in rpm, of which the figure has rad/s as well.
    pub(super) has_speeds: bool,
    /// Words of the figure where neighbours are merged, after their number.
    pub(super) merged: &'static str,
    /// Numbers of every cell for the figure, as `[row][column]`; if there are any, neighbours are not merged, and the drawing has an image
    /// of its own.
    pub(super) data: Vec<Vec<Vec<f32>>>,
}
