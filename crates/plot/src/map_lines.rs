//! Layers of a map besides its amplitudes: hatching, engine orders, natural frequencies, crossings, and their labels.

use super::cells::{Cell, rpm, within};
use super::colour::on_dark;
use super::diagram::Diagram;
use super::hatching;
use super::labels::Labels;
use super::layer::{Course, Curve, Layer, Mark, Marks, Place, Stroke};
use super::map_view::{Natural, OrderLine, VerticalAxis, View, is_missing, lobes, missing_words};
use super::marks;
use super::sketch::Panel;
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, INK, group, line, rectangle, text, upright};
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use rubmap_wheel::response::waves::fold;

/// Colour of the linear criterion's crossings on a screen, visible on all amplitudes.
const LINEAR: &str = "#ff77cc";

/// Name of the engine orders that the lobes excite.
const LOBES: &str = "engine orders of lobes";

/// Class of engine orders in the drawing.
const ORDERS: &str = "engine-order";

/// Dark patch of a key, on which a sample shows as on amplitudes.
fn dark(width: f64) -> Element {
    rectangle(0.0, -8.0, width, 16.0).set("fill", "#101010")
}

/// Hatching below the amplitudes, with transparent areas that name the speeds without a result.
pub(super) fn background(map: &InteractionMap, cells: &[Cell], diagram: &Diagram) -> Element {
    let (low, high) = diagram.x.values;
    let missing = within(cells, (low, high)).iter().filter(|cell| is_missing(map, cell)).map(|cell| {
        let (left, right) = (diagram.x.place(cell.from.max(low)), diagram.x.place(cell.to.min(high)));
        let area = rectangle(left, diagram.top, right - left, diagram.height);
        let area = area.set("class", "missing").set("fill", "white").set("fill-opacity", "0");
        area.title(&missing_words(map, cell))
    });
    group().child(diagram.background(hatching::FILL)).children(missing)
}

/// Curves of the engine orders, those that the lobes excite last.
pub(super) fn engine_orders(map: &InteractionMap, view: &View) -> Vec<Curve> {
    let has_lobes = lobes(map) > 1;
    let (excited, others): (Vec<OrderLine>, Vec<OrderLine>) =
        view.order_lines(map).into_iter().partition(|line| line.excited && has_lobes);
    let colour = |paper: &str, screen: &str| Colour {
        paper: format!("rgba(255, 255, 255, {paper})"),
        screen: format!("rgba(176, 176, 176, {screen})"),
    };
    let (words, pen) = match has_lobes {
        true => ("other engine orders", Pen::new(colour("0.6", "0.6"), Dash::Sparse, 1.0)),
        // Nothing distinguishes the lines from each other.
        false => {
            let pen = Pen::new(colour("0.45", "0.6"), Dash::Solid, 1.0);
            ("engine orders", pen.on_screen(Dash::Sparse, 1.0))
        }
    };
    let lines = [(words, others, pen), (LOBES, excited, Pen::new(colour("0.45", "0.45"), Dash::Solid, 1.0))];
    let lines = lines.into_iter().filter(|(_, lines, _)| !lines.is_empty());
    let curve = |(name, lines, pen): (&str, Vec<OrderLine>, Pen)| {
        let stroke = |line: &OrderLine| Stroke { places: line.ends.map(Some).to_vec(), title: String::new() };
        let curve = Curve::of(name, lines.iter().map(stroke), pen).course(Course::Cut).class(ORDERS);
        let is_labelled = view.axis == VerticalAxis::Frequency;
        let labels = lines.iter().filter(|_| is_labelled).map(|line| line.order.to_string());
        // The drawing has numbers beside the frame and at its upper edge.
        Curve { labels: labels.collect(), has_texts: true, ..curve }
    };
    lines.map(curve).collect()
}

/// Adds the engine orders of a panel to its key, those that the lobes excite first.
pub(super) fn explain_orders(panel: &mut Panel<'_>) {
    let rows = panel.layers.iter().rev().filter_map(|layer| match layer {
        Layer::Curve(curve) if curve.class == ORDERS => {
            let stroke = curve.pen.draw(line((3.0, 0.0), (27.0, 0.0)));
            let words = if curve.name == LOBES { "multiples of the lobe count" } else { &curve.name };
            Some((group().child(dark(30.0)).child(stroke), words.to_owned()))
        }
        _ => None,
    });
    for (sample, words) in rows.collect::<Vec<_>>() {
        panel.wide_sample(sample, 30.0, &words);
    }
}

