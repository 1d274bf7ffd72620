//! Numbers in [−1, 1) whose bits depend on no library.

/// State of the sequence of numbers.
pub(super) struct Numbers(pub(super) u64);

impl Numbers {
    pub(super) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 12) as f64 / (1u64 << 51) as f64 - 1.0
    }
}
