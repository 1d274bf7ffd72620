//! Abradable coating of the casing: one-dimensional elasto-plastic rods that blades press and wear down (Legrand, Batailly and
//! Pierre, Journal of Computational and Nonlinear Dynamics 7, 2012).
//!
//! The coating, of thickness t0 on a rigid casing, is cut into rods that stand side by side around the circumference, one row for
//! every contact node. A rod of area A that a tip compresses by x has the strain ε = x/t0, of which ε_p is plastic and stays:
//!
//! ```text
//! λ = A σ,   σ = E (ε − ε_p) ≤ σ_Y + K ε_p,   0 ≤ ε ≤ 1
//! ```
//!
//! so that λ over x is the [`BilinearLaw`] that starts at the worn depth w = ε_p t0, rises by AE/t0, yields at σ_Y + Kε_p and goes
//! on by A EK/((E + K) t0), until at x = t0 the tip meets the metal. Plastic strain is material rubbed off: it never returns, all
//! blades share it, and it lasts for the whole run. A compressed rod springs back at once when its blade has passed on.
//!
//! A node presses one rod at a time, so the width of a rod, 2πr/rods, is that of the contact across a blade's tip: forces grow with it.

mod fresh;
mod rods;
mod worn;

pub use self::fresh::{Coating, CoatingError, CoatingMaterial, LEAST_HARDENING, RODS_PER_SECTOR};
pub use self::worn::WornCoating;
#[cfg(doc)]
use rubmap_numerics::complementarity::law::BilinearLaw;
