//! Surface of a wheel or of one of its sectors with a field on it, hidden parts hidden.

mod depths;
mod levels;
mod shape;
mod view;

use rubmap_analysis::result::FieldSurface;

use super::axis::{Scale, label, significant, ticks};
use super::diagram::Diagram;
use super::key::Flow;
use super::pixels::{self, DENSITY, MISSING};
use super::svg::{Element, document, group, line, rectangle, text_width};
use super::{colour, colour_bar, hatching, heading, marks};
use depths::{Depths, Fragment, Side};
use levels::{Levels, OF_EDGE, OF_INSIDE, OF_REST};
use shape::Shape;
use view::{Camera, LARGEST_SHARE};

pub use view::SurfaceView;

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 92.0;
const PLOT: (f64, f64) = (900.0, 700.0);

/// Depth by which an edge may lie behind the faces it belongs to, in pixels.
const TOLERANCE: f64 = 3.0;

/// Draws a surface as it is displaced, coloured by its values, at the same scale in both directions.
///
/// Hidden surfaces are hidden pixel by pixel; an image of a fixed size with a palette carries the surface, so that a drawing of a hundred
/// thousand faces is as large as one of a hundred. Colours are bands between round values: light and shade darken them and move no
/// border. Displacement is drawn so large that the largest one is a twentieth of the wheel's radius, which the heading says; the outline at
/// rest is drawn over it. Nodes without a value are hatched. Close the surface of a sector by its cyclic faces if they are to be seen: what
/// is open shows its inside, in a colour of its own.
pub fn surface(surface: &FieldSurface, view: SurfaceView) -> String {
    let camera = Camera::new(view, &surface.nodes);
    let stretch = view::stretch(surface);
    let moved = |(index, node): (usize, &[f64; 3])| {
        let displacement = surface.displacement.get(index).copied().unwrap_or_default();
        camera.project([0, 1, 2].map(|axis| node[axis] + stretch * displacement[axis]))
    };
    let displaced: Vec<[f64; 3]> = surface.nodes.iter().enumerate().map(moved).collect();
    let at_rest: Vec<[f64; 3]> = surface.nodes.iter().map(|node| camera.project(*node)).collect();

    let words = paragraphs(surface, camera, stretch);
    let (heading, bottom) = heading::heading(LEFT, &surface.title, &words, None);
    let seen = |places: &[[f64; 3]]| places.iter().map(|place| (place[0], place[1])).collect::<Vec<_>>();
    let all = [seen(&displaced), seen(&at_rest)].concat();
    let diagram = Diagram::of_one_scale(&all, (LEFT, bottom + 24.0), PLOT);
    let picture = Picture::new(surface, &diagram, displaced, (stretch > 0.0).then_some(at_rest));

    let (x, y) = (ticks(diagram.x.values, 9.0), ticks(diagram.y.values, 8.0));
    let axes = camera.axes().map(|axis| format!("{axis}, {}", surface.length_unit));
    let mut content = vec![hatching::definition(), heading, diagram.grid(&x, &y)];
    match &picture {
        Some(picture) => content.extend([picture.image(&diagram), picture.largest_mark(surface)]),
        None => content.push(diagram.words("Nothing to draw: the surface has no faces")),
    }
    content.extend([diagram.frame(), diagram.x_axis(&x, &axes[0]), diagram.y_axis(&y, &axes[1], 66.0)]);
    let levels = picture.as_ref().and_then(|picture| picture.levels.as_ref());
    let differs = largest(&surface.colour.values).is_some();
    content.extend(levels.filter(|_| differs).map(|levels| bar(levels, surface, &diagram)));
    let widest = words
        .iter()
        .map(|line| text_width(line, 13.0))
        .fold(1.15 * text_width(&surface.title, 18.0), f64::max);
    let width = (diagram.right() + 150.0).max(LEFT + widest + 20.0).min(WIDTH);
    content.extend(picture.map(|picture| picture.key(surface, (width, diagram.bottom() + 66.0))));
    document(&surface.title, width, diagram.bottom() + 110.0, content)
}

