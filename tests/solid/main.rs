//! Finite elements of a sector: stress against CalculiX, patch tests, closed forms.

mod calculix;
mod closed_forms;
mod crooked;
mod cyclic;
mod deck;
mod matrices;
mod meshes;
mod patch;
