//! Check that no element of a mesh is turned inside out or collapsed.

use super::element::{Hex8, Hex20, Hexahedron};
use super::error::ImpellerError;
use super::mesh::{Elements, HexMesh};

impl HexMesh {
    /// Refuses a mesh with an element whose Jacobian determinant is not positive at its corners and at every point
    /// of integration.
    ///
    /// # Errors
    /// [`ImpellerError::Jacobian`] names the first such element.
    pub fn check_jacobians(&self) -> Result<(), ImpellerError> {
        match &self.elements {
            Elements::Linear(elements) => self.check::<Hex8, 8>(elements),
            Elements::Quadratic(elements) => self.check::<Hex20, 20>(elements),
        }
    }

    fn check<E: Hexahedron<N>, const N: usize>(&self, elements: &[[usize; N]]) -> Result<(), ImpellerError> {
        for (element, nodes) in elements.iter().enumerate() {
            let determinant = E::from(self.positions(nodes)).smallest_jacobian();
            if !(determinant > 0.0 && determinant.is_finite()) {
                let mean = |d: usize| self.corners(element).iter().map(|x| x[d] / 8.0).sum::<f64>();
                return Err(ImpellerError::Jacobian {
                    element: element + 1,
                    radius: mean(0).hypot(mean(1)),
                    axial: mean(2),
                    determinant,
                });
            }
        }
        Ok(())
    }
}
