//! Check that no element of a mesh is turned inside out or collapsed.

use rubmap_solid::element::ElementKind;
use rubmap_solid::gauss::gauss_points;
use rubmap_solid::jacobian;
use rubmap_solid::natural::CORNERS;

use super::error::ImpellerError;
use super::mesh::{Elements, HexMesh};

impl HexMesh {
    /// Refuses a mesh with an element whose Jacobian determinant is not positive at its corners and at every point
    /// of integration.
    ///
    /// # Errors
    /// [`ImpellerError::Jacobian`] names the first such element.
    pub fn check_jacobians(&self) -> Result<(), ImpellerError> {
        for element in 0..self.elements.len() {
            let determinant = self.smallest_jacobian(element);
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

    /// Smallest det J over the corners and the integration points of an element; NaN if any is NaN.
    fn smallest_jacobian(&self, element: usize) -> f64 {
        let kind = match self.elements {
            Elements::Linear(_) => ElementKind::QM6,
            Elements::Quadratic(_) => ElementKind::C3D20,
        };
        let positions: Vec<[f64; 3]> =
            self.elements.nodes_of(element).iter().map(|&node| self.nodes[node]).collect();
        let gauss = gauss_points(3).iter().map(|point| point.xi);
        let least = |least: f64, det: f64| if det < least || det.is_nan() { det } else { least };
        let determinants =
            CORNERS.into_iter().chain(gauss).map(|xi| jacobian(kind, &positions, xi).determinant());
        determinants.fold(f64::INFINITY, least)
    }
}
