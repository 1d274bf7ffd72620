//! Search for the generated impeller that has given natural frequencies: pure functions, without files and HTTP.
//!
//! A [`FitRequest`] names parameters of the generator with their bounds, and frequencies as targets. [`Problem::new`] checks it, [`fit`] varies
//! the parameters from several starting points until the weighted differences are least in the mean square, and
//! [`FitResult`] says how well each target is met and how well each parameter is known.

mod error;
mod evaluation;
mod identify;
mod problem;
mod reference;
mod request;
mod result;
mod search;
mod wheel;

pub use error::FitError;
pub use evaluation::{Evaluation, Keeper, Outcome, Row};
pub use problem::{Goal, Problem, Variable};
pub use request::{FitRequest, Target, Unit};
pub use result::{Bound, FitResult, StartResult, TargetResult, VariableResult, fit};
