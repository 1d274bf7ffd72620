//! Drawing of a result, in both of its forms.

use super::figure::{Figure, sketched};
use super::pen;
use super::sketch::Sketch;

/// Drawing of a result: as SVG, or as a figure for Plotly with the same content.
pub struct Drawing<'a>(Box<Sketch<'a>>);

impl Drawing<'_> {
    /// Draws the SVG.
    pub fn svg(&self) -> String {
        pen::svg(&self.0)
    }

    /// Makes the figure for Plotly.
    pub fn figure(&self) -> Figure {
        sketched::figure(&self.0)
    }
}

impl<'a> From<Sketch<'a>> for Drawing<'a> {
    fn from(sketch: Sketch<'a>) -> Self {
        Self(Box::new(sketch))
    }
}

impl std::fmt::Debug for Drawing<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_tuple("Drawing").finish_non_exhaustive()
    }
}
