//! Point at which families are named, and the modes of other points that have their shapes.
//!
//! Families are named by rank at rest and followed from there to the speed of every target, as everywhere in the program. From the reference to
//! another wheel they are followed by the modal assurance with the masses of both,
//!
//! ```text
//! MAC = |φ_aᴴ M_a φ_b| · |φ_aᴴ M_b φ_b|,   φ_aᴴ M_a φ_a = φ_bᴴ M_b φ_b = 1
//! ```
//!
//! which is 1 for equal shapes, also where the masses differ by a factor.

use faer::{Mat, c64};
use rubmap_wheel::dynamics::families::{FamilyWalk, assignment::assign};
use rubmap_wheel::dynamics::modal_wheel::natural_modes;
use rubmap_wheel::dynamics::reduction::{FreeInterfaceModes, FreeInterfaceShapes};

use crate::evaluation::{Memo, Outcome, Row};
use crate::problem::{Goal, Problem};
use crate::wheel::modes_at;

/// Point at which families are named.
pub(crate) struct Reference<'a> {
    problem: &'a Problem,
    /// Point, with a free unit.
    pub(crate) point: Vec<f64>,
    /// Modes of the wheel at the point.
    modes: FreeInterfaceModes,
    /// Coordinates of the shapes of the families at the speed of every target.
    followed: Vec<Mat<c64>>,
}

impl<'a> Reference<'a> {
    /// Reference at a point, with a free unit.
    ///
    /// # Errors
    /// Message where the point gives no valid wheel.
    pub(crate) fn new(problem: &'a Problem, point: &[f64]) -> Result<Self, String> {
        Self::of(problem, point.to_vec(), modes_at(problem, point, point)?)
    }

    /// Reference at a starting point without a free unit, which is then the one that fits best there.
    ///
    /// # Errors
    /// Message where the point gives no valid wheel.
    pub(crate) fn at_start(problem: &'a Problem, start: &[f64]) -> Result<Self, String> {
        let modes = modes_at(problem, start, start)?;
        if !problem.is_free() {
            return Self::of(problem, start.to_vec(), modes);
        }
        let with = |unit: f64| start.iter().copied().chain([unit]).collect::<Vec<f64>>();
        let mut unit = unit_at_rest(problem, &modes)?;
        // Newton's method for the mean of ln f; the growth with the speed is small beside f.
        for _ in 0..UNIT_STEPS {
            let reference = Self::of(problem, with(unit), modes.clone())?;
            let rows = reference.rows(&modes, &with(unit))?;
            let (mut sum, mut slope) = (0.0, 0.0);
            for (goal, row) in problem.goals.iter().zip(rows) {
                let weight = goal.error.powi(-2);
                sum += weight * (row.omega / (goal.omega * unit.exp())).ln();
                slope += weight * (1.0 - row.growth / row.omega);
            }
            if slope <= 0.0 || !(sum / slope).is_finite() {
                break;
            }
            unit += sum / slope;
        }
        Self::of(problem, with(unit), modes)
    }

    fn of(problem: &'a Problem, point: Vec<f64>, modes: FreeInterfaceModes) -> Result<Self, String> {
        let unit = problem.unit_hz(&point);
        let families = |goal: &Goal| {
            let speed = goal.speed * unit;
            let walk = || FamilyWalk::new(&modes.wheel, goal.nodal_diameter, true)?.at(speed);
            let ranks = walk().map_err(|error| error.to_string())?.ranks;
            let (_, shapes) = natural_modes(&modes.wheel, goal.nodal_diameter, speed, true)
                .map_err(|error| error.to_string())?;
            let count = problem.modes().min(ranks.len());
            Ok(Mat::from_fn(shapes.nrows(), count, |i, family| shapes[(i, ranks[family])]))
        };
        let followed = problem.goals.iter().map(families).collect::<Result<_, String>>()?;
        Ok(Self { problem, point, modes, followed })
    }

    /// Frequencies of the targets of the wheel itself.
    ///
    /// # Errors
    /// Message where the stiffness is not positive definite at a speed.
    pub(crate) fn own_rows(&self) -> Result<Vec<Row>, String> {
        self.rows(&self.modes, &self.point)
    }

