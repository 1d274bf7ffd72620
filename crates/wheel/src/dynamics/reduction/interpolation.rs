//! Check whether K(Ω) can be trusted between the given speeds (docs/method.md, Centrifugal stiffening).
//!
//! On the undeformed geometry K is linear in Ω²: K2 vanishes to round-off, and eigenvalues are smooth in Ω². Tangents
//! of a geometrically non-linear step sit on the deformed geometry; every stiff entry moves with the deformation, K2
//! does not vanish, and the interpolant is right at the three speeds and wrong between them.

use super::findings::{InterpolationCheck, InterpolationVerdict};
use super::reduced::ReducedHarmonic;
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::SectorModel;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::hermitian::EigenError;

/// Fraction of K0's entries above which K2 entries cannot be the round-off of matrices written with six digits or more.
const QUADRATIC_LIMIT: f64 = 1e-5;

/// Deviation of the lowest frequencies beyond which they are no longer a smooth curve.
const FREQUENCY_LIMIT: f64 = 0.01;

pub(super) fn check(
    sector: &SectorModel,
    harmonics: &[ReducedHarmonic],
) -> Result<InterpolationCheck, ModelError> {
    let ([_, a, b], Some(ratios)) = (&*sector.speeds_rad_s, MatrixRatios::of(sector)) else {
        return Ok(InterpolationCheck {
            verdict: InterpolationVerdict::Absent,
            linear_ratio: 0.0,
            quadratic_ratio: 0.0,
            frequency_error: 0.0,
        });
    };
    let MatrixRatios { linear: linear_ratio, quadratic: quadratic_ratio } = ratios;
    let mut frequency_error: f64 = 0.0;
    for harmonic in harmonics {
        frequency_error = frequency_error.max(lowest_frequency_deviation(harmonic, *a, *b)?);
    }
    let verdict = if ratios.are_linear() && frequency_error.is_finite() {
        // Linear in Ω²: the interpolant is right everywhere, and a lowest frequency that is no smooth curve has
        // modes that cross.
        frequency_error = frequency_error.min(quadratic_ratio);
        InterpolationVerdict::Sound
    } else if frequency_error <= FREQUENCY_LIMIT {
        InterpolationVerdict::Suspect
    } else {
        InterpolationVerdict::Unsound
    };
    Ok(InterpolationCheck { verdict, linear_ratio, quadratic_ratio, frequency_error })
}

/// Ratios of the three stiffness matrices of a sector, which alone bear on K(Ω) (largest entries).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixRatios {
    /// Ratio ‖Ω1²K1‖/‖K0‖.
    pub linear: f64,
    /// Ratio ‖Ω1⁴K2‖/‖K0‖.
    pub quadratic: f64,
}

impl MatrixRatios {
    /// Ratios of a sector with stiffness at three speeds; entry by entry, so that nothing is held beside the matrices.
    pub fn of(sector: &SectorModel) -> Option<Self> {
        let ([_, a, b], [k0, ka, kb]) = (&*sector.speeds_rad_s, &*sector.stiffness) else { return None };
        let blocks = [[&k0.own, &ka.own, &kb.own], [&k0.next, &ka.next, &kb.next]];
        let (xa, xb) = (a * a, b * b);
        let (mut scale, mut linear, mut quadratic) = (0.0f64, 0.0f64, 0.0f64);
        for (matrices, column) in
            blocks.into_iter().flat_map(|matrices| (0..k0.own.ncols()).map(move |column| (matrices, column)))
        {
            let mut left = matrices
                .map(|matrix| matrix.row_idx_of_col(column).zip(matrix.val_of_col(column)).peekable());
            while let Some(row) = left.iter_mut().filter_map(|rest| rest.peek().map(|entry| entry.0)).min() {
                let [at_rest, at_a, at_b] = left
                    .each_mut()
                    .map(|rest| rest.next_if(|entry| entry.0 == row).map_or(0.0, |entry| *entry.1));
                // Divided differences, as in the fit, scaled to Ω1² K1 and Ω1⁴ K2.
                let slope_a = (at_a - at_rest) * (xb / xa);
                let curved = ((at_b - at_rest) - slope_a) * (xb / (xb - xa));
                scale = scale.max(at_rest.abs());
                linear = linear.max((slope_a - curved * (xa / xb)).abs());
                quadratic = quadratic.max(curved.abs());
            }
        }
        Some(Self { linear: linear / scale, quadratic: quadratic / scale })
    }

    /// Whether K is linear in Ω², to the round-off of matrices as they are written.
    pub fn are_linear(self) -> bool {
        self.quadratic <= QUADRATIC_LIMIT
    }
}

/// Deviation |f − f_smooth|/f at ¼ and ¾ of the last speed, where f_smooth² is the parabola in Ω² through the lowest eigenvalues at the
/// three given speeds.
fn lowest_frequency_deviation(harmonic: &ReducedHarmonic, a: f64, b: f64) -> Result<f64, ModelError> {
    let lowest = |speed_rad_s: f64| -> Result<f64, ModelError> {
        let nodal_diameter = harmonic.harmonic;
        let stiffness = harmonic.stiffness.at(speed_rad_s, true);
        match Dense::generalised_eigenvalues(stiffness.as_ref(), harmonic.mass.as_ref()) {
            Ok(values) => Ok(values[0]),
            Err(EigenError::MassNotPositiveDefinite) => {
                Err(ModelError::MassNotPositiveDefinite { nodal_diameter })
            }
            Err(EigenError::NotConverged) => {
                Err(ModelError::DecompositionFailed { nodal_diameter, speed_rad_s })
            }
        }
    };
    let (xa, xb) = (a * a, b * b);
    let (l0, la, lb) = (lowest(0.0)?, lowest(a)?, lowest(b)?);
    let slope = (la - l0) / xa;
    let curvature = ((lb - l0) / xb - slope) / (xb - xa);
    let mut worst: f64 = 0.0;
    for speed in [0.25 * b, 0.75 * b] {
        let x = speed * speed;
        let found = lowest(speed)?;
        let smooth = l0 + slope * x + curvature * x * (x - xa);
        let deviation =
            if found > 0.0 && smooth > 0.0 { ((found / smooth).sqrt() - 1.0).abs() } else { f64::INFINITY };
        worst = worst.max(deviation);
    }
    Ok(worst)
}
