//! The path of the wheel over a revolution in few directions, those that stress the wheel most first.
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
use rubmap_numerics::hermitian::{EigenError, eigenpairs};
use rubmap_wheel::dynamics::reduction::ReducedHarmonic;
use rubmap_wheel::dynamics::states::WheelStates;

/// Directions by which places are bounded, a vector of them: twice as many rule out no more.
const BOUNDING: usize = LANES;
/// Share of the largest stress, as a mean over places, that those directions leave by which places are looked at: the rest is bounded.
const LOOKED: f64 = 5e-3;
/// The same of those by which places are followed: less than single precision leaves of the operator.
const FOLLOWED: f64 = 1e-8;

/// The path of one nodal diameter, x̃ = Lᴴ X with K_r(0) = L Lᴴ.
#[derive(Debug)]
pub(super) struct Path {
    /// Nodal diameter i of the wheel.
    pub(super) harmonic: usize,
    /// u_k, `unknowns × directions`.
    pub(super) directions: Mat<c64>,
    /// c_k, `directions × instants`.
    pub(super) course: Mat<c64>,
    /// max|c_k| over the instants.
    pub(super) reach: Vec<f64>,
    /// By the first so many directions places are bounded,
    pub(super) bounding: usize,
    /// which leave no more than this of |x̃|_G at any instant.
    pub(super) left_by_bounding: f64,
    /// By so many directions places are looked at.
    pub(super) looking: usize,
    /// All directions leave no more than this of |x̃|_G at any instant.
    pub(super) left: f64,
}

/// The paths of all nodal diameters that move.
///
/// # Errors
/// If an eigenvalue iteration fails, or a state is not finite.
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

/// For every number of directions, how much of the path is left at the instant at which most is.
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
    /// Of all directions of a path of root energies.
    fn new(harmonic: usize, energy: &Mat<c64>, metric: &Metric) -> Result<Self, EigenError> {
        let stressing = metric.lower.adjoint() * energy;
        let gram = &stressing * stressing.adjoint();
        let gram =
            Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| (gram[(i, j)] + gram[(j, i)].conj()) * 0.5);
        let ascending = eigenpairs(gram.as_ref())?.vectors;
        let count = ascending.ncols();
        let mut directions = Mat::from_fn(count, count, |row, k| ascending[(row, count - 1 - k)]);
        let course = directions.adjoint() * &stressing;
        metric.coordinates(directions.as_mut());
        let reach = (0..count).map(|k| course.row(k).iter().map(|c| c.norm()).fold(0.0, f64::max)).collect();
        let (bounding, looking) = (count, count);
        Ok(Self { harmonic, directions, course, reach, bounding, left_by_bounding: 0.0, looking, left: 0.0 })
    }

    /// Keeps so many directions, and looks by `looking` of them; `left` is what every number of them leaves.
    fn cut(&mut self, followed: usize, looking: usize, left: &[f64]) {
        self.directions = self.directions.subcols(0, followed).to_owned();
        self.course = self.course.subrows(0, followed).to_owned();
        self.reach.truncate(followed);
        self.bounding = BOUNDING.min(followed);
        self.left_by_bounding = left[self.bounding];
        self.looking = looking;
        self.left = left[followed];
    }

    /// Σ |u_k| max|c_k| of the first `count` directions, in root energies.
    pub(super) fn length(&self, count: usize) -> f64 {
        let reach = self.reach[..count].iter().enumerate();
        reach.map(|(k, reach)| reach * self.directions.col(k).norm_l2()).sum()
    }
}