    /// Frequencies of the targets at a point, on a mesh with the degrees of freedom of the reference's; kept in `memo`.
    ///
    /// # Errors
    /// Message where the point gives no valid wheel.
    pub(crate) fn evaluate(&self, memo: &Memo<'_>, point: &[f64]) -> Result<Vec<Row>, String> {
        if point == self.point {
            return self.own_rows();
        }
        let compute =
            || modes_at(self.problem, point, &self.point).and_then(|modes| self.rows(&modes, point));
        let outcome =
            memo.outcome(&self.point, point, || compute().map_or_else(Outcome::Failed, Outcome::Rows));
        match outcome {
            Outcome::Rows(rows) => Ok(rows),
            Outcome::Failed(message) => Err(message),
        }
    }

    fn rows(&self, modes: &FreeInterfaceModes, point: &[f64]) -> Result<Vec<Row>, String> {
        let unit = self.problem.unit_hz(point);
        let shapes = self.modes.shapes.iter().zip(&modes.shapes);
        let products: Vec<[Mat<c64>; 2]> = shapes.map(|(a, b)| products(a, b)).collect();
        let row = |(goal, followed): (&Goal, &Mat<c64>)| {
            let at = modes.shapes.iter().position(|shapes| shapes.nodal_diameter == goal.nodal_diameter);
            let [with_own, with_other] = &products[at.ok_or("nodal diameter without modes")?];
            let speed = goal.speed * unit;
            let (omega, shapes) = natural_modes(&modes.wheel, goal.nodal_diameter, speed, true)
                .map_err(|error| error.to_string())?;
            let lowest = shapes.subcols(0, followed.ncols().min(shapes.ncols()));
            let [own, other] = [with_own, with_other].map(|product| followed.adjoint() * product * lowest);
            let shares = Mat::from_fn(own.nrows(), own.ncols(), |a, b| {
                (own[(a, b)].norm() * other[(a, b)].norm()).min(1.0)
            });
            let rank = assign(shares.as_ref())[goal.family];
            if rank >= lowest.ncols() {
                return Err("fewer modes than families".to_owned());
            }
            let stiffness = &modes.wheel.harmonics[goal.nodal_diameter].stiffness.coefficients;
            let shape = shapes.subcols(rank, 1);
            let form = |k: &Mat<c64>| (shape.adjoint() * k * shape)[(0, 0)].re;
            let squared = speed * speed;
            // dλ/d(Ω²) of λ = cᴴ(K0 + Ω²K1 + Ω⁴K2)c, the shape being stationary.
            let slope = match stiffness.as_slice() {
                [_, k1, k2] => form(k1) + 2.0 * squared * form(k2),
                _ => 0.0,
            };
            let omega = omega[rank];
            let assurance = shares[(goal.family, rank)];
            Ok(Row { omega, growth: squared * slope / omega, rank, assurance })
        };
        self.problem.goals.iter().zip(&self.followed).map(row).collect()
    }
}

/// Number of Newton steps towards a free unit at a starting point: errors of a tenth become round-off.
const UNIT_STEPS: usize = 6;

/// Logarithm of the free unit in Hz that fits best without rotation.
fn unit_at_rest(problem: &Problem, modes: &FreeInterfaceModes) -> Result<f64, String> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for goal in &problem.goals {
        let (omega, _) =
            natural_modes(&modes.wheel, goal.nodal_diameter, 0.0, true).map_err(|error| error.to_string())?;
        let omega = omega.get(goal.family).ok_or("fewer modes than families")?;
        let weight = goal.error.powi(-2);
        sum += weight * (omega / goal.omega).ln();
        weights += weight;
    }
    Ok(sum / weights)
}

/// Products V_aᴴM_aV_b and V_aᴴM_bV_b.
fn products(a: &FreeInterfaceShapes, b: &FreeInterfaceShapes) -> [Mat<c64>; 2] {
    [a.momentum.adjoint() * &b.displacement, a.displacement.adjoint() * &b.momentum]
}
