//! Curves through measured heights, stored once they are made.

use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use rubmap_wheel::dynamics::casing::PeriodicSpline;

/// Curves through measured heights, made once and shared by the copies of a table: of tens of thousands of heights they take longer than
/// all other checks of a request, and the designs of a campaign share the table.
#[derive(Debug, Clone, Default)]
pub struct Curves(Arc<Made>);

/// Results of a table, each made when it is first asked for; of a table that was not checked yet, only how often it repeats.
#[derive(Debug, Default)]
pub struct Made {
    /// Curve of every line.
    pub(super) lines: OnceLock<Vec<PeriodicSpline>>,
    /// Angle and height of the largest and of the smallest height of every line.
    pub(super) extremes: OnceLock<Vec<[(f64, f64); 2]>>,
    /// Width that steps have to resolve, rad.
    pub(super) narrowest_rad: OnceLock<f64>,
    /// Number of times that all lines repeat around the circumference.
    pub(super) repeats: OnceLock<u32>,
}

impl PartialEq for Curves {
    /// Always equal: curves follow from their table, which is compared itself.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Deref for Curves {
    type Target = Made;

    fn deref(&self) -> &Made {
        &self.0
    }
}
