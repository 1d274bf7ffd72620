//! Rows of the reduction basis: what any DOF of the sector does in the reduced coordinates.

use faer::{Mat, c64};

use super::basis::Basis;

/// Υ̂ of one nodal diameter, row by row: u = Υ̂ q for the own DOF in (r, θ, z) components, q being the coordinates of the reduced
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

    /// Own DOF of the sector.
    pub fn dofs(&self) -> usize {
        self.basis.dofs()
    }

    /// Columns.
    pub fn unknowns(&self) -> usize {
        self.mass.ncols()
    }

    /// M_r, which tells to whose reduction rows belong.
    pub fn mass(&self) -> &'a Mat<c64> {
        self.mass
    }

    /// The row of own DOF `dof`.
    pub fn row(&self, dof: usize) -> impl Iterator<Item = c64> + use<'a> {
        self.basis.row(dof)
    }
}

impl std::fmt::Debug for BasisRows<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BasisRows").field("harmonic", &self.harmonic).field("dofs", &self.dofs()).finish()
    }
}