/// Labels of the right axis: engine orders in a map of frequencies, otherwise the nodal diameters that the engine orders drive in a wheel of
/// so many sectors. Engine orders that leave through the top have theirs inside.
pub(super) fn right_axis(map: &InteractionMap, view: &View, sectors: Option<u32>) -> Element {
    let (diagram, lines) = (&view.diagram, view.order_lines(map));
    let is_crowded = lines.len() as f64 * 14.0 > diagram.height;
    let (mut labels, mut is_named) = (group(), false);
    for OrderLine { order, excited, ends: [_, end] } in lines {
        if is_crowded && !excited {
            continue;
        }
        let weight = if excited { "bold" } else { "normal" };
        let (x, y) = diagram.point(end.0, end.1);
        let words = match (view.axis, sectors) {
            (VerticalAxis::Frequency, _) if x < diagram.right() - 0.5 => {
                let label = text(x - 8.0, y + 15.0, "end", &order.to_string()).set("font-size", "11");
                let label = label.set("font-weight", weight);
                let fill = if excited { "white" } else { "#cccccc" };
                labels = labels.child(label.set("fill", fill).rimmed("#101010"));
                continue;
            }
            (VerticalAxis::Frequency, _) => order,
            (VerticalAxis::EngineOrder, Some(sectors)) => fold(order, sectors),
            (VerticalAxis::EngineOrder, None) => continue,
        };
        is_named = true;
        let label = text(x + 6.0, y + 4.0, "start", &words.to_string()).set("class", "right-axis");
        let label = label.set("font-size", "11").set("font-weight", weight);
        labels = labels.child(label.set("fill", if excited { INK } else { "#777777" }));
    }
    let title = match view.axis {
        VerticalAxis::EngineOrder => "nodal diameter that engine order k drives",
        VerticalAxis::Frequency => "engine order k, f = kΩ/2π",
    };
    let middle = diagram.top + 0.5 * diagram.height;
    labels.children(is_named.then(|| upright(diagram.right() + 40.0, middle, "middle", title)))
}

/// Nodal diameters that the engine orders drive in a wheel of so many sectors, at the heights of the orders; none over frequency.
pub(super) fn driven_diameters(
    map: &InteractionMap,
    view: &View,
    sectors: Option<u32>,
) -> Vec<(f64, String)> {
    let Some(sectors) = sectors.filter(|_| view.axis == VerticalAxis::EngineOrder) else { return Vec::new() };
    let lines = view.order_lines(map);
    let is_crowded = lines.len() as f64 * 14.0 > view.diagram.height;
    let named = lines.into_iter().filter(|line| line.excited || !is_crowded);
    named.map(|line| (line.ends[1].1, fold(line.order, sectors).to_string())).collect()
}

/// Number of nodal diameters with natural frequencies.
fn harmonics(campbell: &Campbell) -> usize {
    campbell.frequencies_hz.first().map_or(0, Vec::len)
}

/// Curves of the natural frequencies in the rotating frame, those of a nodal diameter under one name.
pub(super) fn natural_frequencies(campbell: &Campbell, view: &View) -> Vec<Curve> {
    let (count, all) = (harmonics(campbell), view.natural(campbell));
    let curve = |i: usize| {
        let here = || all.iter().filter(move |natural| natural.nodal_diameter == i);
        let stroke = |natural: &Natural| Stroke { places: natural.places.clone(), title: natural.words() };
        let colour = Colour { paper: on_dark(i, count), ..Colour::ordinal(i, count) };
        // Numbers at the curves distinguish them on paper.
        let pen = Pen::new(colour, Dash::Solid, 1.0).on_screen(Dash::nth(i), 1.3);
        let told = here().flat_map(|natural| vec![natural.words(); natural.places.len()]).collect();
        let curve = Curve::of(&format!("nodal diameter {i}"), here().map(stroke), pen).each(told);
        Curve { opacity: 0.85, ..curve.course(Course::Cut).class("natural") }
    };
    (0..count).map(curve).collect()
}

/// Adds natural frequencies to the key of a panel, of many only the first and the last.
pub(super) fn explain_natural(campbell: &Campbell, panel: &mut Panel<'_>) {
    let count = harmonics(campbell);
    let shown = (0..count).filter(|i| count <= 12 || *i == 0 || i + 1 == count);
    let numbers = shown.enumerate().map(|(place, i)| {
        let (x, colour) = (30.0 * place as f64, on_dark(i, count));
        let stroke = line((x + 4.0, 0.0), (x + 14.0, 0.0)).set("stroke", &colour);
        let number = text(x + 17.0, 4.0, "start", &i.to_string()).set("fill", &colour);
        group().child(stroke.set("stroke-width", "1.6")).child(number.set("font-size", "11"))
    });
    let numbers: Vec<Element> = numbers.collect();
    let width = 30.0 * numbers.len() as f64;
    if count > 0 {
        let sample = group().child(dark(width)).children(numbers);
        panel.wide_sample(sample, width, "natural frequencies of nodal diameter i");
    }
}

