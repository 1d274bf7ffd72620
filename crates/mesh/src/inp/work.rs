//! Bound on the work that sets of sets, ranges and instances make: a short deck can name a large set over and over.

use crate::error::MeshProblem;

/// Most numbers that sets, supports and instances take out of ranges and other sets, in a whole deck.
const MOST: u64 = 100_000_000;

/// Numbers that may still be taken.
#[derive(Debug)]
pub(super) struct Work {
    left: u64,
}

impl Default for Work {
    fn default() -> Self {
        Self::of(MOST)
    }
}

impl Work {
    /// Bound of `left` numbers.
    pub(super) fn of(left: u64) -> Self {
        Self { left }
    }

    /// Takes `count` numbers, or refuses the deck.
    pub(super) fn take(&mut self, count: usize) -> Result<(), MeshProblem> {
        match self.left.checked_sub(count as u64) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(MeshProblem::NotCarried {
                what: format!(
                    "a deck whose sets of sets, ranges and instances have more than {MOST} numbers"
                ),
                advice: "sets name each other or the same range too often; name what the model needs only",
            }),
        }
    }
}
