//! Casing: clearance along the chord, static restriction in the fixed frame, and its growth (docs/method.md, Casing and gap).

mod restriction;
mod spline;
mod table;

pub use self::restriction::{Lobe, Lobes, Measured, Part, Profile, Restriction};
pub use self::spline::{ALIKE, PeriodicSpline, narrowest_rad, points_repeat};
pub use self::table::RestrictionTable;

/// Rigid casing of revolution with an optional restriction.
#[derive(Debug, Clone, PartialEq)]
pub struct Casing {
    /// Clearance c_k of every contact node, length.
    pub clearance: Vec<f64>,
    /// Restriction that narrows the gap; absent: circular casing.
    pub restriction: Option<Restriction>,
    /// Revolutions over which the restriction grows from zero.
    pub ramp_revolutions: f64,
}

impl Casing {
    /// Growth of the restriction after `revolutions`.
    pub fn growth(&self, revolutions: f64) -> f64 {
        ramp(revolutions, self.ramp_revolutions)
    }

    /// Largest length by which the casing, fully grown, stands inside a tip that does not move; none where it stands inside none.
    pub fn interference(&self) -> Option<f64> {
        let inside = match &self.restriction {
            Some(restriction) => {
                restriction.extremes_of(self.clearance.len(), |p, node| p - self.clearance[node]).1
            }
            None => self.clearance.iter().fold(f64::NEG_INFINITY, |most, clearance| most.max(-clearance)),
        };
        (inside > 0.0).then_some(inside)
    }

    /// Length against which gaps are round-off: largest clearance and restriction, whatever their signs, of each no more than `reach`, the
    /// farthest that a tip can move.
    pub fn length_scale(&self, reach: f64) -> f64 {
        let clearance = self.clearance.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        clearance.min(reach)
            + self.restriction.as_ref().map_or(0.0, |r| r.largest(self.clearance.len()).min(reach))
    }
}

/// Growth x²(3 − 2x) over the ramp, x = revolutions/ramp, then 1.
pub(crate) fn ramp(revolutions: f64, ramp_revolutions: f64) -> f64 {
    if revolutions >= ramp_revolutions {
        return 1.0;
    }
    let x = revolutions / ramp_revolutions;
    x * x * (3.0 - 2.0 * x)
}

/// Clearances linear in the arc length through the contact nodes, from `leading` to `trailing`.
///
/// `positions` as of [`arc_lengths`].
pub fn clearance_along_chord(leading: f64, trailing: f64, positions: &[[f64; 3]]) -> Vec<f64> {
    let arc = arc_lengths(positions);
    let total = arc.last().copied().unwrap_or(0.0);
    let share = |s: f64| if total > 0.0 { s / total } else { 0.0 };
    arc.into_iter().map(|s| leading + (trailing - leading) * share(s)).collect()
}

/// Length along straight segments from the first of `positions`, cylindrical (r, θ, z), to each.
pub fn arc_lengths(positions: &[[f64; 3]]) -> Vec<f64> {
    let cartesian = |p: &[f64; 3]| [p[0] * p[1].cos(), p[0] * p[1].sin(), p[2]];
    let mut arc = vec![0.0; positions.len()];
    for (k, pair) in positions.windows(2).enumerate() {
        let (a, b) = (cartesian(&pair[0]), cartesian(&pair[1]));
        let length = (0..3).map(|d| (b[d] - a[d]).powi(2)).sum::<f64>().sqrt();
        arc[k + 1] = arc[k] + length;
    }
    arc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clearance_is_linear_in_arc_length() {
        let positions = [[10.0, 0.0, 0.0], [10.0, 0.0, 3.0], [14.0, 0.0, 3.0]];
        let c = clearance_along_chord(0.3, 1.0, &positions);
        for (found, expected) in c.iter().zip([0.3, 0.6, 1.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
    }

    /// Scale of gaps of a casing without clearance: heights outward count as lengths, too.
    #[test]
    fn the_scale_of_gaps_is_a_length() {
        let wave = Profile::Wave { order: 0, amplitude: -0.3, phase_rad: 0.0 };
        let restriction = Some(Restriction { parts: vec![Part { profile: wave, along_chord: None }] });
        let casing = Casing { clearance: vec![0.0; 2], restriction, ramp_revolutions: 1.0 };
        assert_eq!((casing.length_scale(1.0), casing.length_scale(0.2)), (0.3, 0.2));
    }

    #[test]
    fn growth_is_smooth_and_ends_at_one() {
        let casing = Casing { clearance: vec![0.1], restriction: None, ramp_revolutions: 2.0 };
        assert_eq!([0.0, 1.0, 2.0, 9.0].map(|r| casing.growth(r)), [0.0, 0.5, 1.0, 1.0]);
    }
}
