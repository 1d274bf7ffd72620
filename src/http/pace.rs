//! Pace of a client: how long it keeps the service waiting for each piece that it sends or takes.

use std::time::Duration;

/// Bytes of a piece; the wait is limited for a whole piece, so that a byte now and then wins no time.
pub(super) const PIECE: u64 = 64 << 10;

/// Pace at which a body comes or an answer is taken.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Pace {
    waited: Duration,
    moved: u64,
}

impl Pace {
    /// Time for which this piece was waited for until its last byte so far.
    pub(super) fn waited(self) -> Duration {
        self.waited
    }

    /// Counts `bytes` more that came or were taken after a further wait.
    pub(super) fn moves(&mut self, bytes: u64, after: Duration) {
        self.waited += after;
        self.moved += bytes;
        if self.moved >= PIECE {
            *self = Self::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patience_is_for_a_piece_and_not_for_a_byte() {
        let second = Duration::from_secs(1);
        let mut pace = Pace::default();
        for _ in 0..30 {
            pace.moves(1, second);
        }
        assert_eq!(pace.waited(), 30 * second, "a trickle wins no time");
        pace.moves(PIECE - 31, second);
        assert_eq!(pace.waited(), 31 * second);
        pace.moves(1, second);
        assert_eq!(pace, Pace::default());
    }
}
