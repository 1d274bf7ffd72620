//! Sections of the sector: the paper's Figs 1 and 3.

use std::collections::BTreeSet;

use super::axis::significant;
use super::diagram::Diagram;
use super::drawing::Drawing;
use super::key::MARK_WIDTH;
use super::layer::{Course, Curve, Mark, Marks, Stroke};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, group, line, rectangle, text, text_width};
use rubmap_analysis::result::{NodeKind, SectorGeometry, SectorNode};
use serde_json::json;

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

/// Kinds of nodes in the order in which they are drawn over each other, with their names.
const KINDS: [(NodeKind, &str); 5] = [
    (NodeKind::Internal, "other nodes"),
    (NodeKind::Low, "low cyclic face"),
    (NodeKind::High, "high cyclic face"),
    (NodeKind::Clamped, "clamped"),
    (NodeKind::Contact, LINE),
];

/// Name of the contact line, and of its nodes.
const LINE: &str = "contact line";

/// Look of nodes of a kind, distinct without colours too: round on the low face, a diamond on the high one, a square where clamped.
fn look(kind: NodeKind) -> Look {
    let (symbol, radius, size, paper, screen) = match kind {
        NodeKind::Internal => (Symbol::Circle, 1.3, 2.0, "#b4bcc4", "#808080"),
        NodeKind::Low => (Symbol::Circle, 2.2, 4.0, "#0072b2", "#0072b2"),
        NodeKind::High => (Symbol::Diamond, 2.5, 5.0, "#e69f00", "#e69f00"),
        NodeKind::Clamped => (Symbol::Square, 2.7, 5.0, "#222222", "#009e73"),
        NodeKind::Contact => (Symbol::Circle, 2.6, 6.0, "#d62728", "#d55e00"),
    };
    let colour = Colour { paper: paper.to_owned(), screen: screen.to_owned() };
    Look::filled(symbol, (radius, size), colour).with(paper, "none", 0.0)
}

/// Class of nodes of a kind in the drawing.
fn class(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::Internal => "internal",
        NodeKind::Low => "low",
        NodeKind::High => "high",
        NodeKind::Contact => "contact",
        NodeKind::Clamped => "clamped",
    }
}

/// Sector at the same scale in both directions: across the axis its silhouette with the contact line, the casing at its clearance, what is
/// clamped and the axis of rotation; along the axis, and without elements, its nodes, one of those that cover each other.
pub fn section(geometry: &SectorGeometry, view: SectionView) -> Drawing<'static> {
    let mut sketch = Sketch::new("section", title(geometry, view), vec![words(geometry, view)]).high(640);
    sketch = sketch.meta("units", json!({"x": geometry.units.length, "y": geometry.units.length}));
    if geometry.nodes.is_empty() && geometry.contact.is_empty() {
        return sketch.nothing("Nothing to draw: no node is known").into();
    }
    let section = Section::new(geometry, view, sketch.top() + 24.0);
    let has_wall = section.wall().is_some();
    sketch.more.extend((section.stretch > 1.0 && has_wall).then(|| section.stretch_words()));
    let panel = section.panel();
    let wide = (panel.diagram.right() + 290.0).max(LEFT + 1.15 * text_width(&sketch.title, 18.0));
    Sketch { width: wide.min(sketch.width), ..sketch }.with(panel).into()
}

/// Title: the section and the name of the model.
fn title(geometry: &SectorGeometry, view: SectionView) -> String {
    let subject = match view {
        SectionView::Meridional => "Meridional section",
        SectionView::Cyclic => "Cyclic faces, seen along the axis",
    };
    let name = if geometry.name.is_empty() { String::new() } else { format!(": {}", geometry.name) };
    format!("{subject}{name}")
}

