//! Reduced wheel at one speed in modal coordinates (docs/method.md, One speed in modal coordinates; Eq. 7).
//!
//! The wheel is block diagonal in the nodal diameter. Each small pencil (K_r(Ω), M_r) is solved once, an exact change
//! of coordinates, after which the free motion is one scalar oscillator per mode:
//!
//! ```text
//! u_s(t) = Σ_i Re( w_i e^{jisα} Σ_m φ⁽ⁱ⁾_m z_{i,m}(t) ),   w_i = 1/√N for single harmonics, √(2/N) for pairs
//! z̈ + 2ζω ż + ω² z = φᴴ f̂⁽ⁱ⁾,                                f̂⁽ⁱ⁾ = w_i Σ_s f_s e^{−jisα}
//! ```
//!
//! Coriolis forces, where asked for, couple the modes of a nodal diameter: Ω g ż with g = Φᴴ Ĝ Φ joins the left side.
//! z is complex for pairs (cosine and sine mode) and real for single harmonics; with these weights the modal mass is 1.

use faer::{Mat, c64};

use super::error::ModelError;
use super::reduction::reduced::{ReducedHarmonic, ReducedWheel};
use rubmap_numerics::dense::Dense;
use rubmap_numerics::hermitian::{EigenError, Eigenpairs};
use rubmap_numerics::sector_fourier::is_single;

/// Effects of rotation that a wheel has at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RotationEffects {
    /// Whether the stiffness is K(Ω) instead of that at rest.
    pub stiffening: bool,
    /// Whether Coriolis forces act.
    pub coriolis: bool,
}

impl RotationEffects {
    /// Effects without Coriolis forces.
    pub fn stiffening(stiffening: bool) -> Self {
        Self { stiffening, coriolis: false }
    }
}

/// Modes of one nodal diameter.
#[derive(Debug, Clone)]
pub struct ModalHarmonic {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// Whether the modes are single (real) rather than pairs.
    pub single: bool,
    /// Natural frequencies ω_m, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Mode shapes φ restricted to the contact DOF, `n_b × modes`, mass-normalised; below them r, θ, z of nodes that are read
    /// ([`NodeRows::join`](super::node_rows::NodeRows::join)).
    pub contact: Mat<c64>,
    /// Gyroscopic matrix g = Φᴴ Ĝ Φ per unit speed, `modes × modes`, skew-Hermitian, real for single modes; absent without Coriolis forces.
    pub gyroscopic: Option<Mat<c64>>,
}

/// All modes of the reduced wheel at one speed.
#[derive(Debug, Clone)]
pub struct ModalWheel {
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Number of sectors simulated: all N, or one of the parts the wheel repeats.
    pub sectors: usize,
    /// Number of times the wheel repeats these sectors around the circumference: 1 for a full wheel.
    pub repeats: usize,
    /// Modes of every nodal diameter.
    pub harmonics: Vec<ModalHarmonic>,
}

impl ModalWheel {
    /// Solves every nodal diameter of `reduced` at `speed_rad_s`. Refuses a K(Ω) that is not positive definite, and
    /// Coriolis forces of a wheel without gyroscopic matrix.
    pub fn at(
        reduced: &ReducedWheel,
        speed_rad_s: f64,
        effects: RotationEffects,
    ) -> Result<Self, ModelError> {
        let solve = |nodal_diameter| modal_harmonic(reduced, nodal_diameter, speed_rad_s, effects);
        let harmonics = (0..reduced.harmonics.len()).map(solve).collect::<Result<_, _>>()?;
        Ok(Self { speed_rad_s, sectors: reduced.sectors, repeats: 1, harmonics })
    }

    /// Modal wheel as of [`Self::at`], with Φ of every nodal diameter in the coordinates of the reduction, as of [`mode_shapes`].
    pub fn with_shapes(
        reduced: &ReducedWheel,
        speed_rad_s: f64,
        effects: RotationEffects,
    ) -> Result<(Self, Vec<Mat<c64>>), ModelError> {
        let solve = |harmonic| modal_harmonic_with_shapes(reduced, harmonic, speed_rad_s, effects);
        let solved = (0..reduced.harmonics.len()).map(solve).collect::<Result<Vec<_>, _>>()?;
        let (harmonics, shapes) = solved.into_iter().unzip();
        Ok((Self { speed_rad_s, sectors: reduced.sectors, repeats: 1, harmonics }, shapes))
    }

    /// Number N of sectors around, of which [`Self::sectors`] are simulated.
    pub fn around(&self) -> usize {
        self.sectors * self.repeats
    }

    /// Largest natural frequency ω_max, rad/s: with central differences it bounds the step, h < 2/ω_max.
    pub fn largest_frequency(&self) -> f64 {
        self.harmonics.iter().filter_map(|h| h.omega.last()).copied().fold(0.0, f64::max)
    }

    /// Whether Coriolis forces act.
    pub(crate) fn turns(&self) -> bool {
        self.harmonics.iter().any(|harmonic| harmonic.gyroscopic.is_some())
    }

    /// Number of real unknowns of the whole wheel.
    pub fn unknowns(&self) -> usize {
        self.harmonics.iter().map(|h| if h.single { h.omega.len() } else { 2 * h.omega.len() }).sum()
    }
}

