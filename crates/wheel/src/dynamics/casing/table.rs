//! Heights of the casing at the steps of a revolution.

use std::f64::consts::TAU;

use num_integer::gcd;

/// Heights p at every contact node for every time step of a revolution: nothing is evaluated in the step loop.
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

    /// Tabulates the height `profile(φ, node)` for contact nodes at `angles_rad`.
    pub fn new(
        profile: impl Fn(f64, usize) -> f64,
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
                values
                    .extend(angles_rad.iter().enumerate().map(|(node, theta)| profile(theta + turned, node)));
                values.resize(values.len() + stride - angles_rad.len(), 0.0);
            }
        }
        let place = |s: usize| ((s * steps % sectors) / common * steps * stride, s * steps / sectors);
        Self { steps, stride, values, sectors: (0..sectors).map(place).collect() }
    }

    /// Heights p at the nodes of `sector` at `step` of the revolution (0 ≤ step < S).
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
    use super::super::Lobes;
    use super::*;

    #[test]
    fn table_equals_the_formula_for_any_step_count() {
        let restriction = Lobes { count: 2, amplitude: 0.4, width_rad: 0.35, phase_rad: 0.2 };
        let angles = [0.1, -0.7, 2.9];
        for (steps, sectors) in [(40, 10), (37, 10), (36, 8), (9, 1), (12, 7)] {
            let table = RestrictionTable::new(|phi, _| restriction.height(phi), &angles, steps, sectors, 8);
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
}
