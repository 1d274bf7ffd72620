//! The layout of the oscillators.

use super::super::mistuning::Place;

/// Where the modes of one nodal diameter live.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) single: bool,
    /// Modes.
    pub(super) integrated: usize,
    /// Modes, padded.
    pub(super) length: usize,
    /// Start in the coefficient arrays.
    pub(super) modes: usize,
    /// Start in the state arrays (the imaginary part of a pair follows after `length`).
    pub(super) state: usize,
    /// Fourier column of the real part (the imaginary part is the next).
    pub(super) column: usize,
}

impl Segment {
    /// Starts of its real and, for a pair, imaginary part in the state arrays.
    pub(super) fn parts(self) -> impl Iterator<Item = usize> {
        (0..if self.single { 1 } else { 2 }).map(move |part| self.state + part * self.length)
    }

    /// The same, and its Fourier column, for what couples nodal diameters.
    pub(super) fn place(&self) -> Place {
        Place { re: self.state, im: (!self.single).then_some(self.state + self.length), column: self.column }
    }

    /// Numbers in the state arrays.
    pub(super) fn size(self) -> usize {
        if self.single { self.length } else { 2 * self.length }
    }
}
