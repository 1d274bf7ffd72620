//! Drawing of a result, in both of its forms.

use super::figure::{Figure, sketched};
use super::pen;
use super::sketch::Sketch;

/// Drawing of a result: as SVG, or as a figure for Plotly with the same content.
pub struct Drawing<'a>(Form<'a>);

enum Form<'a> {
    /// Described once, for both pens.
    Sketched(Box<Sketch>),
    /// Drawn by a function for each form.
    Twice(Box<dyn Fn() -> String + 'a>, Box<dyn Fn() -> Figure + 'a>),
}

impl<'a> Drawing<'a> {
    /// Drawing whose two forms have functions of their own.
    pub(super) fn twice(svg: impl Fn() -> String + 'a, figure: impl Fn() -> Figure + 'a) -> Self {
        Self(Form::Twice(Box::new(svg), Box::new(figure)))
    }

    /// Draws the SVG.
    pub fn svg(&self) -> String {
        match &self.0 {
            Form::Sketched(sketch) => pen::svg(sketch),
            Form::Twice(svg, _) => svg(),
        }
    }

    /// Makes the figure for Plotly.
    pub fn figure(&self) -> Figure {
        match &self.0 {
            Form::Sketched(sketch) => sketched::figure(sketch),
            Form::Twice(_, figure) => figure(),
        }
    }
}

impl From<Sketch> for Drawing<'_> {
    fn from(sketch: Sketch) -> Self {
        Self(Form::Sketched(Box::new(sketch)))
    }
}

impl std::fmt::Debug for Drawing<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_tuple("Drawing").finish_non_exhaustive()
    }
}
