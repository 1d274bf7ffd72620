//! Sections of a sector.

use plotly::common::{DashType, MarkerSymbol};
use serde_json::json;

use super::document::{Figure, axis};
use super::marks::{PointTrace, line, marks, silent, strokes};
use super::palette::{CURVE, NEUTRAL, WARNING};
use crate::outline::outline;
use crate::section::{self as drawing, Drawing, NO_NODES, SectionView, project};
use rubmap_analysis::result::{NodeKind, SectorGeometry};

/// Name of the contact line, and of its nodes.
const LINE: &str = "contact line";

/// Nodes of the sector, one of those that cover each other, at the same scale in both directions; across the axis with the contact line and
/// the casing at its clearance.
pub fn section(geometry: &SectorGeometry, view: SectionView) -> Figure {
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
            Some(marks(look.words(view), told, style(look.kind))?.legend_group(look.words(view)))
        }))
        .with_all(contact_line(geometry, view))
        .with_all(drawn.wall().map(|wall| {
            let places = wall.into_iter().map(|place| Some(project(view, place)));
            silent("casing at rest", places, (NEUTRAL, DashType::Solid, 3.0))
        }))
        .axis("xaxis", axis(&x))
        .axis("yaxis", axis(&y).scale_anchor("x").scale_ratio(1.0))
}

fn style(kind: NodeKind) -> (MarkerSymbol, usize, &'static str) {
    match kind {
        NodeKind::Internal => (MarkerSymbol::Circle, 2, NEUTRAL),
        NodeKind::Low => (MarkerSymbol::Circle, 4, CURVE),
        NodeKind::High => (MarkerSymbol::Diamond, 5, "#e69f00"),
        NodeKind::Clamped => (MarkerSymbol::Square, 5, "#009e73"),
        NodeKind::Contact => (MarkerSymbol::TriangleUp, 6, WARNING),
    }
}

/// Outline of the area that the nodes cover, turned into one plane.
fn rim(geometry: &SectorGeometry, view: SectionView) -> Option<PointTrace> {
    (view == SectionView::Meridional).then_some(())?;
    let places: Vec<(f64, f64)> = geometry.nodes.iter().map(|node| project(view, node.position)).collect();
    let (_, edges) = outline(&places);
    let pen = (NEUTRAL, DashType::Solid, 1.2);
    (!edges.is_empty()).then(|| silent("what the nodes cover", strokes(edges), pen))
}

/// Trace of the contact line, with the clearance of every node where it is known.
fn contact_line(geometry: &SectorGeometry, view: SectionView) -> Option<PointTrace> {
    let places = geometry.contact.iter().map(|place| Some(project(view, place.position)));
    let told = geometry.contact.iter().enumerate().map(|(k, place)| {
        let clearance = place.clearance.map(|clearance| {
            format!(", clearance {} {}", crate::axis::significant(clearance), geometry.units.length)
        });
        format!("contact node {k}: node {}{}", place.id, clearance.unwrap_or_default())
    });
    let trace = line(LINE, places, (WARNING, DashType::Solid, 2.2));
    let trace = super::marks::words(trace, told.collect()).legend_group(LINE);
    // Known nodes of the contact line have its name already.
    let named = geometry.nodes.iter().any(|node| node.kind == NodeKind::Contact);
    (!geometry.contact.is_empty()).then(|| trace.show_legend(!named))
}
