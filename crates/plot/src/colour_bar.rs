//! Colour bar of a map: colours with ticks and a title.

use super::axis::Scale;
use super::colour;
use super::svg::{Element, INK, group, line, rectangle, text, text_width, upright};

const WIDTH: f64 = 16.0;

/// Draws a bar of colours at ascending shares of a scale.
pub(super) fn draw(
    colours: impl IntoIterator<Item = (f64, [u8; 3])>,
    amplitudes: &Scale,
    left: f64,
    ticks: &[(f64, String)],
    title: &str,
) -> Element {
    let stops: Vec<(String, String)> =
        colours.into_iter().map(|(share, rgb)| (format!("{share:.4}"), colour::hex(rgb))).collect();
    // Drawings share a page, so a name must identify one bar: equal colours, equal name.
    let bytes = stops.iter().flat_map(|(share, colour)| share.bytes().chain(colour.bytes()));
    let sum = bytes.fold(0u32, |sum, byte| sum.wrapping_mul(31).wrapping_add(u32::from(byte)));
    let id = format!("scale-{sum:x}");
    let stops = stops
        .iter()
        .map(|(share, colour)| Element::new("stop").set("offset", share).set("stop-color", colour));
    let gradient = Element::new("linearGradient")
        .set("id", &id)
        .set("x1", "0")
        .set("x2", "0")
        .set("y1", "1")
        .set("y2", "0")
        .children(stops);
    let (low, high) = amplitudes.values;
    let (bottom, top) = (amplitudes.place(low), amplitudes.place(high));
    let inside = ticks.iter().filter(|(value, _)| amplitudes.contains(*value));
    let marks = inside.flat_map(|(value, label)| {
        let y = amplitudes.place(*value);
        let tick = line((left + WIDTH, y), (left + WIDTH + 4.0, y)).set("stroke", INK);
        [tick, text(left + WIDTH + 7.0, y + 4.0, "start", label).set("font-size", "11")]
    });
    let widest = ticks.iter().map(|(_, label)| text_width(label, 11.0)).fold(0.0, f64::max);
    let title = upright(left + f64::max(66.0, WIDTH + widest + 26.0), 0.5 * (bottom + top), "middle", title);
    group()
        .child(Element::new("defs").child(gradient))
        .child(
            rectangle(left, top, WIDTH, bottom - top).set("fill", format!("url(#{id})")).set("stroke", INK),
        )
        .children(marks)
        .child(title.set("font-size", "14"))
}
