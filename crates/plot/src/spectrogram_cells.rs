//! Amplitudes of a run as cells, no more than a reader distinguishes.

use std::f64::consts::TAU;

use super::heat::loudest_within;
use super::spectrogram_view::{SpectrogramUnit, View, mean};
use rubmap_analysis::result::RunUpFrame;

/// Least height of a spectral line in a spectrogram of frequencies, relative to the vertical axis.
const LINE_HEIGHT: f64 = 0.006;

/// Loudest amplitude of a cell, and the frame it comes from.
pub(super) type Loudest<'a> = (f64, &'a RunUpFrame);

/// Amplitudes of a view in columns and rows, both in ascending order.
pub(super) struct Cells<'a> {
    /// Lower and upper bound of each column on the horizontal axis.
    pub(super) columns: Vec<(f64, f64)>,
    pub(super) rows: Vec<(f64, f64)>,
    /// Cells as `[row][column]`; none beyond the spectra.
    pub(super) values: Vec<Vec<Option<Loudest<'a>>>>,
    /// Message about merged frames and lines, if there are any.
    pub(super) thinned: Option<String>,
}

impl<'a> Cells<'a> {
    /// Divides a view into at most about so many columns and rows. Frames that are narrower than a column are merged with their neighbours;
    /// so are, over the speed, frames in which the speed is held.
    pub(super) fn of(view: &View<'a>, most: (usize, usize)) -> Self {
        let columns = columns(view, most.0);
        let (rows, together) = rows(view, most.1);
        let row = |band: &(f64, f64)| {
            let loudest = |frames: &[&'a RunUpFrame]| {
                let all = frames.iter().filter_map(|frame| Some((loudest(view, frame, *band)?, *frame)));
                all.max_by(|a, b| a.0.total_cmp(&b.0))
            };
            columns.iter().map(|frames| loudest(frames)).collect()
        };
        let values = rows.iter().map(row).collect();
        let frames = view.frames.len().div_ceil(columns.len().max(1));
        let reach = |frames: &Vec<&RunUpFrame>| {
            let ends = frames.iter().map(|frame| view.stretch(frame));
            let reach = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or(view.x);
            if reach.0 < reach.1 { reach } else { view.x }
        };
        Self {
            columns: columns.iter().map(reach).collect(),
            rows,
            values,
            thinned: thinned(frames, together),
        }
    }
}

/// Frames of every column.
fn columns<'a>(view: &View<'a>, most: usize) -> Vec<Vec<&'a RunUpFrame>> {
    let narrowest = (view.x.1 - view.x.0) / most.max(1) as f64;
    let mut upwards = view.frames.clone();
    if upwards.first().zip(upwards.last()).is_some_and(|(a, b)| view.stretch(a).0 > view.stretch(b).0) {
        upwards.reverse();
    }
    let (mut columns, mut column, mut begin): (Vec<Vec<&RunUpFrame>>, Vec<&RunUpFrame>, f64) =
        (Vec::new(), Vec::new(), view.x.0);
    for frame in upwards {
        let (from, to) = view.stretch(frame);
        begin = if column.is_empty() { from } else { begin };
        column.push(frame);
        if to - begin >= narrowest {
            columns.push(std::mem::take(&mut column));
        }
    }
    // The remaining frames are too narrow for a column of their own.
    match columns.last_mut() {
        Some(last) => last.append(&mut column),
        None => columns.extend((!column.is_empty()).then_some(column)),
    }
    columns
}

/// Bands of the vertical axis, and the number of lines merged in each.
fn rows(view: &View<'_>, most: usize) -> (Vec<(f64, f64)>, usize) {
    match view.unit {
        SpectrogramUnit::Order => {
            let together = view.orders.len().div_ceil(most.max(1)).max(1);
            let half = 0.5 * view.run.order_step;
            let band = |lines: &[f64]| (lines[0] - half, lines[lines.len() - 1] + half);
            (view.orders.chunks(together).map(band).collect(), together)
        }
        SpectrogramUnit::Hz => {
            let step = view.y.1 / most.max(1) as f64;
            ((0..most).map(|row| (step * row as f64, step * (row + 1) as f64)).collect(), 1)
        }
    }
}

/// The loudest line of a frame in a band of the vertical axis.
fn loudest(view: &View<'_>, frame: &RunUpFrame, (low, high): (f64, f64)) -> Option<f64> {
    let band = match view.unit {
        SpectrogramUnit::Order => (low, high),
        SpectrogramUnit::Hz => {
            let wider = (0.5 * (LINE_HEIGHT * view.y.1 - (high - low))).max(0.0);
            let per_order = mean(frame) / TAU;
            if per_order <= 0.0 {
                return None;
            }
            let reach = ((low - wider) / per_order, (high + wider) / per_order);
            // A band above the last line, which only the least height reaches, is empty.
            if 0.5 * (low + high) / per_order > view.orders.last()? + 0.5 * view.run.order_step {
                return None;
            }
            reach
        }
    };
    loudest_within(&view.orders, view.amplitudes(frame), band)
}

fn thinned(frames: usize, lines: usize) -> Option<String> {
    let of = |count: usize, words: String| (count > 1).then_some(words);
    let parts =
        [of(frames, format!("about {frames} frames")), of(lines, format!("{lines} lines of the spectra"))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("{} are one cell with the loudest", parts.join(" and ")))
}
