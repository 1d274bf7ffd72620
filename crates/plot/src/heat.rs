//! Amplitudes of a map as one image with a palette.

use super::axis::Scale;
use super::cells::{Cell, rpm};
use super::diagram::Diagram;
use super::pixels::{DENSITY, Pixels};
use super::svg::Element;
use super::window::Window;
use rubmap_analysis::result::InteractionMap;

/// Least height of a spectral line in the drawing. At 24 engine orders and a window of 20 revolutions a bin alone would be
/// a pixel high.
const LINE_HEIGHT: f64 = 5.0;

/// Loudest amplitude of a map within a window, without the mean; none if nothing moves or the window is empty.
pub(super) fn loudest(map: &InteractionMap, window: &Window) -> Option<f64> {
    let rows =
        map.speeds_rad_s.iter().zip(&map.amplitude).filter(|(speed, _)| window.has_speed(rpm(**speed)));
    let values = rows.filter_map(|(_, row)| row.as_ref()).flat_map(|row| row.iter().zip(&map.engine_orders));
    let inside = values.filter(|(_, order)| **order > 0.0 && window.has_order(**order));
    let loudest = inside.fold(0.0, |m: f64, (a, _)| m.max(*a));
    (loudest.is_finite() && loudest > 0.0).then_some(loudest)
}

/// Draws amplitudes over the diagram. `engine_order` reads a point of the vertical axis at a speed in rpm. Where bins or
/// speeds share a pixel, the loudest is seen.
pub(super) fn image(
    map: &InteractionMap,
    cells: &[Cell],
    diagram: &Diagram,
    amplitudes: &Scale,
    engine_order: impl Fn(f64, f64) -> f64,
) -> Element {
    let mut pixels = Pixels::over(diagram);
    let value = |pixel: usize| diagram.x.value(diagram.left + pixel as f64 / DENSITY);
    let mut first = 0;
    for column in 0..pixels.width {
        let (from, to) = (value(column), value(column + 1));
        while first + 1 < cells.len() && cells[first].to <= from {
            first += 1;
        }
        // Speeds that cover a part of the column.
        let here = cells[first..].iter().take_while(|cell| cell.from < to).filter(|cell| cell.to > from);
        for cell in here {
            let Some(row) = map.amplitude.get(cell.index).and_then(Option::as_ref) else { continue };
            let rpm = 0.5 * (from + to);
            for line in 0..pixels.height {
                let y = diagram.top + (line as f64 + 0.5) / DENSITY;
                let order = |y: f64| engine_order(diagram.y.value(y), rpm);
                let band = (order(y + 0.5 * LINE_HEIGHT), order(y - 0.5 * LINE_HEIGHT));
                let Some(amplitude) = loudest_within(&map.engine_orders, row, band) else { continue };
                pixels.paint(column, line, amplitudes.share(amplitude.max(f64::MIN_POSITIVE)));
            }
        }
    }
    pixels.draw()
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
