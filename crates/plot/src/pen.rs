//! Pen that draws a sketch as SVG.

use super::axis::{Scale, logarithmic_ticks, ticks};
use super::colour_bar;
use super::diagram::Diagram;
use super::heading;
use super::key::{Flow, Key};
use super::labels::{Labels, traced};
use super::layer::{
    Area, Areas, Bars, Cells, Course, Curve, Hover, Layer, Mark, Marks, Place, Reach, Stroke, Upright,
    Uprights,
};
use super::marks::spread;
use super::pixels::Pixels;
use super::sketch::{Panel, Row, Sketch, Stand};
use super::style::{Dash, Pen};
use super::svg::{Element, document, group, line, polyline, rectangle, text, upright};
use super::trace::Trace;

/// Size of an empty frame with a message.
const EMPTY: (f64, f64) = (800.0, 420.0);

/// Colour of areas, of which as much shows as in figures.
const AREA: &str = "#808a94";

/// Height of a strip along the upper edge of a panel.
const STRIP: f64 = 7.0;

/// Draws a sketch.
pub(super) fn svg(sketch: &Sketch) -> String {
    let (heading, bottom) =
        heading::heading(sketch.left, &sketch.title, &sketch.paragraphs, sketch.warning.as_ref());
    let mut content = vec![heading];
    let panels = || sketch.panels.iter().filter(|panel| !panel.is_shown_only);
    let foot = panels().map(|panel| panel.diagram.bottom()).fold(bottom, f64::max);
    let shared = panels().filter(|panel| !panel.is_apart);
    let lowest = shared.map(|panel| panel.diagram.bottom()).fold(0.0, f64::max);
    let mut height = foot + 66.0;
    if let Some(words) = &sketch.nothing {
        let frame = Diagram::new((sketch.left, bottom + 24.0), EMPTY, (0.0, 1.0), (0.0, 1.0));
        height = frame.bottom() + 66.0;
        content.extend([frame.frame(), frame.words(words)]);
    }
    for panel in panels() {
        content.extend(draw(panel, panel.is_apart || panel.diagram.bottom() == lowest));
        let (key, end) = key(panel, sketch.width);
        content.push(key);
        height = height.max(end + 26.0);
    }
    content.extend(panels().flat_map(uprights));
    content.extend(common_bar(&sketch.panels));
    if let Some(line) = &sketch.foot {
        height = sketch.least.max(height + 16.0);
        content
            .push(group().set("transform", format!("translate(0 {:.2})", height - 18.0)).child(line.clone()));
    }
    if let Some(words) = sketch.footnote.as_ref().filter(|words| !words.is_empty()) {
        height += 24.0;
        let note = text(sketch.left, height - 16.0, "start", words).set("class", "left-out");
        content.push(note.set("font-size", "12").set("fill", "#555555"));
    }
    document(&sketch.title, sketch.width, height, content)
}

/// Draws a panel; the lowest has the ticks and the title of the horizontal axis.
fn draw(panel: &Panel, is_lowest: bool) -> Vec<Element> {
    let diagram = &panel.diagram;
    let mut content = vec![diagram.grid(&panel.x.ticks, &panel.y.ticks)];
    let is_cut = |layer: &Layer| matches!(layer, Layer::Curve(curve) if curve.course == Course::Cut);
    let region = format!("frame-{:.0}-{:.0}-{:.0}", diagram.left, diagram.top, diagram.bottom());
    content.extend(panel.layers.iter().any(is_cut).then(|| diagram.region(&region)));
    for layer in &panel.layers {
        content.push(match layer {
            Layer::Curve(found) => {
                let clip = (found.course == Course::Cut).then(|| format!("url(#{region})"));
                curve(panel, found, clip)
            }
            Layer::Marks(found) => marks(panel, found),
            Layer::Cells(found) if !found.data.is_empty() => continue,
            Layer::Cells(found) => cells(panel, found),
            Layer::Areas(found) => areas(panel, found),
            Layer::Heat(heat) => {
                let range = panel.ramp.as_ref().map_or((1.0, 10.0), |ramp| ramp.range);
                heat.image(diagram, &Scale::logarithmic(range, (0.0, 1.0)))
            }
            Layer::Drawn(element) => element.clone(),
            // Upright lines go through several panels and are drawn after all of them.
            Layer::Uprights(_) | Layer::Shown(_) => continue,
        });
    }
    content.push(stems(panel));
    content.push(diagram.frame());
    content.push(labels(panel));
    content.extend(is_lowest.then(|| diagram.x_axis(&panel.x.ticks, &panel.x.title)));
    content.push(diagram.y_axis(&panel.y.ticks, &panel.y.title, panel.y.away));
    if panel.across.is_none() {
        content.extend(bar_of(panel, diagram));
    }
    content.extend(
        panel.name.as_ref().map(|name| {
            text(diagram.left, diagram.top - 8.0 - STRIP, "start", name).set("font-weight", "bold")
        }),
    );
    content
}

