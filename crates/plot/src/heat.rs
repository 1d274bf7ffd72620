//! Amplitudes of a map: an image of the drawing, cells of the figure.

use super::axis::Scale;
use super::cells::{Cell, rpm, within};
use super::diagram::Diagram;
use super::map_view::{VerticalAxis, View};
use super::merged::together;
use super::pixels::{DENSITY, Pixels};
use super::svg::Element;
use super::window::Window;
use rubmap_analysis::result::InteractionMap;

/// Least height of a spectral line in the drawing. At 24 engine orders and a window of 20 revolutions a bin alone would be
/// a pixel high.
const LINE_HEIGHT: f64 = 5.0;

/// Least height of a spectral line in the figure, relative to the height of the map: a bin alone would be a pixel high, below the line of
/// its engine order.
const LEAST_SHARE: f64 = 0.012;

/// Row of cells of the figure: its middle and its band, in units of the vertical axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) middle: f64,
    pub(super) band: (f64, f64),
}

/// Amplitudes of the part of a map that a view shows.
#[derive(Debug)]
pub(super) struct Heat<'a> {
    pub(super) map: &'a InteractionMap,
    /// Stretches of the speeds, in ascending order.
    pub(super) cells: Vec<Cell>,
    pub(super) view: View,
    /// Largest number of columns and rows of the figure. Where there are more speeds or bins, neighbours are one cell with the loudest.
    pub(super) most: (usize, usize),
}

impl Heat<'_> {
    /// Speeds in view.
    fn seen(&self) -> &[Cell] {
        within(&self.cells, self.view.diagram.x.values)
    }

    /// Columns of the figure: speeds merged into one each.
    pub(super) fn columns(&self) -> impl Iterator<Item = &[Cell]> {
        let seen = self.seen();
        seen.chunks(together(seen.len(), self.most.0))
    }

    /// Index of the loudest speed of every column.
    pub(super) fn loudest_speeds(&self) -> Vec<usize> {
        let peak = |cell: &Cell| {
            self.row(cell).map_or(0.0, |row| row.iter().skip(1).fold(0.0, |m: f64, a| m.max(*a)))
        };
        let loudest =
            |column: &[Cell]| column.iter().max_by(|a, b| peak(a).total_cmp(&peak(b))).map(|cell| cell.index);
        self.columns().filter_map(loudest).collect()
    }

    /// Bins in view; engine order 0 is the mean, which is no vibration.
    fn bins(&self) -> Vec<f64> {
        let (low, high) = self.view.diagram.y.values;
        let is_shown = |order: &f64| *order > 0.0 && (low..=high).contains(order);
        self.map.engine_orders.iter().copied().filter(is_shown).collect()
    }

    /// Rows of the figure, from the lowest up.
    pub(super) fn rows(&self) -> Vec<Row> {
        match self.view.axis {
            VerticalAxis::EngineOrder => {
                let bins = self.bins();
                let row = |bins: &[f64]| {
                    let band = (bins[0], bins[bins.len() - 1]);
                    Row { middle: 0.5 * (band.0 + band.1), band }
                };
                match self.rows_of_order() {
                    Some(count) => self.even_rows(count),
                    None => bins.chunks(together(bins.len(), self.most.1)).map(row).collect(),
                }
            }
            VerticalAxis::Frequency => {
                let (low, high) = self.view.diagram.y.values;
                let step = (high - low) / self.most.1 as f64;
                let edge = |i: usize| low + step * i as f64;
                let row =
                    |i: usize| Row { middle: low + step * (i as f64 + 0.5), band: (edge(i), edge(i + 1)) };
                (0..self.most.1).map(row).collect()
            }
        }
    }

    /// Number of rows of an engine order where bins are merged: every whole order lies in the middle of a row, so that all orders have lines of
    /// one thickness. None where every bin is a row, or a row has several orders.
    fn rows_of_order(&self) -> Option<u32> {
        let (low, high) = self.view.diagram.y.values;
        let count = (self.most.1 as f64 / (high - low)).floor();
        (together(self.bins().len(), self.most.1) > 1 && count >= 2.0).then_some(count as u32)
    }

    /// Rows of which `count` make an engine order, with whole orders in their middles.
    fn even_rows(&self, count: u32) -> Vec<Row> {
        let (low, high) = self.view.diagram.y.values;
        let count = f64::from(count);
        let (first, last) = ((low * count).ceil().max(1.0) as u64, (high * count).floor() as u64);
        let row = |place: u64| {
            let at = |place: f64| place / count;
            let place = place as f64;
            Row { middle: at(place), band: (at(place - 0.5), at(place + 0.5)) }
        };
        (first..=last).map(row).collect()
    }

    /// Words about merged speeds and bins, if there are any.
    pub(super) fn merged(&self) -> Option<String> {
        let bins = match self.view.axis {
            VerticalAxis::EngineOrder => together(self.bins().len(), self.rows().len().max(1)),
            VerticalAxis::Frequency => 1,
        };
        let speeds = together(self.seen().len(), self.most.0);
        let parts = [(speeds, "speeds"), (bins, "lines of the spectra")].into_iter();
        let parts = parts.filter(|(count, _)| *count > 1).map(|(count, words)| format!("{count} {words}"));
        let parts: Vec<String> = parts.collect();
        (!parts.is_empty()).then(|| {
            format!("{} are one cell with the loudest: choose a part to see each", parts.join(" and "))
        })
    }

    /// Amplitudes at a speed.
    fn row(&self, cell: &Cell) -> Option<&Vec<f64>> {
        self.map.amplitude.get(cell.index)?.as_ref()
    }

    /// Loudest amplitude of a speed in a row of the figure.
    pub(super) fn loudest(&self, cell: &Cell, row: &Row) -> Option<f64> {
        let (low, high) = row.band;
        let height = self.view.diagram.y.values.1 - self.view.diagram.y.values.0;
        let wider = (0.5 * (LEAST_SHARE * height - (high - low))).max(0.0);
        let orders = (self.view.order(low - wider, cell.rpm), self.view.order(high + wider, cell.rpm));
        loudest_within(&self.map.engine_orders, self.row(cell)?, orders)
    }

    /// Draws the amplitudes over a diagram. Where bins or speeds share a pixel, the loudest is seen.
    pub(super) fn image(&self, diagram: &Diagram, amplitudes: &Scale) -> Element {
        let mut pixels = Pixels::over(diagram);
        let value = |pixel: usize| diagram.x.value(diagram.left + pixel as f64 / DENSITY);
        let mut first = 0;
        for column in 0..pixels.width {
            let (from, to) = (value(column), value(column + 1));
            while first + 1 < self.cells.len() && self.cells[first].to <= from {
                first += 1;
            }
            // Speeds that cover a part of the column.
            let here =
                self.cells[first..].iter().take_while(|cell| cell.from < to).filter(|cell| cell.to > from);
            for cell in here {
                let Some(row) = self.row(cell) else { continue };
                let rpm = 0.5 * (from + to);
                for line in 0..pixels.height {
                    let y = diagram.top + (line as f64 + 0.5) / DENSITY;
                    let order = |y: f64| self.view.order(diagram.y.value(y), rpm);
                    let band = (order(y + 0.5 * LINE_HEIGHT), order(y - 0.5 * LINE_HEIGHT));
                    let Some(amplitude) = loudest_within(&self.map.engine_orders, row, band) else {
                        continue;
                    };
                    pixels.paint(column, line, amplitudes.share(amplitude.max(f64::MIN_POSITIVE)));
                }
            }
        }
        pixels.draw()
    }
}

