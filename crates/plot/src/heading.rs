//! Heading above a diagram: title, paragraphs, and a warning.

use super::svg::{Element, group, text};

const LINE_HEIGHT: f64 = 17.0;

/// Number of characters in a line of the heading: at 13 units hardly more fit into the width of a drawing.
const COLUMNS: usize = 165;

/// Colour of warnings in words.
pub(super) const WARNING: &str = "#b01f20";

/// Draws a title, paragraphs and a warning, broken into as many lines as they need, and returns the height at which they end.
pub(super) fn heading(
    left: f64,
    title: &str,
    paragraphs: &[String],
    warning: Option<&String>,
) -> (Element, f64) {
    let title = text(left, 28.0, "start", title).set("font-size", "18").set("font-weight", "bold");
    let plain = lines(paragraphs).into_iter().map(|line| (line, "#555555"));
    let lines = plain.chain(lines(warning).into_iter().map(|line| (line, WARNING))).enumerate();
    let rows = lines.map(|(i, (line, colour))| text(left, height(i), "start", &line).set("fill", colour));
    (group().child(title).children(rows), bottom(paragraphs, warning))
}

/// Height at which a title, paragraphs and a warning end.
pub(super) fn bottom(paragraphs: &[String], warning: Option<&String>) -> f64 {
    height((lines(paragraphs).len() + lines(warning).len()).saturating_sub(1))
}

fn lines<'a>(paragraphs: impl IntoIterator<Item = &'a String>) -> Vec<String> {
    paragraphs.into_iter().flat_map(|words| broken(words, COLUMNS)).collect()
}

fn height(line: usize) -> f64 {
    48.0 + LINE_HEIGHT * line as f64
}

/// Words for the model and the program version that numbers come from.
pub(super) fn origin(model: &str, version: &str) -> String {
    let model: String = model.chars().take(12).collect();
    format!("model {model} · rubmap {version}")
}

/// Breaks words into lines of at most `columns` characters, unless a single word has more.
pub(super) fn broken(words: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        assert_eq!(broken("a tiny  perturbation grows", 8), ["a tiny", "perturbation", "grows"]);
        assert_eq!(broken("Ω is 2 π", 8), ["Ω is 2 π"]);
        assert!(broken(" ", 8).is_empty());
    }
}
