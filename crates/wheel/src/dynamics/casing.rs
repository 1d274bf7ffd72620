//! The casing: clearance along the chord, static restriction in the fixed frame, and its growth (docs/method.md,
//! Casing and gap).

use std::f64::consts::{PI, TAU};

use num_integer::gcd;

/// Equal Gaussian lobes in the fixed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restriction {
    /// Number of lobes.
    pub count: u32,
    /// Height A, length.
    pub amplitude: f64,
    /// Half-width w in exp(−(φ/w)²), rad.
    pub width_rad: f64,
    /// Angle of the first lobe, rad.
    pub phase_rad: f64,
}

impl Restriction {
    /// p(φ) = A Σ_l exp(−(wrap(φ − φ_l)/w)²), φ_l = 2πl/count + phase.
    pub fn height(&self, angle_rad: f64) -> f64 {
        let lobe = |l: u32| {
            let centre = TAU * f64::from(l) / f64::from(self.count) + self.phase_rad;
            (-(wrap(angle_rad - centre) / self.width_rad).powi(2)).exp()
        };
        self.amplitude * (0..self.count).map(lobe).sum::<f64>()
    }

    /// Largest p over the circumference, to a thousandth of a lobe spacing.
    pub fn highest(&self) -> f64 {
        let spacing = TAU / f64::from(self.count.max(1));
        (0..=1000).map(|i| self.height(self.phase_rad + spacing * f64::from(i) / 1000.0)).fold(0.0, f64::max)
    }
}

/// φ into (−π, π].
fn wrap(angle_rad: f64) -> f64 {
    let turns = angle_rad - TAU * (angle_rad / TAU).round();
    if turns <= -PI { turns + TAU } else { turns }
}

/// Rigid casing of revolution with an optional restriction.
#[derive(Debug, Clone, PartialEq)]
pub struct Casing {
    /// c_k, one per contact node, length.
    pub clearance: Vec<f64>,
    /// Lobes; absent: circular.
    pub restriction: Option<Restriction>,
    /// Revolutions over which the restriction grows from zero.
    pub ramp_revolutions: f64,
}

impl Casing {
    /// Growth of the restriction after `revolutions`.
    pub fn growth(&self, revolutions: f64) -> f64 {
        ramp(revolutions, self.ramp_revolutions)
    }

    /// The length against which gaps are round-off: largest clearance and restriction, of each no more than `reach`,
    /// the farthest that a tip can move.
    pub fn length_scale(&self, reach: f64) -> f64 {
        let clearance = self.clearance.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        clearance.min(reach) + self.restriction.map_or(0.0, |r| r.highest().min(reach))
    }
}

/// x²(3 − 2x), x = revolutions/ramp, then 1.
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

/// p at every contact node for every time step of a revolution: nothing is evaluated in the step loop.
///
/// Node k of sector s sits at θ_k + sα + 2πq/S at step q. With sS = a·N + b the sector's angle is a whole steps and a
/// fraction b/N, so one table per distinct b, `[step][node]` with nodes padded to `stride`, serves all sectors.
#[derive(Debug, Clone)]
pub struct RestrictionTable {
    steps: usize,
    stride: usize,
    values: Vec<f64>,
    /// Start of the sector's table and offset in steps, per sector.
    sectors: Vec<(usize, usize)>,
}

impl RestrictionTable {
    /// Number of values a table for these sizes holds.
    pub fn size(steps: usize, sectors: usize, stride: usize) -> usize {
        steps.saturating_mul(sectors / gcd(steps, sectors)).saturating_mul(stride)
    }

    /// Tabulates the height `profile(φ)` for contact nodes at `angles_rad`.
    pub fn new(
        profile: impl Fn(f64) -> f64,
        angles_rad: &[f64],
        steps: usize,
        sectors: usize,
        stride: usize,
    ) -> Self {
        let common = gcd(steps, sectors);
        let classes = sectors / common;
        let mut values = Vec::with_capacity(Self::size(steps, sectors, stride));
        for class in 0..classes {
            let fraction = (class * common) as f64 / sectors as f64;
            for step in 0..steps {
                let turned = TAU * ((step as f64 + fraction) / steps as f64);
                values.extend(angles_rad.iter().map(|theta| profile(theta + turned)));
                values.resize(values.len() + stride - angles_rad.len(), 0.0);
            }
        }
        let place = |s: usize| ((s * steps % sectors) / common * steps * stride, s * steps / sectors);
        Self { steps, stride, values, sectors: (0..sectors).map(place).collect() }
    }

    /// p at the nodes of `sector` at `step` of the revolution (0 ≤ step < S).
    #[inline(always)]
    pub fn at(&self, step: usize, sector: usize) -> &[f64] {
        let (start, offset) = self.sectors[sector];
        let mut row = step + offset;
        if row >= self.steps {
            row -= self.steps;
        }
        &self.values[start + row * self.stride..][..self.stride]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_equals_the_formula_for_any_step_count() {
        let restriction = Restriction { count: 2, amplitude: 0.4, width_rad: 0.35, phase_rad: 0.2 };
        let angles = [0.1, -0.7, 2.9];
        for (steps, sectors) in [(40, 10), (37, 10), (36, 8), (9, 1), (12, 7)] {
            let table = RestrictionTable::new(|phi| restriction.height(phi), &angles, steps, sectors, 8);
            assert_eq!(table.values.len(), RestrictionTable::size(steps, sectors, 8));
            for step in 0..steps {
                for sector in 0..sectors {
                    let turned = TAU * (sector as f64 / sectors as f64 + step as f64 / steps as f64);
                    for (k, theta) in angles.iter().enumerate() {
                        let difference = table.at(step, sector)[k] - restriction.height(theta + turned);
                        assert!(difference.abs() < 1e-14, "{steps} {sectors} {step} {sector}");
                    }
                }
            }
        }
    }

    #[test]
    fn lobes_are_even_and_wrap_around() {
        let lobes = Restriction { count: 3, amplitude: 2.0, width_rad: 0.2, phase_rad: 0.0 };
        assert!((lobes.height(0.0) - 2.0).abs() < 1e-12);
        assert!((lobes.height(TAU / 3.0 + 0.2) - 2.0 / std::f64::consts::E).abs() < 1e-12);
        assert!((lobes.height(10.0 * TAU - 0.1) - lobes.height(0.1)).abs() < 1e-12);
    }

    #[test]
    fn clearance_is_linear_in_arc_length() {
        let positions = [[10.0, 0.0, 0.0], [10.0, 0.0, 3.0], [14.0, 0.0, 3.0]];
        let c = clearance_along_chord(0.3, 1.0, &positions);
        for (found, expected) in c.iter().zip([0.3, 0.6, 1.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn growth_is_smooth_and_ends_at_one() {
        let casing = Casing { clearance: vec![0.1], restriction: None, ramp_revolutions: 2.0 };
        assert_eq!([0.0, 1.0, 2.0, 9.0].map(|r| casing.growth(r)), [0.0, 0.5, 1.0, 1.0]);
    }
}
