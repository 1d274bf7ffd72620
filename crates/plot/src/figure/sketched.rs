//! Pen that writes a sketch as a figure for Plotly.

use serde_json::{Value, json};

use super::attributes::{Axis, Cells as Heat, ColorBar, ErrorBars, Line, Marker, Scatter, Title};
use super::cells::{self, cells};
use super::document::{Figure, axis};
use super::heat;
use super::marks::{bars, scatter, template};
use super::text::escaped;
use super::thinned;
use crate::layer::{
    Areas, Band, Bars, Cells, Course, Curve, Hover, Layer, Marks, Place, Reach, Upright, Uprights,
};
use crate::marks::spread;
use crate::merged::{MOST, together};
use crate::sketch::{self, Kind, Panel, Sketch, Zoom};
use crate::style::{Look, Pen};

/// Height of a strip along the upper edge of a panel, relative to that of the panel.
const STRIP: f64 = 0.04;

/// Writes a sketch as a figure.
pub(crate) fn figure(sketch: &Sketch) -> Figure {
    let layers = || sketch.panels.iter().flat_map(|panel| &panel.layers);
    let sampled = layers().filter_map(|layer| match layer {
        Layer::Curve(curve) if matches!(curve.hover, Hover::Template(..)) => Some(curve.strokes.len()),
        _ => None,
    });
    let sampled = sampled.sum();
    let mut thinned_by = 1;
    let (mut traces, mut grids, mut merged) = (Vec::new(), Vec::new(), Vec::new());
    for (index, panel) in sketch.panels.iter().enumerate() {
        let x = if panel.is_apart { axis_name("x", index) } else { "x".to_owned() };
        let y = axis_name("y", index);
        for layer in &panel.layers {
            let trace = match layer {
                Layer::Curve(found) => curve(found, sampled, &mut thinned_by),
                Layer::Marks(found) | Layer::Shown(found) => marks(found, panel),
                Layer::Uprights(found) => uprights(found, panel),
                Layer::Areas(found) => areas(found, panel),
                Layer::Cells(found) => {
                    let (grid, words) = grid(found, panel);
                    grids.push(grid.xaxis(&x).yaxis(&y));
                    merged.extend(words);
                    continue;
                }
                Layer::Heat(found) => {
                    grids.push(grid(&heat::cells(found), panel).0.xaxis(&x).yaxis(&y));
                    continue;
                }
                Layer::Drawn(_) => continue,
            };
            let trace = if panel.is_apart && index > 0 { trace.xaxis(&x) } else { trace };
            traces.push(if index == 0 { trace } else { trace.yaxis(&y) });
        }
    }
    let words = sketch
        .paragraphs
        .iter()
        .chain(&sketch.warning)
        .chain(&sketch.more)
        .chain(&sketch.footnote)
        .chain(&merged);
    let words = words.filter(|words| !words.is_empty()).cloned();
    let words: Vec<String> = words.chain(thinned::words(thinned_by)).collect();
    let figure = Figure::new(sketch.kind, &sketch.title, &words);
    let figure = sketch.meta.iter().fold(figure, |figure, (name, value)| figure.meta(name, value));
    if let Some(words) = &sketch.nothing {
        return figure.empty(words);
    }
    let figure = figure.high(sketch.high).with_all(grids).with_all(grouped(layers(), traces));
    let figure = axes(figure, &sketch.panels);
    let figure = match &sketch.note {
        Some(words) => figure.note(words, 0.7),
        None => figure,
    };
    let (above, longest) = above(&sketch.panels);
    let figure =
        figure.annotations(names(&sketch.panels)).annotations(above).annotations(right(&sketch.panels));
    figure.room(if longest > 0 { 24 + LETTER * longest } else { 0 })
}

/// Width of a letter of a label, and of the panels by which labels are moved apart at first, pixels.
const LETTER: usize = 6;
const NOMINAL: f64 = 900.0;

