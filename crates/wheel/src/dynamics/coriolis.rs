//! Coriolis forces in time.
//!
//! With g = ΦᴴĜΦ of a nodal diameter (skew-Hermitian) its modes obey z̈ + 2ζωż + Ωgż + ω²z = φᴴf. Every scheme's
//! recursion ([`super::schemes`]) takes ż at the middle instant as (z⁺ − z⁻)/2h, so that Coriolis forces only change the
//! swing z⁺ − z⁻ of a step:
//!
//! ```text
//! z⁺ − z⁻ = S (z⁺ − z⁻ without them),   S = (1 + R Ωg/2h)⁻¹,   R = diag(receptance)
//! ```
//!
//! Coriolis forces do no work: Re (z⁺ − z⁻)ᴴ g (z⁺ − z⁻) = 0, so that the energy identity stands, and every step that is stable without
//! them is stable with them. A force moves S R φᴴ f within its step: the contact operator is no longer symmetric, but positive definite
//! still. The order in h is two, whatever the scheme.

use faer::{Mat, MatRef, c64};
use rubmap_numerics::dense::Dense;

/// Swing matrix S of one nodal diameter over the integrated modes, whose receptances are given.
pub(crate) fn swing_matrix(g: MatRef<'_, c64>, speed_rad_s: f64, step: f64, receptance: &[f64]) -> Mat<c64> {
    let modes = receptance.len();
    let factor = speed_rad_s / (2.0 * step);
    let system = Mat::from_fn(modes, modes, |i, j| {
        g[(i, j)] * (factor * receptance[i]) + if i == j { c64::ONE } else { c64::ZERO }
    });
    c64::inverse(system.as_ref())
}
