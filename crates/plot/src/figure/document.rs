//! A figure as a whole: its traces, and what is around them.

use plotly::common::{Orientation, Title as AxisTitle};
use plotly::layout::{Axis, HoverMode, Margin};
use plotly::{HeatMap, Layout, Scatter};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::text::{broken, escaped};

/// Characters of a line above a figure, of the title and of what is below it: what fits into 390 pixels.
const COLUMNS: (usize, usize) = (44, 64);

/// A result as a figure for Plotly: its JSON is `{"data": […], "layout": {…}}`.
///
/// `layout.meta` says what the figure is of (`kind`) and what a program needs that shows it. Colours of paper, frame, letters and grid are
/// left to whoever does; texts have no styles of their own, which some pages forbid.
#[derive(Debug, Clone, Serialize)]
pub struct Figure {
    data: Vec<Trace>,
    layout: Around,
}

/// What is drawn.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Trace {
    Scatter(Box<Scatter<f64, f64>>),
    Cells(Box<Cells>),
}

/// Colours over cells; the crate's trace knows neither an axis of colours that several share nor data of every cell.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Cells {
    #[serde(flatten)]
    pub(super) map: HeatMap<f64, f64, Vec<f32>>,
    pub(super) coloraxis: &'static str,
    /// Of every cell what the pointer tells, row by row.
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

/// The crate's layout, and attributes that it does not have.
#[derive(Debug, Clone, Serialize)]
struct Around {
    #[serde(flatten)]
    layout: Layout,
    #[serde(flatten)]
    more: Map<String, Value>,
}

impl Figure {
    /// An empty figure of this kind with a title and, below it, paragraphs.
    pub(super) fn new(kind: &str, title: &str, paragraphs: &[String]) -> Self {
        let words: Vec<String> = paragraphs.iter().map(|words| broken(words, COLUMNS.1)).collect();
        let (title, words) = (broken(title, COLUMNS.0), words.join("<br>"));
        let lines = |text: &str| if text.is_empty() { 0 } else { 1 + text.matches("<br>").count() };
        // Room for the lines of both.
        let top = 24 + 20 * lines(&title) + 15 * lines(&words);
        let title = json!({
            "text": title, "font": {"size": 15}, "x": 0.02, "xanchor": "left", "y": 1, "yanchor": "top", "yref": "container",
            "pad": {"t": 12}, "subtitle": {"text": words, "font": {"size": 11}},
        });
        // Below all, as wide as the figure.
        let legend = json!({
            "orientation": Orientation::Horizontal, "x": 0, "xanchor": "left", "xref": "container", "y": 0.0, "yanchor": "bottom",
            "yref": "container", "font": {"size": 11},
        });
        let more = [("title", title), ("legend", legend), ("meta", json!({"kind": kind}))];
        let layout = Layout::new()
            .hover_mode(HoverMode::Closest)
            .margin(Margin::new().top(top).left(64).right(16).bottom(48));
        let more = more.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Self { data: Vec::new(), layout: Around { layout, more } }
    }

    /// So many pixels high.
    pub(super) fn high(mut self, pixels: usize) -> Self {
        self.layout.layout = self.layout.layout.height(pixels);
        self
    }

    /// With another trace over those that are there.
    pub(super) fn with(mut self, trace: impl Into<Trace>) -> Self {
        self.data.push(trace.into());
        self
    }

    /// With several.
    pub(super) fn with_all<T: Into<Trace>>(mut self, traces: impl IntoIterator<Item = T>) -> Self {
        self.data.extend(traces.into_iter().map(Into::into));
        self
    }

    /// With an axis, such as `xaxis` or `yaxis2`.
    pub(super) fn axis(self, name: &str, axis: Axis) -> Self {
        self.attribute(name, json!(axis))
    }

    /// With an attribute of the layout.
    pub(super) fn attribute(mut self, name: &str, value: Value) -> Self {
        self.layout.more.insert(name.to_owned(), value);
        self
    }

    /// With something to know in `layout.meta`.
    pub(super) fn meta(mut self, name: &str, value: impl Serialize) -> Self {
        if let Some(Value::Object(meta)) = self.layout.more.get_mut("meta") {
            meta.insert(name.to_owned(), json!(value));
        }
        self
    }

    /// With words in the middle, where there is nothing to draw.
    pub(super) fn empty(self, words: &str) -> Self {
        let hidden = || Axis::new().visible(false);
        self.axis("xaxis", hidden()).axis("yaxis", hidden()).attribute(
            "annotations",
            json!([{"text": broken(words, COLUMNS.0), "xref": "paper", "yref": "paper", "x": 0.5, "y": 0.5, "showarrow": false}]),
        )
    }
}

/// An axis with a title.
pub(super) fn axis(title: &str) -> Axis {
    Axis::new().title(AxisTitle::with_text(escaped(title))).auto_margin(true).separate_thousands(true)
}
