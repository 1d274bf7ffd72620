//! Designs of numerical experiments: points of the unit cube, and the quantile functions that carry them to a distribution.
//!
//! Every coordinate lies within (0, 1), never at an end, so that every quantile function may be asked for it. The same arguments give
//! the same points in every version.

pub mod quantile;

mod latin_hypercube;
mod sobol;

pub use self::latin_hypercube::latin_hypercube;
pub use self::sobol::{MOST_DIMENSIONS, MOST_POINTS, sobol_point};
