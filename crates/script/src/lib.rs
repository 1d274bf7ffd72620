//! Plotly's script, which draws the figures of the page (<https://plotly.com/javascript/>, MIT).

/// Plotly's script, compressed by gzip.
pub const GZIPPED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/plotly.js.gz"));
