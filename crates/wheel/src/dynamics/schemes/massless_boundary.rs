//! Boundary without mass (docs/method.md, A boundary without mass; Monjaraz-Tec, Gross and Krack, Computers & Structures 260, 2022).
//!
//! The r lowest modes of every nodal diameter of the reduced wheel carry the mass. All others follow statically, through the residual
//! flexibility they leave at the contact DOF:
//!
//! ```text
//! u_b = Φ_b η + F f,   F = Σ_{m>r} φ_m φ_mᴴ/ω_m²        (= K⁻¹ − Φ_b Ω_r⁻² Φ_bᴴ, without its cancellation)
//! η̈ + 2ζΩ_r η̇ + Ω_r² η = Φ_bᴴ f,   f = −n λ
//! 0 ≤ λ ⊥ g = c − p − nᵀ(Φ_b η − F n λ) ≥ 0             at the new time, once η is there
//! ```
//!
//! η advances by the exact propagator ([`super::exact_modal`]) with the force of the instant it starts from, which makes
//! the scheme second order and, undamped, time-symmetric. No mass is stopped at a closing, and nothing penetrates. The energy
//! identity is that of the integrated modes, E of [`super`]; the residual flexibility stores ½ fᵀFf beside it, and what
//! a closing and its opening leave of that is O(h²), of either sign.
//!
//! Step rule: h < 1/ω_c with ω_c² the largest eigenvalue of Ω_r² + Φ_bᴴ n F_nn⁻¹ nᵀ Φ_b over the nodal diameters: the wheel
//! with every contact node held. Fewer closed nodes only make it softer, and the exact propagator only lowers the bound
//! of each mode, so h < 2/ω_c keeps every fixed set of closed nodes stable. Nodes that open and close pass energy from one set
//! to the next, though: with little damping, steps between half that limit and the limit make it grow without bound (up to
//! 36 times as far as central differences on random wheels, with perfect credentials), steps below half of it did not.
//! Keeping more modes leaves less flexibility: ω_c grows.

use faer::{Mat, c64};

use super::super::contact::flexibility::{flexibility, outward_normals, ridge};
use super::super::direction::Direction;
use super::super::modal_wheel::ModalWheel;
use super::super::sector::ContactNode;
use super::central_differences;
use rubmap_numerics::dense::Dense;

/// Fewest steps per revolution with h < 1/ω_c; the largest number there is if the modes left out leave no flexibility: fewer of them than
/// contact nodes cannot close every gap, and nodes would be held by the ridge of a singular F.
pub(super) fn smallest_stable_steps(wheel: &ModalWheel, kept: usize, contact_nodes: &[ContactNode]) -> u64 {
    if contact_nodes.is_empty() {
        return 1;
    }
    if wheel.harmonics.iter().any(|harmonic| harmonic.omega.len() < kept + contact_nodes.len()) {
        return u64::MAX;
    }
    match closed_frequency(wheel, kept, contact_nodes) {
        Some(omega) => central_differences::smallest_stable_steps(2.0 * omega, wheel.speed_rad_s),
        None => u64::MAX,
    }
}

/// Frequency ω_c, rad/s, of the wheel with every contact node held; none if F is singular.
fn closed_frequency(wheel: &ModalWheel, kept: usize, contact_nodes: &[ContactNode]) -> Option<f64> {
    let normals = outward_normals(contact_nodes);
    let residual = residual_flexibility(wheel, kept, &normals, &normals);
    let ridge = ridge(&residual, wheel.sectors);
    let mut largest = 0.0f64;
    for (harmonic, mut block) in wheel.harmonics.iter().zip(residual) {
        for k in 0..normals.len() {
            block[(k, k)] += ridge;
        }
        let modes = Mat::from_fn(normals.len(), kept, |k, m| normals[k].of(harmonic.contact.as_ref(), m));
        let held = modes.adjoint() * c64::definite_solve(block.as_ref(), modes.as_ref())?;
        let closed = Mat::from_fn(kept, kept, |i, j| {
            let own = if i == j { harmonic.omega[i].powi(2) } else { 0.0 };
            0.5 * (held[(i, j)] + held[(j, i)].conj()) + c64::new(own, 0.0)
        });
        let values = Dense::eigenvalues(closed.as_ref()).ok()?;
        largest = largest.max(values.last().copied().unwrap_or(0.0));
    }
    largest.is_finite().then(|| largest.sqrt())
}

/// Residual flexibility F of the modes beyond the `kept` lowest, per nodal diameter.
pub fn residual_flexibility(
    wheel: &ModalWheel,
    kept: usize,
    to: &[Direction],
    from: &[Direction],
) -> Vec<Mat<c64>> {
    let omega = |harmonic: usize, mode: usize| wheel.harmonics[harmonic].omega[mode];
    flexibility(
        wheel,
        to,
        from,
        |harmonic, mode| {
            if mode < kept { 0.0 } else { omega(harmonic, mode).powi(-2) }
        },
    )
}

/// Largest number of kept modes per nodal diameter that is stable with `steps` per revolution; none if not even one is.
pub fn most_kept_modes(wheel: &ModalWheel, contact_nodes: &[ContactNode], steps: u64) -> Option<usize> {
    let modes = wheel.harmonics.iter().map(|harmonic| harmonic.omega.len()).max()?;
    // ω_c grows with every mode that is kept.
    let (mut stable, mut unstable) = (0, modes + 1);
    while unstable - stable > 1 {
        let middle = stable.midpoint(unstable);
        if smallest_stable_steps(wheel, middle, contact_nodes) <= steps {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    (stable > 0).then_some(stable)
}