/// Draws the bar of colours that panels side by side share.
fn common_bar(panels: &[Panel]) -> Option<Element> {
    let first = panels.first().filter(|panel| panel.across.is_some())?;
    let right = panels.iter().map(|panel| panel.diagram.right()).fold(0.0, f64::max);
    let bottom = panels.iter().map(|panel| panel.diagram.bottom()).fold(0.0, f64::max);
    let Diagram { left, top, .. } = first.diagram;
    bar_of(first, &Diagram { width: right - left, height: bottom - top, ..first.diagram })
}

/// Draws upright lines from above a panel down to its foot, with their labels, which are moved apart.
fn uprights(panel: &Panel) -> Vec<Element> {
    let layers = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Uprights(uprights) => Some(uprights),
        _ => None,
    });
    let lines =
        layers.flat_map(|all| all.lines.iter().map(move |line| (panel.diagram.x.place(line.x), all, line)));
    let mut lines: Vec<(f64, &Uprights, &Upright)> = lines.collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    let places: Vec<f64> = lines.iter().map(|(x, ..)| *x).collect();
    let apart = spread(&places, panel.diagram.right());
    let drawn = lines.into_iter().zip(apart).map(|((x, of, found), label)| {
        let long = of.pen.draw(line((x, of.top), (x, panel.diagram.bottom()))).set("class", of.class);
        let lead = line((label, of.top - 12.0), (x, of.top)).set("stroke", &of.pen.colour.paper);
        let words = upright(label + 4.5, of.top - 16.0, "start", &found.label);
        let words = words.set("fill", heading::WARNING).set("font-size", "12");
        group().child(long.title(&format!("{}{}", found.label, found.more))).child(lead).child(words)
    });
    drawn.collect()
}

/// Draws rectangles, cut off at the sides of the frame.
fn areas(panel: &Panel, areas: &Areas) -> Element {
    let (diagram, (low, high)) = (&panel.diagram, panel.x.range);
    let draw = |area: &Area| {
        let (from, to) = (diagram.x.place(area.across.0.max(low)), diagram.x.place(area.across.1.min(high)));
        let (bottom, top) = match area.upwards {
            Some((foot, head)) => (diagram.y.place(foot), diagram.y.place(head)),
            None => (diagram.top, diagram.top - STRIP),
        };
        let drawn = rectangle(from, top, to - from, bottom - top).set("class", areas.class);
        drawn.set("fill", &areas.fill).title(&area.words)
    };
    group().children(areas.areas.iter().map(draw))
}

/// Draws the strokes of a curve within a clipping region, the marks at their points, and the words at their ends.
fn curve(panel: &Panel, curve: &Curve, clip: Option<String>) -> Element {
    let diagram = &panel.diagram;
    let area = curve.is_area.then(|| {
        let ring = |one: &Stroke| one.places.iter().copied().chain([None]).collect::<Vec<_>>();
        let places = curve.strokes.iter().flat_map(ring);
        let area = polyline(places.map(|place| place.map(|(x, y)| diagram.point(x, y))));
        area.set("class", "area").set("style", format!("fill:{AREA};fill-opacity:0.22;fill-rule:evenodd"))
    });
    let strokes = group().children(area).children(curve.strokes.iter().map(|one| stroke(panel, curve, one)));
    let strokes = match clip {
        Some(clip) => strokes.set("clip-path", clip),
        None => strokes,
    };
    // Words are those of places, gaps among them.
    let places = curve.strokes.iter().flat_map(|stroke| &stroke.places).enumerate();
    let points = places.filter_map(|(index, place)| Some((index, (*place)?)));
    let marks = curve.look.iter().flat_map(|look| {
        points.clone().filter_map(|(index, (x, y))| {
            let mark = look.draw(diagram.inside(x, y)?, look.radius, None);
            Some(match &curve.hover {
                Hover::Each(words) => mark.set("class", "point").title(words.get(index)?),
                Hover::Nothing | Hover::Template(..) => mark,
            })
        })
    });
    let ends = curve.strokes.iter().zip(&curve.labels);
    let ends = ends.filter(|(_, words)| !curve.has_texts && !words.is_empty());
    let labels = ends
        .filter_map(|(stroke, words)| Some(end(panel, *stroke.places.iter().flatten().next_back()?, words)));
    group().child(strokes).children(marks).children(labels)
}

