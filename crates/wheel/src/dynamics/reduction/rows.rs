//! Rows of the reduction basis: displacement of any DOF of the sector in the reduced coordinates.

use faer::{Mat, c64};

use super::basis::Basis;
use super::reduced::mark;

/// Basis Υ̂ of one nodal diameter, row by row: u = Υ̂ q for the own DOF in (r, θ, z) components, q being the coordinates of the reduced
/// matrices. The DOF of the high face are those of the low one in the next sector.
#[derive(Clone, Copy)]
pub struct BasisRows<'a> {
    harmonic: usize,
    basis: &'a Basis<'a>,
    mass: &'a Mat<c64>,
}

impl<'a> BasisRows<'a> {
    pub(super) fn new(harmonic: usize, basis: &'a Basis<'a>, mass: &'a Mat<c64>) -> Self {
        Self { harmonic, basis, mass }
    }

    /// Nodal diameter i.
    pub fn harmonic(&self) -> usize {
        self.harmonic
    }

    /// Number of own DOF of the sector.
    pub fn dofs(&self) -> usize {
        self.basis.dofs()
    }

    /// Number of columns.
    pub fn unknowns(&self) -> usize {
        self.mass.ncols()
    }

    /// Mark of the reduction that the rows belong to; see [`ReducedHarmonic::mark`](super::ReducedHarmonic::mark).
    pub fn mark(&self) -> [u8; 32] {
        mark(self.mass)
    }

    /// Row of own DOF `dof`: real and imaginary part of every column.
    pub fn row(&self, dof: usize) -> impl Iterator<Item = f64> + use<'a> {
        self.basis.row(dof).flat_map(|value| [value.re, value.im])
    }
}

impl std::fmt::Debug for BasisRows<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BasisRows").field("harmonic", &self.harmonic).field("dofs", &self.dofs()).finish()
    }
}
