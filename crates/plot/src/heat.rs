//! The amplitudes as one image with a palette.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::axis::Scale;
use super::cells::Cell;
use super::colour;
use super::diagram::Diagram;
use super::svg::Element;
use rubmap_analysis::result::InteractionMap;

/// Pixels of the image for each unit of the drawing.
const DENSITY: f64 = 2.0;

/// Least height of a spectral line in the drawing. At 24 engine orders and a window of 20 revolutions a bin alone would be
/// a pixel high.
const LINE_HEIGHT: f64 = 5.0;

/// Palette index of a speed without result: transparent.
const MISSING: u8 = 255;

/// The loudest amplitude of the map beside the mean; none if nothing moves or nothing is there.
pub(super) fn loudest(map: &InteractionMap) -> Option<f64> {
    let values = map.amplitude.iter().flatten().flat_map(|row| row.iter().zip(&map.engine_orders));
    let loudest = values.filter(|(_, order)| **order > 0.0).fold(0.0, |m: f64, (a, _)| m.max(*a));
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
    let (width, height) = ((diagram.width * DENSITY) as usize, (diagram.height * DENSITY) as usize);
    let mut pixels = vec![MISSING; width * height];
    let value = |pixel: usize| diagram.x.value(diagram.left + pixel as f64 / DENSITY);
    let mut first = 0;
    for column in 0..width {
        let (from, to) = (value(column), value(column + 1));
        while first + 1 < cells.len() && cells[first].to <= from {
            first += 1;
        }
        // The cell at the left edge, and all that begin within the column.
        let here = cells[first..].iter().enumerate().take_while(|(i, cell)| *i == 0 || cell.from < to);
        for (_, cell) in here {
            let Some(row) = map.amplitude.get(cell.index).and_then(Option::as_ref) else { continue };
            let rpm = 0.5 * (from + to);
            for line in 0..height {
                let y = diagram.top + (line as f64 + 0.5) / DENSITY;
                let order = |y: f64| engine_order(diagram.y.value(y), rpm);
                let band = (order(y + 0.5 * LINE_HEIGHT), order(y - 0.5 * LINE_HEIGHT));
                let Some(amplitude) = loudest_within(&map.engine_orders, row, band) else { continue };
                let shade =
                    (amplitudes.share(amplitude.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0) * 254.0).round();
                let pixel = &mut pixels[line * width + column];
                *pixel = if *pixel == MISSING { shade as u8 } else { (*pixel).max(shade as u8) };
            }
        }
    }
    Element::new("image")
        .number("x", diagram.left)
        .number("y", diagram.top)
        .number("width", diagram.width)
        .number("height", diagram.height)
        .set("preserveAspectRatio", "none")
        .set("image-rendering", "pixelated")
        .set("href", data_uri(width, height, &pixels))
}

/// The loudest of the bins whose engine order lies in a band or is the nearest to its middle; the mean is no vibration.
fn loudest_within(orders: &[f64], row: &[f64], (low, high): (f64, f64)) -> Option<f64> {
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

fn data_uri(width: usize, height: usize, pixels: &[u8]) -> String {
    let palette: Vec<u8> =
        (0..=254).flat_map(|i| colour::amplitude(f64::from(i) / 254.0)).chain([0; 3]).collect();
    let mut transparency = [255; 256];
    transparency[usize::from(MISSING)] = 0;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_trns(transparency.to_vec());
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels));
    // Into memory, with sizes that agree, nothing can fail; without an image the drawing is still one.
    match written {
        Ok(()) => format!("data:image/png;base64,{}", STANDARD.encode(&file)),
        Err(_) => "data:,".to_owned(),
    }
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
