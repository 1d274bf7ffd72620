//! Surface with a field on it, from which pictures of modes, deflection shapes and stresses are drawn.

use serde::Serialize;

/// The outer surface of a wheel or of one of its sectors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldSurface {
    /// Title: what is shown, in words, such as `nodal diameter 2, mode 1, 1,234.5 Hz at 20,000 rpm`.
    pub title: String,
    /// Further words below the title, a line each.
    pub subtitles: Vec<String>,
    /// Cartesian positions about the axis of rotation, which is z, before anything moves.
    pub nodes: Vec<[f64; 3]>,
    /// Displacement of each node; for a mode shape, of any scale.
    pub displacement: Vec<[f64; 3]>,
    /// Corners of the faces, indices into `nodes`, three or four each, anticlockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Field that colours the surface.
    pub colour: SurfaceColour,
    /// Unit of length.
    pub length_unit: String,
}

/// Field of numbers, one for each node of a surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceColour {
    /// Name of the quantity, such as `von Mises stress`.
    pub quantity: String,
    /// Unit of the quantity; empty if it has none.
    pub unit: String,
    /// Value at each node; none where nothing is claimed.
    pub values: Vec<Option<f64>>,
}
