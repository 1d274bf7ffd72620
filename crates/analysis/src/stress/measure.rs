//! Scalar measures of a stress: von Mises, its sign, principal stress.

use std::f64::consts::TAU;

/// Stress components σ_rr, σ_θθ, σ_zz, σ_rθ, σ_θz, σ_zr.
pub(super) type Stress = [f64; 6];

/// Symmetric form whose square root is the von Mises stress, a seminorm: hydrostatic pressure has none.
pub(super) fn form(a: &Stress, b: &Stress) -> f64 {
    let normal =
        (a[0] - a[1]) * (b[0] - b[1]) + (a[1] - a[2]) * (b[1] - b[2]) + (a[2] - a[0]) * (b[2] - b[0]);
    0.5 * normal + 3.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// Von Mises stress.
pub(super) fn von_mises(stress: &Stress) -> f64 {
    form(stress, stress).sqrt()
}

/// Three times the mean normal stress.
pub(super) fn trace(stress: &Stress) -> f64 {
    stress[0] + stress[1] + stress[2]
}

/// Von Mises stress with the sign of the mean normal stress, + where that is zero.
pub(super) fn signed(stress: &Stress) -> f64 {
    let size = von_mises(stress);
    if trace(stress) < 0.0 { -size } else { size }
}

/// Principal stress that is largest in magnitude; the tensile one of two equal ones.
pub(super) fn principal(stress: &Stress) -> f64 {
    let mean = trace(stress) / 3.0;
    let [x, y, z] = [stress[0] - mean, stress[1] - mean, stress[2] - mean];
    let [xy, yz, zx] = [stress[3], stress[4], stress[5]];
    let second = form(stress, stress) / 3.0;
    if second <= 0.0 {
        return mean;
    }
    let third = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    // Eigenvalues of the deviator are 2√(J₂/3) cos φ at three angles 120° apart.
    let cosine = (1.5 * 3f64.sqrt() * third / second.powf(1.5)).clamp(-1.0, 1.0);
    let (angle, radius) = (cosine.acos() / 3.0, 2.0 * (second / 3.0).sqrt());
    let (high, low) = (mean + radius * angle.cos(), mean + radius * (angle + TAU / 3.0).cos());
    if high.abs() >= low.abs() { high } else { low }
}

/// Largest von Mises stress of Re(e^{jφ} (a + jb)) over φ: half the long axis of an ellipse.
#[cfg(test)]
pub(super) fn ellipse(a: &Stress, b: &Stress) -> f64 {
    let (aa, bb, ab) = (form(a, a), form(b, b), form(a, b));
    (0.5 * (aa + bb + (aa - bb).hypot(2.0 * ab))).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;

    #[test]
    fn simple_states_have_the_numbers_of_every_textbook() {
        assert_eq!(von_mises(&[7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert_eq!(von_mises(&[-3.0, -3.0, -3.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
        assert_eq!(signed(&[-7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), -7.0);
        assert!((principal(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]) - 2.0).abs() < 1e-12);
        assert!((principal(&[0.0, -5.0, 1.0, 0.0, 0.0, 0.0]) + 5.0).abs() < 1e-12);
        assert_eq!(principal(&[4.0, 4.0, 4.0, 0.0, 0.0, 0.0]), 4.0);
    }

    #[test]
    fn principal_stress_is_an_eigenvalue() {
        for seed in 0..200 {
            let s: Stress = std::array::from_fn(|k| (1.7 * f64::from(seed) + 2.3 * k as f64).sin() * 10.0);
            let tensor = Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
            let eigen = tensor.symmetric_eigenvalues();
            let largest = eigen.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
            assert!((principal(&s) - largest).abs() < 1e-9, "{s:?}: {largest}");
        }
    }

    #[test]
    fn the_long_axis_is_the_largest_over_a_turn() {
        for seed in 0..50 {
            let of = |shift: f64| -> Stress {
                std::array::from_fn(|k| (0.7 * f64::from(seed) + 1.9 * k as f64 + shift).sin())
            };
            let (a, b) = (of(0.0), of(2.0));
            let at = |step: u32| {
                let (sin, cos) = (f64::from(step) * TAU / 3600.0).sin_cos();
                von_mises(&std::array::from_fn(|k| cos * a[k] - sin * b[k]))
            };
            let largest = (0..3600).map(at).fold(0.0, f64::max);
            assert!((ellipse(&a, &b) - largest).abs() < 1e-5 * largest);
            assert!(ellipse(&a, &b) >= largest * (1.0 - 1e-12));
        }
    }
}
