//! Knowledge that targets give of the unknowns: singular values of the derivatives, and standard deviations.

use nalgebra::DMatrix;

/// Fraction of the largest singular value below which a direction of the unknowns leaves the targets as they are.
const UNKNOWN: f64 = 1e-6;

/// Share of a direction that leaves the targets as they are, above which an unknown is not known.
const SHARE: f64 = 1e-3;

/// Knowledge of the unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Knowledge {
    /// Singular values of the derivatives, descending.
    pub(crate) singular_values: Vec<f64>,
    /// Standard deviation of every unknown where each target has its own error; none where the targets do not determine it.
    pub(crate) deviations: Vec<Option<f64>>,
}

impl Knowledge {
    /// Knowledge from the derivatives of the weighted differences, one column per unknown: with J = UΣVᵀ the covariance is VΣ⁻²Vᵀ.
    pub(crate) fn of(columns: &[Vec<f64>]) -> Self {
        let rows = columns.first().map_or(0, Vec::len);
        let jacobian = DMatrix::from_fn(rows, columns.len(), |row, column| columns[column][row]);
        let svd = jacobian.svd(false, true);
        let singular_values: Vec<f64> = svd.singular_values.iter().copied().collect();
        let largest = singular_values.first().copied().unwrap_or(0.0);
        let deviation = |unknown: usize| {
            let directions = svd.v_t.as_ref()?;
            let mut variance = 0.0;
            for (direction, &value) in singular_values.iter().enumerate() {
                let share = directions[(direction, unknown)];
                if value > UNKNOWN * largest {
                    variance += (share / value).powi(2);
                } else if share.abs() > SHARE {
                    return None;
                }
            }
            Some(variance.sqrt())
        };
        let deviations = (0..columns.len()).map(deviation).collect();
        Self { singular_values, deviations }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of four measurements with an error of 1, and a line through points at −1, 0 and 1, have textbook variances.
    #[test]
    fn deviations_are_those_of_a_mean_and_a_line() {
        let mean = Knowledge::of(&[vec![1.0; 4]]);
        assert!((mean.deviations[0].unwrap() - 0.5).abs() < 1e-14);
        let line = Knowledge::of(&[vec![1.0; 3], vec![-1.0, 0.0, 1.0]]);
        assert!((line.deviations[0].unwrap() - (1.0f64 / 3.0).sqrt()).abs() < 1e-14);
        assert!((line.deviations[1].unwrap() - 0.5f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn unknowns_that_act_alike_are_not_known_and_others_are() {
        let (a, b) = (vec![1.0, 2.0, 3.0], vec![1.0, -2.0, 1.0]);
        let knowledge = Knowledge::of(&[a.clone(), a, b]);
        assert_eq!(knowledge.deviations[..2], [None, None]);
        assert!((knowledge.deviations[2].unwrap() - 6.0f64.sqrt().recip()).abs() < 1e-14);
    }
}
