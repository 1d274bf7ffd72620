//! Waves under Coriolis forces: one nodal diameter's natural frequencies with and against the rotation.
//!
//! In the modal coordinates of the wheel without them, free undamped motion is z̈ + Ω g ż + ω² z = 0 with g = Φᴴ Ĝ Φ
//! skew-Hermitian. Energy coordinates make it a Hermitian eigenproblem with real eigenvalues ν for z ∝ e^{jνt}:
//!
//! ```text
//! x = [ωz; ż],   ẋ = S x,   S = [ 0   ω  ]          −jS x = ν x
//!                               [−ω  −Ωg ]
//! ```
//!
//! K(Ω) being positive definite, n of the 2n eigenvalues are negative and n positive. With u_s = Re(w z e^{jisα}) the
//! phase of a mode is isα + νt: where ν < 0 a crest moves to larger s, towards +θ, so the wave travels forward (with the
//! rotation), where ν > 0 backward. Single harmonics are real, their eigenvalues come in pairs ±ν of one standing motion.

use faer::{Mat, c64};

use super::error::ModelError;
use super::families::assignment::assign;
use super::modal_wheel::{ModalHarmonic, RotationEffects, modal_harmonic};
use super::reduction::ReducedWheel;
use rubmap_numerics::dense::Dense;

/// Natural frequencies |ν| of one nodal diameter's waves in the rotating frame, rad/s, ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveFrequencies {
    /// Frequencies of waves that travel with the rotation.
    pub forward: Vec<f64>,
    /// Frequencies of waves that travel against the rotation; equal to the forward ones where the nodal diameter is single.
    pub backward: Vec<f64>,
}

/// Natural frequencies of the waves of nodal diameter `nodal_diameter` at `speed_rad_s`.
///
/// # Errors
///
/// Errors of the modes, and [`ModelError::NoGyroscopicMatrix`].
pub fn wave_frequencies(
    wheel: &ReducedWheel,
    nodal_diameter: usize,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<WaveFrequencies, ModelError> {
    let effects = RotationEffects { stiffening, coriolis: true };
    let modes = modal_harmonic(wheel, nodal_diameter, speed_rad_s, effects)?;
    let failed = || ModelError::DecompositionFailed { nodal_diameter, speed_rad_s };
    let ascending =
        Dense::eigenvalues(hermitian_form(&modes, speed_rad_s)?.as_ref()).map_err(|_| failed())?;
    let (negative, positive) = ascending.split_at(modes.omega.len());
    let backward = positive.to_vec();
    let forward = if modes.single { backward.clone() } else { negative.iter().rev().map(|nu| -nu).collect() };
    Ok(WaveFrequencies { forward, backward })
}

/// Waves of one nodal diameter with the modes that they consist of.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveModes {
    /// Rank, from 0, of the mode without Coriolis forces that most of each forward wave is, by the rank of the wave.
    pub forward: Vec<usize>,
    /// Ranks of the modes that most of the backward waves are.
    pub backward: Vec<usize>,
}

/// Modes without Coriolis forces that the waves of nodal diameter `nodal_diameter` at `speed_rad_s` mostly consist of, by their energy: a mode for each
/// wave of either direction.
///
/// # Errors
///
/// Errors of [`wave_frequencies`].
pub fn wave_modes(
    wheel: &ReducedWheel,
    nodal_diameter: usize,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<WaveModes, ModelError> {
    let effects = RotationEffects { stiffening, coriolis: true };
    let modes = modal_harmonic(wheel, nodal_diameter, speed_rad_s, effects)?;
    let n = modes.omega.len();
    if modes.single {
        return Ok(WaveModes { forward: (0..n).collect(), backward: (0..n).collect() });
    }
    let form = hermitian_form(&modes, speed_rad_s)?;
    let failed = |_| ModelError::DecompositionFailed { nodal_diameter, speed_rad_s };
    let vectors = Dense::generalised_eigenpairs(form.as_ref(), Mat::<c64>::identity(2 * n, 2 * n).as_ref())
        .map_err(failed)?
        .vectors;
    // Share of the mode in a column in the energy of the wave in a row.
    let shares = |column: &dyn Fn(usize) -> usize| {
        Mat::from_fn(n, n, |wave, mode| {
            let x = vectors.col(column(wave));
            x[mode].norm_sqr() + x[n + mode].norm_sqr()
        })
    };
    let (forward, backward) = (shares(&|wave| n - 1 - wave), shares(&|wave| n + wave));
    Ok(WaveModes { forward: assign(forward.as_ref()), backward: assign(backward.as_ref()) })
}

/// Hermitian matrix −jS.
fn hermitian_form(modes: &ModalHarmonic, speed_rad_s: f64) -> Result<Mat<c64>, ModelError> {
    let n = modes.omega.len();
    let g = modes.gyroscopic.as_ref().ok_or(ModelError::NoGyroscopicMatrix)?;
    let j = c64::new(0.0, 1.0);
    let mut form = Mat::zeros(2 * n, 2 * n);
    for (m, &omega) in modes.omega.iter().enumerate() {
        form[(m, n + m)] = -j * omega;
        form[(n + m, m)] = j * omega;
    }
    for column in 0..n {
        for row in 0..n {
            form[(n + row, n + column)] = j * g[(row, column)] * speed_rad_s;
        }
    }
    Ok(form)
}
