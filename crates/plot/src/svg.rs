//! Subset of SVG that the drawings need: elements with escaped attributes and texts.

use std::fmt::Write;

/// Font families that most machines have, and any sans-serif one elsewhere.
const FONTS: &str = "Helvetica, Arial, 'DejaVu Sans Condensed', 'DejaVu Sans', sans-serif";

/// SVG element with its attributes and children.
#[derive(Debug, Clone)]
pub(super) struct Element {
    name: &'static str,
    attributes: String,
    children: String,
}

impl Element {
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, attributes: String::new(), children: String::new() }
    }

    /// Sets an attribute to words.
    pub(super) fn set(mut self, name: &str, value: impl AsRef<str>) -> Self {
        self.attributes += &format!(" {name}=\"{}\"", escape(value.as_ref()));
        self
    }

    /// Sets an attribute to a number in user units, rounded to a hundredth.
    pub(super) fn number(self, name: &str, value: f64) -> Self {
        self.set(name, number(value))
    }

    /// Adds a text inside the element.
    pub(super) fn text(mut self, text: &str) -> Self {
        self.children += &escape(text);
        self
    }

    /// Sets the title of the element, which a browser shows under the pointer.
    pub(super) fn title(self, text: &str) -> Self {
        self.child(Self::new("title").text(text))
    }

    /// Sets a rim that keeps a text legible over its background.
    pub(super) fn rimmed(self, colour: &str) -> Self {
        let rim = self.set("paint-order", "stroke").set("stroke", colour).set("stroke-width", "3");
        rim.set("stroke-linejoin", "round")
    }

    /// Adds an element inside.
    pub(super) fn child(mut self, child: Self) -> Self {
        child.write_to(&mut self.children);
        self
    }

    /// Adds elements inside.
    pub(super) fn children(self, children: impl IntoIterator<Item = Self>) -> Self {
        children.into_iter().fold(self, Self::child)
    }

    fn write_to(&self, out: &mut String) {
        let Self { name, attributes, children } = self;
        if children.is_empty() {
            out.push_str(&format!("<{name}{attributes}/>\n"));
        } else {
            out.push_str(&format!("<{name}{attributes}>{children}</{name}>\n"));
        }
    }
}

/// Renders a whole drawing of `width` × `height` on white.
pub(super) fn document(title: &str, width: f64, height: f64, content: Vec<Element>) -> String {
    let root = Element::new("svg")
        .set("xmlns", "http://www.w3.org/2000/svg")
        .number("width", width)
        .number("height", height)
        .set("viewBox", format!("0 0 {} {}", number(width), number(height)))
        .set("font-family", FONTS)
        .set("font-size", "13")
        .set("fill", INK)
        .title(title)
        .child(rectangle(0.0, 0.0, width, height).set("fill", "white"))
        .children(content);
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    root.write_to(&mut out);
    out
}

/// Colour of texts and axes.
pub(super) const INK: &str = "#222222";

/// SVG group.
pub(super) fn group() -> Element {
    Element::new("g")
}

/// SVG rectangle.
pub(super) fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Element {
    Element::new("rect").number("x", x).number("y", y).number("width", width).number("height", height)
}

/// Straight line between two points.
pub(super) fn line(from: (f64, f64), to: (f64, f64)) -> Element {
    Element::new("line").number("x1", from.0).number("y1", from.1).number("x2", to.0).number("y2", to.1)
}

/// Polyline through points; a missing point interrupts it.
pub(super) fn polyline(points: impl IntoIterator<Item = Option<(f64, f64)>>) -> Element {
    let mut path = String::new();
    let mut pen_down = false;
    for point in points {
        if let Some((x, y)) = point {
            let command = if pen_down { 'L' } else { 'M' };
            // Writing to a string cannot fail.
            let _ = write!(path, "{command}{} {}", number(x), number(y));
        }
        pen_down = point.is_some();
    }
    Element::new("path").set("d", path).set("fill", "none")
}

/// Text that begins, is centred (`middle`) or ends at a point.
pub(super) fn text(x: f64, y: f64, anchor: &str, content: &str) -> Element {
    Element::new("text").number("x", x).number("y", y).set("text-anchor", anchor).text(content)
}

/// Approximate width of a text of this size in the fonts of a drawing.
pub(super) fn text_width(words: &str, size: f64) -> f64 {
    let share = |character: char| match character {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '|' | '\'' | ' ' | '·' | '(' | ')' | '/' => 0.34,
        'm' | 'w' | 'M' | 'W' | '%' | '—' | '→' | '±' | '−' | '≤' | '×' => 0.84,
        c if c.is_uppercase() => 0.68,
        _ => 0.57,
    };
    size * words.chars().map(share).sum::<f64>()
}

/// Text that reads upwards from (or centred at) a point.
pub(super) fn upright(x: f64, y: f64, anchor: &str, content: &str) -> Element {
    text(x, y, anchor, content).set("transform", format!("rotate(-90 {} {})", number(x), number(y)))
}

/// Formats a number to a hundredth, without trailing zeros.
fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Negative zero is written as 0.
    format!("{}", rounded + 0.0)
}

fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML 1.0 allows no other control characters, not even escaped.
            c if c.is_control() && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_texts_stay_texts() {
        let drawing = document("a < b & \"c\"\u{1}", 10.0, 10.0, vec![text(1.0, -0.001, "start", "</text>")]);
        let read = roxmltree::Document::parse(&drawing).unwrap();
        let texts: Vec<_> = read.descendants().filter(|n| n.has_tag_name("text")).collect();
        assert_eq!(texts[0].text(), Some("</text>"));
        assert_eq!(texts[0].attribute("y"), Some("0"));
        assert_eq!(read.root_element().first_element_child().unwrap().text(), Some("a < b & \"c\"\u{fffd}"));
    }

    #[test]
    fn missing_points_interrupt_lines() {
        let drawing = polyline([Some((0.0, 1.0)), Some((1.0, 1.0)), None, Some((3.0, 0.5))]);
        assert!(drawing.attributes.contains("M0 1L1 1M3 0.5"), "{}", drawing.attributes);
    }
}
