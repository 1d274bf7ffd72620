//! Colours and shapes that distinguish the time stepping schemes.

use super::colour;
use super::svg::Element;
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

/// Mark of a scheme: a shape of about the area of a circle of this radius.
pub(super) fn mark(scheme: SchemeChoice, (x, y): (f64, f64), radius: f64) -> Element {
    let polygon = |corners: &[(f64, f64)]| {
        let corners = corners.iter().map(|(u, v)| format!("{:.2},{:.2}", x + radius * u, y + radius * v));
        Element::new("polygon").set("points", corners.collect::<Vec<_>>().join(" "))
    };
    let mark = match scheme {
        SchemeChoice::ExactModal => {
            Element::new("circle").number("cx", x).number("cy", y).number("r", radius)
        }
        SchemeChoice::MasslessBoundary => {
            polygon(&[(-0.89, -0.89), (0.89, -0.89), (0.89, 0.89), (-0.89, 0.89)])
        }
        SchemeChoice::CentralDifferences => polygon(&[(0.0, -1.42), (1.3, 0.83), (-1.3, 0.83)]),
        SchemeChoice::Auto => polygon(&[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)]),
    };
    mark.set("fill", colour(scheme)).set("stroke", "white").set("stroke-width", "0.8")
}
