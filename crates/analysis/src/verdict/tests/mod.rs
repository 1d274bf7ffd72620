//! Verdicts against scenes by hand, and properties over random ones.

mod hidden;
mod properties;
mod scene;
mod scenes;
