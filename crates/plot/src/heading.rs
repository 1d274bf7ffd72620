//! Heading above a diagram: title and paragraphs.

use super::svg::{Element, group, text};

const LINE_HEIGHT: f64 = 17.0;

/// Number of characters in a line of the heading: at 13 units hardly more fit into the width of a drawing.
const COLUMNS: usize = 165;

/// Draws a title and paragraphs, broken into as many lines as they need, and returns the height at which they end.
pub(super) fn heading(left: f64, title: &str, paragraphs: &[String]) -> (Element, f64) {
    let title = text(left, 28.0, "start", title).set("font-size", "18").set("font-weight", "bold");
    let lines = lines(paragraphs);
    let row = |(i, line): (usize, &String)| text(left, height(i), "start", line).set("fill", "#555555");
    (group().child(title).children(lines.iter().enumerate().map(row)), bottom(paragraphs))
}

/// Height at which a title and paragraphs end.
pub(super) fn bottom(paragraphs: &[String]) -> f64 {
    height(lines(paragraphs).len().saturating_sub(1))
}

fn lines(paragraphs: &[String]) -> Vec<String> {
    paragraphs.iter().flat_map(|words| broken(words, COLUMNS)).collect()
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
