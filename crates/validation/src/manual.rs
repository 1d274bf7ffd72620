//! Document of the table, docs/validation.md: what follows from the table alone.

use std::fmt::Write;

use crate::claim::{Check, Claim};
use crate::report::{cell, repeat};
use crate::table::claims;

const HEAD: &str = "# Validation

Claims of the program, each with the reference that it is held against. `rubmap validate` computes the first table on your machine in some seconds, row by row,
and ends with the code 1 if one fails; `--out FOLDER` leaves the run there as `validation.json` and `validation.md`, with date, version, machine, kind
of vectors and every error. `--vectors scalar` computes the same on scalars. `--only NAME` computes one row.

References of that table share no code with what they judge. Each problem can be given to the program slightly wrong: a test multiplies the number
in the column *number that is tried 2 % off* by 1.02 and asserts that the row fails. Another test asserts that every effect of a
scene, every kind of job and every importer has a row in one of the tables.

`rubmap validate --manual` prints this page.

## Computed by the program

| row | claim | reference | quantity | limit and its reason | number that is tried 2 % off |
|---|---|---|---|---|---|
";

const TESTS: &str = "
## Computed by tests of the repository

Tests against CalculiX (`ccx`) and against the file of a commercial solver are skipped, saying so, where those are not there.

| row | claim | reference | quantity | limit and its reason | how to repeat |
|---|---|---|---|---|---|
";

const CONSISTENCY: &str = "
## Consistency of the program with itself

These have no reference but the program: they show that it says the same in two ways, not that it agrees with others.

| row | claim | held against | quantity | limit and its reason | how to repeat |
|---|---|---|---|---|---|
";

const OPEN: &str = "
## Without an independent reference

| row | claim | reference | quantity |
|---|---|---|---|
";

/// Text of docs/validation.md.
pub fn manual() -> String {
    let mut text = HEAD.to_owned();
    for claim in claims() {
        if let Check::Computed(computed) = claim.check {
            let limit = format!("{:.0e}: {}", computed.limit, computed.reason);
            line(&mut text, claim, &[&limit, computed.wrong]);
        }
    }
    text += TESTS;
    for claim in claims() {
        if let Check::Test { limit, .. } = claim.check {
            line(&mut text, claim, &[limit, &format!("`{}`", repeat(claim))]);
        }
    }
    text += CONSISTENCY;
    for claim in claims() {
        if let Check::Consistency { limit, .. } = claim.check {
            line(&mut text, claim, &[limit, &format!("`{}`", repeat(claim))]);
        }
    }
    text += OPEN;
    claims().filter(|claim| matches!(claim.check, Check::None)).for_each(|claim| line(&mut text, claim, &[]));
    text
}

fn line(text: &mut String, claim: &Claim, more: &[&str]) {
    let own = [&format!("`{}`", claim.name), claim.claim, claim.reference, claim.quantity];
    let cells: Vec<String> = own.iter().chain(more).map(|text| cell(text)).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "| {} |", cells.join(" | "));
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_committed_document_is_the_generated_one() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
        assert!(
            std::fs::read_to_string(path).unwrap_or_default() == super::manual(),
            "docs/validation.md is out of date; run `cargo run --release -- validate --manual > docs/validation.md`"
        );
    }
}
