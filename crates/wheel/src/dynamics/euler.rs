//! Euler force of a wheel whose speed changes (docs/method.md, Run-up and run-down).
//!
//! ```text
//! −Ω̇ ẑ × (r + u)   per unit mass:   φᴴf = −Ω̇ √N φᵀ ∫ρ Υᵀ(ẑ × r) dV   of nodal diameter 0,   −½Ω̇ g z   of every nodal diameter
//! ```
//!
//! On the wheel at rest in its frame the Euler force is the same in every sector, so that it drives nodal diameter 0 alone. On the vibration it
//! acts where Coriolis forces do, by their matrix: G = 2∫ρ Nᵀ[ẑ×]N dV. It pushes across the displacement, and may do work on it.

use faer::{MatRef, c64};

/// Rate Ω̇ of the speed in part of a run: straight pieces, one behind the other, between which it may jump.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedRate(pub Vec<StraightRate>);

/// Rate Ω̇ that goes straight from one end to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightRate {
    /// Revolutions after the start of the run at which the piece begins and ends.
    pub revolutions: [f64; 2],
    /// Rate Ω̇ at both ends, rad/s².
    pub rad_s2: [f64; 2],
}

impl SpeedRate {
    /// Rate Ω̇ after `revolutions`, rad/s²; beyond the ends the value at the end.
    pub(crate) fn at(&self, revolutions: f64) -> f64 {
        let begun = self.0.partition_point(|piece| piece.revolutions[0] <= revolutions);
        self.0.get(begun.saturating_sub(1)).map_or(0.0, |piece| piece.at(revolutions))
    }
}

impl StraightRate {
    fn at(&self, revolutions: f64) -> f64 {
        let ([from, to], [first, last]) = (self.revolutions, self.rad_s2);
        first + ((revolutions - from) / (to - from)).clamp(0.0, 1.0) * (last - first)
    }
}

/// Euler force in part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct EulerForce {
    /// Rate of change of the speed.
    pub rate: SpeedRate,
    /// Force on every mode of nodal diameter 0 per unit Ω̇, as of [`modal_load`].
    pub load: Vec<f64>,
}

/// Modal load √N Φᵀf: the force of `reduced`, a load of every sector in the coordinates of the reduction at nodal diameter 0, on the modes
/// `shapes` of a wheel of `sectors` sectors.
pub fn modal_load(reduced: &[f64], shapes: MatRef<'_, c64>, sectors: usize) -> Vec<f64> {
    let of = |mode: usize| shapes.col(mode).iter().zip(reduced).map(|(phi, f)| phi.re * f).sum::<f64>();
    (0..shapes.ncols()).map(|mode| (sectors as f64).sqrt() * of(mode)).collect()
}
