//! States of the whole wheel at some instants, in the coordinates of the reduction: fields and stresses are read there.
//!
//! ```text
//! u_s = Re Σ_i e^{jisα} Υ̂_i X_i,   X_i = w_i Φ_i z_i,   w_i = 1/√N for single harmonics, √(2/N) for pairs
//! ```
//!
//! with u_s all own DOF of sector s, N the sectors that were simulated and Φ the modes of [`ModalWheel`].

use faer::{Mat, c64};

use super::error::ModelError;
use super::integrate::ModalStates;
use super::modal_wheel::{ModalHarmonic, ModalWheel, mode_shapes};
use super::reduction::ReducedWheel;

/// States of the wheel at some instants.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelStates {
    /// Instants, in revolutions since the start.
    pub revolutions: Vec<f64>,
    /// States of every nodal diameter that was simulated; the others are at rest.
    pub harmonics: Vec<HarmonicStates>,
}

/// States of one nodal diameter at the instants of [`WheelStates`].
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicStates {
    /// Nodal diameter i of the whole wheel.
    pub harmonic: usize,
    /// Coordinates X_i, `unknowns of the reduction × instants`.
    pub coordinates: Mat<c64>,
}

impl WheelStates {
    /// States in the coordinates of `reduced` from the modes of `wheel`, which is `reduced` at its speed.
    ///
    /// # Errors
    /// Errors of [`ModalWheel::at`].
    pub fn of(
        modes: &ModalStates,
        wheel: &ModalWheel,
        reduced: &ReducedWheel,
        stiffening: bool,
    ) -> Result<Self, ModelError> {
        let of = |(of, z): (&ModalHarmonic, &Mat<c64>)| {
            let shapes = mode_shapes(reduced, of.harmonic, wheel.speed_rad_s, stiffening)?;
            let weight = if of.single { 1.0 } else { 2.0 };
            let weight = (weight / wheel.sectors as f64).sqrt();
            let coordinates = shapes * z * faer::Scale(c64::new(weight, 0.0));
            Ok(HarmonicStates { harmonic: of.harmonic, coordinates })
        };
        let harmonics =
            wheel.harmonics.iter().zip(&modes.harmonics).map(of).collect::<Result<_, ModelError>>()?;
        Ok(Self { revolutions: modes.revolutions.clone(), harmonics })
    }
}
