//! Wheel that vibrates freely, its blades bending far.

use faer::{Mat, c64};

use crate::dynamics::bending::{BladeBending, EnergyForm};
use crate::dynamics::error::ModelError;
use crate::dynamics::modal_wheel::natural_modes;
use crate::dynamics::reduction::ReducedWheel;

/// Wheel that vibrates freely, its blades bending far.
#[derive(Debug, Clone)]
pub struct FreeWheel<'a> {
    /// Number N of sectors.
    pub sectors: usize,
    /// Modes of nodal diameters 0 to N/2.
    pub modes: Vec<FreeModes>,
    /// Strain energy of a blade beyond the quadratic one.
    pub potential: &'a EnergyForm,
    /// Kinetic energy of its displacement of second order.
    pub inertia: &'a EnergyForm,
}

/// Modes of a nodal diameter, mass-normalised.
#[derive(Debug, Clone)]
pub struct FreeModes {
    /// Natural frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Coordinates of a blade by the modes, `coordinates × modes`.
    pub rows: Mat<c64>,
    /// Displacement of the contact nodes by the modes, r, θ, z of every node, `3 nodes × modes`.
    pub contact: Mat<c64>,
}

/// Mode that a curve begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FreeMode {
    /// Nodal diameter i.
    pub nodal_diameter: usize,
    /// Rank among the modes of the nodal diameter, from 0.
    pub rank: usize,
}

impl BladeBending {
    /// Wheel of these blades at `speed_rad_s`, free of contact.
    ///
    /// # Errors
    /// Errors of [`natural_modes`].
    pub fn free_wheel(
        &self,
        reduced: &ReducedWheel,
        speed_rad_s: f64,
        stiffening: bool,
    ) -> Result<FreeWheel<'_>, ModelError> {
        let modes = |harmonic: usize| {
            let (omega, shapes) = natural_modes(reduced, harmonic, speed_rad_s, stiffening)?;
            let contact = shapes.subrows(0, reduced.contact_dofs()).to_owned();
            Ok(FreeModes { omega, rows: &self.rows[harmonic] * shapes, contact })
        };
        let modes = (0..reduced.harmonics.len()).map(modes).collect::<Result<_, _>>()?;
        Ok(FreeWheel { sectors: reduced.sectors, modes, potential: &self.potential, inertia: &self.inertia })
    }
}