/// Loudest amplitude of a map within a window, without the mean; none if nothing moves or the window is empty.
pub(super) fn loudest(map: &InteractionMap, window: &Window) -> Option<f64> {
    let rows =
        map.speeds_rad_s.iter().zip(&map.amplitude).filter(|(speed, _)| window.has_speed(rpm(**speed)));
    let values = rows.filter_map(|(_, row)| row.as_ref()).flat_map(|row| row.iter().zip(&map.engine_orders));
    let inside = values.filter(|(_, order)| **order > 0.0 && window.has_order(**order));
    let loudest = inside.fold(0.0, |m: f64, (a, _)| m.max(*a));
    (loudest.is_finite() && loudest > 0.0).then_some(loudest)
}

/// Loudest of the bins whose engine order lies in a band or is nearest to its middle; the mean is no vibration and is left out.
pub(super) fn loudest_within(orders: &[f64], row: &[f64], (low, high): (f64, f64)) -> Option<f64> {
    let highest = *orders.last()?;
    if low > highest {
        // Half an engine order above the last one is left dark, so that its line stands out.
        return (low <= highest + 0.5).then_some(0.0);
    }
    let (first, end) = (orders.partition_point(|o| *o < low), orders.partition_point(|o| *o <= high));
    let range = if first < end {
        first..end
    } else {
        let middle = 0.5 * (low + high);
        let nearer =
            first > 0 && orders.get(first).is_none_or(|above| middle - orders[first - 1] < above - middle);
        let nearest = if nearer { first - 1 } else { first };
        nearest..(nearest + 1).min(orders.len())
    };
    let bins = range.filter(|bin| orders[*bin] > 0.0).filter_map(|bin| row.get(bin));
    Some(bins.fold(0.0, |m: f64, a| m.max(*a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loudest_bin_of_a_band_is_seen_and_the_mean_is_not() {
        let orders = [0.0, 0.5, 1.0, 1.5, 2.0];
        let row = [9.0, 1.0, 2.0, 4.0, 3.0];
        assert_eq!(loudest_within(&orders, &row, (0.9, 1.6)), Some(4.0));
        assert_eq!(loudest_within(&orders, &row, (1.05, 1.1)), Some(2.0), "the nearest");
        assert_eq!(loudest_within(&orders, &row, (1.40, 1.45)), Some(4.0), "the nearest");
        assert_eq!(loudest_within(&orders, &row, (0.0, 0.1)), Some(0.0), "the mean");
        assert_eq!(loudest_within(&orders, &row, (2.6, 2.7)), None);
        assert_eq!(loudest_within(&[], &[], (0.0, 1.0)), None);
    }
}