/// Labels over upright lines, moved apart, and the number of letters of the longest. Whoever shows the figure at another width moves the
/// annotations named `above` anew.
fn above(panels: &[Panel]) -> (Vec<Value>, usize) {
    let lines = panels.iter().filter(|panel| panel.across.is_none()).flat_map(|panel| {
        let uprights = panel.layers.iter().filter_map(|layer| match layer {
            Layer::Uprights(uprights) => Some(uprights),
            _ => None,
        });
        let lines = uprights.flat_map(|all| all.lines.iter().map(move |line| (all, line)));
        let (low, high) = panel.x.range;
        lines.map(move |(all, line)| (NOMINAL * (line.x - low) / (high - low), all, line))
    });
    let mut lines: Vec<(f64, &Uprights, &Upright)> =
        lines.filter(|(.., line)| !line.label.is_empty()).collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    let places: Vec<f64> = lines.iter().map(|(place, ..)| *place).collect();
    let longest = lines.iter().map(|(.., line)| line.label.chars().count()).max().unwrap_or(0);
    let label = |((place, of, line), apart): (&(f64, &Uprights, &Upright), f64)| {
        json!({
            "name": "above", "text": escaped(&line.label), "hovertext": escaped(&format!("{}{}", line.label, line.more)),
            "x": line.x, "y": 1, "xref": "x", "yref": "paper", "textangle": -90, "xanchor": "center", "yanchor": "middle",
            "ax": (apart - place).round(), "ay": -(14.0 + 0.5 * (LETTER * line.label.chars().count()) as f64), "showarrow": true, "arrowhead": 0, "arrowwidth": 1,
            "arrowcolor": of.pen.colour.screen, "font": {"size": 11},
        })
    };
    (lines.iter().zip(spread(&places, NOMINAL)).map(label).collect(), longest)
}

/// Labels of heights at the right edge of panels, and their titles.
fn right(panels: &[Panel]) -> Vec<Value> {
    let of = |(index, panel): (usize, &Panel)| {
        let (title, labels) = &panel.right;
        let beside = |text: &str, yref: &str, y: f64, yanchor: &str| {
            json!({
                "text": escaped(text), "xref": "paper", "yref": yref, "x": 1, "y": y, "xanchor": "left", "yanchor": yanchor,
                "showarrow": false, "font": {"size": 10},
            })
        };
        let axis = axis_name("y", index);
        let top = panel.domain.map_or(1.0, |domain| domain[1]);
        let mut all: Vec<Value> =
            labels.iter().map(|(y, words)| beside(words, &axis, *y, "middle")).collect();
        all.extend((!labels.is_empty()).then(|| beside(title, "paper", top, "bottom")));
        all
    };
    panels.iter().enumerate().flat_map(of).collect()
}

/// Name of an axis in traces, such as `x2`.
fn axis_name(letter: &str, index: usize) -> String {
    if index == 0 { letter.to_owned() } else { format!("{letter}{}", index + 1) }
}

/// Writes the names of panels above them.
fn names(panels: &[Panel]) -> Vec<Value> {
    let names = panels.iter().filter_map(|panel| {
        let (across, upwards) = (panel.across.unwrap_or([0.0, 1.0]), panel.domain.unwrap_or([0.0, 1.0]));
        Some(json!({
            "text": escaped(panel.name.as_ref()?), "xref": "paper", "yref": "paper", "x": across[0], "y": upwards[1],
            "xanchor": "left", "yanchor": "bottom", "showarrow": false,
        }))
    });
    names.collect()
}

