//! Serde form of dense complex matrices, for `#[serde(with = …)]`: shape and column-major (re, im) pairs.

use faer::{Mat, c64};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
struct Flat {
    rows: usize,
    columns: usize,
    values: Vec<(f64, f64)>,
}

impl From<&Mat<c64>> for Flat {
    fn from(matrix: &Mat<c64>) -> Self {
        let (rows, columns) = (matrix.nrows(), matrix.ncols());
        let at = |i: usize, j: usize| (matrix[(i, j)].re, matrix[(i, j)].im);
        let values = (0..columns).flat_map(|j| (0..rows).map(move |i| at(i, j))).collect();
        Self { rows, columns, values }
    }
}

/// Error: the numbers do not fill the matrix.
#[derive(Debug, thiserror::Error)]
#[error("{values} values of a {rows} × {columns} matrix")]
struct WrongShape {
    values: usize,
    rows: usize,
    columns: usize,
}

impl TryFrom<Flat> for Mat<c64> {
    type Error = WrongShape;

    fn try_from(flat: Flat) -> Result<Self, WrongShape> {
        if flat.rows.checked_mul(flat.columns) != Some(flat.values.len()) {
            return Err(WrongShape { values: flat.values.len(), rows: flat.rows, columns: flat.columns });
        }
        Ok(Self::from_fn(flat.rows, flat.columns, |i, j| {
            let (re, im) = flat.values[i + j * flat.rows];
            c64::new(re, im)
        }))
    }
}

/// Serialises one matrix.
pub fn serialize<S: Serializer>(matrix: &Mat<c64>, serializer: S) -> Result<S::Ok, S::Error> {
    Flat::from(matrix).serialize(serializer)
}

/// Deserialises one matrix.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<c64>, D::Error> {
    Flat::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
}

/// Serde form of a matrix that may be absent.
pub mod option {
    use super::*;

    /// Serialises the matrix, if there is one.
    pub fn serialize<S: Serializer>(matrix: &Option<Mat<c64>>, serializer: S) -> Result<S::Ok, S::Error> {
        matrix.as_ref().map(Flat::from).serialize(serializer)
    }

    /// Deserialises the matrix, if there is one.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Mat<c64>>, D::Error> {
        let flat = Option::<Flat>::deserialize(deserializer)?;
        flat.map(|flat| flat.try_into().map_err(D::Error::custom)).transpose()
    }
}

/// Serde form of a list of matrices.
pub mod list {
    use super::*;

    /// Serialises the matrices in order.
    pub fn serialize<S: Serializer>(matrices: &[Mat<c64>], serializer: S) -> Result<S::Ok, S::Error> {
        matrices.iter().map(Flat::from).collect::<Vec<_>>().serialize(serializer)
    }

    /// Deserialises the matrices in order.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Mat<c64>>, D::Error> {
        let flats = Vec::<Flat>::deserialize(deserializer)?;
        flats.into_iter().map(|flat| flat.try_into().map_err(D::Error::custom)).collect()
    }
}
