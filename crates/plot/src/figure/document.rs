//! Figure for Plotly: its traces, title, axes and metadata.

use serde::Serialize;
use serde_json::{Map, Value, json};

use super::attributes::{Axis, Cells, Font, Scatter, Title};
use super::text::broken;

/// Largest number of characters in a line of the title, of the paragraphs below it, and beside an axis: what fits into 390 pixels.
const COLUMNS: (usize, usize, usize) = (44, 60, 46);

/// Result as a figure for Plotly: its JSON is `{"data": […], "layout": {…}}`.
///
/// `layout.meta` holds the kind of figure (`kind`) and what a program needs that shows it. Colours of paper, frame, letters and grid are
/// left to the program that shows it; texts have no styles of their own, which some pages forbid.
#[derive(Debug, Clone, Serialize)]
pub struct Figure {
    data: Vec<Trace>,
    layout: Map<String, Value>,
}

/// Trace of a figure: points and lines, or cells.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Trace {
    Scatter(Box<Scatter>),
    Cells(Box<Cells>),
}

impl From<Scatter> for Trace {
    fn from(trace: Scatter) -> Self {
        Self::Scatter(Box::new(trace))
    }
}

impl From<Cells> for Trace {
    fn from(trace: Cells) -> Self {
        Self::Cells(Box::new(trace))
    }
}

impl Figure {
    /// Builds an empty figure of this kind with a title and, below it, paragraphs.
    pub(super) fn new(kind: &str, title: &str, paragraphs: &[String]) -> Self {
        let words: Vec<String> = paragraphs.iter().map(|words| broken(words, COLUMNS.1)).collect();
        let (title, words) = (broken(title, COLUMNS.0), words.join("<br>"));
        let lines = |text: &str| if text.is_empty() { 0 } else { 1 + text.matches("<br>").count() };
        // Room for the lines of the title and the paragraphs. Plotly sets several lines higher than one.
        let top = 24 + 20 * lines(&title) + 15 * lines(&words);
        let pad = if lines(&title) > 1 { 22 } else { 12 };
        let title = json!({
            "text": title, "font": {"size": 15}, "x": 0.02, "xanchor": "left", "y": 1, "yanchor": "top", "yref": "container",
            "pad": {"t": pad}, "subtitle": {"text": words, "font": {"size": 11}},
        });
        // The legend lies below the diagrams, as wide as the figure.
        let legend = json!({
            "orientation": "h", "x": 0, "xanchor": "left", "xref": "container", "y": 0.0, "yanchor": "bottom",
            "yref": "container", "font": {"size": 11}, "tracegroupgap": 0,
        });
        let figure = Self { data: Vec::new(), layout: Map::new() };
        figure
            .attribute("hovermode", json!("closest"))
            .attribute("margin", json!({"t": top, "l": 64, "r": 16, "b": 48}))
            .attribute("title", title)
            .attribute("legend", legend)
            .attribute("meta", json!({"kind": kind}))
    }

    /// Sets the height of the figure, in pixels.
    pub(super) fn high(self, pixels: usize) -> Self {
        self.attribute("height", json!(pixels))
    }

    /// Adds several traces.
    pub(super) fn with_all<T: Into<Trace>>(mut self, traces: impl IntoIterator<Item = T>) -> Self {
        self.data.extend(traces.into_iter().map(Into::into));
        self
    }

    /// Sets an axis, such as `xaxis` or `yaxis2`.
    pub(super) fn axis(self, name: &str, axis: Axis) -> Self {
        self.attribute(name, json!(axis))
    }

    /// Sets an attribute of the layout.
    pub(super) fn attribute(mut self, name: &str, value: Value) -> Self {
        self.layout.insert(name.to_owned(), value);
        self
    }

    /// Sets an entry of `layout.meta`.
    pub(super) fn meta(mut self, name: &str, value: impl Serialize) -> Self {
        if let Some(Value::Object(meta)) = self.layout.get_mut("meta") {
            meta.insert(name.to_owned(), json!(value));
        }
        self
    }

    /// Puts a message in the middle, where there is nothing to draw.
    pub(super) fn empty(self, words: &str) -> Self {
        let hidden = || Axis::default().visible(false);
        self.axis("xaxis", hidden()).axis("yaxis", hidden()).note(words, 0.5)
    }

    /// Puts a message over the middle, at this share of the height.
    pub(super) fn note(self, words: &str, height: f64) -> Self {
        let words = broken(words, COLUMNS.0);
        let place = json!({"text": words, "xref": "paper", "yref": "paper", "x": 0.5, "y": height, "showarrow": false});
        self.annotations([place])
    }

    /// Adds annotations.
    pub(super) fn annotations(mut self, more: impl IntoIterator<Item = Value>) -> Self {
        let mut more = more.into_iter().peekable();
        if more.peek().is_some()
            && let Value::Array(all) = self.layout.entry("annotations").or_insert_with(|| json!([]))
        {
            all.extend(more);
        }
        self
    }

    /// Adds room above the panels, in pixels, which makes the figure so much higher.
    pub(super) fn room(mut self, pixels: usize) -> Self {
        let more = |value: &mut Value| {
            if let Some(before) = value.as_u64() {
                *value = json!(before + pixels as u64);
            }
        };
        self.layout.get_mut("margin").and_then(|margin| margin.get_mut("t")).map(more);
        self.layout.get_mut("height").map(more);
        self
    }
}

/// Axis with a title.
pub(super) fn axis(title: &str) -> Axis {
    let title = Title::default().text(broken(title, COLUMNS.2)).font(Font::default().size(12u32));
    Axis::default().title(title).automargin(true).separatethousands(true)
}
