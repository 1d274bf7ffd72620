//! The path of the wheel over a revolution in few directions: an orthonormal basis of where each nodal diameter was.

use faer::{Mat, c64};

use super::make::lower;
use rubmap_numerics::hermitian::{EigenError, eigenpairs};
use rubmap_wheel::dynamics::reduction::ReducedHarmonic;
use rubmap_wheel::dynamics::states::WheelStates;

/// Share of the largest root energy that those directions leave by which places are bounded: they are few, and what is left is bounded
/// too.
const BOUNDED: f64 = 3e-3;
/// The same of those by which places are followed: less than single precision leaves of the operator.
const FOLLOWED: f64 = 1e-8;

/// The path of one nodal diameter, x̃ = Lᴴ X with K_r(0) = L Lᴴ: x̃ᴴx̃ is twice its energy at rest.
#[derive(Debug)]
pub(super) struct Path {
    /// Nodal diameter i of the wheel.
    pub(super) harmonic: usize,
    /// U, `unknowns × directions`, orthonormal, the strongest first.
    pub(super) directions: Mat<c64>,
    /// c = Uᴴ x̃, `directions × instants`.
    pub(super) course: Mat<c64>,
    /// So many directions bound,
    pub(super) bounding: usize,
    /// and leave no more than this of x̃ at any instant.
    pub(super) left: f64,
}

/// The paths of all nodal diameters that move.
pub(super) fn paths(states: &WheelStates, harmonics: &[ReducedHarmonic]) -> Result<Vec<Path>, EigenError> {
    let mut found = Vec::new();
    for state in &states.harmonics {
        let lower = lower(&harmonics[state.harmonic]).ok_or(EigenError::MassNotPositiveDefinite)?;
        let energy = lower.adjoint() * &state.coordinates;
        if energy.norm_max() == 0.0 {
            continue;
        }
        let gram = &energy * energy.adjoint();
        let gram =
            Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| (gram[(i, j)] + gram[(j, i)].conj()) * 0.5);
        let ascending = eigenpairs(gram.as_ref())?.vectors;
        let last = ascending.ncols() - 1;
        let directions = Mat::from_fn(ascending.nrows(), last + 1, |row, k| ascending[(row, last - k)]);
        let course = directions.adjoint() * &energy;
        found.push((state.harmonic, directions, course));
    }
    let largest = found.iter().map(|(_, _, course)| left_by(course)[0]).fold(0.0, f64::max);
    let path = |(harmonic, directions, course): (usize, Mat<c64>, Mat<c64>)| {
        let left = left_by(&course);
        let enough =
            |share: f64| left.iter().position(|&left| left <= share * largest).unwrap_or(left.len() - 1);
        let (bounding, followed) = (enough(BOUNDED), enough(FOLLOWED));
        Path {
            harmonic,
            directions: directions.subcols(0, followed).to_owned(),
            course: course.subrows(0, followed).to_owned(),
            bounding,
            left: left[bounding],
        }
    };
    Ok(found.into_iter().map(path).collect())
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
    /// Largest magnitude of each bounding direction.
    pub(super) fn reach(&self) -> Vec<f64> {
        let largest = |k: usize| {
            (0..self.course.ncols()).map(|t| self.course[(k, t)].norm_sqr()).fold(0.0, f64::max).sqrt()
        };
        (0..self.bounding).map(largest).collect()
    }

    /// How far each bounding direction strays from straight lines between `knots`.
    pub(super) fn strays(&self, knots: &[usize]) -> Vec<f64> {
        let stray = |k: usize| {
            let mut most = 0.0f64;
            for ends in knots.windows(2) {
                let (from, to) = (self.course[(k, ends[0])], self.course[(k, ends[1])]);
                for t in ends[0] + 1..ends[1] {
                    let share = (t - ends[0]) as f64 / (ends[1] - ends[0]) as f64;
                    most = most.max((self.course[(k, t)] - from - (to - from) * share).norm());
                }
            }
            most
        };
        (0..self.bounding).map(stray).collect()
    }
}
