//! Colours and shapes that distinguish the time stepping schemes.

use super::colour;
use super::style::{Colour, Look, Symbol};
use rubmap_analysis::request::SchemeChoice;

/// Words for a scheme.
pub(super) fn words(scheme: SchemeChoice) -> String {
    scheme.as_str().replace('_', " ")
}

/// Colour of a scheme.
pub(super) fn colour(scheme: SchemeChoice) -> &'static str {
    let [blue, vermilion, green, purple, ..] = colour::DISTINCT;
    match scheme {
        SchemeChoice::ExactModal => blue,
        SchemeChoice::MasslessBoundary => vermilion,
        SchemeChoice::CentralDifferences => green,
        SchemeChoice::Auto => purple,
    }
}

/// Look of the runs of a scheme, of this radius in the drawing and size in the figure.
pub(super) fn look(scheme: SchemeChoice, size: (f64, f64)) -> Look {
    let symbol = match scheme {
        SchemeChoice::ExactModal => Symbol::Circle,
        SchemeChoice::MasslessBoundary => Symbol::Square,
        SchemeChoice::CentralDifferences => Symbol::TriangleUp,
        SchemeChoice::Auto => Symbol::Diamond,
    };
    Look::filled(symbol, size, Colour::of(colour(scheme)))
}