/// Joins traces of one name: shown and hidden together, and named once.
fn grouped<'a>(layers: impl Iterator<Item = &'a Layer<'a>>, traces: Vec<Scatter>) -> Vec<Scatter> {
    let names = layers.filter_map(|layer| match layer {
        Layer::Curve(curve) => {
            Some((&*curve.name, &**curve.group.as_ref().unwrap_or(&curve.name), curve.is_listed))
        }
        Layer::Marks(marks) | Layer::Shown(marks) => Some((&*marks.name, &*marks.name, marks.is_listed)),
        Layer::Uprights(uprights) => Some((&*uprights.name, &*uprights.name, true)),
        Layer::Areas(areas) => Some((areas.name, areas.name, true)),
        Layer::Cells(_) | Layer::Heat(_) | Layer::Drawn(_) => None,
    });
    let names: Vec<(&str, &str, bool)> = names.collect();
    let mut named: Vec<&str> = Vec::new();
    let grouped = traces.into_iter().zip(&names).map(|(trace, (name, group, is_listed))| {
        let is_first = *is_listed && !named.contains(name);
        named.extend(is_first.then_some(*name));
        let trace = if is_first { trace } else { trace.showlegend(false) };
        let is_alone = names.iter().filter(|(_, other, _)| other == group).count() == 1;
        if is_alone { trace } else { trace.legendgroup(escaped(group)) }
    });
    grouped.collect()
}

fn columns(places: &[Option<Place>]) -> (Vec<f64>, Vec<f64>) {
    places.iter().map(|place| place.unwrap_or((f64::NAN, f64::NAN))).unzip()
}

/// Trace of a curve, thinned to what a screen shows of so many strokes unless its points have words of their own.
fn curve(curve: &Curve, sampled: usize, thinned_by: &mut usize) -> Scatter {
    let mut places: Vec<Option<Place>> = Vec::new();
    for (index, stroke) in curve.strokes.iter().enumerate() {
        places.extend((index > 0).then_some(None));
        match &curve.hover {
            Hover::Template(..) => {
                let gap = (f64::NAN, f64::NAN);
                let all = stroke.places.iter().map(|place| place.unwrap_or(gap)).collect();
                let (left, here) = thinned::thinned(all, sampled);
                *thinned_by = here.max(*thinned_by);
                places.extend(left.into_iter().map(Some));
            }
            Hover::Nothing | Hover::Each(_) => places.extend(&stroke.places),
        }
    }
    let pen = line(&curve.pen);
    let pen = if curve.course == Course::Steps { pen.shape("hv") } else { pen };
    // A line through one point is invisible.
    let is_sampled = matches!(curve.hover, Hover::Template(..));
    let has_point = !is_sampled && curve.strokes.iter().any(|stroke| stroke.places.len() == 1);
    let mode = match (&curve.look, curve.labels.is_empty()) {
        (Some(_), _) => "lines+markers",
        (None, _) if has_point => "lines+markers",
        (None, false) => "lines+text",
        (None, true) => "lines",
    };
    let trace = scatter(&curve.name, mode, columns(&places)).line(pen);
    let trace = match &curve.look {
        Some(look) => trace.marker(marker(look)),
        None if has_point => {
            let marker = Marker::default().size(curve.pen.width.max(5.0));
            trace.marker(marker.color(curve.pen.colour.screen.as_str()))
        }
        None => trace,
    };
    let trace = match curve.errors.is_empty() {
        true => trace,
        false => {
            let bars = reaching(&curve.errors).color(curve.pen.colour.screen.as_str());
            trace.error_y(bars.thickness(1.0).width(2.0))
        }
    };
    let trace = if curve.opacity < 1.0 { trace.opacity(curve.opacity) } else { trace };
    let trace = if curve.is_area { trace.fill("toself").fillcolor("rgba(128,138,148,0.22)") } else { trace };
    let trace = match curve.labels.is_empty() {
        true => trace,
        false => trace.text(ends(curve)).textposition("bottom left"),
    };
    match &curve.hover {
        Hover::Nothing => trace.hoverinfo("skip"),
        Hover::Template(words, point) if words.is_empty() => trace.hovertemplate(template(&escaped(point))),
        Hover::Template(words, point) => {
            trace.hovertemplate(template(&format!("{}<br>{}", escaped(words), escaped(point))))
        }
        Hover::Each(words) => {
            let mut words = words.iter().map(|words| escaped(words));
            let mut told = Vec::new();
            for (index, stroke) in curve.strokes.iter().enumerate() {
                told.extend((index > 0).then(String::new));
                told.extend(words.by_ref().take(stroke.places.len()));
            }
            trace.hovertext(told).hoverinfo("text")
        }
    }
}

