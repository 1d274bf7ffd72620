//! Colours, dashes and symbols as both pens draw them.

use super::colour::{self, DISTINCT};
use super::key::MARK_WIDTH;
use super::svg::{Element, group, line};

/// Colour of a line or a mark: on white paper, and on a screen whose background may be dark.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Colour {
    pub(super) paper: String,
    pub(super) screen: String,
}

impl Colour {
    /// Colour that shows on light and on dark.
    pub(super) fn of(both: &str) -> Self {
        Self { paper: both.to_owned(), screen: both.to_owned() }
    }

    /// Colour on paper whose counterpart on a screen is a neutral grey, as far from white as from black.
    pub(super) fn neutral(paper: &str) -> Self {
        Self { paper: paper.to_owned(), screen: "#808080".to_owned() }
    }

    /// Colour of warnings and limits.
    pub(super) fn warning() -> Self {
        Self { paper: "#d62728".to_owned(), screen: DISTINCT[1].to_owned() }
    }

    /// Colour of the only curve of a diagram.
    pub(super) fn curve() -> Self {
        Self { paper: "#1f4e79".to_owned(), screen: DISTINCT[0].to_owned() }
    }

    /// Colour of one of `count` families of modes, the same on paper, on screens and in Python.
    pub(super) fn family(index: usize, count: usize) -> Self {
        Self::of(&Self::ordinal(index, count).screen)
    }

    /// Colour of one of `count` things in a natural order.
    pub(super) fn ordinal(index: usize, count: usize) -> Self {
        let screen = match DISTINCT.get(index).filter(|_| count <= DISTINCT.len()) {
            Some(colour) => (*colour).to_owned(),
            // The darkest and the brightest colours are left out: a background may have them.
            None => {
                colour::hex(colour::level(0.2 + 0.7 * index as f64 / count.saturating_sub(1).max(1) as f64))
            }
        };
        Self { paper: colour::ordinal(index, count), screen }
    }
}

/// Number of kinds of dashes that lines are told apart by.
pub(super) const DASHES: usize = 4;

/// Dashes of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dash {
    Solid,
    Dashed,
    Dotted,
    /// Dots with much between them, through which what lies below is seen.
    Sparse,
    /// Dashes and dots in turn.
    Mixed,
}

impl Dash {
    /// Dashes of the line with this index; they repeat.
    pub(super) fn nth(index: usize) -> Self {
        [Self::Solid, Self::Dashed, Self::Dotted, Self::Mixed][index % DASHES]
    }

    /// Lengths of dashes and gaps in SVG.
    pub(super) fn lengths(self) -> &'static str {
        match self {
            Self::Solid => "",
            Self::Dashed => "8 3",
            Self::Dotted => "2 3",
            Self::Sparse => "1.5 5",
            Self::Mixed => "9 3 2 3",
        }
    }

    /// Name that Plotly gives the dashes.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Dashed => "dash",
            Self::Dotted | Self::Sparse => "dot",
            Self::Mixed => "dashdot",
        }
    }
}

/// Colour, dashes and width of a line: on paper, and on a screen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: Colour,
    pub(super) dash: Dash,
    pub(super) width: f64,
    /// Dashes and width on a screen, where they differ.
    pub(super) screen: Option<(Dash, f64)>,
}

impl Pen {
    /// Pen of this colour, dashes and width.
    pub(super) fn new(colour: Colour, dash: Dash, width: f64) -> Self {
        Self { colour, dash, width, screen: None }
    }

    /// Sets dashes and width on a screen.
    pub(super) fn on_screen(self, dash: Dash, width: f64) -> Self {
        Self { screen: Some((dash, width)), ..self }
    }

    /// Draws a stroke of SVG with the pen.
    pub(super) fn draw(&self, stroke: Element) -> Element {
        let stroke = stroke.set("stroke", &self.colour.paper).number("stroke-width", self.width);
        match self.dash {
            Dash::Solid => stroke,
            dash => stroke.set("stroke-dasharray", dash.lengths()),
        }
    }

    /// Sample of the pen in a key.
    pub(super) fn sample(&self) -> Element {
        self.draw(line((0.0, 0.0), (MARK_WIDTH, 0.0)))
    }
}

/// Shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    Circle,
    Square,
    TriangleUp,
    Diamond,
    TriangleDown,
    Hexagon,
    /// Circle with a dot in its middle.
    Target,
    Cross,
    /// Circle with a cross in it.
    Crossed,
}

impl Symbol {
    /// Symbol of the marks with this index; symbols repeat.
    pub(super) fn nth(index: usize) -> Self {
        [Self::Circle, Self::Square, Self::TriangleUp, Self::Diamond, Self::TriangleDown, Self::Hexagon]
            [index % 6]
    }

