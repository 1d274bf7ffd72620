//! Engineering results from histories: spectra, nodal diameters, settling and critical speeds (docs/method.md, Reading responses).

pub mod campbell;
pub mod coincidence;
pub mod critical_speed;
mod growth;
pub mod sensitivity;
pub mod settling;
pub mod side_bands;
pub mod spectra;
pub mod symmetry_breaking;
pub mod veerings;
pub mod waves;
