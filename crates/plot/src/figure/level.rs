//! Level over speed, above a map, with its error, how well it has settled, and the validity of linear theory.

use super::attributes::{Line, Scatter};
use super::marks::{bars, columns, marks, scatter, strokes, words};
use super::palette::{CURVE, NEUTRAL, WARNING};
use crate::cells::Cell;
use crate::level::{self, LevelColour, rms};
use crate::settling_strip::Standing;
use crate::{map_view, margin, validity};
use rubmap_analysis::result::{InteractionMap, ValidityVerdict, Verdict};

/// Traces of the level over speed, in the panel of these axes.
pub(super) fn traces(map: &InteractionMap, cells: &[Cell], by: LevelColour, y_axis: &str) -> Vec<Scatter> {
    let below = |cell: &Cell| Some((0.0, rms(map, cell.index)?));
    let mut traces = if by == LevelColour::Utilisation { utilisation(map, cells, below) } else { Vec::new() };
    traces.push(curve(map, cells));
    traces.extend(Standing::ALL.into_iter().filter_map(|standing| standings(map, cells, standing)));
    traces.extend(validity::MARKED.into_iter().filter_map(|verdict| verdicts(map, cells, verdict)));
    traces.into_iter().map(|trace| trace.yaxis(y_axis)).collect()
}

/// Trace of the level, with error bars where errors were estimated.
fn curve(map: &InteractionMap, cells: &[Cell]) -> Scatter {
    let (x, y) = columns(cells.iter().map(|cell| Some((cell.rpm, rms(map, cell.index)?))));
    let pen = Line::default().color(CURVE).width(1.6);
    let curve = scatter("level", "lines", (x, y)).line(pen).hoverinfo("skip");
    let Some(errors) = map.errors.as_ref().filter(|errors| !errors.points.is_empty()) else { return curve };
    let error = |cell: &Cell| Some(rms(map, cell.index)? * errors.of(cell.index as u32)?);
    let errors: Vec<f64> = cells.iter().map(|cell| error(cell).unwrap_or(f64::NAN)).collect();
    curve.error_y(bars().array(errors).color(CURVE).thickness(1.0).width(2))
}

/// Marks of the speeds of one standing: at their level, or on the axis if they have none.
fn standings(map: &InteractionMap, cells: &[Cell], standing: Standing) -> Option<Scatter> {
    let style = match standing {
        Standing::Settled(Verdict::Periodic) => ("circle", 4, CURVE),
        Standing::Settled(Verdict::Subharmonic) => ("square", 6, "#009e73"),
        Standing::Settled(Verdict::Aperiodic) => ("diamond", 7, "#cc79a7"),
        Standing::Settled(Verdict::NotSettled) => ("triangle-up", 8, "#e69f00"),
        Standing::Missing => ("x", 7, NEUTRAL),
        // Gaps show pending speeds.
        Standing::Pending => return None,
    };
    let of = cells.iter().filter(|cell| Standing::of(map, cell.index) == standing);
    let of: Vec<(&Cell, Option<f64>)> = of.map(|cell| (cell, rms(map, cell.index))).collect();
    let place = |(cell, rms): &(&Cell, Option<f64>)| {
        let told = match rms {
            Some(rms) => format!("{}, {}", level::words(map, cell, *rms), standing.words()),
            None => map_view::missing_words(map, cell),
        };
        ((cell.rpm, rms.unwrap_or(0.0)), told)
    };
    let trace = marks(standing.words(), of.iter().map(place), style)?;
    Some(trace.customdata(of.iter().map(|(cell, _)| cell.index).collect::<Vec<usize>>()))
}

/// Rings about the speeds at which linear theory has this verdict.
fn verdicts(map: &InteractionMap, cells: &[Cell], verdict: ValidityVerdict) -> Option<Scatter> {
    let (symbol, size) = match verdict {
        ValidityVerdict::Beyond => ("circle-x-open", 12),
        _ => ("circle-open", 12),
    };
    let place = |cell: &Cell| {
        let found =
            validity::point(map, cell.index)?.validity.as_ref().filter(|found| found.verdict == verdict)?;
        Some((
            (cell.rpm, rms(map, cell.index)?),
            format!("{:.0} rpm: {}", cell.rpm, validity::reason(found)?),
        ))
    };
    marks(validity::words(verdict), cells.iter().filter_map(place), (symbol, size, WARNING))
}

/// Areas in classes of utilisation, over every speed from the lower to the upper of two heights.
pub(super) fn utilisation(
    map: &InteractionMap,
    cells: &[Cell],
    heights: impl Fn(&Cell) -> Option<(f64, f64)>,
) -> Vec<Scatter> {
    let of = |class: usize| {
        let bars = cells.iter().filter_map(|cell| {
            let used = margin::utilisation(map, cell.index)?;
            (margin::class(used) == class).then_some((cell, heights(cell)?, used))
        });
        let bars: Vec<(&Cell, (f64, f64), f64)> = bars.collect();
        let corners = bars.iter().map(|(cell, (low, high), _)| {
            [(cell.from, *low), (cell.from, *high), (cell.to, *high), (cell.to, *low), (cell.from, *low)]
        });
        let (x, y) = columns(strokes(corners));
        let told = bars.iter().flat_map(|(cell, _, used)| vec![margin::words(cell, *used); 6]).collect();
        let fill = margin::fill(class);
        let pen = Line::default().color(fill.clone()).width(0.0);
        let trace = scatter(margin::CLASSES[class].2, "lines", (x, y)).line(pen);
        let trace = trace.fill("toself").fillcolor(fill);
        (!bars.is_empty()).then(|| words(trace, told))
    };
    (0..margin::CLASSES.len()).filter_map(of).collect()
}
