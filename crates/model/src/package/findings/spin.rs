//! Test whether K(Ω) − K(0) is the effect of spinning on the undeformed geometry, without knowing the stresses (docs/method.md, Centrifugal
//! stiffening).
//!
//! Move the sector rigidly, w = t + a × x. The elastic stiffness gives no force; the geometric stiffness turns the nodal
//! forces that the stresses balance, K_σ w = a × Ω² M x⊥ where nothing else holds a node (x⊥ is the part of x
//! normal to the axis); spin softening gives −Ω² M_spin w, with M_spin the mass without its axial part. So
//!
//! ```text
//! (K(Ω) − K(0)) w = Ω² (σ a × M x⊥ − β M_spin w),    σ = β = 1,    for every t and a
//! ```
//!
//! holds for exact undeformed-geometry matrices of any element, and for no tangent on the deformed geometry, where the
//! left side has K_e (a × u) in it, of the same order. The shares σ and β that fit best tell what is missing.

use nalgebra::{Matrix2, Vector2};

use super::rigid::{Balance, Body, MOTIONS, OfMotions, forces};
use crate::package::raw::{RawMatrix, RawPackage};
use crate::package::units;
use rubmap_wheel::dynamics::findings::SpinFinding;

/// Largest residual of matrices on the undeformed geometry; printed stresses of seven digits leave 1e-7.
const SOUND: f64 = 1e-3;

/// Largest relative residual of the best-fitting shares at which they are reported.
const FITS: f64 = 0.05;

/// Largest difference of a share from 1 that passes: stress and mass may be integrated by different quadratures.
const NEARLY: f64 = 0.02;

/// Largest round-off of K(0), as a part of the right-hand side, that does not hide it.
const HIDDEN: f64 = 0.03;

/// Factor by which round-off may add to a residual.
const ROUND_OFF: f64 = 3.0;

/// Largest standard deviation of a share that is reported although round-off hides it in single rows.
const KNOWN: f64 = 0.05;

/// Largest difference from 1 of shares that round-off leaves.
const AS_SAID: f64 = 0.3;

/// Compares K(Ω) at `speed`, rad/s, with the identity, at nodes that K(0) leaves in balance.
pub(super) fn find(
    body: &Body,
    balance: &Balance,
    package: &RawPackage,
    speed: f64,
    at_speed: &RawMatrix,
) -> SpinFinding {
    let reading = &body.stated;
    let moved = forces(at_speed, &body.motions(reading));
    let load = forces(&package.mass, &body.radii(reading));
    let in_plane = forces(&package.mass, &body.motions_in_plane(reading));
    let square = (speed * units::seconds(&package.manifest.units)).powi(2);
    let mut sums = Sums::default();
    for node in (0..balance.nodes.len()).filter(|&node| balance.nodes[node]) {
        let at = |by_row: &[OfMotions], motion| reading.vector(node, by_row, motion);
        for motion in 0..MOTIONS {
            let at_rest = at(&balance.forces, motion) / square;
            let found = at(&moved, motion) / square - at_rest;
            let turned = Body::turn(motion).cross(&at(&load, 0));
            let softening = body.in_plane(at(&in_plane, motion));
            for k in 0..3 {
                sums.add(found[k], turned[k], softening[k], at_rest[k]);
            }
        }
    }
    sums.judge()
}

/// Sums of squares and products over rows and motions.
#[derive(Default)]
struct Sums {
    /// Products of found, turned and −softening.
    products: [[f64; 3]; 3],
    /// Sum of (found − turned + softening)².
    residual: f64,
    /// Sum of the squared forces of K(0), which should be zero.
    noise: f64,
    /// Number of rows and motions that were added.
    rows: f64,
}

impl Sums {
    fn add(&mut self, found: f64, turned: f64, softening: f64, at_rest: f64) {
        let row = [found, turned, -softening];
        for (sums, a) in self.products.iter_mut().zip(row) {
            sums.iter_mut().zip(row).for_each(|(sum, b)| *sum += a * b);
        }
        self.residual += (found - turned + softening).powi(2);
        self.noise += at_rest * at_rest;
        self.rows += 1.0;
    }

    fn judge(&self) -> SpinFinding {
        let [[found, of_turned, of_softening], [_, turned, both], [_, _, softening]] = self.products;
        let size = turned + softening;
        if size == 0.0 {
            return SpinFinding::NotChecked;
        }
        let [residual, noise] = [self.residual, self.noise].map(|sum| (sum / size).sqrt());
        if residual <= SOUND.max(ROUND_OFF * noise) && noise <= HIDDEN {
            return SpinFinding::Undeformed { residual };
        }
        let normal = Matrix2::new(turned, both, both, softening);
        let inverse = normal.try_inverse().filter(|inverse| inverse.iter().all(|x| x.is_finite()));
        let shares = inverse.map(|inverse| inverse * Vector2::new(of_turned, of_softening));
        if noise > HIDDEN {
            // Over many rows round-off averages out.
            let variance =
                |k: usize| inverse.map_or(f64::INFINITY, |inverse| inverse[(k, k)] * self.noise / self.rows);
            let known = variance(0).max(variance(1)) <= KNOWN * KNOWN;
            return match shares
                .filter(|shares| known && shares.iter().any(|share| (share - 1.0).abs() > AS_SAID))
            {
                Some(shares) => SpinFinding::Shares { stiffening: shares.x, softening: shares.y, residual },
                None => SpinFinding::Hidden,
            };
        }
        if found <= (SOUND * SOUND).max((ROUND_OFF * noise).powi(2)) * size {
            return SpinFinding::Shares { stiffening: 0.0, softening: 0.0, residual };
        }
        let Some(shares) = shares else { return SpinFinding::Other { residual } };
        let left = (found - shares.dot(&Vector2::new(of_turned, of_softening))).max(0.0) / found;
        if left.sqrt() > FITS.max(ROUND_OFF * noise * (size / found).sqrt()) {
            return SpinFinding::Other { residual };
        }
        if shares.iter().all(|share| (share - 1.0).abs() <= NEARLY) {
            return SpinFinding::Undeformed { residual };
        }
        SpinFinding::Shares { stiffening: shares.x, softening: shares.y, residual }
    }
}
