//! Finite elements of a sector: stress against CalculiX, patch tests, closed forms.

mod calculix;
mod closed_forms;
mod cyclic;
mod meshes;
mod patch;
