//! Casing around the circumference, the paper's Fig. 1: all tips, and the casing in an exaggerated distance from them.

use std::f64::consts::TAU;

use super::axis::significant;
use super::diagram::Diagram;
use super::drawing::Drawing;
use super::layer::{Course, Curve, Mark, Marks, Stroke};
use super::section::round_up;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use rubmap_analysis::result::SectorGeometry;
use serde_json::json;

/// Share of the tips' radius at which the largest distance is drawn, at least.
const VISIBLE: f64 = 0.06;

/// Share of the tips' radius at which the drawn blades begin.
const ROOT: f64 = 0.8;

/// Number of angles at which a circular casing is drawn.
const ANGLES: usize = 720;

const LEFT: f64 = 92.0;
const CASING: &str = "casing at rest";
const PRESSED: &str = "casing farther in than the tips";
const BLADES: &str = "blades";
const CIRCLE: &str = "circle of the tips";

/// Tips at one contact node of all blades, and the casing before them.
struct Ring {
    /// Contact node, counted from the leading edge.
    node: usize,
    radius: f64,
    /// Distance of the casing from the tips at equal angles of the fixed frame; negative where it stands farther in.
    gaps: Vec<f64>,
    /// Angles of the blades' tips at the beginning.
    blades: Vec<f64>,
    /// Magnification of the distances.
    stretch: f64,
}

impl Ring {
    /// Ring of the contact node to which the casing comes closest; none without a casing.
    fn of(geometry: &SectorGeometry) -> Option<Self> {
        let rings = geometry.contact.iter().enumerate().filter_map(|(node, place)| {
            let clearance = place.clearance?;
            let gaps: Vec<f64> = match &place.heights[..] {
                [] => vec![clearance; ANGLES],
                heights => heights.iter().map(|height| clearance - height).collect(),
            };
            Some((node, place.position, gaps))
        });
        let closest = |gaps: &[f64]| gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let (node, [radius, theta, _], gaps) =
            rings.min_by(|a, b| closest(&a.2).total_cmp(&closest(&b.2)))?;
        let pitch = TAU / f64::from(geometry.sectors);
        let blades = (0..geometry.sectors).map(|blade| theta + pitch * f64::from(blade)).collect();
        let largest = gaps.iter().fold(0.0, |most: f64, gap| most.max(gap.abs()));
        let stretch = if largest > 0.0 { round_up(VISIBLE * radius / largest) } else { 1.0 };
        Some(Self { node, radius, gaps, blades, stretch })
    }

    /// Angle of a gap.
    fn angle(&self, index: usize) -> f64 {
        TAU * index as f64 / self.gaps.len() as f64
    }

    /// Point of the casing, wherever its index is in the round.
    fn wall(&self, index: usize) -> (f64, f64) {
        polar(self.radius + self.stretch * self.gaps[index % self.gaps.len()], self.angle(index))
    }

    /// Points of the casing where it stands farther in than the tips; others are gaps of the curve.
    fn pressed(&self) -> Vec<Option<(f64, f64)>> {
        (0..=self.gaps.len())
            .map(|index| (self.gaps[index % self.gaps.len()] < 0.0).then(|| self.wall(index)))
            .collect()
    }

    fn extremes(&self) -> [f64; 2] {
        let all = || self.gaps.iter().copied();
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    }
}

fn polar(radius: f64, angle: f64) -> (f64, f64) {
    (radius * angle.cos(), radius * angle.sin())
}

