//! Stress tensors: von Mises stress and principal stresses.

use nalgebra::Matrix3;

/// Von Mises stress of σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx.
pub fn von_mises(stress: [f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + zx * zx)).sqrt()
}

/// Principal stresses of σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx, the largest first.
pub fn principal(stress: [f64; 6]) -> [f64; 3] {
    let mut values: [f64; 3] = matrix(stress).symmetric_eigenvalues().into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Stress tensor of its six components.
pub(super) fn matrix([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// Components of a stress tensor: σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx.
pub(super) fn components(m: &Matrix3<f64>) -> [f64; 6] {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(1, 2)], m[(2, 0)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_tensors() {
        assert!((von_mises([7.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 7.0).abs() < 1e-14);
        assert!((von_mises([0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-14);
        assert!(von_mises([3.0, 3.0, 3.0, 0.0, 0.0, 0.0]) < 1e-14, "pressure");
        let found = principal([1.0, 1.0, 5.0, 2.0, 0.0, 0.0]);
        assert!(found.iter().zip([5.0, 3.0, -1.0]).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
    }
}
