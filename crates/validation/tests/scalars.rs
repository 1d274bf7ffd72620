//! Rows on scalars, in a process of their own: the kind of vectors is chosen once.

use rubmap_numerics::vectors::choose_scalars;
use rubmap_validation::report::{Row, Verdict};
use rubmap_validation::table::claims;
use rubmap_wheel::vectors::vectors;

#[test]
fn no_row_fails_on_scalars() {
    choose_scalars().unwrap();
    for claim in claims() {
        let row = Row::of(claim);
        assert_ne!(row.verdict, Verdict::Failed, "{row:?}");
    }
    assert_eq!(vectors(), "Scalar");
}
