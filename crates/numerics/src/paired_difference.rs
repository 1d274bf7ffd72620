//! Differences between two numbers that were found side by side in several cases, and whether they can be chance.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Mean of differences and its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairedDifference {
    /// Number of pairs.
    pub pairs: usize,
    /// Mean of the differences.
    pub mean: f64,
    /// Standard error of the mean and the interval in which the true mean lies with the confidence asked for, by Student's t; none for one pair.
    pub error: Option<MeanError>,
}

/// Uncertainty of a mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanError {
    /// Standard error of the mean.
    pub standard: f64,
    /// Ends of the interval in which the true mean lies with the confidence asked for.
    pub interval: (f64, f64),
}

/// Mean of `differences`, one per pair, taken for independent and normally distributed; none without pairs, and where one is not finite.
///
/// # Panics
/// If `confidence` is not between 0 and 1.
pub fn paired_difference(differences: &[f64], confidence: f64) -> Option<PairedDifference> {
    assert!(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
    let pairs = differences.len();
    let mean = differences.iter().sum::<f64>() / pairs as f64;
    if !mean.is_finite() {
        return None;
    }
    let squares: f64 = differences.iter().map(|difference| (difference - mean).powi(2)).sum();
    let freedom = pairs as f64 - 1.0;
    // No distribution has no degree of freedom.
    let error = StudentsT::new(0.0, 1.0, freedom).ok().map(|student| {
        let standard = (squares / freedom / pairs as f64).sqrt();
        let reach = student.inverse_cdf(0.5 + 0.5 * confidence) * standard;
        MeanError { standard, interval: (mean - reach, mean + reach) }
    });
    Some(PairedDifference { pairs, mean, error })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Example of Student, Biometrika 6 (1908): hours of sleep gained by ten patients with one drug and with another; t = 4.06 as it has
    /// been quoted since.
    #[test]
    fn students_own_pairs() {
        let differences = [1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4];
        let found = paired_difference(&differences, 0.95).unwrap();
        let error = found.error.unwrap();
        assert!((found.mean - 1.58).abs() < 1e-12 && found.pairs == 10);
        assert!((found.mean / error.standard - 4.0621).abs() < 1e-4, "{error:?}");
        // The table's 2.262 for nine degrees of freedom.
        assert!(((error.interval.1 - found.mean) / error.standard - 2.262).abs() < 1e-3, "{error:?}");
    }

    #[test]
    fn few_pairs_and_none() {
        assert_eq!(paired_difference(&[], 0.95), None);
        assert_eq!(paired_difference(&[1.0, f64::INFINITY], 0.95), None);
        assert_eq!(
            paired_difference(&[3.0], 0.95),
            Some(PairedDifference { pairs: 1, mean: 3.0, error: None })
        );
        // One degree of freedom is Cauchy's distribution: tan(0.45 π).
        let two = paired_difference(&[0.0, 2.0], 0.9).unwrap().error.unwrap();
        assert!((two.standard - 1.0).abs() < 1e-15);
        assert!((two.interval.1 - 1.0 - (0.45 * std::f64::consts::PI).tan()).abs() < 1e-6, "{two:?}");
        let alike = paired_difference(&[2.0; 4], 0.95).unwrap().error.unwrap();
        assert_eq!((alike.standard, alike.interval), (0.0, (2.0, 2.0)));
    }
}