    /// Name that Plotly gives the symbol, filled or open.
    pub(super) fn name(self, is_filled: bool) -> &'static str {
        let (filled, open) = match self {
            Self::Circle => ("circle", "circle-open"),
            Self::Square => ("square", "square-open"),
            Self::TriangleUp => ("triangle-up", "triangle-up-open"),
            Self::Diamond => ("diamond", "diamond-open"),
            Self::TriangleDown => ("triangle-down", "triangle-down-open"),
            Self::Hexagon => ("hexagon", "hexagon-open"),
            Self::Target => ("circle-dot", "circle-open-dot"),
            Self::Cross => ("x", "x-open"),
            Self::Crossed => ("circle-x", "circle-x-open"),
        };
        if is_filled { filled } else { open }
    }

    /// Outline in SVG, of about the area of a circle of this radius.
    pub(super) fn outline(self, (x, y): (f64, f64), radius: f64) -> Element {
        let disc = |radius| Element::new("circle").number("cx", x).number("cy", y).number("r", radius);
        let stroke = |u: f64, v: f64| {
            let (u, v) = (radius * u, radius * v);
            format!("M{:.2} {:.2}L{:.2} {:.2}", x - u, y - v, x + u, y + v)
        };
        let corners: &[(f64, f64)] = match self {
            Self::Circle => return disc(radius),
            Self::Target => {
                let dot = disc(0.36 * radius).set("fill", "white").set("stroke", "none");
                return group().child(disc(radius)).child(dot);
            }
            Self::Cross | Self::Crossed => {
                let cross = Element::new("path").set("d", stroke(1.0, 1.0) + &stroke(1.0, -1.0));
                return if self == Self::Cross { cross } else { group().child(disc(radius)).child(cross) };
            }
            Self::Square => &[(-0.89, -0.89), (0.89, -0.89), (0.89, 0.89), (-0.89, 0.89)],
            Self::TriangleUp => &[(0.0, -1.42), (1.3, 0.83), (-1.3, 0.83)],
            Self::TriangleDown => &[(-1.3, -0.83), (1.3, -0.83), (0.0, 1.42)],
            Self::Hexagon => &[(-0.4, -1.2), (0.4, -1.2), (0.4, 1.2), (-0.4, 1.2)],
            Self::Diamond => &[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)],
        };
        let place = |(u, v): &(f64, f64)| format!("{:.2} {:.2}", x + radius * u, y + radius * v);
        let corners: Vec<String> = corners.iter().map(place).collect();
        Element::new("path").set("d", format!("M{}Z", corners.join("L")))
    }
}

/// Shape, size and colour of marks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Look {
    pub(super) symbol: Symbol,
    pub(super) is_filled: bool,
    /// Radius in the drawing.
    pub(super) radius: f64,
    /// Diameter in the figure, pixels.
    pub(super) size: f64,
    pub(super) colour: Colour,
    /// Fill in the drawing: the colour of a filled mark.
    fill: String,
    /// Colour and width of the rim in the drawing.
    rim: (String, f64),
    is_dashed: bool,
}

impl Look {
    /// Filled mark with a thin white rim.
    pub(super) fn filled(symbol: Symbol, (radius, size): (f64, f64), colour: Colour) -> Self {
        let (fill, rim) = (colour.paper.clone(), ("white".to_owned(), 0.8));
        Self { symbol, is_filled: true, radius, size, colour, fill, rim, is_dashed: false }
    }

    /// Open mark, through which what lies below is seen.
    pub(super) fn open(symbol: Symbol, (radius, size): (f64, f64), colour: Colour) -> Self {
        let (fill, rim) = ("none".to_owned(), (colour.paper.clone(), 1.5));
        Self { symbol, is_filled: false, radius, size, colour, fill, rim, is_dashed: false }
    }

    /// Sets fill and rim in the drawing.
    pub(super) fn with(self, fill: &str, rim: &str, width: f64) -> Self {
        Self { fill: fill.to_owned(), rim: (rim.to_owned(), width), ..self }
    }

    /// Dashes the rim in the drawing.
    pub(super) fn dashed(self) -> Self {
        Self { is_dashed: true, ..self }
    }

    /// Draws the mark at a place of the drawing; `colour` replaces its own.
    pub(super) fn draw(&self, place: (f64, f64), radius: f64, colour: Option<&str>) -> Element {
        let (fill, rim) = match colour {
            Some(colour) if self.fill == self.colour.paper => (colour, self.rim.0.as_str()),
            Some(colour) => (self.fill.as_str(), colour),
            None => (self.fill.as_str(), self.rim.0.as_str()),
        };
        let mark = self.symbol.outline(place, radius).set("fill", fill).set("stroke", rim);
        let mark = mark.number("stroke-width", self.rim.1);
        if self.is_dashed { mark.set("stroke-dasharray", "2.5 2") } else { mark }
    }

    /// Sample of the mark in a key.
    pub(super) fn sample(&self) -> Element {
        group().child(self.draw((0.5 * MARK_WIDTH, 0.0), self.radius, None))
    }
}