/// Paragraphs below the title: subtitles of the surface, the view, and the magnification of displacements.
fn paragraphs(surface: &FieldSurface, camera: Camera, stretch: f64) -> Vec<String> {
    let mut words = surface.subtitles.clone();
    let drawn = if stretch > 0.0 {
        format!(
            "displacements drawn {} times as large: the largest as {:.0} % of the wheel's radius",
            two_digits(stretch),
            100.0 * LARGEST_SHARE
        )
    } else {
        "nothing is displaced".to_owned()
    };
    words.push(format!("{} · {drawn}", camera.words()));
    words.push("darker where a surface turns away".to_owned());
    words
}

fn bar(levels: &Levels, surface: &FieldSurface, diagram: &Diagram) -> Element {
    let scale = Scale::linear(levels.values, (diagram.bottom(), diagram.top));
    let colour = &surface.colour;
    let unit = if colour.unit.is_empty() { String::new() } else { format!(", {}", colour.unit) };
    let title = format!("{}{unit}", colour.quantity);
    colour_bar::draw(levels.stops(), &scale, diagram.right() + 26.0, &levels.borders, &title)
}

/// Surface as the drawing shows it.
struct Picture {
    levels: Option<Levels>,
    depths: Depths,
    /// Palette indices of the pixels, line by line.
    indices: Vec<u8>,
    /// Position in the drawing of the node with the largest value, this value, and whether the node can be seen.
    largest: Option<((f64, f64), f64, bool)>,
    /// Whether the outline at rest is drawn.
    rests: bool,
}

impl Picture {
    /// Draws a surface into pixels; none without faces.
    fn new(
        surface: &FieldSurface,
        diagram: &Diagram,
        displaced: Vec<[f64; 3]>,
        at_rest: Option<Vec<[f64; 3]>>,
    ) -> Option<Self> {
        let (width, height) = ((diagram.width * DENSITY) as usize, (diagram.height * DENSITY) as usize);
        let per_unit = DENSITY * diagram.width / (diagram.x.values.1 - diagram.x.values.0);
        let pixels = |[x, y, depth]: [f64; 3]| {
            let (x, y) = diagram.point(x, y);
            [DENSITY * (x - diagram.left), DENSITY * (y - diagram.top), per_unit * depth]
        };
        let shape = Shape::new(surface, displaced.into_iter().map(pixels).collect());
        if shape.is_empty() {
            return None;
        }
        let values = &surface.colour.values;
        let levels = Levels::of(values);
        let mut depths = Depths::new(width, height);
        shape.draw(values, &mut depths);
        let colour = |(index, fragment): (usize, &Fragment)| match fragment.side {
            Side::Nothing => MISSING,
            Side::Inside => levels::shade(OF_INSIDE, f64::from(fragment.light)),
            Side::Outside => {
                let colour = levels::of_value(
                    levels.as_ref(),
                    f64::from(fragment.value),
                    (index % width, index / width),
                );
                levels::shade(colour, f64::from(fragment.light))
            }
        };
        let mut indices: Vec<u8> = depths.fragments().iter().enumerate().map(colour).collect();
        for edge in shape.edges() {
            draw_edge(edge, &depths, &mut indices);
        }
        let rests = at_rest.is_some();
        if let Some(at_rest) = at_rest {
            let mut covered = Depths::new(width, height);
            Shape::new(surface, at_rest.into_iter().map(pixels).collect()).draw(&[], &mut covered);
            draw_outline(&covered, &mut indices);
        }
        let largest = largest(values).and_then(|(node, value)| {
            let [x, y, depth] = *shape.places.get(node)?;
            let place = (diagram.left + x / DENSITY, diagram.top + y / DENSITY);
            diagram.encloses(place).then(|| (place, value, depths.shows([x, y, depth], TOLERANCE)))
        });
        Some(Self { levels, depths, indices, largest, rests })
    }

    fn image(&self, diagram: &Diagram) -> Element {
        let palette = levels::palette(self.levels.as_ref());
        pixels::over(
            diagram,
            pixels::data_uri((self.depths.width, self.depths.height), palette, &self.indices),
        )
    }

    /// Ring about the node with the largest value, if it can be seen.
    fn largest_mark(&self, surface: &FieldSurface) -> Element {
        let Some((place, value, true)) = self.largest else { return group() };
        let words =
            format!("largest {}: {}", surface.colour.quantity, with_unit(value, &surface.colour.unit));
        let rim = Element::new("circle").number("cx", place.0).number("cy", place.1).number("r", 6.0);
        let rim = rim.set("fill", "white").set("fill-opacity", "0.6");
        group().set("class", "largest").child(rim).child(marks::ring(place, "#d62728")).title(&words)
    }