/// Words at the end of a line: above the frame where it leaves at the top, otherwise before the end.
fn end(panel: &Panel, (x, y): Place, words: &str) -> Element {
    let to = panel.diagram.point(x, y);
    let (x, y, anchor) = match to.1 <= panel.diagram.top + 0.5 {
        true => (to.0, to.1 - 6.0, "middle"),
        false => (to.0 - 12.0, to.1 - 4.0, "end"),
    };
    text(x, y, anchor, words).set("font-size", "11").set("fill", "#555555").rimmed("white")
}

fn stroke(panel: &Panel, curve: &Curve, stroke: &Stroke) -> Element {
    let diagram = &panel.diagram;
    let place = |(x, y): Place| match curve.course {
        Course::Cut | Course::History => Some(diagram.point(x, y)),
        Course::Straight | Course::Steps => diagram.inside(x, y),
    };
    let places = || stroke.places.iter().map(|found| found.and_then(place));
    let drawn = match curve.course {
        Course::Straight | Course::Cut => match &stroke.places[..] {
            // A line through one point is invisible.
            [Some(alone)] if curve.look.is_none() => match place(*alone) {
                Some((x, y)) => {
                    let dot = Element::new("circle")
                        .number("cx", x)
                        .number("cy", y)
                        .number("r", (0.5 * curve.pen.width).max(2.4));
                    dot.set("fill", &curve.pen.colour.paper)
                }
                None => group(),
            },
            _ => curve.pen.draw(polyline(thinned(places()))).set("stroke-linejoin", "round"),
        },
        Course::Steps => curve.pen.draw(polyline(steps(panel, places().flatten()))),
        Course::History => {
            let trace = Trace::of(places().flatten().collect(), diagram.x.place(1.0) - diagram.x.place(0.0));
            let is_history =
                |layer: &&Layer| matches!(layer, Layer::Curve(curve) if curve.course == Course::History);
            trace.drawn(&curve.pen, panel.layers.iter().filter(is_history).count() > 2)
        }
    };
    let drawn = if curve.opacity < 1.0 { drawn.number("opacity", curve.opacity) } else { drawn };
    let drawn = if curve.class.is_empty() { drawn } else { drawn.set("class", curve.class) };
    if stroke.title.is_empty() { drawn } else { drawn.title(&stroke.title) }
}

/// Leaves out points of a long line that are too close to the one before to be seen.
fn thinned(places: impl ExactSizeIterator<Item = Option<Place>>) -> Vec<Option<Place>> {
    /// Number of points of a line that is left as it is.
    const FEW: usize = 4000;
    const LEAST: f64 = 0.5;
    if places.len() <= FEW {
        return places.collect();
    }
    let mut left: Vec<Option<Place>> = Vec::new();
    for place in places {
        let before = left.last().copied().flatten().zip(place);
        let is_hidden = before.is_some_and(|(a, b)| f64::hypot(a.0 - b.0, a.1 - b.1) < LEAST);
        if !is_hidden {
            left.push(place);
        }
    }
    left
}

/// Corners of steps from the top of a panel down to each point, and on to the right.
fn steps(panel: &Panel, points: impl Iterator<Item = Place>) -> Vec<Option<Place>> {
    let (mut corners, mut height) = (Vec::new(), panel.diagram.top);
    for (x, y) in points {
        corners.extend([Some((x, height)), Some((x, y))]);
        height = y;
    }
    corners.push(Some((panel.diagram.right(), height)));
    corners
}

