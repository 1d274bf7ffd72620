//! A surface with something on it: what pictures of modes, deflection shapes and stresses are drawn from.

use serde::Serialize;

/// The outer surface of a wheel or of one of its sectors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldSurface {
    /// What is shown, in words, such as `nodal diameter 2, mode 1, 1,234.5 Hz at 20,000 rpm`.
    pub title: String,
    /// More words, a line each.
    pub subtitles: Vec<String>,
    /// Cartesian positions about the axis of rotation, which is z, before anything moves.
    pub nodes: Vec<[f64; 3]>,
    /// Displacement of each node; of a mode shape of any scale.
    pub displacement: Vec<[f64; 3]>,
    /// Corners of its faces, places in `nodes`, three or four each, anticlockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// What it is coloured by.
    pub colour: SurfaceColour,
    /// Unit of length.
    pub length_unit: String,
}

/// A number for each node of a surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceColour {
    /// What it is, such as `von Mises stress`.
    pub quantity: String,
    /// Its unit; empty if it has none.
    pub unit: String,
    /// `[node]`; none where nothing is claimed.
    pub values: Vec<Option<f64>>,
}