/// All tips at the contact node to which the casing comes closest, seen along the axis, and the casing before them; its distance is drawn
/// radially and larger than it is, by a factor that the drawing names.
pub fn around(geometry: &SectorGeometry) -> Drawing<'static> {
    let name = if geometry.name.is_empty() { String::new() } else { format!(": {}", geometry.name) };
    let title = format!("Casing around the circumference{name}");
    let length = &geometry.units.length;
    let Some(ring) = Ring::of(geometry) else {
        let nothing = "Nothing to draw: name a job with a casing";
        return Sketch::new("casing", title, Vec::new()).nothing(nothing).into();
    };
    let [least, most] = ring.extremes().map(significant);
    let words = format!(
        "{} tips at radius {} {length}, contact node {} · distance of the casing at rest from {least} to {most} {length}",
        geometry.sectors,
        significant(ring.radius),
        ring.node
    );
    let stretched = format!("distance of the casing drawn {} times as large", ring.stretch);
    let mut sketch = Sketch::new("casing", title, vec![words]).high(640);
    sketch = sketch.meta("units", json!({"x": length, "y": length})).meta("magnification", ring.stretch);
    sketch.more.push(stretched.clone());
    let walls: Vec<(f64, f64)> = (0..=ring.gaps.len()).map(|index| ring.wall(index)).collect();
    let tips = || ring.blades.iter().map(|angle| polar(ring.radius, *angle));
    let places: Vec<(f64, f64)> = walls.iter().copied().chain(tips()).collect();
    let top = sketch.top() + 24.0;
    let Diagram { left, top, width, height, x, y } =
        Diagram::of_one_scale(&places, (LEFT, top), (640.0, 640.0));
    let x = Axis::linear(format!("x, {length}"), x.values, 9.0).free();
    let y = Axis::linear(format!("y, {length}"), y.values, 9.0).one_scale();
    let mut panel = Panel::new((left, top), (width, height), x, y);

    let circle = (0..=ANGLES).map(|k| Some(polar(ring.radius, TAU * k as f64 / ANGLES as f64)));
    let circle = Curve::new(CIRCLE, circle, Pen::new(Colour::neutral("#888888"), Dash::nth(1), 0.9));
    let blades = ring.blades.iter().map(|angle| Stroke {
        places: vec![Some(polar(ROOT * ring.radius, *angle)), Some(polar(ring.radius, *angle))],
        title: String::new(),
    });
    let blades = Curve::of(BLADES, blades, Pen::new(Colour::neutral("#5a6672"), Dash::Solid, 2.4));
    let wall = walls.iter().map(|place| Some(*place));
    let told = (0..=ring.gaps.len()).map(|index| {
        let gap = significant(ring.gaps[index % ring.gaps.len()]);
        format!("at {:.1}°: {gap} {length} from the tips", ring.angle(index).to_degrees())
    });
    let wall = Curve::new(CASING, wall, Pen::new(Colour::neutral("#444444"), Dash::Solid, 3.0))
        .each(told.collect())
        .title(CASING)
        .class("casing")
        .course(Course::Cut);
    let pressed = Curve::new(PRESSED, ring.pressed(), Pen::new(Colour::warning(), Dash::Solid, 4.0))
        .title(PRESSED)
        .class("pressed");
    let tip = Look::filled(Symbol::Circle, (2.6, 6.0), Colour::of("#0072b2"));
    let marks = tips().enumerate().map(|(blade, place)| Mark::new(place, format!("tip of blade {blade}")));
    let marks = Marks::new("tips", tip, marks).class("tip");

    let is_pressed = ring.gaps.iter().any(|gap| *gap < 0.0);
    for curve in [circle, blades, wall].into_iter().chain(is_pressed.then_some(pressed)) {
        let words = curve.name.clone();
        panel.sample(curve.sample(), &words);
        panel.push(curve);
    }
    panel.sample(marks.sample(), "tips");
    panel.note(&stretched);
    panel.push(marks);
    Sketch { width: panel.diagram.right() + 330.0, ..sketch }.with(panel).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wheel of 10 blades whose casing stands inward by 0.4 cos 2φ from a clearance of 0.25 before its second contact node.
    fn oval() -> SectorGeometry {
        let height = |index: u32| 0.4 * (2.0 * TAU * f64::from(index) / 720.0).cos();
        let place = |id: u32, r: f64, clearance: f64, heights: Vec<f64>| json!({"id": id, "position": [r, 0.1, 0.0], "normal": [1.0, 0.0, 0.0], "clearance": clearance, "heights": heights});
        let heights: Vec<f64> = (0..720).map(height).collect();
        let contact = [place(1, 90.0, 0.3, heights.clone()), place(2, 100.0, 0.25, heights)];
        let units = json!({"length": "mm", "force": "N", "time": "s", "mass": "t"});
        let geometry = json!({"name": "w", "sectors": 10, "units": units, "nodes": [], "contact": contact});
        serde_json::from_value(geometry).unwrap()
    }

    #[test]
    fn an_oval_casing_is_drawn_where_it_is_closest_and_marked_where_it_presses() {
        let ring = Ring::of(&oval()).unwrap();
        assert_eq!((ring.node, ring.radius, ring.blades.len()), (1, 100.0, 10));
        assert!((ring.blades[3] - 0.1 - 0.3 * TAU).abs() < 1e-12);
        // The largest distance is 0.65, and 6 of 100 are to be seen.
        assert_eq!(ring.stretch, 10.0);
        let (x, y) = ring.wall(0);
        assert!((x - 98.5).abs() < 1e-9 && y == 0.0, "10 times −0.15 from the tips");
        let (x, y) = ring.wall(180);
        assert!(x.abs() < 1e-9 && (y - 106.5).abs() < 1e-9, "10 times 0.65 from the tips");
        // cos 2φ exceeds 0.625 over this share of the circumference.
        let share = 0.625_f64.acos() / std::f64::consts::PI;
        let pressed = ring.pressed().iter().flatten().count();
        assert!((pressed as f64 - 720.0 * share).abs() < 3.0, "{pressed}");
        let svg = around(&oval()).svg();
        for words in
            ["10 tips at radius 100 mm", "drawn 10 times as large", PRESSED, "from −0.150 to 0.650 mm"]
        {
            assert!(svg.contains(words), "{words}");
        }
    }

    #[test]
    fn a_round_casing_presses_nothing_and_none_is_said() {
        let mut geometry = oval();
        geometry.contact.iter_mut().for_each(|place| place.heights.clear());
        let ring = Ring::of(&geometry).unwrap();
        assert!(ring.pressed().iter().all(Option::is_none));
        assert!(!around(&geometry).svg().contains(PRESSED));
        geometry.contact.iter_mut().for_each(|place| place.clearance = None);
        assert!(around(&geometry).svg().contains("Nothing to draw"));
    }
}
