//! How it looks where a map has no result.

use super::svg::{Element, rectangle};

/// What areas without a result are filled with, where [`definition`] is in the drawing.
pub(super) const FILL: &str = "url(#missing)";

/// The pattern itself.
pub(super) fn definition() -> Element {
    let pattern = Element::new("pattern")
        .set("id", "missing")
        .set("width", "8")
        .set("height", "8")
        .set("patternUnits", "userSpaceOnUse")
        .set("patternTransform", "rotate(45)")
        .child(rectangle(0.0, 0.0, 8.0, 8.0).set("fill", "#e9e9e9"))
        .child(rectangle(0.0, 0.0, 3.0, 8.0).set("fill", "#b5b5b5"));
    Element::new("defs").child(pattern)
}

/// A mark of a key, 20 wide.
pub(super) fn mark() -> Element {
    rectangle(0.0, -7.0, 20.0, 14.0).set("fill", FILL).set("stroke", "#888888")
}
