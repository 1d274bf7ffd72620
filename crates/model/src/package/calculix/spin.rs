//! Whether K(Ω) − K(0) is what spinning adds on the undeformed geometry, without knowing the stresses (docs/method.md,
//! Centrifugal stiffening).
//!
//! Turn the sector rigidly, w = a × x. The elastic stiffness gives no force; the geometric stiffness turns the nodal
//! forces that the stresses balance, K_σ w = a × Ω² M x⊥ where nothing else holds a node (x⊥ is the part of x
//! normal to the axis); spin softening gives −Ω² M_spin w, with M_spin the mass without its axial part. So
//!
//! ```text
//! (K(Ω) − K(0)) w = Ω² (a × M x⊥ − M_spin w)        for every a
//! ```
//!
//! holds for exact undeformed-geometry matrices of any element, and for no tangent on the deformed geometry, where the
//! left side has K_e (a × u) in it, of the same order.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::wheel::times;
use crate::package::raw::{RawDof, RawMatrix};

/// Forces of a translation below this part of Σ|K_ij| mark a row that no clamp holds.
const FREE: f64 = 1e-8;

/// Residuals up to this are undeformed geometry; printed stresses of seven digits leave 1e-7.
const SOUND: f64 = 1e-3;

/// What a stiffness at speed was found to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpinFinding {
    /// Geometric stiffness and spin softening on the undeformed geometry, within the residual.
    Undeformed {
        /// Residual of the identity, relative to its right-hand side.
        residual: f64,
    },
    /// The same without −Ω² M_spin.
    WithoutSoftening {
        /// Residual of the identity without the softening term.
        residual: f64,
    },
    /// Something else: the deformed geometry, stresses of another speed or of a sector whose ties were open.
    Other {
        /// Residual of the identity.
        residual: f64,
    },
    /// No row is free of clamps and cyclic faces.
    NotChecked,
}

/// Checks K(Ω) at `speed` against the identity, at rows of `inner` nodes.
pub(super) fn check(
    speed: f64,
    [rest, at_speed, mass]: [&RawMatrix; 3],
    dofs: &[RawDof],
    positions: &HashMap<u64, [f64; 3]>,
    (origin, e3): (Vector3<f64>, Vector3<f64>),
    inner: impl Fn(u64) -> bool,
) -> SpinFinding {
    let of = |vector: &dyn Fn(Vector3<f64>) -> Vector3<f64>| -> Vec<f64> {
        dofs.iter()
            .map(|dof| {
                let from_axis = Vector3::from(positions[&dof.node]) - origin;
                vector(from_axis)[usize::from(dof.component) - 1]
            })
            .collect()
    };
    let units = [Vector3::x(), Vector3::y(), Vector3::z()];
    let magnitudes = RawMatrix {
        size: rest.size,
        entries: rest.entries.iter().map(|&(row, column, value)| (row, column, value.abs())).collect(),
    };
    let scale = times(&magnitudes, &vec![1.0; rest.size]);
    let mut free: Vec<bool> = dofs.iter().map(|dof| inner(dof.node)).collect();
    for unit in units {
        let force = times(rest, &of(&|_| unit));
        for (row, free) in free.iter_mut().enumerate() {
            *free &= force[row].abs() <= FREE * scale[row];
        }
    }
    let normal_part = |v: Vector3<f64>| v - e3 * v.dot(&e3);
    let load = times(mass, &of(&normal_part));
    let [mut with, mut without, mut size] = [0.0; 3];
    for a in units {
        let turn = of(&|x| a.cross(&x));
        let in_plane = times(mass, &of(&|x| normal_part(a.cross(&x))));
        let difference: Vec<f64> =
            times(at_speed, &turn).iter().zip(times(rest, &turn)).map(|(a, b)| a - b).collect();
        // Only rows of nodes with all three DOF can be turned; others keep zeros in `load` and are left out.
        let mut rows: HashMap<u64, [Option<usize>; 3]> = HashMap::new();
        for (row, dof) in dofs.iter().enumerate() {
            rows.entry(dof.node).or_default()[usize::from(dof.component) - 1] = Some(row);
        }
        let mut nodes: Vec<[usize; 3]> =
            rows.into_values().filter_map(|[x, y, z]| Some([x?, y?, z?])).collect();
        nodes.sort_unstable();
        for node in nodes.into_iter().filter(|node| node.iter().all(|row| free[*row])) {
            let at = |v: &[f64]| Vector3::from(node.map(|row| v[row]));
            let turned_load = a.cross(&at(&load));
            let softening = normal_part(at(&in_plane));
            for k in 0..3 {
                let found = at(&difference)[k] / (speed * speed);
                with += (found - turned_load[k] + softening[k]).powi(2);
                without += (found - turned_load[k]).powi(2);
                size += turned_load[k].powi(2) + softening[k].powi(2);
            }
        }
    }
    if size == 0.0 {
        return SpinFinding::NotChecked;
    }
    let [with, without] = [with, without].map(|sum| (sum / size).sqrt());
    match (with <= SOUND, without <= SOUND) {
        (true, _) => SpinFinding::Undeformed { residual: with },
        (false, true) => SpinFinding::WithoutSoftening { residual: without },
        _ => SpinFinding::Other { residual: with },
    }
}
