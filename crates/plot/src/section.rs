//! Sections of the sector: the paper's Figs 1 and 3.

use std::collections::BTreeSet;

use super::axis::{significant, ticks};
use super::diagram::Diagram;
use super::heading::heading;
use super::key::{Key, MARK_WIDTH};
use super::outline;
use super::svg::{Element, document, group, line, polyline, rectangle, text, text_width};
use rubmap_analysis::result::{NodeKind, SectorGeometry, SectorNode};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 800.0;
const LEFT: f64 = 92.0;
const PLOT: (f64, f64) = (790.0, 640.0);

/// Distance below which dots are drawn as one.
const COVERED: f64 = 1.5;

/// Width in the drawing at which a gap is visible.
const VISIBLE: f64 = 14.0;

/// Direction from which a sector is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionView {
    /// Across the axis: all nodes turned into one plane, with the contact line and the casing at its clearance.
    Meridional,
    /// Along the axis: the cyclic faces and what is clamped.
    Cyclic,
}

/// Message where no node is known.
pub(super) const NO_NODES: &str = "Nothing to draw: no node is known";

/// Colour, size and name of a kind of node.
pub(super) struct Look {
    pub(super) kind: NodeKind,
    words: &'static str,
    colour: &'static str,
    radius: f64,
}

impl Look {
    /// Name of such nodes in a view.
    pub(super) fn words(&self, view: SectionView) -> &'static str {
        match (view, self.kind) {
            (SectionView::Meridional, NodeKind::Low) => "cyclic faces",
            _ => self.words,
        }
    }
}

/// Looks of all kinds of nodes, in the order in which they are drawn over each other.
const LOOKS: [Look; 5] = [
    Look { kind: NodeKind::Internal, words: "other nodes", colour: "#b4bcc4", radius: 1.3 },
    Look { kind: NodeKind::Low, words: "low cyclic face", colour: "#0072b2", radius: 2.2 },
    Look { kind: NodeKind::High, words: "high cyclic face", colour: "#e69f00", radius: 2.2 },
    Look { kind: NodeKind::Clamped, words: "clamped", colour: "#222222", radius: 2.4 },
    Look { kind: NodeKind::Contact, words: "contact line", colour: "#d62728", radius: 2.6 },
];

/// Draws the nodes of the sector as dots, at the same scale in both directions.
pub(super) fn section(geometry: &SectorGeometry, view: SectionView) -> String {
    let title = title(geometry, view);
    let (heading, bottom) = heading(LEFT, &title, &[words(geometry, view)]);
    let axes = axes(geometry, view);
    let drawing = Drawing::new(geometry, view, bottom + 24.0);
    let diagram = &drawing.diagram;
    let (x, y) = (ticks(diagram.x.values, 9.0), ticks(diagram.y.values, 8.0));
    let content = vec![
        heading,
        diagram.grid(&x, &y),
        diagram.region("inside"),
        group().set("clip-path", "url(#inside)").children(drawing.content()),
        diagram.frame(),
        diagram.x_axis(&x, &axes[0]),
        diagram.y_axis(&y, &axes[1], 66.0),
        drawing.key(),
    ];
    let width = (diagram.right() + 290.0).max(LEFT + 1.15 * text_width(&title, 18.0)).min(WIDTH);
    document(&title, width, diagram.bottom() + 66.0, content)
}

/// Title: the section and the name of the model.
pub(super) fn title(geometry: &SectorGeometry, view: SectionView) -> String {
    let subject = match view {
        SectionView::Meridional => "Meridional section",
        SectionView::Cyclic => "Cyclic faces, seen along the axis",
    };
    let name = if geometry.name.is_empty() { String::new() } else { format!(": {}", geometry.name) };
    format!("{subject}{name}")
}

/// Paragraph below the title: numbers of sectors and nodes, and the clearance.
pub(super) fn words(geometry: &SectorGeometry, view: SectionView) -> String {
    let mut words = format!(
        "one of {} sectors · {} nodes, {} on the contact line",
        geometry.sectors,
        geometry.nodes.len(),
        geometry.contact.len()
    );
    if let (SectionView::Meridional, Some(clearance)) = (view, clearances(geometry)) {
        words += &format!(" · clearance {clearance} {}", geometry.units.length);
    }
    words
}

/// Titles of the axes.
pub(super) fn axes(geometry: &SectorGeometry, view: SectionView) -> [String; 2] {
    let axes = match view {
        SectionView::Meridional => ["axial coordinate z", "radius r"],
        SectionView::Cyclic => ["x", "y"],
    };
    axes.map(|axis| format!("{axis}, {}", geometry.units.length))
}

