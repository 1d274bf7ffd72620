//! The published contract as requests are held against it: bodies by the schema of their type, query strings by the
//! parameters of their route. What the document says is what is checked, so that neither can be forgotten.

mod check;
mod published;
mod query;
mod shape;

pub(super) use check::{Findings, check};
pub use published::Contract;
pub(super) use query::refuse_unknown_parameters;
