//! Validation: claims about what the program computes, each with its reference, its error and the limit of that error.
//!
//! A [`Claim`](claim::Claim) is a row of docs/validation.md. Most rows are small problems whose solution is known from elsewhere: the program
//! computes them when it is asked to (`rubmap validate`), and a test of this crate holds every error against its limit. Every such problem
//! can be given to the program slightly wrong; the test asserts that the row then fails, so that no limit is loose. The other rows name a
//! test of the repository. [`claims`](table::claims) lists all rows, a [`Report`](report::Report) is a run of them.

pub mod claim;
pub mod manual;
pub mod report;
mod rows;
pub mod table;
