//! Haigh diagram: alternating over mean stress, and the limits of the materials.

use serde_json::json;

use super::attributes::{ColorBar, Marker, Scatter, Title};
use super::document::{Figure, axis};
use super::marks::{marks, silent, strokes};
use super::palette::{NEUTRAL, WARNING, dash, symbol};
use super::text::escaped;
use crate::haigh::{self as drawing, Cycle, HaighColour, LINES, MOST, NO_STRESS};
use rubmap_analysis::result::SweepStress;

/// Cycles of all speeds in the plane of mean and alternating stress, those of a material under one name, with Goodman's lines of equal
/// utilisation and the yield line of every material whose strengths are known. `customdata` of a cycle is the index of its speed.
pub fn haigh(stress: &SweepStress, by: HaighColour) -> Figure {
    let (stress, unit) = &drawing::drawn(stress);
    let cycles = drawing::ranked(stress);
    let mut paragraphs = drawing::words(stress, &cycles, unit);
    if cycles.len() > MOST {
        paragraphs.push(format!("{} less utilised ones are not drawn", cycles.len() - MOST));
    }
    let diagram = drawing::diagram(stress, &cycles, 0.0);
    let figure = Figure::new("haigh", "Haigh diagram", &paragraphs)
        .meta("units", json!({"x": unit, "y": unit}))
        .meta("speed_indices", stress.speeds.iter().map(|speed| speed.index).collect::<Vec<u32>>());
    if cycles.is_empty() {
        return figure.empty(NO_STRESS);
    }
    let shown = &cycles[..cycles.len().min(MOST)];
    figure
        .high(620)
        .with_all(limits(stress, diagram.x.values.0))
        .with_all(dots(shown, by, unit, drawing::colours(&cycles, by, &diagram)))
        .axis("xaxis", axis(&drawing::mean_axis(unit)).range(<[f64; 2]>::from(diagram.x.values)))
        .axis("yaxis", axis(&drawing::alternating_axis(unit)).range(<[f64; 2]>::from(diagram.y.values)))
}

/// Traces of Goodman's lines and the yield lines.
fn limits(stress: &SweepStress, left: f64) -> Vec<Scatter> {
    let mut traces = Vec::new();
    for (index, set) in stress.strengths.iter().enumerate() {
        if let (Some(fatigue), Some(ultimate)) = (set.fatigue, set.ultimate) {
            let line = |used: f64| drawing::goodman(left, used, (fatigue, ultimate));
            let whole = silent(
                &format!("Goodman, utilisation 1: {}", set.set),
                strokes([line(1.0)]),
                (WARNING, dash(index), 1.8),
            );
            let parts =
                silent("utilisation 0.25, 0.5, 0.75", strokes(LINES.map(line)), (WARNING, dash(index), 0.7));
            traces.extend([whole, parts.legendgroup("parts").showlegend(index == 0)]);
        }
        if let Some(bears) = set.yield_ {
            let yields = strokes([drawing::yields(bears)]);
            traces.push(silent(&format!("yield: {}", set.set), yields, (NEUTRAL, "dashdot", 1.2)));
        }
    }
    traces
}

/// Traces of the cycles of every material; cycles without a known colour value are grey.
fn dots(
    cycles: &[Cycle],
    by: HaighColour,
    unit: &str,
    (scale, title): (crate::axis::Scale, &str),
) -> Vec<Scatter> {
    let mut sets: Vec<&str> = Vec::new();
    for (_, cycle) in cycles {
        if !sets.contains(&cycle.set.as_str()) {
            sets.push(&cycle.set);
        }
    }
    let mut traces = Vec::new();
    for (index, set) in sets.into_iter().enumerate() {
        for known in [true, false] {
            let of = |cycle: &&Cycle| cycle.1.set == set && drawing::value(cycle, by).is_some() == known;
            // The most utilised cycles lie over the others.
            let here: Vec<&Cycle> = cycles.iter().rev().filter(of).collect();
            let told =
                here.iter().map(|cycle| ((cycle.1.mean, cycle.1.alternating), drawing::told(cycle, unit)));
            let name = if known { set.to_owned() } else { format!("{set}, {title} not known") };
            let Some(trace) = marks(&name, told, (symbol(index, true), 7, NEUTRAL)) else { continue };
            let indices: Vec<usize> = here.iter().map(|cycle| cycle.0.index as usize).collect();
            let trace = trace.customdata(indices);
            let values: Vec<f64> = here.iter().filter_map(|cycle| drawing::value(cycle, by)).collect();
            traces.push(match known && drawing::tells_apart(cycles, by) {
                true => trace.marker(coloured(values, scale.values, title, index).showscale(index == 0)),
                false => trace,
            });
        }
    }
    traces
}

fn coloured(values: Vec<f64>, (low, high): (f64, f64), title: &str, index: usize) -> Marker {
    let bar = ColorBar::default()
        .title(Title::default().text(escaped(title)).side("right"))
        .thickness(12.0)
        .x(1.01);
    let scale = "Viridis";
    let marker = Marker::default().symbol(symbol(index, true)).size(7.0).color(values);
    marker.colorscale(scale).cmin(low).cmax(high).colorbar(bar)
}