/// Crossing in view of a natural frequency: its place, words, and label.
struct Crossed {
    place: Place,
    words: String,
    label: String,
}

/// Crossings in view of natural frequencies with the linear criterion.
fn linear_crossings(critical: &CriticalSpeeds, view: &View) -> Vec<Crossed> {
    let found = critical.linear_crossings.iter().filter_map(|found| {
        let order = f64::from(found.nodal_diameter * found.superharmonic);
        let place = view.seen(rpm(found.speed_rad_s), order)?;
        Some(Crossed { place, words: marks::linear_words(found), label: marks::triple(found) })
    });
    found.collect()
}

/// Crossings in view of natural frequencies with engine orders of the lobes.
fn driven_crossings(critical: &CriticalSpeeds, view: &View) -> Vec<Crossed> {
    let found = critical.driven_crossings.iter().filter_map(|found| {
        let place = view.seen(rpm(found.speed_rad_s), f64::from(found.engine_order))?;
        Some(Crossed { place, words: marks::driven_words(found), label: marks::pair(found) })
    });
    found.collect()
}

/// Adds the crossings of natural frequencies, and their rows in the key.
pub(super) fn add_crossings(critical: &CriticalSpeeds, view: &View, panel: &mut Panel<'_>) {
    let colour = |paper: &str, screen: &str| Colour { paper: paper.to_owned(), screen: screen.to_owned() };
    let ring = Look::open(Symbol::Circle, (4.5, 10.0), colour("white", LINEAR));
    let diamond = Look::filled(Symbol::Diamond, (4.4, 9.0), Colour::of(marks::DRIVEN)).with(
        marks::DRIVEN,
        "black",
        1.0,
    );
    let marks = |name: &str, look: Look, found: Vec<Crossed>| {
        Marks::new(name, look, found.into_iter().map(|crossed| Mark::new(crossed.place, crossed.words)))
    };
    let linear = marks("linear (i, j, n)", ring, linear_crossings(critical, view));
    let driven = marks("driven (i, j)", diamond, driven_crossings(critical, view));
    for (marks, words) in
        [(&driven, "driven by the lobes, (i, j)"), (&linear, "linear criterion (i, j, n) at k = i·n")]
    {
        if !marks.marks.is_empty() {
            let mark = marks.look.draw((8.0, 0.0), marks.look.radius, None);
            panel.wide_sample(group().child(dark(16.0)).child(mark), 16.0, words);
        }
    }
    panel.push(linear);
    panel.push(driven);
}

/// Labels of crossings, and numbers of nodal diameters at their natural frequencies, where there is room, legible on amplitudes.
pub(super) fn labels(critical: Option<&CriticalSpeeds>, natural: &[Curve], view: &View) -> Element {
    let mut labels = Labels::inside(&view.diagram);
    let found = critical.map(|critical| [linear_crossings(critical, view), driven_crossings(critical, view)]);
    let found: Vec<Crossed> = found.into_iter().flatten().flatten().collect();
    let place = |(x, y): &Place| view.diagram.point(*x, *y);
    found.iter().for_each(|crossed| labels.keep_off(place(&crossed.place), 4.0));
    let mut drawn = group();
    for crossed in &found {
        let label = labels.beside(place(&crossed.place), 5.0, &crossed.label, 10.5);
        drawn = drawn.children(label.map(|label| label.set("fill", "white").rimmed("#101010")));
    }
    for (i, curve) in natural.iter().enumerate() {
        for stroke in &curve.strokes {
            let seen = stroke.places.iter().flatten().map(place);
            let seen: Vec<Place> = seen.filter(|place| view.diagram.encloses(*place)).collect();
            let stretches = [0.97, 0.85, 0.7, 0.5, 0.3, 0.1, 0.03];
            let tried = stretches.map(|share| seen.get((share * seen.len() as f64) as usize).copied());
            let number = labels.at_first(tried.into_iter().flatten(), &i.to_string(), 11.0);
            let number =
                number.map(|label| label.set("fill", &curve.pen.colour.paper).set("font-weight", "bold"));
            drawn = drawn.children(number.map(|label| label.rimmed("#101010")));
        }
    }
    drawn
}

/// Adds the reason for hatching to the key of a panel, if there is any in view.
pub(super) fn explain_hatching(map: &InteractionMap, cells: &[Cell], view: &View, panel: &mut Panel<'_>) {
    if has_missing(map, cells, view) {
        panel.wide_sample(hatching::mark(), 20.0, "no result");
    } else if view.reaches_beyond(map) {
        panel.wide_sample(hatching::mark(), 20.0, "beyond the spectra");
    }
}

/// Whether a speed in view has no result.
pub(super) fn has_missing(map: &InteractionMap, cells: &[Cell], view: &View) -> bool {
    within(cells, view.diagram.x.values).iter().any(|cell| is_missing(map, cell))
}
