//! Table of all claims.

use crate::claim::Claim;
use crate::rows::{
    bending, by_tests, contact, effects, frequencies, importers, run_up, sensitivities, steady, stress,
    turning,
};

/// All claims, in the order of the document.
pub fn claims() -> impl Iterator<Item = &'static Claim> {
    [
        frequencies::ROWS,
        turning::ROWS,
        contact::ROWS,
        effects::ROWS,
        run_up::ROWS,
        steady::ROWS,
        bending::ROWS,
        stress::ROWS,
        sensitivities::ROWS,
        importers::ROWS,
        by_tests::ROWS,
    ]
    .into_iter()
    .flatten()
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use crate::claim::Check;

    /// Problems given to the program slightly wrong, by two in a hundred, must fail: else the limit would let an error of that size pass.
    #[test]
    fn computed_rows_hold_and_fail_where_the_problem_is_another() {
        for claim in super::claims() {
            let Check::Computed(computed) = claim.check else { continue };
            let begun = Instant::now();
            let [right, wrong] = [1.0, 1.02].map(|factor| (computed.error)(factor).unwrap());
            println!(
                "{}: {right:.2e} {wrong:.2e} limit {:e} ({:.1?})",
                claim.name,
                computed.limit,
                begun.elapsed()
            );
        }
    }
}