/// Draws marks with their error bars.
fn marks(panel: &Panel, marks: &Marks) -> Element {
    let ends = |bars: &Option<Bars>, is_level: bool| -> Vec<Element> {
        let lengths =
            bars.iter().flat_map(|bars| bars.lengths.iter().zip(&marks.marks).map(move |both| (bars, both)));
        let known = lengths.filter(|(_, (reach, _))| reach.above.is_finite());
        known.filter_map(|(bars, (reach, mark))| bar(panel, bars, mark, *reach, is_level)).collect()
    };
    let standing = marks.stems.is_some();
    let drawn = marks.marks.iter().filter(|_| !standing).filter_map(|mark| {
        let place = panel.diagram.inside(mark.place.0, mark.place.1)?;
        let radius = mark.radius.unwrap_or(marks.look.radius);
        let drawn = match marks.beam {
            Some(height) => beam(panel, place, height).set("fill", &marks.look.colour.paper),
            None => marks.look.draw(place, radius, mark.colour.as_deref()),
        };
        Some(drawn.set("class", marks.class).title(&mark.words))
    });
    let bars = ends(&marks.across, true).into_iter().chain(ends(&marks.bars, false));
    match marks.beam {
        Some(_) => group().children(drawn).children(bars),
        None => group().children(bars).children(drawn),
    }
}

/// Bar from zero to a place of the drawing.
fn beam(panel: &Panel, (x, y): Place, height: f64) -> Element {
    let zero = panel.diagram.x.place(0.0);
    rectangle(zero.min(x), y - 0.5 * height, (x - zero).abs(), height)
}

/// Draws the marks of all layers that stand on stems, smaller ones in front of larger ones.
fn stems(panel: &Panel) -> Element {
    let layers = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Marks(marks) => Some((marks, marks.stems?)),
        _ => None,
    });
    let mut all: Vec<(&Marks, Dash, &Mark)> =
        layers.flat_map(|(marks, dash)| marks.marks.iter().map(move |mark| (marks, dash, mark))).collect();
    all.sort_by(|a, b| b.2.place.1.total_cmp(&a.2.place.1));
    let drawn = all.into_iter().map(|(marks, dash, mark)| {
        let (x, y) = panel.diagram.point(mark.place.0, mark.place.1);
        let pen = Pen::new(marks.look.colour.clone(), dash, 1.4);
        let stem = pen.draw(line((x, panel.diagram.bottom()), (x, y)));
        let head = (marks.look.radius > 0.0).then(|| marks.look.draw((x, y), marks.look.radius, None));
        group().child(stem).children(head).title(&mark.words)
    });
    group().children(drawn)
}

/// Error bar of a mark with caps, cut off at the frame.
fn bar(panel: &Panel, bars: &Bars, mark: &Mark, reach: Reach, is_level: bool) -> Option<Element> {
    const CAP: f64 = 3.5;
    let (x, y) = panel.diagram.inside(mark.place.0, mark.place.1)?;
    let (scale, range, at) = match is_level {
        true => (panel.diagram.x, panel.x.range, mark.place.0),
        false => (panel.diagram.y, panel.y.range, mark.place.1),
    };
    let ends = [at - reach.below, at + reach.above].map(|value| scale.place(value.clamp(range.0, range.1)));
    let stroke = match is_level {
        true => line((ends[0], y), (ends[1], y)),
        false => line((x, ends[0]), (x, ends[1])),
    };
    let caps = ends.map(|end| match is_level {
        true => line((end, y - CAP), (end, y + CAP)),
        false => line((x - CAP, end), (x + CAP, end)),
    });
    let bar = group().set("stroke", &bars.colour.paper).set("stroke-width", "1.2");
    Some(bar.child(stroke.set("class", bars.class)).children(caps))
}

