//! Plotly's script, which draws the figures of the page (<https://plotly.com/javascript/>, MIT).

/// The script, compressed by gzip.
pub const GZIPPED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/plotly.js.gz"));