/// Line of a pen on a screen.
fn line(pen: &Pen) -> Line {
    let (dash, width) = pen.screen.unwrap_or((pen.dash, pen.width));
    Line::default().color(pen.colour.screen.as_str()).dash(dash.name()).width(width)
}

/// Joins several lines into one, with gaps between them.
fn joined(lines: impl IntoIterator<Item = Vec<Place>>) -> (Vec<f64>, Vec<f64>) {
    let mut places: Vec<Option<Place>> = Vec::new();
    for line in lines {
        places.extend((!places.is_empty()).then_some(None));
        places.extend(line.into_iter().map(Some));
    }
    columns(&places)
}

/// Trace of upright lines.
fn uprights(uprights: &Uprights, panel: &Panel) -> Scatter {
    let (low, high) = panel.y.range;
    let lines = uprights.lines.iter().map(|line| vec![(line.x, low), (line.x, high)]);
    scatter(&uprights.name, "lines", joined(lines)).line(line(&uprights.pen)).hoverinfo("skip")
}

/// Trace of rectangles.
fn areas(areas: &Areas, panel: &Panel) -> Scatter {
    let (low, high) = panel.y.range;
    let strip = (high - STRIP * (high - low), high);
    let corners = areas.areas.iter().map(|area| {
        let ((left, right), (foot, head)) = (area.across, area.upwards.unwrap_or(strip));
        vec![(left, foot), (left, head), (right, head), (right, foot), (left, foot)]
    });
    let told = areas.areas.iter().enumerate();
    let told = told.flat_map(|(index, area)| vec![escaped(&area.words); if index == 0 { 5 } else { 6 }]);
    let pen = Line::default().color(areas.fill.as_str()).width(0.0);
    let trace = scatter(areas.name, "lines", joined(corners)).line(pen);
    let trace = trace.fill("toself").fillcolor(areas.fill.as_str());
    trace.hovertext(told.collect::<Vec<String>>()).hoverinfo("text")
}

/// Words at all points of a curve: those of its labels at the last point of every stroke.
fn ends(curve: &Curve) -> Vec<String> {
    let mut words = Vec::new();
    for (index, (stroke, label)) in curve.strokes.iter().zip(&curve.labels).enumerate() {
        words.extend((index > 0).then(String::new));
        words.extend(std::iter::repeat_n(String::new(), stroke.places.len().saturating_sub(1)));
        words.push(escaped(label));
    }
    words
}

fn marker(look: &Look) -> Marker {
    let marker = Marker::default().symbol(look.symbol.name(look.is_filled)).size(look.size);
    marker.color(look.colour.screen.as_str())
}

/// Cells of at most as many columns and rows as a screen shows, and words about those that are merged.
fn grid(of: &Cells, panel: &Panel) -> (Heat, Option<String>) {
    let (wide, high) = match of.data.is_empty() {
        true => (together(of.columns.len(), MOST.0), together(of.rows.len(), MOST.1)),
        false => (1, 1),
    };
    let columns: Vec<&[Band]> = of.columns.chunks(wide).collect();
    let largest = |rows: &[Vec<Option<f64>>], column: usize| {
        let all = rows.iter().flat_map(|row| row[column * wide..].iter().take(wide).flatten());
        all.copied().filter(|value| value.is_finite()).max_by(f64::total_cmp)
    };
    let least = panel.ramp.as_ref().filter(|ramp| ramp.is_logarithmic).map(|ramp| ramp.range.0);
    let shown = |value: f64| least.map_or(value, |least| value.max(least).log10()) as f32;
    let row = |rows: &[Vec<Option<f64>>]| {
        (0..columns.len()).map(|column| largest(rows, column).map_or(f32::NAN, shown)).collect()
    };
    let values: Vec<Vec<f32>> = of.values.chunks(high).map(row).collect();
    let middle = |bands: &[Band]| bands[bands.len() / 2].value;
    let rad_s = |bands: &&[Band]| vec![(middle(bands) * std::f64::consts::TAU / 60.0) as f32];
    let data = match of.has_speeds {
        true => values.iter().map(|_| columns.iter().map(rad_s).collect()).collect(),
        false => of.data.clone(),
    };
    let x = match columns[..] {
        // A single column has its edges: nothing else says how wide it is.
        [[alone]] => vec![alone.from, alone.to],
        _ => columns.iter().map(|bands| middle(bands)).collect(),
    };
    let y = of.rows.chunks(high).map(middle).collect();
    let words = (wide * high > 1).then(|| format!("{} {}", wide * high, of.merged));
    let told: Vec<String> = of.hover.iter().map(|line| escaped(line)).collect();
    (cells((x, y), (values, data), &told.join("<br>")), words)
}

