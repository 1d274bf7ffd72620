//! Results as files of numbers: one table for spreadsheets (CSV), arrays for numpy (`.npz`). Pure functions from results to numbers
//! with names, by which they are put into other units.

mod array;
mod backbones;
mod branches;
mod campaign;
mod campbell;
mod critical_speeds;
pub mod csv;
pub mod fields;
mod force_map;
mod interference;
mod level;
pub mod maps;
mod npz;
mod run_ups;
mod section;
pub mod spectra;
mod speed_histories;
mod stress;
mod studies;
mod unit;
mod verdict;
pub mod wear;
mod wheel;

use std::io::{self, Write};

pub use array::{Array, Values};
pub use npz::write as write_npz;
pub use unit::{add_to_arrays, add_to_json, for_reading};

use crate::analysis::request::SpeedUnit;

/// Result that can be written as files of numbers.
pub trait Export {
    /// Table of the result: arrays of one dimension and one length, whose names have units.
    fn table(&self) -> Vec<Array>;

    /// Arrays of all numbers of the result, named as the fields of the JSON.
    fn arrays(&self) -> Vec<Array>;
}

/// Writes the table of a result as comma-separated values (RFC 4180): speeds in `unit`, rpm without one, and motions in micrometres.
///
/// # Errors
/// Errors of writing.
pub fn write_csv(result: &impl Export, unit: Option<SpeedUnit>, out: &mut dyn Write) -> io::Result<()> {
    csv::write(&for_reading(result.table(), unit), out)
}