/// Words for the clearances at both ends of the contact line.
fn clearances(geometry: &SectorGeometry) -> Option<String> {
    let all: Option<Vec<f64>> = geometry.contact.iter().map(|place| place.clearance).collect();
    let all = all.filter(|all| !all.is_empty())?;
    let (leading, trailing) = (all[0], all[all.len() - 1]);
    Some(if leading == trailing {
        significant(leading)
    } else {
        format!("from {} to {}", significant(leading), significant(trailing))
    })
}

/// Section of a sector, and its positions in the drawing.
pub(super) struct Drawing<'a> {
    geometry: &'a SectorGeometry,
    view: SectionView,
    diagram: Diagram,
    /// Magnification of the clearance.
    pub(super) stretch: f64,
}

impl<'a> Drawing<'a> {
    /// Lays out a section in a diagram that begins at `top`.
    pub(super) fn new(geometry: &'a SectorGeometry, view: SectionView, top: f64) -> Self {
        let nodes = geometry.nodes.iter().map(|node| node.position);
        let places = nodes.chain(geometry.contact.iter().map(|place| place.position));
        let places: Vec<(f64, f64)> = places.map(|position| project(view, position)).collect();
        let diagram =
            Diagram::of_one_scale(&places, (LEFT, top), (PLOT.0, f64::min(PLOT.1, HEIGHT - 66.0 - top)));
        let scale = diagram.width / (diagram.x.values.1 - diagram.x.values.0);
        let clearance = geometry.contact.iter().filter_map(|place| place.clearance).fold(0.0, f64::max);
        let stretch = if clearance > 0.0 { round_up(VISIBLE / (clearance * scale)) } else { 1.0 };
        Self { geometry, view, diagram, stretch }
    }

    fn place(&self, position: [f64; 3]) -> (f64, f64) {
        let (x, y) = project(self.view, position);
        self.diagram.point(x, y)
    }

    /// Kinds of nodes that a view distinguishes: turned into one plane, both cyclic faces coincide.
    pub(super) fn looks(&self) -> impl Iterator<Item = &'static Look> {
        let view = self.view;
        LOOKS.iter().filter(move |look| view == SectionView::Cyclic || look.kind != NodeKind::High)
    }

    fn of(&self, kind: NodeKind) -> impl Iterator<Item = &SectorNode> {
        self.geometry.nodes.iter().filter(move |node| node.kind == kind)
    }

    /// Nodes of one kind; of nodes that cover each other only one.
    pub(super) fn seen(&self, kind: NodeKind) -> Vec<&SectorNode> {
        let mut taken = BTreeSet::new();
        let cell = |(x, y): (f64, f64)| ((x / COVERED) as i64, (y / COVERED) as i64);
        self.of(kind).filter(|node| taken.insert(cell(self.place(node.position)))).collect()
    }

    fn content(&self) -> Vec<Element> {
        let mut content = Vec::new();
        if self.geometry.nodes.is_empty() && self.geometry.contact.is_empty() {
            return vec![self.diagram.words(NO_NODES)];
        }
        content.extend(self.outline());
        content.extend(self.casing());
        for look in self.looks() {
            let dots = self.seen(look.kind).into_iter().map(|node| dot(self.place(node.position), look));
            content.push(group().set("class", class(look.kind)).set("fill", look.colour).children(dots));
        }
        let line = self.geometry.contact.iter().map(|contact| Some(self.place(contact.position)));
        let line = polyline(line).set("class", "contact-line").set("stroke", "#d62728");
        content.push(line.set("stroke-width", "2.2").title("contact line"));
        content.push(self.ends());
        content
    }

    /// Draws the area that the nodes cover, turned into one plane.
    fn outline(&self) -> Option<Element> {
        (self.view == SectionView::Meridional).then_some(())?;
        let places: Vec<(f64, f64)> =
            self.geometry.nodes.iter().map(|node| self.place(node.position)).collect();
        let (triangles, edges) = outline::outline(&places);
        (!edges.is_empty()).then_some(())?;
        let corners = |[a, b, c]: [(f64, f64); 3]| [Some(a), Some(b), Some(c), Some(a), None];
        let area = polyline(triangles.into_iter().flat_map(corners)).set("style", "fill:#e3e8ee");
        // The stroke covers the slits between the triangles.
        let area = area.set("class", "area").set("stroke", "#e3e8ee").set("stroke-width", "0.8");
        let rim = polyline(edges.into_iter().flat_map(|[a, b]| [Some(a), Some(b), None]));
        let rim = rim.set("class", "outline").set("stroke", "#5a6672").set("stroke-width", "1.2");
        Some(group().child(area).child(rim.set("stroke-linecap", "round")))
    }

    /// Labels the two ends of the contact line.
    fn ends(&self) -> Element {
        let contact = &self.geometry.contact;
        let end = |index: usize, words: &str| {
            let (x, y) = self.place(contact[index].position);
            let anchor = if x > self.diagram.left + 0.6 * self.diagram.width { "end" } else { "start" };
            let beside = if anchor == "end" { -9.0 } else { 9.0 };
            text(x + beside, y + 16.0, anchor, words).set("font-size", "11").rimmed("white")
        };
        match contact.len() {
            0 => group(),
            1 => group().child(end(0, "contact node 0")),
            count => {
                let last = format!("contact node {}", count - 1);
                group().child(end(0, "contact node 0, leading edge")).child(end(count - 1, &last))
            }
        }
    }

    /// Points of the casing along the normals, before each contact node; none where its clearance is unknown.
    pub(super) fn wall(&self) -> Option<Vec<[f64; 3]>> {
        (self.view == SectionView::Meridional).then_some(())?;
        let at = |place: &rubmap_analysis::result::ContactPlace| {
            let [r, theta, z] = place.position;
            let away = self.stretch * place.clearance?;
            Some([r + away * place.normal[0], theta, z + away * place.normal[2]])
        };
        self.geometry.contact.iter().map(at).collect()
    }

    /// Draws the casing at its clearance along the normals, with the normals.
    fn casing(&self) -> Option<Element> {
        let contact = &self.geometry.contact;
        let wall: Vec<(f64, f64)> = self.wall()?.into_iter().map(|place| self.place(place)).collect();
        let every = contact.len().div_ceil(24).max(1);
        let normals = contact.iter().zip(&wall).step_by(every).map(|(place, wall)| {
            line(self.place(place.position), *wall).set("stroke", "#888888").set("stroke-width", "0.7")
        });
        let wall = polyline(wall.iter().copied().map(Some)).set("class", "casing").set("stroke", "#444444");
        let wall = wall.set("stroke-width", "3").title("casing");
        Some(group().children(normals).child(wall))
    }

    /// Words for the magnification of the clearance.
    pub(super) fn stretch_words(&self) -> String {
        format!("its clearance drawn {} times as large", self.stretch)
    }

    fn key(&self) -> Element {
        let mut key = Key::new(self.diagram.right() + 30.0, self.diagram.top + 8.0);
        for look in self.looks() {
            let on_line = look.kind == NodeKind::Contact && !self.geometry.contact.is_empty();
            if on_line || self.of(look.kind).next().is_some() {
                let mark = dot((0.5 * MARK_WIDTH, 0.0), look).set("fill", look.colour);
                let stroke = line((2.0, 0.0), (MARK_WIDTH - 2.0, 0.0)).set("stroke", look.colour);
                let stroke = on_line.then(|| stroke.set("stroke-width", "2.2"));
                key = key.row(group().children(stroke).child(mark), look.words(self.view));
            }
        }
        if self.outline().is_some() {
            let area = rectangle(2.0, -6.0, MARK_WIDTH - 4.0, 12.0).set("fill", "#e3e8ee");
            key = key.row(area.set("stroke", "#5a6672"), "what the nodes cover");
        }
        if self.casing().is_some() {
            let wall = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", "#444444").set("stroke-width", "3");
            key = key.row(wall, "casing at rest");
            if self.stretch > 1.0 {
                key = key.note(&self.stretch_words());
            }
        }
        key.draw()
    }
}

