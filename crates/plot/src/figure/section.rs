//! Sections of a sector.

use serde_json::json;

use super::attributes::Scatter;
use super::document::{Figure, axis};
use super::marks::{line, marks, silent, strokes};
use super::palette::{CURVE, NEUTRAL, WARNING};
use crate::outline::outline;
use crate::section::{self as drawing, Drawing, NO_NODES, SectionView, project};
use rubmap_analysis::result::{NodeKind, SectorGeometry};

/// Name of the contact line, and of its nodes.
const LINE: &str = "contact line";

/// Nodes of the sector, one of those that cover each other, at the same scale in both directions; across the axis with the contact line and
/// the casing at its clearance.
pub(crate) fn section(geometry: &SectorGeometry, view: SectionView) -> Figure {
    let drawn = Drawing::new(geometry, view, 0.0);
    let [x, y] = drawing::axes(geometry, view);
    let mut paragraphs = vec![drawing::words(geometry, view)];
    paragraphs.extend((drawn.stretch > 1.0 && drawn.wall().is_some()).then(|| drawn.stretch_words()));
    let figure = Figure::new("section", &drawing::title(geometry, view), &paragraphs)
        .meta("units", json!({"x": geometry.units.length, "y": geometry.units.length}));
    if geometry.nodes.is_empty() && geometry.contact.is_empty() {
        return figure.empty(NO_NODES);
    }
    figure
        .high(640)
        .with_all(rim(geometry, view))
        .with_all(drawn.looks().filter_map(|look| {
            let told = drawn.seen(look.kind).into_iter().map(|node| {
                (project(view, node.position), format!("node {}, {}", node.id, look.words(view)))
            });
            Some(marks(look.words(view), told, style(look.kind))?.legendgroup(look.words(view)))
        }))
        .with_all(contact_line(geometry, view))
        .with_all(drawn.wall().map(|wall| {
            let places = wall.into_iter().map(|place| Some(project(view, place)));
            silent("casing at rest", places, (NEUTRAL, "solid", 3.0))
        }))
        .axis("xaxis", axis(&x))
        .axis("yaxis", axis(&y).scaleanchor("x").scaleratio(1.0))
}

fn style(kind: NodeKind) -> (&'static str, u32, &'static str) {
    match kind {
        NodeKind::Internal => ("circle", 2, NEUTRAL),
        NodeKind::Low => ("circle", 4, CURVE),
        NodeKind::High => ("diamond", 5, "#e69f00"),
        NodeKind::Clamped => ("square", 5, "#009e73"),
        NodeKind::Contact => ("triangle-up", 6, WARNING),
    }
}

/// Outline of the area that the nodes cover, turned into one plane.
fn rim(geometry: &SectorGeometry, view: SectionView) -> Option<Scatter> {
    (view == SectionView::Meridional).then_some(())?;
    let places: Vec<(f64, f64)> = geometry.nodes.iter().map(|node| project(view, node.position)).collect();
    let (_, edges) = outline(&places);
    let pen = (NEUTRAL, "solid", 1.2);
    (!edges.is_empty()).then(|| silent("what the nodes cover", strokes(edges), pen))
}

/// Trace of the contact line, with the clearance of every node where it is known.
fn contact_line(geometry: &SectorGeometry, view: SectionView) -> Option<Scatter> {
    let places = geometry.contact.iter().map(|place| Some(project(view, place.position)));
    let told = geometry.contact.iter().enumerate().map(|(k, place)| {
        let clearance = place.clearance.map(|clearance| {
            format!(", clearance {} {}", crate::axis::significant(clearance), geometry.units.length)
        });
        format!("contact node {k}: node {}{}", place.id, clearance.unwrap_or_default())
    });
    let trace = line(LINE, places, (WARNING, "solid", 2.2));
    let trace = super::marks::words(trace, told.collect()).legendgroup(LINE);
    // Known nodes of the contact line have its name already.
    let named = geometry.nodes.iter().any(|node| node.kind == NodeKind::Contact);
    (!geometry.contact.is_empty()).then(|| trace.showlegend(!named))
}
