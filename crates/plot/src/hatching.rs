//! Hatching of areas of a map without a result.

use super::svg::{Element, rectangle};

/// Fill of areas without a result, where [`definition`] is in the drawing.
pub(super) const FILL: &str = "url(#missing)";

/// Definition of the hatching pattern.
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

/// Mark of a key for hatching, 20 wide.
pub(super) fn mark() -> Element {
    rectangle(0.0, -7.0, 20.0, 14.0).set("fill", FILL).set("stroke", "#888888")
}
