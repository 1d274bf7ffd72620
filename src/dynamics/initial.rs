//! The state a run starts from.

use faer::c64;

/// One mode that moves when the run starts; all others are at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InitialMode {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// Mode within the nodal diameter, counted from 0; one that the scheme integrates.
    pub family: usize,
    /// z(0); its imaginary part is ignored for a single harmonic.
    pub displacement: c64,
    /// ż(0).
    pub velocity: c64,
}