/// Draws cells as one image.
fn cells(panel: &Panel, cells: &Cells) -> Element {
    let diagram = &panel.diagram;
    let mut pixels = Pixels::over(diagram);
    let range = panel.ramp.as_ref().map_or((0.0, 1.0), |ramp| ramp.range);
    let scale = Scale::linear(range, (0.0, 1.0));
    for (row, values) in cells.rows.iter().zip(&cells.values) {
        for (column, value) in cells.columns.iter().zip(values) {
            let Some(value) = value else { continue };
            let x = (diagram.x.place(column.from), diagram.x.place(column.to));
            let y = (diagram.y.place(row.to), diagram.y.place(row.from));
            pixels.paint_area(x, y, if value.is_finite() { scale.share(*value) } else { 0.0 });
        }
    }
    pixels.draw()
}

/// Bar of the colours of a panel beside a frame.
fn bar_of(panel: &Panel, diagram: &Diagram) -> Option<Element> {
    let ramp = panel.ramp.as_ref()?;
    let left = diagram.right() + ramp.beside?;
    let stops = (0..=32).map(|i| f64::from(i) / 32.0).map(|share| (share, (ramp.colour)(share)));
    let places = (diagram.bottom(), diagram.top);
    let (scale, ticks) = match ramp.is_logarithmic {
        true => (Scale::logarithmic(ramp.range, places), logarithmic_ticks(ramp.range)),
        false => (Scale::linear(ramp.range, places), ticks(ramp.range, 8.0)),
    };
    Some(colour_bar::draw(stops, &scale, left, &ticks, &ramp.title))
}

/// Labels beside the marks that have one, those of the upper marks first, off the lines where possible.
fn labels(panel: &Panel) -> Element {
    let diagram = &panel.diagram;
    let place = |(x, y): &Place| diagram.inside(*x, *y);
    let mut labels = Labels::inside(diagram);
    let layers = panel.layers.iter().rev().filter_map(|layer| match layer {
        Layer::Marks(marks) => Some(marks),
        _ => None,
    });
    let layers: Vec<&Marks> = layers.collect();
    let named = || {
        let all = layers.iter().flat_map(|marks| marks.marks.iter().rev().map(move |mark| (marks, mark)));
        all.filter(|(_, mark)| !mark.label.is_empty()).filter_map(|(marks, mark)| {
            Some((mark, place(&mark.place)?, mark.radius.unwrap_or(marks.look.radius), marks.look.is_filled))
        })
    };
    named().for_each(|(_, place, radius, _)| labels.keep_off(place, 0.9 * radius));
    let strokes = panel.layers.iter().flat_map(|layer| match layer {
        Layer::Curve(curve) if curve.course != Course::History => &curve.strokes[..],
        _ => &[],
    });
    let lines: Vec<Place> = match named().next() {
        Some(_) => {
            strokes.flat_map(|stroke| traced(stroke.places.iter().flatten().filter_map(place))).collect()
        }
        None => Vec::new(),
    };
    group().children(named().filter_map(|(mark, place, radius, is_filled)| {
        let label = labels.beside_off(&lines, place, radius + 1.5, &mark.label, 11.0)?.rimmed("white");
        // The colours of open marks are dark enough for letters.
        Some(match mark.colour.as_ref().filter(|_| !is_filled) {
            Some(colour) => label.set("fill", colour),
            None => label,
        })
    }))
}

/// Key of a panel, and where it ends.
fn key(panel: &Panel, width: f64) -> (Element, f64) {
    let diagram = &panel.diagram;
    let beside = match panel.stand {
        Stand::Beside(distance) => distance,
        Stand::Below => {
            let flow = Flow::new(diagram.left, width - 20.0, diagram.bottom() + 66.0);
            let flow = panel.key.iter().fold(flow, |flow, row| match row {
                Row::Sample { sample, width, words } => {
                    flow.entry(group().child(sample.clone()), *width, words)
                }
                Row::Heading(words) | Row::Note(words) => flow.entry(group(), 0.0, words),
            });
            let end = flow.bottom();
            return (flow.draw(), end);
        }
    };
    let key = Key::new(diagram.right() + beside, diagram.top + 8.0);
    let rows = panel.key.iter().fold(key, |key, row| match row {
        Row::Sample { sample, words, .. } => key.row(group().child(sample.clone()), words),
        Row::Heading(words) => key.heading(words),
        Row::Note(words) => key.note(words),
    });
    (rows.draw(), 0.0)
}
