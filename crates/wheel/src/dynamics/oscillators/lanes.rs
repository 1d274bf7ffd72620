//! Width of vectors.

/// Number of doubles per padded group: the widest vector in use (AVX-512).
pub(crate) const LANES: usize = 8;

pub(crate) fn padded(count: usize) -> usize {
    count.next_multiple_of(LANES)
}
