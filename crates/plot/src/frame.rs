//! Frame from which a wheel is observed.

/// Frame from which the wheel is observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Rotating frame, which turns with the wheel.
    Rotating,
    /// Fixed frame beside the wheel: a wave of nodal diameter n at engine order k is seen at k + n or k − n, as it travels with the
    /// rotation or against it.
    Fixed,
}