/// Trace of marks.
fn marks(marks: &Marks, panel: &Panel) -> Scatter {
    let places: Vec<Option<Place>> = marks.marks.iter().map(|mark| Some(mark.place)).collect();
    let words: Vec<String> =
        marks.marks.iter().map(|mark| escaped(&format!("{}{}", mark.words, mark.more))).collect();
    let mode = if marks.has_texts { "markers+text" } else { "markers" };
    let trace = scatter(&marks.name, mode, columns(&places)).hovertext(words).hoverinfo("text");
    let radii: Option<Vec<f64>> = marks.marks.iter().map(|mark| mark.radius).collect();
    let marker = match radii {
        Some(radii) => marker(&marks.look)
            .size(radii.into_iter().map(|radius| (2.2 * radius).floor()).collect::<Vec<_>>()),
        None => marker(&marks.look),
    };
    let marker = match panel.ramp.as_ref().filter(|_| !marks.values.is_empty()) {
        Some(ramp) => {
            let title = Title::default().text(escaped(&ramp.title)).side("right");
            let bar = ColorBar::default().title(title).thickness(12.0).x(1.01);
            let marker = marker
                .color(marks.values.clone())
                .colorscale(cells::stops(ramp))
                .cmin(ramp.range.0)
                .cmax(ramp.range.1);
            marker.colorbar(bar).showscale(is_first(panel, marks))
        }
        None => marker,
    };
    let trace = trace.marker(marker);
    let indices: Option<Vec<usize>> = marks.marks.iter().map(|mark| mark.index).collect();
    let trace = match indices {
        Some(indices) => trace.customdata(indices),
        None => trace,
    };
    let trace = match marks.has_texts {
        true => {
            let texts: Vec<String> = marks.marks.iter().map(|mark| escaped(&mark.label)).collect();
            trace.text(texts).textposition("top right").cliponaxis(false)
        }
        false => trace,
    };
    let lengths = |of: &Bars| {
        let bars = reaching(&of.lengths).color(of.colour.screen.as_str());
        bars.thickness(1.3).width(4.0)
    };
    let trace = match &marks.across {
        Some(found) => trace.error_x(lengths(found)),
        None => trace,
    };
    match (&marks.bars, marks.stems) {
        (Some(found), _) => trace.error_y(lengths(found)),
        (None, Some(_)) => trace.error_y(stems(marks, panel.y.range.0)),
        (None, None) => trace,
    }
}

/// Error bars of these lengths.
fn reaching(lengths: &[Reach]) -> ErrorBars {
    let above: Vec<f64> = lengths.iter().map(|reach| reach.above).collect();
    let bars = bars().array(above);
    if lengths.iter().all(Reach::is_even) {
        return bars;
    }
    let below: Vec<f64> = lengths.iter().map(|reach| reach.below).collect();
    bars.arrayminus(below).symmetric(false)
}

/// Whether marks are the first of the panel that have values.
fn is_first(panel: &Panel, marks: &Marks) -> bool {
    let mut coloured = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Marks(marks) if !marks.values.is_empty() => Some(marks),
        _ => None,
    });
    coloured.next().is_some_and(|first| std::ptr::eq(first, marks))
}

