//! Path of the wheel over a revolution in few directions, those that stress the wheel most first.
//!
//! ```text
//! x̃(t) ≈ Σ_k u_k c_k(t),   the u_k orthonormal in the measure G of the stress at all places
//! ```

use faer::{Mat, c64};

use super::error::StressError;
use super::make::lower;
use super::metric::Metric;
use super::reduced::ReducedStress;
use super::sums::LANES;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::hermitian::EigenError;
use rubmap_wheel::dynamics::reduction::ReducedHarmonic;
use rubmap_wheel::dynamics::states::WheelStates;

/// Number of directions for the bounds of places, one vector of them: twice as many rule out no more places.
const BOUNDING: usize = LANES;
/// Share of the largest stress, as a mean over places, that the evaluated directions may neglect; the rest is bounded.
const LOOKED: f64 = 5e-3;
/// Share of the largest stress, as a mean over places, that the followed directions may neglect: less than the rounding of the operator in
/// single precision.
const FOLLOWED: f64 = 1e-8;

/// Path of one nodal diameter, x̃ = Lᴴ X with K_r(0) = L Lᴴ.
#[derive(Debug)]
pub(super) struct Path {
    /// Nodal diameter i of the wheel.
    pub(super) harmonic: usize,
    /// Directions u_k, `unknowns × directions`.
    pub(super) directions: Mat<c64>,
    /// Coefficients c_k, `directions × instants`.
    pub(super) course: Mat<c64>,
    /// Largest coefficient max|c_k| over the instants.
    pub(super) reach: Vec<f64>,
    /// Number of directions, the first ones, for the bounds of places.
    pub(super) bounding: usize,
    /// Largest |x̃|_G at any instant that the directions for the bounds neglect.
    pub(super) left_by_bounding: f64,
    /// Number of directions, the first ones, with which places are evaluated.
    pub(super) looking: usize,
    /// Largest |x̃|_G at any instant that all directions neglect.
    pub(super) left: f64,
}

/// Paths of all nodal diameters that move.
///
/// # Errors
/// Eigenvalue iteration that fails, or state that is not finite.
pub(super) fn paths(
    states: &WheelStates,
    harmonics: &[ReducedHarmonic],
    stress: &ReducedStress,
) -> Result<Vec<Path>, StressError> {
    let mut found = Vec::new();
    for state in &states.harmonics {
        let lower = lower(&harmonics[state.harmonic]).ok_or(EigenError::MassNotPositiveDefinite)?;
        let energy = lower.adjoint() * &state.coordinates;
        if !energy.is_all_finite() {
            return Err(StressError::NotFinite);
        }
        if energy.norm_max() > 0.0 {
            found.push(Path::new(state.harmonic, &energy, &stress.harmonics[state.harmonic].metric)?);
        }
    }
    let left: Vec<Vec<f64>> = found.iter().map(|path| left_by(&path.course)).collect();
    let largest = left.iter().map(|left| left[0]).fold(0.0, f64::max);
    for (path, left) in found.iter_mut().zip(left) {
        let enough =
            |share: f64| left.iter().position(|&left| left <= share * largest).unwrap_or(left.len() - 1);
        path.cut(enough(FOLLOWED), enough(LOOKED), &left);
    }
    found.retain(|path| !path.reach.is_empty());
    Ok(found)
}

/// Largest norm of the path over all instants that is neglected, for every number of directions.
fn left_by(course: &Mat<c64>) -> Vec<f64> {
    let mut squares = vec![0.0f64; course.ncols()];
    let mut left = vec![0.0; course.nrows() + 1];
    for count in (0..course.nrows()).rev() {
        for (instant, square) in squares.iter_mut().enumerate() {
            *square += course[(count, instant)].norm_sqr();
        }
        left[count] = squares.iter().copied().fold(0.0, f64::max).sqrt();
    }
    left
}

impl Path {
    /// Path in all its directions, from root energies.
    fn new(harmonic: usize, energy: &Mat<c64>, metric: &Metric) -> Result<Self, EigenError> {
        let stressing = metric.lower.adjoint() * energy;
        let gram = &stressing * stressing.adjoint();
        let gram =
            Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| (gram[(i, j)] + gram[(j, i)].conj()) * 0.5);
        let ascending = Dense::eigenpairs(gram.as_ref())?.vectors;
        let count = ascending.ncols();
        let mut directions = Mat::from_fn(count, count, |row, k| ascending[(row, count - 1 - k)]);
        let course = directions.adjoint() * &stressing;
        metric.coordinates(directions.as_mut());
        let reach = (0..count).map(|k| course.row(k).iter().map(|c| c.norm()).fold(0.0, f64::max)).collect();
        let (bounding, looking) = (count, count);
        Ok(Self { harmonic, directions, course, reach, bounding, left_by_bounding: 0.0, looking, left: 0.0 })
    }

    /// Keeps the first `followed` directions, `looking` of them for evaluation; `left` is what every number of directions neglects.
    fn cut(&mut self, followed: usize, looking: usize, left: &[f64]) {
        self.directions = self.directions.subcols(0, followed).to_owned();
        self.course = self.course.subrows(0, followed).to_owned();
        self.reach.truncate(followed);
        self.bounding = BOUNDING.min(followed);
        self.left_by_bounding = left[self.bounding];
        self.looking = looking;
        self.left = left[followed];
    }

    /// Length Σ |u_k| max|c_k| of the first `count` directions, in root energies.
    pub(super) fn length(&self, count: usize) -> f64 {
        let reach = self.reach[..count].iter().enumerate();
        reach.map(|(k, reach)| reach * self.directions.col(k).norm_l2()).sum()
    }
}
