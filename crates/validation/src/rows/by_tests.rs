//! Rows by tests of the repository.

use crate::claim::Claim;

pub(crate) const ROWS: &[Claim] = &[];
