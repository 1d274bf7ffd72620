//! Blades that bend far: displacement of second order and geometric stiffening, in a few coordinates p of every sector (docs/method.md, Blades
//! that bend far).
//!
//! ```text
//! p_s = Σ_i Re(w_i e^{jisα} R_i z_i)                   u_s = Φ z + Σ_a v_a q_a(p_s),    q_a = p_j p_k, j ≤ k
//! V = Σ_s Σ_ja B_ja p_j q_a + ½ Σ_ab A_ab q_a q_b      T = Σ_s Σ_ja C_ja ṗ_j q̇_a + ½ Σ_ab Γ_ab q̇_a q̇_b
//! f = −∂V/∂z − d/dt ∂T/∂ż + ∂T/∂z
//! ```
//!
//! V is what remains of the cubic and the quartic part of the strain energy once everything that carries no motion has followed statically, T
//! the kinetic energy that the displacement v q adds: C = ΨᵀMv, Γ = vᵀMv, M the mass of the free displacements.

pub mod backbone;
mod energy_form;

use faer::{Mat, c64};

use super::direction::{COMPONENTS, Direction};
use super::error::ModelError;
use super::modal_wheel::{ModalWheel, mode_shapes};
use super::reduction::ReducedWheel;
pub(crate) use energy_form::{Derivatives, MOST_PRODUCTS, Motion};
pub use energy_form::{EnergyForm, MOST_COORDINATES, products};

/// Second-order bending of the blade of a sector.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeBending {
    /// Number of coordinates that were asked for: there are fewer where the families have no more.
    pub asked: usize,
    /// Rows R of every nodal diameter, `coordinates × unknowns` of the reduction.
    pub rows: Vec<Mat<c64>>,
    /// Strain energy V beyond the quadratic one.
    pub potential: EnergyForm,
    /// Kinetic energy T of the displacement of second order.
    pub inertia: EnergyForm,
    /// Linear displacement of the contact nodes by the coordinates, `3 nodes × coordinates`: r, θ, z of every node.
    pub linear: Mat<f64>,
    /// Displacement v_a of second order of the contact nodes, `3 nodes × products`: r, θ, z of every node.
    pub second_order: Mat<f64>,
}

/// Bending of the blades as a simulation takes it.
#[derive(Debug, Clone, Copy)]
pub struct Bending<'a> {
    /// Second-order bending of a blade.
    pub blade: &'a BladeBending,
    /// First of the places below the contact nodes of the wheel where [`BladeBending::join`] put the coordinates.
    pub first: usize,
    /// Whether blades stiffen: V and T act. Otherwise only the displacement of second order counts.
    pub stiffens: bool,
}

impl BladeBending {
    /// Blade of no particular shape, every coefficient `size` but those of inertia, which are 1e-8 of it, as at 10⁴ rad/s: to measure what bending
    /// costs. Without rows its coordinates are read elsewhere.
    pub fn alike(coordinates: usize, contact_nodes: usize, rows: Vec<Mat<c64>>, size: f64) -> Self {
        let (count, places) = (products(coordinates).count(), COMPONENTS * contact_nodes);
        let alike = |rows, columns| Mat::from_fn(rows, columns, |_, _| size);
        let inertia = |rows, columns| 1e-8 * alike(rows, columns);
        Self {
            asked: coordinates,
            rows,
            potential: EnergyForm::new(&alike(coordinates, count), &alike(count, count)),
            inertia: EnergyForm::new(&inertia(coordinates, count), &inertia(count, count)),
            linear: alike(places, coordinates),
            second_order: alike(places, count),
        }
    }

    /// Number of coordinates of a sector.
    pub fn coordinates(&self) -> usize {
        self.potential.coordinates()
    }

    /// Joins the coordinates to `wheel` at its speed, below all nodes it has, three to a place. Returns their first place.
    ///
    /// # Errors
    /// Errors of [`ModalWheel::at`].
    pub fn join(
        &self,
        wheel: &mut ModalWheel,
        reduced: &ReducedWheel,
        stiffening: bool,
    ) -> Result<usize, ModelError> {
        let mut first = 0;
        for harmonic in &mut wheel.harmonics {
            let shapes = mode_shapes(reduced, harmonic.harmonic, wheel.speed_rad_s, stiffening)?;
            let read = &self.rows[harmonic.harmonic] * shapes;
            let above = harmonic.contact.nrows();
            first = above / COMPONENTS;
            let rows = above + COMPONENTS * read.nrows().div_ceil(COMPONENTS);
            harmonic.contact = Mat::from_fn(rows, read.ncols(), |row, mode| match row.checked_sub(above) {
                None => harmonic.contact[(row, mode)],
                Some(row) if row < read.nrows() => read[(row, mode)],
                Some(_) => c64::ZERO,
            });
        }
        Ok(first)
    }
}

impl Bending<'_> {
    /// Coordinates as directions of displacement.
    pub(crate) fn directions(&self) -> impl Iterator<Item = Direction> {
        let first = self.first;
        (0..self.blade.coordinates()).map(move |j| {
            let mut components = [0.0; COMPONENTS];
            components[j % COMPONENTS] = 1.0;
            Direction { node: first + j / COMPONENTS, components }
        })
    }
}

#[cfg(test)]
mod tests;
