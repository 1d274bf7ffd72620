//! Findings about a package that passed every check: its size in SI units, and what looks wrong in it.
//!
//! ```text
//! K(0), positions ──▶ rigid motions ──▶ nodes in balance ──▶ digits of the matrices
//!                                              └──▶ M, K(Ω) ──▶ share of stiffening and softening
//! ```
//!
//! Rows that are in balance only if they are read in another order or frame are refused ([`order`]), and so are high faces that fit the low
//! ones only otherwise ([`faces`]).

mod better;
mod contact;
mod digits;
mod faces;
pub(super) mod in_si;
mod mass;
mod order;
mod rigid;
mod spin;

use rubmap_wheel::dynamics::findings::{Findings, SpinAtSpeed, Unbalanced};

use super::check::layout::Layout;
use super::error::PackageError;
use super::raw::RawPackage;
use rigid::{Balance, Body};

/// Findings from rigid motions of the sector and its matrices; the size is added later.
///
/// # Errors
/// Rows in another order or frame than the package says.
pub(super) fn of_matrices(package: &RawPackage, layout: &Layout) -> Result<Findings, PackageError> {
    let body = Body::of(package, layout);
    let balance = Balance::of(&body, &body.stated, &package.stiffness[0]);
    order::check(&body, &balance, package, layout)?;
    let open_joint = faces::check(&body, &balance, package, layout)?;
    let at_speed = package.manifest.speeds_rad_s.iter().zip(&package.stiffness).skip(1);
    let spin = at_speed.map(|(&speed_rad_s, matrix)| SpinAtSpeed {
        speed_rad_s,
        finding: spin::find(&body, &balance, package, speed_rad_s, matrix),
    });
    Ok(Findings {
        spin: spin.collect(),
        digits: digits::find(&body, &balance, package, layout),
        unbalanced: Unbalanced::of(balance.count(), body.inner().count()),
        open_joint,
        uneven_mass: mass::find(&body, package),
        odd_contact: contact::find(&body, package, layout),
        in_si: None,
    })
}
