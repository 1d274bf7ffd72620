//! Findings about a package that passed every check: its size in SI units, and what in it looks wrong.
//!
//! ```text
//! K(0), positions ──▶ rigid motions ──▶ nodes in balance ──▶ digits of the matrices
//!                                              └──▶ M, K(Ω) ──▶ share of stiffening and softening
//! ```
//!
//! Rows that are in balance only if they are read in another order or frame are refused ([`order`]).

mod digits;
pub(super) mod in_si;
mod order;
mod rigid;
mod spin;

use rubmap_wheel::dynamics::findings::{DigitNoise, Findings, InSi, SpinFinding};

use super::check::layout::Layout;
use super::error::PackageError;
use super::raw::RawPackage;
use rigid::{Balance, Body};

/// What the matrices of a package say about its rigid motions.
pub(super) struct OfMatrices {
    spin: Vec<(f64, SpinFinding)>,
    digits: Option<DigitNoise>,
}

/// Moves the sector rigidly against its matrices.
///
/// # Errors
/// Rows in another order or frame than the package says.
pub(super) fn of_matrices(package: &RawPackage, layout: &Layout) -> Result<OfMatrices, PackageError> {
    let body = Body::of(package, layout);
    let balance = Balance::of(&body, &body.as_stated(), &package.stiffness[0]);
    order::check(&body, &balance, package)?;
    let at_speed = package.manifest.speeds_rad_s.iter().zip(&package.stiffness).skip(1);
    Ok(OfMatrices {
        spin: at_speed
            .map(|(&speed, matrix)| (speed, spin::find(&body, &balance, package, speed, matrix)))
            .collect(),
        digits: digits::find(&body, &balance, package, layout),
    })
}

impl OfMatrices {
    /// With size and materials.
    pub(super) fn with_size(self, in_si: Option<InSi>) -> Findings {
        Findings { spin: self.spin, digits: self.digits, in_si }
    }
}