    /// Key of the marks that occur.
    fn key(&self, surface: &FieldSurface, (width, y): (f64, f64)) -> Element {
        let mut flow = Flow::new(LEFT, width - 20.0, y);
        let patch = |rgb: [u8; 3]| {
            rectangle(0.0, -7.0, 20.0, 14.0).set("fill", colour::hex(rgb)).set("stroke", "#888888")
        };
        if let Some((_, value, is_seen)) = self.largest {
            let value = with_unit(value, &surface.colour.unit);
            flow = if is_seen {
                flow.entry(marks::ring((6.0, 0.0), "#d62728"), 12.0, &format!("largest: {value}"))
            } else {
                flow.entry(group(), 0.0, &format!("largest: {value}, hidden here"))
            };
        }
        let fragments = self.depths.fragments();
        let pixels = |of: &dyn Fn(&Fragment) -> bool| fragments.iter().filter(|seen| of(seen)).count();
        let covered = pixels(&|seen| seen.side != Side::Nothing);
        // Hatching cannot be seen on single pixels.
        if 1000 * pixels(&|seen| seen.side == Side::Outside && seen.value.is_nan()) > covered {
            let words =
                if self.levels.is_some() { "nothing claimed: near contact nodes" } else { "no values" };
            flow = flow.entry(hatching::mark(), 20.0, words);
        }
        // At the rim of a closed surface, single pixels show its far side.
        if 1000 * pixels(&|seen| seen.side == Side::Inside) > covered {
            flow = flow.entry(patch(levels::INSIDE), 20.0, "inside of an open surface");
        }
        if self.rests {
            let stroke = line((0.0, 0.0), (24.0, 0.0)).set("stroke", colour::hex(levels::AT_REST));
            flow = flow.entry(stroke.set("stroke-width", "1.2"), 24.0, "outline at rest");
        }
        flow.draw()
    }
}

/// Formats a factor of two digits.
fn two_digits(value: f64) -> String {
    match value.log10().floor() {
        power if (-4.0..6.0).contains(&power) => label(value, (1.0 - power).max(0.0) as usize),
        _ => format!("{value:.1e}"),
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", significant(value)).trim_end().to_owned()
}

/// Index and value of the node with the largest value; none where all values are 0.
fn largest(values: &[Option<f64>]) -> Option<(usize, f64)> {
    let found = values.iter().enumerate().filter_map(|(node, value)| Some((node, (*value)?)));
    let known: Vec<(usize, f64)> = found.filter(|(_, value)| value.is_finite()).collect();
    let all_zero = known.iter().all(|(_, value)| *value == 0.0);
    known.into_iter().filter(|_| !all_zero).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Draws an edge, two pixels wide, where nothing hides it.
fn draw_edge([from, to]: [[f64; 3]; 2], depths: &Depths, indices: &mut [u8]) {
    let length = f64::max((to[0] - from[0]).abs(), (to[1] - from[1]).abs());
    // No edge is longer than the image, whose diagram has room for all nodes.
    let steps = length.ceil().clamp(1.0, (depths.width + depths.height) as f64);
    for step in 0..=steps as usize {
        let share = step as f64 / steps;
        let place = [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        if !depths.shows(place, TOLERANCE) {
            continue;
        }
        let first = |value: f64| (value - 0.5).floor().max(0.0) as usize;
        let (column, line) = (first(place[0]), first(place[1]));
        for (column, line) in [(column, line), (column + 1, line), (column, line + 1), (column + 1, line + 1)]
        {
            if column < depths.width && line < depths.height {
                indices[line * depths.width + column] = OF_EDGE;
            }
        }
    }
}

/// Draws the border of the covered pixels, two pixels wide, over everything else.
fn draw_outline(covered: &Depths, indices: &mut [u8]) {
    let is_covered = |column: usize, line: usize| covered.at(column, line).side != Side::Nothing;
    for line in 1..covered.height.max(1) - 1 {
        for column in 1..covered.width.max(1) - 1 {
            let beside = [(column - 1, line), (column + 1, line), (column, line - 1), (column, line + 1)];
            let here = is_covered(column, line);
            if beside.iter().any(|(column, line)| is_covered(*column, *line) != here) {
                indices[line * covered.width + column] = OF_REST;
            }
        }
    }
}
