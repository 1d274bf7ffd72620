//! Key of a drawing: marks with words.

use super::svg::{Element, group, text, text_width};

/// Width that the mark of a row may take.
pub(super) const MARK_WIDTH: f64 = 32.0;

/// Font size of the words.
const SIZE: f64 = 13.0;

const ROW_HEIGHT: f64 = 21.0;

/// Key in rows, from the top down.
#[derive(Debug)]
pub(super) struct Key {
    x: f64,
    y: f64,
    rows: Element,
}

impl Key {
    /// Begins a key whose first row is at `y`.
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y, rows: group() }
    }

    /// Adds a row: a mark, drawn about y = 0 from x = 0 to [`MARK_WIDTH`], and its words.
    pub(super) fn row(mut self, mark: Element, words: &str) -> Self {
        let Self { x, y, .. } = self;
        self.rows = self
            .rows
            .child(mark.set("transform", format!("translate({x} {y})")))
            .child(text(x + MARK_WIDTH + 10.0, y + 4.5, "start", words).set("class", "key"));
        self.y += ROW_HEIGHT;
        self
    }

    /// Adds a heading over the rows that follow.
    pub(super) fn heading(mut self, words: &str) -> Self {
        self.y += 0.5 * ROW_HEIGHT;
        self.rows = self.rows.child(text(self.x, self.y + 4.5, "start", words).set("fill", "#555555"));
        self.y += ROW_HEIGHT;
        self
    }

    /// Adds a note about the rows above.
    pub(super) fn note(mut self, words: &str) -> Self {
        let note = text(self.x, self.y + 3.5, "start", words).set("class", "key").set("fill", "#555555");
        self.rows = self.rows.child(note.set("font-size", "11"));
        self.y += 0.8 * ROW_HEIGHT;
        self
    }

    pub(super) fn draw(self) -> Element {
        self.rows
    }
}

/// Key side by side: marks with words, in as many lines as they need between two positions.
#[derive(Debug)]
pub(super) struct Flow {
    left: f64,
    right: f64,
    x: f64,
    y: f64,
    entries: Element,
}

impl Flow {
    /// Begins a key whose first line is at `y`.
    pub(super) fn new(left: f64, right: f64, y: f64) -> Self {
        Self { left, right, x: left, y, entries: group() }
    }

    /// Adds an entry: a mark, drawn about y = 0 from x = 0 to `width`, and its words.
    pub(super) fn entry(mut self, mark: Element, width: f64, words: &str) -> Self {
        let wide = width + 7.0 + text_width(words, SIZE);
        if self.x > self.left && self.x + wide > self.right {
            self.x = self.left;
            self.y += ROW_HEIGHT;
        }
        let Self { x, y, .. } = self;
        let place = format!("translate({x:.2} {y:.2})");
        let words = text(x + width + 7.0, y + 4.5, "start", words);
        self.entries = self.entries.child(mark.set("transform", place)).child(words.set("class", "key"));
        self.x += wide + 22.0;
        self
    }

    /// Height of the last line of the key.
    pub(super) fn bottom(&self) -> f64 {
        self.y
    }

    pub(super) fn draw(self) -> Element {
        self.entries
    }
}