/// Stems down to the foot of the axis, as error bars with one end there.
fn stems(marks: &Marks, foot: f64) -> ErrorBars {
    let down: Vec<f64> = marks.marks.iter().map(|mark| mark.place.1 - foot).collect();
    let bars = bars().array(vec![0.0; down.len()]).arrayminus(down).symmetric(false);
    bars.color(marks.look.colour.screen.as_str()).thickness(1.5).width(0.0)
}

/// Sets the axes of all panels, which share the horizontal one below the lowest.
fn axes(figure: Figure, panels: &[Panel]) -> Figure {
    let Some(first) = panels.first() else { return figure };
    let name = |index: usize| if index == 0 { String::new() } else { format!("{}", index + 1) };
    let x = axis_of(&first.x);
    let foot = |index: &usize| panels[*index].domain.map_or(0.0, |domain| domain[0]);
    let shared = (0..panels.len()).filter(|index| !panels[*index].is_apart);
    let lowest = shared.min_by(|a, b| foot(a).total_cmp(&foot(b))).unwrap_or(0);
    let x = if panels.len() > 1 { x.anchor(format!("y{}", name(lowest))) } else { x };
    let has_cells =
        |panel: &&Panel| panel.layers.iter().any(|layer| matches!(layer, Layer::Cells(_) | Layer::Heat(_)));
    let coloured = panels.iter().find(has_cells).and_then(|panel| Some((panel, panel.ramp.as_ref()?)));
    let figure = match coloured {
        Some((panel, ramp)) => {
            let [low, high] = panel.domain.filter(|_| panel.across.is_none()).unwrap_or([0.0, 1.0]);
            let beside = if panel.right.1.is_empty() { 1.01 } else { 1.05 };
            figure.attribute("coloraxis", cells::axis(ramp, (beside, [low, high])))
        }
        None => figure,
    };
    panels.iter().enumerate().fold(figure.axis("xaxis", x), |figure, (index, panel)| {
        let y = axis_of(&panel.y);
        let y = match panel.is_apart {
            true => y.anchor(format!("x{}", name(index))),
            false if index == lowest => y,
            false => y.anchor("x"),
        };
        let y = if panel.y.zoom == Zoom::OneScale { y.scaleanchor("x").scaleratio(1.0) } else { y };
        let y = match panel.domain {
            Some(domain) => y.domain(domain),
            None => y,
        };
        let is_tied = panel.across.is_some() && index > 0;
        let y = if is_tied { y.matches("y") } else { y };
        let figure = figure.axis(&format!("yaxis{}", name(index)), y);
        if !panel.is_apart {
            return figure;
        }
        let x = axis_of(&panel.x).anchor(format!("y{}", name(index)));
        let x = match panel.across {
            Some(across) => x.domain(across).nticks(4u32).tickangle(0.0),
            None => x,
        };
        figure.axis(&format!("xaxis{}", name(index)), if is_tied { x.matches("x") } else { x })
    })
}

/// Axis of the figure with the title, range and scale of one of the sketch.
fn axis_of(described: &sketch::Axis) -> Axis {
    let (axis, (low, high)) = (axis(described.short.as_ref().unwrap_or(&described.title)), described.range);
    let axis = match described.kind {
        Kind::Logarithmic => return axis.kind("log").range([low.log10(), high.log10()]).exponentformat("e"),
        Kind::Speeds => axis.exponentformat("none"),
        Kind::Turn => axis.dtick(45.0).ticksuffix("°"),
        Kind::Names => {
            let (values, names): (Vec<f64>, Vec<String>) =
                described.ticks.iter().map(|(value, name)| (*value, escaped(name))).unzip();
            axis.tickvals(values).ticktext(names).zeroline(false)
        }
        Kind::Linear => axis,
    };
    match described.zoom {
        Zoom::Same => axis.range([low, high]),
        Zoom::Free => axis,
        Zoom::OneScale => axis.constrain("domain"),
        Zoom::FromZero => axis.rangemode("tozero"),
    }
}