/// Natural frequencies ω in rad/s of one nodal diameter at `speed_rad_s`, ascending.
pub fn natural_frequencies(
    harmonic: &ReducedHarmonic,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<Vec<f64>, ModelError> {
    let stiffness = harmonic.stiffness.at(speed_rad_s, stiffening);
    let values = Dense::generalised_eigenvalues(stiffness.as_ref(), harmonic.mass.as_ref())
        .map_err(|error| decomposition_error(error, harmonic.harmonic, speed_rad_s))?;
    frequencies(&values, harmonic.harmonic, speed_rad_s)
}

/// Mode shapes Φ of nodal diameter `harmonic` of `wheel` in the coordinates of the reduction, `unknowns × modes`, mass-normalised: equal to
/// the last bit to those behind [`ModalWheel::at`].
pub fn mode_shapes(
    wheel: &ReducedWheel,
    harmonic: usize,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<Mat<c64>, ModelError> {
    Ok(mode_pairs(wheel, harmonic, speed_rad_s, stiffening)?.vectors)
}

/// Natural frequencies ω in rad/s, ascending, and Φ of nodal diameter `harmonic` as [`mode_shapes`] has it; errors as of [`ModalWheel::at`].
pub fn natural_modes(
    wheel: &ReducedWheel,
    harmonic: usize,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<(Vec<f64>, Mat<c64>), ModelError> {
    let pairs = mode_pairs(wheel, harmonic, speed_rad_s, stiffening)?;
    Ok((frequencies(&pairs.values, harmonic, speed_rad_s)?, pairs.vectors))
}

/// Eigenvalues ω² of nodal diameter `harmonic`, ascending and of any sign, with Φ as [`mode_shapes`] has it.
pub(super) fn mode_pairs(
    wheel: &ReducedWheel,
    harmonic: usize,
    speed_rad_s: f64,
    stiffening: bool,
) -> Result<Eigenpairs<c64>, ModelError> {
    let reduced = &wheel.harmonics[harmonic];
    let stiffness = reduced.stiffness.at(speed_rad_s, stiffening);
    let pairs = if is_single(harmonic, wheel.sectors) {
        let (k, m) = (real(&stiffness), real(&reduced.mass));
        Dense::generalised_eigenpairs(k.as_ref(), m.as_ref()).map(|Eigenpairs { values, vectors }| {
            let complex =
                Mat::from_fn(vectors.nrows(), vectors.ncols(), |i, j| c64::new(vectors[(i, j)], 0.0));
            Eigenpairs { values, vectors: complex }
        })
    } else {
        Dense::generalised_eigenpairs(stiffness.as_ref(), reduced.mass.as_ref())
    };
    pairs.map_err(|error| decomposition_error(error, harmonic, speed_rad_s))
}

/// Modes of nodal diameter `harmonic` of `wheel` at `speed_rad_s`; errors as of [`ModalWheel::at`].
pub(super) fn modal_harmonic(
    wheel: &ReducedWheel,
    harmonic: usize,
    speed_rad_s: f64,
    effects: RotationEffects,
) -> Result<ModalHarmonic, ModelError> {
    Ok(modal_harmonic_with_shapes(wheel, harmonic, speed_rad_s, effects)?.0)
}

fn modal_harmonic_with_shapes(
    wheel: &ReducedWheel,
    harmonic: usize,
    speed_rad_s: f64,
    effects: RotationEffects,
) -> Result<(ModalHarmonic, Mat<c64>), ModelError> {
    let single = is_single(harmonic, wheel.sectors);
    let (omega, shapes) = natural_modes(wheel, harmonic, speed_rad_s, effects.stiffening)?;
    let modes = ModalHarmonic {
        harmonic,
        single,
        omega,
        contact: shapes.subrows(0, wheel.contact_dofs()).to_owned(),
        gyroscopic: if effects.coriolis {
            Some(modal_gyroscopic(&wheel.harmonics[harmonic], &shapes, single)?)
        } else {
            None
        },
    };
    Ok((modes, shapes))
}

/// Gyroscopic matrix Φᴴ Ĝ Φ, skew-Hermitian to the last bit; real where the modes are.
fn modal_gyroscopic(
    reduced: &ReducedHarmonic,
    modes: &Mat<c64>,
    single: bool,
) -> Result<Mat<c64>, ModelError> {
    let gyroscopic = reduced.gyroscopic.as_ref().ok_or(ModelError::NoGyroscopicMatrix)?;
    let full = modes.adjoint() * (gyroscopic * modes);
    Ok(Mat::from_fn(full.nrows(), full.ncols(), |i, j| {
        let skew = (full[(i, j)] - full[(j, i)].conj()) * 0.5;
        if single { c64::new(skew.re, 0.0) } else { skew }
    }))
}

fn real(matrix: &Mat<c64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].re)
}

/// Fraction of the largest eigenvalue below which eigenvalues are round-off: zero, as far as double precision can tell.
const ZERO: f64 = 1e-13;

fn frequencies(values: &[f64], nodal_diameter: usize, speed_rad_s: f64) -> Result<Vec<f64>, ModelError> {
    let zero = ZERO * values.iter().fold(0.0f64, |m, lambda| m.max(lambda.abs()));
    let modes = values.iter().filter(|lambda| lambda.abs() <= zero).count();
    if modes > 0 {
        return Err(ModelError::RigidBodyModes { nodal_diameter, speed_rad_s, modes });
    }
    if values.iter().all(|&lambda| lambda > 0.0) {
        Ok(values.iter().map(|lambda| lambda.sqrt()).collect())
    } else {
        Err(ModelError::StiffnessNotPositiveDefinite {
            nodal_diameter,
            speed_rad_s,
            hint: "K(Ω) interpolated between the given speeds is wrong there (see the model's stiffening check), \
                   or the wheel is unstable at this speed",
        })
    }
}

fn decomposition_error(error: EigenError, nodal_diameter: usize, speed_rad_s: f64) -> ModelError {
    match error {
        EigenError::MassNotPositiveDefinite => ModelError::MassNotPositiveDefinite { nodal_diameter },
        EigenError::NotConverged => ModelError::DecompositionFailed { nodal_diameter, speed_rad_s },
    }
}
