//! Attributes of Plotly's traces and axes, as far as figures use them, under the names that Plotly gives them.

use serde::Serialize;

/// Defines a struct of optional attributes, each with a method that sets it; what is not set is not written.
macro_rules! attributes {
    ($(#[$about:meta])* $name:ident { $($(#[$serde:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Default, Serialize)]
        pub(super) struct $name {
            $($(#[$serde])* #[serde(skip_serializing_if = "Option::is_none")] $field: Option<$type>,)*
        }

        impl $name {
            $(pub(super) fn $field(mut self, value: impl Into<$type>) -> Self {
                self.$field = Some(value.into());
                self
            })*
        }
    };
}

/// One value for all points of a trace, or one for each.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Each<T> {
    /// Value of all points.
    All(T),
    /// Values of the points, in their order.
    Every(Vec<T>),
}

impl From<&str> for Each<String> {
    fn from(value: &str) -> Self {
        Self::All(value.to_owned())
    }
}

impl From<String> for Each<String> {
    fn from(value: String) -> Self {
        Self::All(value)
    }
}

impl From<f64> for Each<f64> {
    fn from(value: f64) -> Self {
        Self::All(value)
    }
}

impl From<Vec<f64>> for Each<f64> {
    fn from(values: Vec<f64>) -> Self {
        Self::Every(values)
    }
}

/// Colours of a scale at shares of its range.
pub(super) type Stops = Vec<(f64, String)>;

/// Colour of a mark: its name, or a value on a colour scale for each.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Paint {
    /// Colour of all marks.
    Named(String),
    /// Values on the colour scale, one for each mark.
    Scaled(Vec<f64>),
}

impl From<&str> for Paint {
    fn from(name: &str) -> Self {
        Self::Named(name.to_owned())
    }
}

impl From<String> for Paint {
    fn from(name: String) -> Self {
        Self::Named(name)
    }
}

impl From<Vec<f64>> for Paint {
    fn from(values: Vec<f64>) -> Self {
        Self::Scaled(values)
    }
}

attributes! {
    /// Stroke of a line.
    Line { color: String, width: f64, dash: &'static str, shape: &'static str, }
}

attributes! {
    /// Title of an axis, of a colour bar, or of a legend.
    Title { text: String, side: &'static str, font: Font, }
}

attributes! {
    /// Size of letters.
    Font { size: u32, }
}

attributes! {
    /// Bar that explains a colour scale.
    ColorBar {
        title: Title, thickness: f64, x: f64, y: f64, len: f64, lenmode: &'static str, outlinewidth: f64,
        tickmode: &'static str, tickvals: Vec<f64>, ticktext: Vec<String>,
    }
}

attributes! {
    /// Marks at the points of a trace.
    Marker {
        symbol: &'static str, size: Each<f64>, color: Paint, colorscale: Stops, cmin: f64, cmax: f64,
        showscale: bool, colorbar: ColorBar,
    }
}

attributes! {
    /// Error bars.
    ErrorBars {
        #[serde(rename = "type")]
        kind: &'static str, array: Vec<f64>, arrayminus: Vec<f64>, symmetric: bool, color: String, thickness: f64, width: f64,
    }
}

attributes! {
    /// Trace of points and lines.
    Scatter {
        #[serde(rename = "type")]
        kind: &'static str, name: String, x: Vec<f64>, y: Vec<f64>, mode: &'static str, line: Line, marker: Marker,
        text: Vec<String>, textposition: &'static str, hoverinfo: &'static str, hovertext: Vec<String>, hovertemplate: String,
        customdata: Vec<usize>, xaxis: String, yaxis: String, legendgroup: String, showlegend: bool, opacity: f64,
        fill: &'static str, fillcolor: String, error_x: ErrorBars, error_y: ErrorBars, cliponaxis: bool,
    }
}

attributes! {
    /// Trace of cells in colours of an axis of colours.
    Cells {
        #[serde(rename = "type")]
        kind: &'static str, x: Vec<f64>, y: Vec<f64>, z: Vec<Vec<f32>>, customdata: Vec<Vec<Vec<f32>>>, hoverongaps: bool,
        hovertemplate: String, xaxis: String, yaxis: String, coloraxis: &'static str,
    }
}

attributes! {
    /// Axis of colours, which traces share.
    ColorAxis { colorscale: Stops, cmin: f64, cmax: f64, colorbar: ColorBar, }
}

attributes! {
    /// Axis of a diagram.
    Axis {
        #[serde(rename = "type")]
        kind: &'static str, title: Title, range: [f64; 2], rangemode: &'static str, domain: [f64; 2], anchor: String,
        matches: &'static str, visible: bool, automargin: bool, separatethousands: bool, exponentformat: &'static str, dtick: f64,
        nticks: u32, tickangle: f64, tickvals: Vec<f64>, ticktext: Vec<String>, ticksuffix: &'static str, zeroline: bool,
        scaleanchor: &'static str, scaleratio: f64, constrain: &'static str,
    }
}
