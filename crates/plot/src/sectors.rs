//! Number of sectors of a wheel, derived from its reduction report.

use rubmap_analysis::result::ReductionReport;

/// Number of sectors N: nodal diameters from 0 to N/2 have their unknowns twice in the wheel, except 0 and, for an even number, N/2. None
/// where the numbers do not determine it.
pub(super) fn sectors(reduction: &ReductionReport) -> Option<u32> {
    let unknowns = &reduction.unknowns;
    let last = u32::try_from(unknowns.len().checked_sub(1)?).ok()?;
    let twice = 2 * unknowns.iter().sum::<u32>() - unknowns.first()?;
    match twice.checked_sub(reduction.wheel_unknowns)? {
        0 => Some(2 * last + 1),
        single if last > 0 && single == unknowns[last as usize] => Some(2 * last),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn report(unknowns: &[u32], wheel: u32) -> ReductionReport {
        serde_json::from_value(json!({"modes_per_speed": 1, "unknowns": unknowns, "wheel_unknowns": wheel,
            "largest_mode_residual": 0.0, "modes": 1, "counted_modes": 1, "full_model": [], "basis_tolerance": 1e-5,
            "stiffening": {"verdict": "sound", "linear_ratio": 0.0, "quadratic_ratio": 0.0, "frequency_error": 0.0, "message": ""},
            "wall_time_s": 0.0, "version": "0"}))
        .unwrap()
    }

    #[test]
    fn even_and_odd_wheels_are_told_apart() {
        assert_eq!(sectors(&report(&[3, 4, 5], 3 + 8 + 5)), Some(4));
        assert_eq!(sectors(&report(&[3, 4, 5], 3 + 8 + 10)), Some(5));
        assert_eq!(sectors(&report(&[3], 3)), Some(1));
        assert_eq!(sectors(&report(&[3, 4], 3 + 4)), Some(2));
        assert_eq!(sectors(&report(&[3, 4], 1)), None);
        assert_eq!(sectors(&report(&[], 0)), None);
    }
}
