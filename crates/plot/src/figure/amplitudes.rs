//! Amplitudes of an interaction map as cells.

use super::attributes::Cells;
use super::cells::{cells, together};
use super::text::escaped;
use crate::cells::Cell;
use crate::frame::Frame;
use crate::heat::loudest_within;
use crate::map_view::{VerticalAxis, View};
use rubmap_analysis::result::InteractionMap;

/// Least height of a spectral line relative to the height of the map: a bin alone would be a pixel high, below the line of its engine
/// order.
const LINE_HEIGHT: f64 = 0.012;

/// Amplitude cells of a map: its trace, and the speed that each column reports.
pub(super) struct Amplitudes {
    pub(super) trace: Cells,
    /// Index of the loudest speed of every column.
    pub(super) indices: Vec<usize>,
    /// Message about merged speeds and rows, if there are any.
    pub(super) thinned: Option<String>,
}

/// Amplitudes of the part of a map that a view shows, from the quietest to the loudest amplitude of the colours. Where there are more
/// speeds or rows than `most`, neighbours are merged into one cell with the loudest of them; spectral lines have a least height.
pub(super) fn amplitudes(
    map: &InteractionMap,
    all: &[Cell],
    view: &View,
    quietest: f64,
    axes: (&str, &str),
    most: (usize, usize),
) -> Amplitudes {
    let (low, high) = view.diagram.x.values;
    let seen: Vec<&Cell> = all.iter().filter(|cell| cell.to > low && cell.from < high).collect();
    let columns: Vec<&[&Cell]> = seen.chunks(together(seen.len(), most.0)).collect();
    let (rows, bins) = rows(map, view, most.1);
    let row_of = |cell: &Cell| map.amplitude.get(cell.index).and_then(Option::as_ref);
    let height = view.diagram.y.values.1 - view.diagram.y.values.0;
    let loudest = |cell: &Cell, (low, high): (f64, f64)| {
        let wider = (0.5 * (LINE_HEIGHT * height - (high - low))).max(0.0);
        let band = (low - wider, high + wider);
        let orders = (view.order(band.0, cell.rpm), view.order(band.1, cell.rpm));
        loudest_within(&map.engine_orders, row_of(cell)?, orders)
    };
    let (mut values, mut told) = (Vec::new(), Vec::new());
    for (y, band) in &rows {
        let (mut line, mut words) = (Vec::new(), Vec::new());
        for column in &columns {
            let found = column.iter().filter_map(|cell| Some((loudest(cell, *band)?, cell.rpm)));
            let found = found.max_by(|a, b| a.0.total_cmp(&b.0));
            line.push(found.map_or(f32::NAN, |(amplitude, _)| amplitude.max(quietest).log10() as f32));
            words.push(found.map_or_else(Vec::new, |(amplitude, rpm)| {
                let other = match view.axis {
                    VerticalAxis::EngineOrder => y * rpm / 60.0,
                    VerticalAxis::Frequency => view.order(*y, rpm),
                };
                [amplitude, other, rpm * std::f64::consts::TAU / 60.0].map(|value| value as f32).to_vec()
            }));
        }
        values.push(line);
        told.push(words);
    }
    let (order, frequency) = match view.axis {
        VerticalAxis::EngineOrder => ("%{y:.4~g}", "%{customdata[1]:,.1f}"),
        VerticalAxis::Frequency => ("%{customdata[1]:.3~g}", "%{y:,.1f}"),
    };
    let unit = escaped(map.sensor.unit(&map.units));
    let orders = match view.frame {
        Frame::Rotating => "engine order",
        Frame::Fixed => "multiple of Ω",
    };
    let words = format!(
        "%{{x:,.1f}} rpm (%{{customdata[2]:,.1f}} rad/s)<br>{orders} {order}, {frequency} Hz<br>%{{customdata[0]:.3~g}} {unit}"
    );
    let x = match columns[..] {
        // A single column has its edges: nothing else says how wide it is.
        [[cell]] => vec![cell.from, cell.to],
        _ => columns.iter().map(|column| column[column.len() / 2].rpm).collect(),
    };
    let y = rows.iter().map(|(y, _)| *y).collect();
    let peak =
        |cell: &Cell| row_of(cell).map_or(0.0, |row| row.iter().skip(1).fold(0.0, |m: f64, a| m.max(*a)));
    let indices = columns
        .iter()
        .filter_map(|column| column.iter().max_by(|a, b| peak(a).total_cmp(&peak(b))).map(|cell| cell.index));
    Amplitudes {
        indices: indices.collect(),
        trace: cells((x, y), (values, told), &words, (axes.0, axes.1, "coloraxis")),
        thinned: thinned(together(seen.len(), most.0), bins),
    }
}

/// Row of cells: its middle and its band.
type Row = (f64, (f64, f64));

/// Rows from the lowest up: the middle and the band of each, in units of the vertical axis, and the number of bins merged into one row.
fn rows(map: &InteractionMap, view: &View, most: usize) -> (Vec<Row>, usize) {
    let (low, high) = view.diagram.y.values;
    match view.axis {
        VerticalAxis::EngineOrder => {
            // Engine order 0 is the mean, which is no vibration.
            let shown = |order: &&f64| **order > 0.0 && (low..=high).contains(*order);
            let orders: Vec<f64> = map.engine_orders.iter().filter(shown).copied().collect();
            let bins = together(orders.len(), most);
            let row =
                |bins: &[f64]| (0.5 * (bins[0] + bins[bins.len() - 1]), (bins[0], bins[bins.len() - 1]));
            (orders.chunks(bins).map(row).collect(), bins)
        }
        VerticalAxis::Frequency => {
            let step = (high - low) / most as f64;
            let row = |i: usize| {
                (low + step * (i as f64 + 0.5), (low + step * i as f64, low + step * (i + 1) as f64))
            };
            ((0..most).map(row).collect(), 1)
        }
    }
}

fn thinned(speeds: usize, bins: usize) -> Option<String> {
    let of = |count: usize, what: &str| (count > 1).then(|| format!("{count} {what}"));
    let parts: Vec<String> =
        [of(speeds, "speeds"), of(bins, "lines of the spectra")].into_iter().flatten().collect();
    (!parts.is_empty())
        .then(|| format!("{} are one cell with the loudest: choose a part to see each", parts.join(" and ")))
}
