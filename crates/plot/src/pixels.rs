//! Image with the palette of amplitudes, stretched over a diagram.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::colour;
use super::diagram::Diagram;
use super::svg::Element;

/// Number of pixels of the image for each unit of the drawing.
pub(super) const DENSITY: f64 = 2.0;

/// Palette index of pixels without a result: transparent.
pub(super) const MISSING: u8 = 255;

/// Image over one diagram; unpainted pixels are transparent.
#[derive(Debug)]
pub(super) struct Pixels {
    diagram: Diagram,
    pub(super) width: usize,
    pub(super) height: usize,
    shades: Vec<u8>,
}

impl Pixels {
    pub(super) fn over(diagram: &Diagram) -> Self {
        let (width, height) = ((diagram.width * DENSITY) as usize, (diagram.height * DENSITY) as usize);
        Self { diagram: *diagram, width, height, shades: vec![MISSING; width * height] }
    }

    /// Paints a share of the scale; where a pixel is painted twice, the larger share stays.
    pub(super) fn paint(&mut self, column: usize, line: usize, share: f64) {
        let shade = (share.clamp(0.0, 1.0) * 254.0).round() as u8;
        let pixel = &mut self.shades[line * self.width + column];
        *pixel = if *pixel == MISSING { shade } else { (*pixel).max(shade) };
    }

    /// Paints the rectangle between two positions of the drawing; at least a pixel wide and high if any of it is in the diagram.
    pub(super) fn paint_area(&mut self, x: (f64, f64), y: (f64, f64), share: f64) {
        let columns = within((x.0 - self.diagram.left, x.1 - self.diagram.left), self.width);
        for line in within((y.0 - self.diagram.top, y.1 - self.diagram.top), self.height) {
            for column in columns.clone() {
                self.paint(column, line, share);
            }
        }
    }

    pub(super) fn draw(&self) -> Element {
        over(&self.diagram, self.data_uri()).set("image-rendering", "pixelated")
    }

    fn data_uri(&self) -> String {
        let palette: Vec<u8> =
            (0..=254).flat_map(|i| colour::amplitude(f64::from(i) / 254.0)).chain([0; 3]).collect();
        data_uri((self.width, self.height), palette, &self.shades)
    }
}

/// Image stretched over a diagram.
pub(super) fn over(diagram: &Diagram, address: String) -> Element {
    let Diagram { left, top, width, height, .. } = *diagram;
    Element::new("image")
        .number("x", left)
        .number("y", top)
        .number("width", width)
        .number("height", height)
        .set("preserveAspectRatio", "none")
        .set("href", address)
}

/// Data URI of an image of `width` × `height` indices into a palette, whose index [`MISSING`] is transparent.
pub(super) fn data_uri((width, height): (usize, usize), palette: Vec<u8>, indices: &[u8]) -> String {
    let mut transparency = [255; 256];
    transparency[usize::from(MISSING)] = 0;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_trns(transparency.to_vec());
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(indices));
    // Writing to memory with sizes that agree cannot fail; without an image the drawing is still one.
    match written {
        Ok(()) => format!("data:image/png;base64,{}", STANDARD.encode(&file)),
        Err(_) => "data:,".to_owned(),
    }
}

/// Range of pixels, of `count`, between two positions.
fn within((from, to): (f64, f64), count: usize) -> std::ops::Range<usize> {
    let first = (from.min(to) * DENSITY).round().max(0.0);
    let end = (from.max(to) * DENSITY).round().max(first + 1.0);
    let inside = |pixel: f64| (pixel as usize).min(count);
    if end <= 0.0 { 0..0 } else { inside(first)..inside(end) }
}