fn class(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::Internal => "internal",
        NodeKind::Low => "low",
        NodeKind::High => "high",
        NodeKind::Contact => "contact",
        NodeKind::Clamped => "clamped",
    }
}

/// Dot of a node, distinct without colours too: round on the low face, a diamond on the high one, a square where clamped.
fn dot((x, y): (f64, f64), look: &Look) -> Element {
    let r = look.radius;
    match look.kind {
        NodeKind::Clamped => rectangle(x - r, y - r, 2.0 * r, 2.0 * r),
        NodeKind::High => {
            let r = 1.4 * r;
            let path =
                format!("M{:.2} {y:.2}L{x:.2} {:.2}L{:.2} {y:.2}L{x:.2} {:.2}Z", x - r, y - r, x + r, y + r);
            Element::new("path").set("d", path)
        }
        NodeKind::Internal | NodeKind::Low | NodeKind::Contact => {
            Element::new("circle").number("cx", x).number("cy", y).number("r", r)
        }
    }
}

/// Projects cylindrical coordinates into the plane of a view.
pub(super) fn project(view: SectionView, [r, theta, z]: [f64; 3]) -> (f64, f64) {
    match view {
        SectionView::Meridional => (z, r),
        SectionView::Cyclic => (r * theta.cos(), r * theta.sin()),
    }
}

/// Rounds up to the next of 1, 2 and 5 times a power of ten; at least 1.
fn round_up(value: f64) -> f64 {
    if value <= 1.0 || !value.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= 0.999 * value).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_round() {
        assert_eq!([0.3, 1.0, 1.1, 4.0, 60.0, f64::INFINITY].map(round_up), [1.0, 1.0, 2.0, 5.0, 100.0, 1.0]);
    }
}