/// Paragraph below the title: numbers of sectors and nodes, and the clearance.
fn words(geometry: &SectorGeometry, view: SectionView) -> String {
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
fn axes(geometry: &SectorGeometry, view: SectionView) -> [String; 2] {
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

/// Section of a sector, and its place in the drawing.
struct Section<'a> {
    geometry: &'a SectorGeometry,
    view: SectionView,
    diagram: Diagram,
    /// Magnification of the clearance.
    stretch: f64,
    /// Ends of the axis of rotation where it is drawn.
    axis: Option<[(f64, f64); 2]>,
}

impl<'a> Section<'a> {
    /// Lays out a section in a diagram that begins at `top`.
    fn new(geometry: &'a SectorGeometry, view: SectionView, top: f64) -> Self {
        let nodes = geometry.nodes.iter().map(|node| node.position);
        let places = nodes.chain(geometry.contact.iter().map(|place| place.position));
        let mut places: Vec<(f64, f64)> = places.map(|position| project(view, position)).collect();
        let axis = axis(view, &places);
        places.extend(axis.into_iter().flatten());
        let diagram = Diagram::of_one_scale(&places, (LEFT, top), (PLOT.0, f64::min(PLOT.1, 734.0 - top)));
        let scale = diagram.width / (diagram.x.values.1 - diagram.x.values.0);
        let clearance = geometry.contact.iter().filter_map(|place| place.clearance).fold(0.0, f64::max);
        let stretch = if clearance > 0.0 { round_up(VISIBLE / (clearance * scale)) } else { 1.0 };
        Self { geometry, view, diagram, stretch, axis }
    }

    fn place(&self, position: [f64; 3]) -> (f64, f64) {
        let (x, y) = project(self.view, position);
        self.diagram.point(x, y)
    }

    /// Nodes of one kind; of nodes that cover each other only one.
    fn seen(&self, kind: NodeKind) -> Vec<&SectorNode> {
        let mut taken = BTreeSet::new();
        let cell = |(x, y): (f64, f64)| ((x / COVERED) as i64, (y / COVERED) as i64);
        let all = self.geometry.nodes.iter().filter(|node| node.kind == kind);
        all.filter(|node| taken.insert(cell(self.place(node.position)))).collect()
    }

    fn panel(&self) -> Panel<'static> {
        let [x, y] = axes(self.geometry, self.view);
        let Diagram { left, top, width, height, .. } = self.diagram;
        let x = Axis::linear(x, self.diagram.x.values, 9.0).one_scale();
        let y = Axis::linear(y, self.diagram.y.values, 8.0).one_scale();
        let mut panel = Panel::new((left, top), (width, height), x, y);
        let has_areas = self.add_areas(&mut panel);
        let wall = self.add_wall(&mut panel);
        for (kind, words) in KINDS {
            if has_areas && !matches!(kind, NodeKind::Clamped | NodeKind::Contact) {
                continue;
            }
            self.add_nodes(&mut panel, kind, words);
        }
        self.add_contact_line(&mut panel);
        if let Some(ends) = self.axis {
            let pen = Pen::new(Colour::neutral("#444444"), Dash::Mixed, 1.0);
            let curve = Curve::new("axis of rotation", ends.map(Some), pen).class("axis");
            panel.sample(curve.sample(), "axis of rotation");
            panel.push(curve);
        }
        if let Some(wall) = wall {
            panel.sample(wall, "casing at rest");
            if self.stretch > 1.0 {
                panel.note(&self.stretch_words());
            }
        }
        panel
    }

    /// Adds the nodes of a kind. Turned into one plane, both cyclic faces coincide.
    fn add_nodes(&self, panel: &mut Panel, kind: NodeKind, words: &'static str) {
        let words = match (self.view, kind) {
            (SectionView::Meridional, NodeKind::High) => return,
            (SectionView::Meridional, NodeKind::Low) => "cyclic faces",
            _ => words,
        };
        let mark = |node: &SectorNode| {
            Mark::new(project(self.view, node.position), format!("node {}, {words}", node.id))
        };
        let marks = Marks::new(words, look(kind), self.seen(kind).into_iter().map(mark)).class(class(kind));
        let is_on_line = kind == NodeKind::Contact && !self.geometry.contact.is_empty();
        if is_on_line || !marks.marks.is_empty() {
            let stroke = line((2.0, 0.0), (MARK_WIDTH - 2.0, 0.0)).set("stroke", "#d62728");
            let stroke = is_on_line.then(|| stroke.set("stroke-width", "2.2"));
            panel.sample(group().children(stroke).child(marks.look.sample()), words);
        }
        panel.push(marks);
    }

    /// Adds the areas of all elements and of the disk; returns whether there are any in this view.
    fn add_areas(&self, panel: &mut Panel) -> bool {
        let SectorGeometry { silhouette, disk, .. } = self.geometry;
        if silhouette.is_empty() || self.view == SectionView::Cyclic {
            return false;
        }
        let stroke = |ring: &Vec<[f64; 2]>| Stroke {
            places: ring.iter().chain(ring.first()).map(|&[z, r]| Some((z, r))).collect(),
            title: String::new(),
        };
        for (name, class, rings, opacity) in
            [(WHEEL, "silhouette", silhouette, "0.22"), (DISK, "disk", disk, "0.4")]
        {
            if rings.is_empty() {
                continue;
            }
            let pen = Pen::new(Colour::neutral("#5a6672"), Dash::Solid, 1.4);
            panel.push(Curve::of(name, rings.iter().map(stroke), pen).class(class).area());
            let patch = rectangle(2.0, -6.0, MARK_WIDTH - 4.0, 12.0).set("fill", "#808a94");
            panel.sample(patch.set("fill-opacity", opacity).set("stroke", "#5a6672"), name);
        }
        true
    }

    /// Points of the casing along the normals, before each contact node; none where its clearance is unknown.
    fn wall(&self) -> Option<Vec<[f64; 3]>> {
        (self.view == SectionView::Meridional).then_some(())?;
        let at = |place: &rubmap_analysis::result::ContactPlace| {
            let [r, theta, z] = place.position;
            let away = self.stretch * place.clearance?;
            Some([r + away * place.normal[0], theta, z + away * place.normal[2]])
        };
        self.geometry.contact.iter().map(at).collect()
    }

    /// Adds the casing at its clearance along the normals, in the drawing with the normals. Returns its sample for the key.
    fn add_wall(&self, panel: &mut Panel) -> Option<Element> {
        let wall = self.wall()?;
        let contact = &self.geometry.contact;
        let every = contact.len().div_ceil(24).max(1);
        let normals = contact.iter().zip(&wall).step_by(every).map(|(place, wall)| {
            let normal = line(self.place(place.position), self.place(*wall));
            normal.set("stroke", "#888888").set("stroke-width", "0.7")
        });
        panel.push(group().children(normals));
        let places = wall.into_iter().map(|place| Some(project(self.view, place)));
        let curve =
            Curve::new("casing at rest", places, Pen::new(Colour::neutral("#444444"), Dash::Solid, 3.0));
        let sample = curve.sample();
        panel.push(curve.title("casing").class("casing").course(Course::Cut));
        Some(sample)
    }

    /// Words for the magnification of the clearance.
    fn stretch_words(&self) -> String {
        format!("its clearance drawn {} times as large", self.stretch)
    }

    /// Adds the contact line, with the clearance of every node where it is known, and labels at its ends.
    fn add_contact_line(&self, panel: &mut Panel) {
        let contact = &self.geometry.contact;
        let told = contact.iter().enumerate().map(|(k, place)| {
            let length = &self.geometry.units.length;
            let clearance =
                place.clearance.map(|known| format!(", clearance {} {length}", significant(known)));
            format!("contact node {k}: node {}{}", place.id, clearance.unwrap_or_default())
        });
        let places = contact.iter().map(|place| Some(project(self.view, place.position)));
        let stroke = Stroke { places: places.collect(), title: LINE.to_owned() };
        let colour = Colour { screen: "#d55e00".to_owned(), ..Colour::warning() };
        let curve = Curve::of(LINE, [stroke], Pen::new(colour, Dash::Solid, 2.2)).class("contact-line");
        if !contact.is_empty() {
            panel.push(curve.each(told.collect()));
            panel.push(self.ends());
        }
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
}

/// Names of the areas that all elements cover, and those between the blades.
const WHEEL: &str = "wheel";
const DISK: &str = "disk, where sectors meet";

/// Ends of the axis of rotation across the axis, somewhat longer than the wheel; none where it is so far away that the wheel would be small.
fn axis(view: SectionView, places: &[(f64, f64)]) -> Option<[(f64, f64); 2]> {
    let ends = |value: fn(&(f64, f64)) -> f64| {
        let values = places.iter().map(value);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)))
    };
    let (z, r) = (ends(|place| place.0), ends(|place| place.1));
    let beyond = 0.06 * (z.1 - z.0);
    let is_near = view == SectionView::Meridional && r.0 <= 0.5 * r.1;
    is_near.then_some([(z.0 - beyond, 0.0), (z.1 + beyond, 0.0)])
}

/// Projects cylindrical coordinates into the plane of a view.
fn project(view: SectionView, [r, theta, z]: [f64; 3]) -> (f64, f64) {
    match view {
        SectionView::Meridional => (z, r),
        SectionView::Cyclic => (r * theta.cos(), r * theta.sin()),
    }
}

/// Rounds up to the next of 1, 2 and 5 times a power of ten; at least 1.
pub(super) fn round_up(value: f64) -> f64 {
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
