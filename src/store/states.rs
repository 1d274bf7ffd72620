//! States of the whole wheel at recorded instants, as a document: JSON around the numbers, which are Base64 of little-endian f64.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use faer::{Mat, c64};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::dynamics::reduction::ReducedWheel;
use crate::dynamics::states::{HarmonicStates, WheelStates};

/// Stored document of states.
#[derive(Serialize, Deserialize)]
struct Stored {
    /// SHA-256 of all numbers, instants first.
    sha256: String,
    /// Recorded instants, revolutions since the start.
    revolutions: String,
    harmonics: Vec<StoredHarmonic>,
}

/// States of one nodal diameter.
#[derive(Serialize, Deserialize)]
struct StoredHarmonic {
    harmonic: usize,
    /// SHA-256 of M_r of the reduction whose coordinates are stored.
    reduction: String,
    unknowns: usize,
    /// Real and imaginary part of every unknown, instant after instant.
    coordinates: String,
}

/// Error of a document of states.
#[derive(Debug, thiserror::Error)]
pub enum StatesError {
    /// Document that is not what was written.
    #[error("the recorded state is damaged: {0}")]
    Damaged(String),
    /// Document with coordinates of another reduction.
    #[error(
        "the state was recorded with another reduction of the model than the one that is there: run the job again"
    )]
    OtherReduction,
}

/// Packs the states of `reduced` into a document.
///
/// # Errors
/// Failures of writing JSON.
pub fn pack(states: &WheelStates, reduced: &ReducedWheel) -> serde_json::Result<String> {
    let mut digest = Sha256::new();
    let mut encode = |numbers: &mut dyn Iterator<Item = f64>| {
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        digest.update(&bytes);
        STANDARD.encode(bytes)
    };
    let revolutions = encode(&mut states.revolutions.iter().copied());
    let harmonics = states
        .harmonics
        .iter()
        .map(|of| {
            let columns = of.coordinates.col_iter();
            let mut numbers = columns.flat_map(|column| column.iter().flat_map(|x| [x.re, x.im]));
            StoredHarmonic {
                harmonic: of.harmonic,
                reduction: hex(&reduced.harmonics[of.harmonic].mark()),
                unknowns: of.coordinates.nrows(),
                coordinates: encode(&mut numbers),
            }
        })
        .collect();
    serde_json::to_string(&Stored { sha256: hex(&digest.finalize()), revolutions, harmonics })
}

/// Unpacks the states of a document, which must belong to `reduced`.
///
/// # Errors
/// A document that is not what was written, or of another reduction.
pub fn unpack(text: &str, reduced: &ReducedWheel) -> Result<WheelStates, StatesError> {
    let damaged = |how: &str| StatesError::Damaged(how.to_owned());
    let stored: Stored = serde_json::from_str(text).map_err(|error| damaged(&error.to_string()))?;
    let mut digest = Sha256::new();
    let mut decode = |text: &str| {
        let bytes = STANDARD.decode(text).map_err(|error| damaged(&error.to_string()))?;
        digest.update(&bytes);
        let number = |bytes: &[u8]| f64::from_le_bytes(std::array::from_fn(|byte| bytes[byte]));
        Ok::<Vec<f64>, StatesError>(bytes.chunks_exact(8).map(number).collect())
    };
    let revolutions = decode(&stored.revolutions)?;
    let mut harmonics = Vec::with_capacity(stored.harmonics.len());
    for StoredHarmonic { harmonic, reduction, unknowns, coordinates } in stored.harmonics {
        let numbers = decode(&coordinates)?;
        let known = reduced.harmonics.get(harmonic).ok_or(StatesError::OtherReduction)?;
        if hex(&known.mark()) != reduction || known.mass.ncols() != unknowns {
            return Err(StatesError::OtherReduction);
        }
        if numbers.len() != 2 * unknowns * revolutions.len() {
            return Err(damaged("numbers are missing"));
        }
        let at = |row: usize, instant: usize| {
            let place = 2 * (instant * unknowns + row);
            c64::new(numbers[place], numbers[place + 1])
        };
        let coordinates = Mat::from_fn(unknowns, revolutions.len(), at);
        harmonics.push(HarmonicStates { harmonic, coordinates });
    }
    if hex(&digest.finalize()) != stored.sha256 {
        return Err(damaged("its numbers are not those that were written"));
    }
    Ok(WheelStates { revolutions, harmonics })
}

/// Checks that a document is what was written.
///
/// # Errors
/// As of [`unpack`], except for the reduction.
pub(super) fn check(text: &str) -> Result<(), StatesError> {
    let stored: Stored =
        serde_json::from_str(text).map_err(|error| StatesError::Damaged(error.to_string()))?;
    let mut digest = Sha256::new();
    let coordinates = stored.harmonics.iter().map(|harmonic| &harmonic.coordinates);
    for numbers in [&stored.revolutions].into_iter().chain(coordinates) {
        let bytes = STANDARD.decode(numbers).map_err(|error| StatesError::Damaged(error.to_string()))?;
        digest.update(bytes);
    }
    if hex(&digest.finalize()) == stored.sha256 {
        return Ok(());
    }
    Err(StatesError::Damaged("its numbers are not those that were written".to_owned()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
