//! Reliability of K(Ω) between the speeds at which it is given, in words.

use crate::result::{PreliminaryStiffening, StiffeningReport, StiffeningVerdict};
use rubmap_wheel::dynamics::findings::{SpinAtSpeed, SpinFinding};
use rubmap_wheel::dynamics::reduction::{InterpolationCheck, InterpolationVerdict, MatrixRatios};
use rubmap_wheel::dynamics::sector::SectorModel;

/// Advice about matrices of the deformed geometry.
const EXPORT_ADVICE: &str = "Export K(Ω) = K_e + K_σ(Ω) − Ω²M_spin on the undeformed geometry instead (linear static pre-stress, no \
                             geometrically non-linear step).";

const NO_STIFFENING: &str = "One stiffness matrix: the model has no centrifugal stiffening.";

pub(super) fn preliminary_stiffening(sector: &SectorModel) -> PreliminaryStiffening {
    let Some(ratios) = MatrixRatios::of(sector) else {
        return PreliminaryStiffening {
            verdict: StiffeningVerdict::Absent,
            linear_ratio: 0.0,
            quadratic_ratio: 0.0,
            message: NO_STIFFENING.into(),
        };
    };
    let MatrixRatios { linear: linear_ratio, quadratic: quadratic_ratio } = ratios;
    let found = format!("(|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}, |Ω1²K1|/|K0| = {linear_ratio:.1e})");
    let (verdict, message) = if ratios.are_linear() {
        let message = format!(
            "The stiffness at speed is consistent: K(Ω) is linear in Ω², as it must be on the undeformed geometry {found}. \
             Preliminary: whether it is positive definite between the given speeds, the first reduction tells."
        );
        (StiffeningVerdict::Sound, message)
    } else {
        let message = format!(
            "By its matrices K(Ω) is not linear in Ω² {found}: it was probably exported on the deformed geometry of a non-linear \
             pre-stress step. Preliminary: how far results between the given speeds are off, and whether K(Ω) can be interpolated \
             at all, the first reduction tells. {EXPORT_ADVICE}"
        );
        (StiffeningVerdict::Suspect, message)
    };
    PreliminaryStiffening { verdict, linear_ratio, quadratic_ratio, message }
}

pub(super) fn stiffening_report(check: &InterpolationCheck, sector: &SectorModel) -> StiffeningReport {
    let InterpolationCheck { verdict, linear_ratio, quadratic_ratio, frequency_error } = *check;
    let highest = sector.speeds_rad_s.last().copied().unwrap_or(0.0);
    let percent = 100.0 * frequency_error;
    let advice = EXPORT_ADVICE;
    let (verdict, message) = match verdict {
        InterpolationVerdict::Absent => (StiffeningVerdict::Absent, NO_STIFFENING.into()),
        InterpolationVerdict::Sound => (
            StiffeningVerdict::Sound,
            format!(
                "The stiffness at speed is consistent: K(Ω) is linear in Ω² up to {highest} rad/s, as it must be on the undeformed geometry \
                 (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e})."
            ),
        ),
        InterpolationVerdict::Suspect => (
            StiffeningVerdict::Suspect,
            format!(
                "K(Ω) is not linear in Ω² (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}, |Ω1²K1|/|K0| = \
                 {linear_ratio:.1e}): it was probably exported on the deformed geometry of a non-linear pre-stress \
                 step. Results are right at the given speeds; between them the lowest frequencies deviate by an \
                 estimated {percent:.2} %. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound if frequency_error.is_finite() => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) cannot be interpolated: between the given speeds the lowest frequencies deviate by {percent:.1} \
                 % from a smooth curve (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}). The matrices were probably exported on \
                 the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) interpolated between the given speeds is not positive definite (|Ω1⁴K2|/|K0| = \
                 {quadratic_ratio:.1e}); speeds at which this is so are refused. The matrices were probably exported \
                 on the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
    };
    // JSON has no infinity; an indefinite K is an error of at least 100 %.
    let frequency_error = frequency_error.min(1.0);
    StiffeningReport { verdict, linear_ratio, quadratic_ratio, frequency_error, message }
}

/// Adds the findings from mass and positions to those about K(Ω).
pub(super) fn with_spin(mut found: PreliminaryStiffening, spin: &[SpinAtSpeed]) -> PreliminaryStiffening {
    (found.verdict, found.message) = judged(found.verdict, found.message, spin);
    found
}

/// Adds the findings from mass and positions about K(Ω) to the report of a reduction.
pub(super) fn report_with_spin(mut found: StiffeningReport, spin: &[SpinAtSpeed]) -> StiffeningReport {
    (found.verdict, found.message) = judged(found.verdict, found.message, spin);
    found
}

fn judged(verdict: StiffeningVerdict, message: String, spin: &[SpinAtSpeed]) -> (StiffeningVerdict, String) {
    let said = |wanted: &dyn Fn(SpinFinding) -> bool| -> Vec<String> {
        let at = spin.iter().filter(|at| wanted(at.finding));
        at.map(|at| format!("The stiffness at {} rad/s is {}.", at.speed_rad_s, at.finding)).collect()
    };
    let wrong = said(&SpinFinding::is_wrong_at_speed);
    if !wrong.is_empty() {
        let wrong = wrong.join(" ");
        // Also why some speeds are refused, if they are.
        let message = if verdict == StiffeningVerdict::Sound { wrong } else { format!("{wrong} {message}") };
        return (StiffeningVerdict::Unsound, message);
    }
    let other = said(&SpinFinding::is_other);
    if !other.is_empty() {
        return (verdict.max(StiffeningVerdict::Suspect), format!("{} {message}", other.join(" ")));
    }
    let is_unknown = |finding: &SpinFinding| matches!(finding, SpinFinding::NotChecked | SpinFinding::Hidden);
    match spin.iter().map(|at| at.finding).find(is_unknown) {
        Some(finding) => {
            (verdict, format!("{message} Whether it is that of the given speeds was {finding}."))
        }
        None => match spin.iter().rev().find_map(|at| at.finding.residual()) {
            Some(residual) => {
                let held = format!(
                    "By mass and positions it is that of the given speeds (residual {residual:.1e})."
                );
                (verdict, format!("{message} {held}"))
            }
            None => (verdict, message),
        },
    }
}
