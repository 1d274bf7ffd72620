//! Other readings of the rows, and which of them puts more in balance than the stated one.

/// Fewest nodes, or pairs of them, that another reading must put in balance.
pub(super) const FEWEST: usize = 3;

/// Reading that balances more than the stated one.
pub(super) struct Better<R> {
    pub(super) reading: R,
    /// Number in balance.
    pub(super) found: usize,
}

/// Number in balance.
pub(super) fn count(balanced: &[bool]) -> usize {
    balanced.iter().filter(|one| **one).count()
}

/// Best of other readings, each with what it balances of `all`: one that puts some in balance that are not so as `stated`, and takes
/// hardly any out of it.
pub(super) fn best<R>(
    stated: &[bool],
    all: usize,
    others: impl Iterator<Item = (R, Vec<bool>)>,
) -> Option<Better<R>> {
    let mut best: Option<Better<R>> = None;
    for (reading, balanced) in others {
        let changes = || stated.iter().zip(&balanced);
        let gained = changes().filter(|(before, after)| !**before && **after).count();
        let lost = changes().filter(|(before, after)| **before && !**after).count();
        let found = count(&balanced);
        if gained >= FEWEST.max(10 * lost) && best.as_ref().is_none_or(|best| found > best.found) {
            best = Some(Better { reading, found });
        }
        // No other one balances more.
        if found == all {
            break;
        }
    }
    best
}
