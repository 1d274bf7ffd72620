//! Drawings as PNG.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};

/// Widths that [`png()`] draws, in pixels: narrower images show nothing, wider ones exceed every screen and cost memory.
pub const WIDTHS: std::ops::RangeInclusive<u32> = 16..=4096;

/// Largest number of pixels of an image of any shape.
const MOST_PIXELS: f64 = 32e6;

/// Error of drawing a PNG.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PngError {
    /// Width outside [`WIDTHS`].
    #[error("a width of {width} pixels: from {} to {} are possible", WIDTHS.start(), WIDTHS.end())]
    Width {
        /// Requested width, pixels.
        width: u32,
    },
    /// Drawing that is too high for its width.
    #[error("{pixels:.0} pixels are too many: ask for a smaller width")]
    Size {
        /// Number of pixels the image would have.
        pixels: f64,
    },
    /// Text that is no SVG drawing.
    #[error("not a drawing: {0}")]
    Svg(String),
    /// Image that could not be written.
    #[error("the image could not be written: {0}")]
    Write(String),
}

/// DejaVu Sans Condensed, as wide as the fonts that browsers substitute; no other font is looked for, so that the same drawing gives the
/// same image everywhere.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    for face in [dejavu::sans_condensed::regular(), dejavu::sans_condensed::bold()] {
        fonts.load_font_source(Source::Binary(Arc::new(face)));
    }
    let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
    if let Some(family) = family {
        fonts.set_sans_serif_family(family);
    }
    Arc::new(fonts)
});

/// Draws an SVG as a PNG of this width in pixels, as high as its proportions require, on white where it is transparent.
///
/// # Errors
/// [`PngError`] of a width that is not possible and of a text that is no drawing.
pub fn png(svg: &str, width: u32) -> Result<Vec<u8>, PngError> {
    if !WIDTHS.contains(&width) {
        return Err(PngError::Width { width });
    }
    let options = Options { fontdb: FONTS.clone(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| PngError::Svg(error.to_string()))?;
    let scale = width as f32 / tree.size().width();
    let height = (tree.size().height() * scale).round().max(1.0);
    let pixels = f64::from(width) * f64::from(height);
    if pixels > MOST_PIXELS {
        return Err(PngError::Size { pixels });
    }
    let mut image = Pixmap::new(width, height as u32).ok_or(PngError::Size { pixels })?;
    image.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut image.as_mut());
    image.encode_png().map_err(|error| PngError::Write(error.to_string()))
}
