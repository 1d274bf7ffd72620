//! The finite elements of a sector: stress against CalculiX, patch tests, closed forms.

mod closed_forms;
mod meshes;
mod patch;
