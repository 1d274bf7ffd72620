//! Checks of requests against the published contract: bodies by the schema of their type, query strings by the parameters of their
//! route. The published document is itself the rule, so that neither can be forgotten.

mod check;
mod published;
mod query;
mod shape;

pub(super) use check::{Findings, check};
pub use published::Contract;
pub(super) use query::refuse_unknown_parameters;
