//! Wheels whose motion repeats around the circumference.
//!
//! A tuned wheel of N sectors against a casing that repeats g times (g | N), started from rest, moves alike in sectors s
//! and s + N/g at every instant, contact included. Only the nodal diameters that are multiples of g move, and N/g sectors
//! say everything: their nodal diameters i′ are the wheel's g·i′. The sub-wheel's modal coordinates are the wheel's over √g,
//! its energies, forces and impulses a g-th of the wheel's. Exact until the symmetry breaks, which the sub-wheel cannot see:
//! small asymmetries of the full wheel may grow (`response::symmetry_breaking`).

use super::modal_wheel::ModalWheel;

impl ModalWheel {
    /// Reduces a full wheel to one of its `repeats` equal parts, `repeats` dividing its sectors.
    pub fn part(mut self, repeats: usize) -> Self {
        self.harmonics.retain(|harmonic| harmonic.harmonic.is_multiple_of(repeats));
        self.sectors /= repeats;
        self.repeats = repeats;
        self
    }
}
