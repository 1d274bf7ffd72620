//! What marks mean: a column of marks with words.

use super::svg::{Element, group, text};

/// Width that a mark of a row may take.
pub(super) const MARK_WIDTH: f64 = 32.0;

const ROW_HEIGHT: f64 = 21.0;

/// Rows from the top down.
#[derive(Debug)]
pub(super) struct Key {
    x: f64,
    y: f64,
    rows: Element,
}

impl Key {
    /// Whose first row is at `y`.
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y, rows: group() }
    }

    /// With a mark, drawn about y = 0 from x = 0 to [`MARK_WIDTH`], and its words.
    pub(super) fn row(mut self, mark: Element, words: &str) -> Self {
        let Self { x, y, .. } = self;
        self.rows = self.rows.child(mark.set("transform", format!("translate({x} {y})"))).child(text(
            x + MARK_WIDTH + 10.0,
            y + 4.5,
            "start",
            words,
        ));
        self.y += ROW_HEIGHT;
        self
    }

    /// With words over the rows that follow.
    pub(super) fn heading(mut self, words: &str) -> Self {
        self.y += 0.5 * ROW_HEIGHT;
        self.rows = self.rows.child(text(self.x, self.y + 4.5, "start", words).set("fill", "#555555"));
        self.y += ROW_HEIGHT;
        self
    }

    pub(super) fn draw(self) -> Element {
        self.rows
    }
}
