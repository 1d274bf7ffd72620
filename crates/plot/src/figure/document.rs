//! Figure for Plotly: its traces, title, axes and metadata.

use plotly::common::{ExponentFormat, Font, Orientation, Title as AxisTitle};
use plotly::layout::{Axis, HoverMode, Margin};
use plotly::{HeatMap, Layout, Scatter};
use serde::Serialize;
use serde_json::{Map, Value, json};

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
    layout: Around,
}

/// Trace of a figure: points and lines, or cells.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Trace {
    Scatter(Box<Scatter<f64, f64>>),
    Cells(Box<Cells>),
}

/// Heat map with a shared colour axis and data of every cell, which the crate's trace does not support.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Cells {
    #[serde(flatten)]
    pub(super) map: HeatMap<f64, f64, Vec<f32>>,
    pub(super) coloraxis: &'static str,
    /// Numbers of every cell that the pointer shows, row by row.
    pub(super) customdata: Vec<Vec<Vec<f32>>>,
}

impl From<Box<Scatter<f64, f64>>> for Trace {
    fn from(trace: Box<Scatter<f64, f64>>) -> Self {
        Self::Scatter(trace)
    }
}

impl From<Box<Cells>> for Trace {
    fn from(trace: Box<Cells>) -> Self {
        Self::Cells(trace)
    }
}

/// Layout of the crate, and attributes that it does not have.
#[derive(Debug, Clone, Serialize)]
struct Around {
    #[serde(flatten)]
    layout: Layout,
    #[serde(flatten)]
    more: Map<String, Value>,
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
            "orientation": Orientation::Horizontal, "x": 0, "xanchor": "left", "xref": "container", "y": 0.0, "yanchor": "bottom",
            "yref": "container", "font": {"size": 11}, "tracegroupgap": 0,
        });
        let more = [("title", title), ("legend", legend), ("meta", json!({"kind": kind}))];
        let layout = Layout::new()
            .hover_mode(HoverMode::Closest)
            .margin(Margin::new().top(top).left(64).right(16).bottom(48));
        let more = more.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Self { data: Vec::new(), layout: Around { layout, more } }
    }

    /// Sets the height of the figure, in pixels.
    pub(super) fn high(mut self, pixels: usize) -> Self {
        self.layout.layout = self.layout.layout.height(pixels);
        self
    }

    /// Adds a trace, drawn over those before it.
    pub(super) fn with(mut self, trace: impl Into<Trace>) -> Self {
        self.data.push(trace.into());
        self
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
        self.layout.more.insert(name.to_owned(), value);
        self
    }

    /// Sets an entry of `layout.meta`.
    pub(super) fn meta(mut self, name: &str, value: impl Serialize) -> Self {
        if let Some(Value::Object(meta)) = self.layout.more.get_mut("meta") {
            meta.insert(name.to_owned(), json!(value));
        }
        self
    }

    /// Puts a message in the middle, where there is nothing to draw.
    pub(super) fn empty(self, words: &str) -> Self {
        let hidden = || Axis::new().visible(false);
        self.axis("xaxis", hidden()).axis("yaxis", hidden()).attribute(
            "annotations",
            json!([{"text": broken(words, COLUMNS.0), "xref": "paper", "yref": "paper", "x": 0.5, "y": 0.5, "showarrow": false}]),
        )
    }
}

/// Axis with a title.
pub(super) fn axis(title: &str) -> Axis {
    let title = AxisTitle::with_text(broken(title, COLUMNS.2)).font(Font::new().size(12));
    Axis::new().title(title).auto_margin(true).separate_thousands(true)
}

/// Axis of rotational speeds.
pub(super) fn speeds() -> Axis {
    axis("rotational speed Ω, rpm").exponent_format(ExponentFormat::None)
}
