//! State of the wheel at the end of a run, from which the next speed of a sweep up or down starts.
//!
//! Mode shapes change with the speed, so the state is kept in the coordinates of the reduction, which do not:
//!
//! ```text
//! q = Φ z,  q̇ = Φ ż        at the end of one speed
//! z = Φᴴ M q,  ż = Φᴴ M q̇   at the start of the next
//! ```
//!
//! Exact where every mode is integrated; a boundary without mass hands on the modes it keeps. A run ends after a whole number
//! of revolutions, so the next one begins at the same angle of the casing.

use faer::{Mat, MatRef, c64};
use serde::{Deserialize, Serialize};

use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, mode_shapes};
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::schemes::Scheme;

/// State of the wheel at the end of a run: q, then q̇, of every simulated nodal diameter, each as real and imaginary parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EndState(pub Vec<f64>);

/// Mode shapes Φ of all simulated nodal diameters.
#[derive(Debug)]
pub(super) struct Shapes(Vec<Mat<c64>>);

impl Shapes {
    pub(super) fn of(
        wheel: &ModalWheel,
        reduced: &ReducedWheel,
        stiffening: bool,
    ) -> Result<Self, ModelError> {
        let of = |harmonic: usize| mode_shapes(reduced, harmonic, wheel.speed_rad_s, stiffening);
        wheel.harmonics.iter().map(|harmonic| of(harmonic.harmonic)).collect::<Result<_, _>>().map(Self)
    }

    /// Mode shapes that were computed together with a wheel.
    pub(super) fn found(shapes: Vec<Mat<c64>>) -> Self {
        Self(shapes)
    }

    /// Mode shapes Φ of a nodal diameter.
    pub(super) fn of_harmonic(&self, harmonic: usize) -> MatRef<'_, c64> {
        self.0[harmonic].as_ref()
    }

    /// Memory of the mode shapes of a wheel, in bytes.
    pub(super) fn bytes(wheel: &ModalWheel) -> u64 {
        let sizes = wheel.harmonics.iter().map(|harmonic| harmonic.omega.len());
        sizes.map(|size| (size_of::<c64>() * size * size) as u64).sum()
    }
}

impl EndState {
    /// State from all modes that were integrated on a wheel of these shapes.
    pub(super) fn new(modes: &[InitialMode], Shapes(shapes): &Shapes) -> Self {
        let mut numbers = Vec::new();
        for (index, shapes) in shapes.iter().enumerate() {
            for part in [|mode: &InitialMode| mode.displacement, |mode: &InitialMode| mode.velocity] {
                let mut q = vec![c64::ZERO; shapes.nrows()];
                for mode in modes.iter().filter(|mode| mode.harmonic == index) {
                    for (row, q) in q.iter_mut().enumerate() {
                        *q += shapes[(row, mode.family)] * part(mode);
                    }
                }
                numbers.extend(q.iter().flat_map(|q| [q.re, q.im]));
            }
        }
        Self(numbers)
    }

    /// State in the modes of `wheel`, which has these shapes: those that `scheme` integrates. None if the state belongs to another
    /// reduction.
    pub(super) fn modes(
        &self,
        wheel: &ModalWheel,
        Shapes(shapes): &Shapes,
        reduced: &ReducedWheel,
        scheme: Scheme,
    ) -> Option<Vec<InitialMode>> {
        let sizes = wheel.harmonics.iter().map(|harmonic| harmonic.omega.len());
        if self.0.len() != sizes.map(|size| 4 * size).sum::<usize>() {
            return None;
        }
        let (mut modes, mut rest) = (Vec::new(), self.0.as_slice());
        for (index, (harmonic, shapes)) in wheel.harmonics.iter().zip(shapes).enumerate() {
            let size = harmonic.omega.len();
            let mut modal = || {
                let (q, after) = rest.split_at(2 * size);
                rest = after;
                let q = Mat::from_fn(size, 1, |row, _| c64::new(q[2 * row], q[2 * row + 1]));
                shapes.adjoint() * (&reduced.harmonics[harmonic.harmonic].mass * q)
            };
            let (displacement, velocity) = (modal(), modal());
            modes.extend((0..scheme.integrated_modes(size)).map(|family| InitialMode {
                harmonic: index,
                family,
                displacement: displacement[(family, 0)],
                velocity: velocity[(family, 0)],
            }));
        }
        Some(modes)
    }
}
