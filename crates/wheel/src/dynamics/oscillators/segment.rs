//! Layout of the oscillators.

use super::super::mistuning::ModeOffsets;

/// Places of the modes of one nodal diameter in the arrays of the oscillators.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) single: bool,
    /// Number of modes.
    pub(super) integrated: usize,
    /// Number of modes, padded.
    pub(super) length: usize,
    /// Start in the coefficient arrays.
    pub(super) modes: usize,
    /// Start in the state arrays (the imaginary part of a pair follows after `length`).
    pub(super) state: usize,
    /// Fourier column of the real part (the imaginary part is the next).
    pub(super) column: usize,
}

impl Segment {
    /// Starts of the real and, for a pair, imaginary part in the state arrays.
    pub(super) fn parts(self) -> impl Iterator<Item = usize> {
        (0..if self.single { 1 } else { 2 }).map(move |part| self.state + part * self.length)
    }

    /// Offsets of the modes in the state, and their Fourier column, for mistuning, which couples nodal diameters.
    pub(super) fn offsets(&self) -> ModeOffsets {
        ModeOffsets {
            re: self.state,
            im: (!self.single).then_some(self.state + self.length),
            column: self.column,
        }
    }

    /// Number of values in the state arrays.
    pub(super) fn size(self) -> usize {
        if self.single { self.length } else { 2 * self.length }
    }
}
