//! Search from one starting point: least squares within the bounds, by Levenberg's and Marquardt's method (crate `rmpfit`, after MINPACK).
//!
//! A search has legs. In each, families have the names of its first point and are followed by shape, and meshes have the degrees of freedom of
//! the first one, so that the differences are smooth. At the end of a leg families are named anew, on a mesh of its own; where that changes
//! anything, another leg begins there: a target is met only by the mode that has its name.

use std::sync::Arc;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use rmpfit::{MPConfig, MPFitter, MPPar, MPResult, MPSide};

use crate::evaluation::{Memo, Row};
use crate::problem::{Goal, Problem};
use crate::reference::Reference;

/// Half of the distance of the points of a central difference, as a fraction of the bounds.
const STEP: f64 = 1e-3;

/// Most legs of a search.
const LEGS: usize = 6;

/// Relative difference up to which frequencies of one wheel count as the same.
const SAME: f64 = 1e-7;

/// Weighted difference that stands for a point without a valid wheel: large enough for every step there to be taken back.
const INVALID: f64 = 1e6;

/// Change of cost and unknowns, relative, at which a leg ends.
const CONVERGED: f64 = 1e-10;

/// End of the search from one starting point.
pub(crate) struct End<'a> {
    /// Reference at the starting point.
    pub(crate) start: Arc<Reference<'a>>,
    /// Reference at the end: families have its names.
    pub(crate) end: Arc<Reference<'a>>,
    /// Frequencies of the targets at the end.
    pub(crate) rows: Vec<Row>,
    /// Number of iterations over all legs.
    pub(crate) iterations: usize,
    /// Number of legs.
    pub(crate) legs: usize,
    /// Root mean square of the weighted differences.
    pub(crate) weighted_rms: f64,
}

/// Starting points of a fit: the wheel's own values, then those candidates whose frequencies come closest to the targets, best first; of equal
/// ones the first. Candidates without a valid wheel come last.
pub(crate) fn starts(problem: &Problem) -> Vec<Vec<f64>> {
    let mut candidates = problem.candidates();
    if candidates.len() > problem.request.starts {
        let distance = |candidate: &Vec<f64>| {
            let reference = Reference::at_start(problem, candidate)?;
            Ok::<f64, String>(weighted_rms(problem, &reference.point, &reference.own_rows()?))
        };
        let others = candidates.split_off(1);
        let far: Vec<f64> =
            others.par_iter().map(|candidate| distance(candidate).unwrap_or(f64::INFINITY)).collect();
        let mut order: Vec<usize> = (0..others.len()).collect();
        order.sort_by(|&a, &b| far[a].total_cmp(&far[b]));
        candidates
            .extend(order.into_iter().take(problem.request.starts - 1).map(|index| others[index].clone()));
    }
    candidates
}

/// Searches from `start`, without a free unit.
///
/// # Errors
/// Message where the starting point gives no valid wheel.
pub(crate) fn search<'a>(problem: &'a Problem, memo: &Memo<'_>, start: &[f64]) -> Result<End<'a>, String> {
    let start = Arc::new(Reference::at_start(problem, start)?);
    let rows = start.own_rows()?;
    let weighted_rms = weighted_rms(problem, &start.point, &rows);
    let mut best = End { end: Arc::clone(&start), rows, iterations: 0, legs: 0, weighted_rms, start };
    let mut reference = Arc::clone(&best.start);
    while best.legs < LEGS && best.iterations < problem.request.iterations {
        best.legs += 1;
        let mut leg = Leg::new(problem, memo, &reference, problem.request.iterations - best.iterations);
        // The library leaves its point behind where derivatives fail; the leg has it.
        best.iterations += leg.mpfit(&mut reference.point.clone()).map_or(1, |status| status.n_iter.max(1));
        let point = leg.best.1;
        let named_anew = || {
            let followed = reference.evaluate(memo, &point)?;
            let next = Reference::new(problem, &point)?;
            let rows = next.own_rows()?;
            Ok::<_, String>((followed, next, rows))
        };
        // A mesh of its own may be invalid there: what was found before stands.
        let Ok((followed, next, rows)) = named_anew() else { break };
        reference = Arc::new(next);
        let goes_on = differ(&followed, &rows);
        let weighted_rms = self::weighted_rms(problem, &point, &rows);
        if weighted_rms < best.weighted_rms {
            best = End { end: Arc::clone(&reference), rows, weighted_rms, ..best };
        }
        if !goes_on {
            break;
        }
    }
    Ok(best)
}

/// Whether a leg's end looks otherwise with names and mesh of its own.
fn differ(followed: &[Row], own: &[Row]) -> bool {
    let mut rows = followed.iter().zip(own);
    rows.any(|(a, b)| a.rank != b.rank || (a.omega / b.omega - 1.0).abs() > SAME)
}

/// Weighted differences (f/f_target − 1)/error of all targets at a point.
pub(crate) fn differences(problem: &Problem, point: &[f64], rows: &[Row]) -> Vec<f64> {
    let unit = problem.unit_hz(point);
    let pairs = problem.goals.iter().zip(rows);
    pairs.map(|(goal, row)| (row.omega / (goal.omega * unit) - 1.0) / goal.error).collect()
}

fn weighted_rms(problem: &Problem, point: &[f64], rows: &[Row]) -> f64 {
    let differences = differences(problem, point, rows);
    (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt()
}

/// Derivatives of the weighted differences at a point, one column per unknown: central differences of the frequencies, one-sided at bounds and
/// beside points without a valid wheel; the free unit's in closed form.
///
/// # Errors
/// Message where the point, or both points beside it, give no valid wheel.
pub(crate) fn derivatives(
    problem: &Problem,
    memo: &Memo<'_>,
    reference: &Reference<'_>,
    point: &[f64],
) -> Result<Vec<Vec<f64>>, String> {
    let middle = reference.evaluate(memo, point)?;
    let moved = |column: usize, by: f64| {
        let mut moved = point.to_vec();
        moved[column] = (moved[column] + by).clamp(0.0, 1.0);
        moved
    };
    let columns = 0..problem.variables.len();
    let points: Vec<Vec<f64>> =
        columns.clone().flat_map(|column| [moved(column, -STEP), moved(column, STEP)]).collect();
    let rows: Vec<_> = points.par_iter().map(|point| reference.evaluate(memo, point)).collect();
    let mut derivatives = Vec::with_capacity(point.len());
    for column in columns {
        let side = |at: usize| match &rows[2 * column + at] {
            Ok(rows) => Ok((points[2 * column + at][column], rows)),
            Err(message) => Err(message),
        };
        let centre = (point[column], &middle);
        let (low, high) = match (side(0), side(1)) {
            (Ok(low), Ok(high)) => (low, high),
            (Ok(low), Err(_)) if low.0 < centre.0 => (low, centre),
            (Err(_), Ok(high)) if high.0 > centre.0 => (centre, high),
            (Err(message), _) | (_, Err(message)) => return Err(message.clone()),
        };
        let [below, above] = [low.1, high.1].map(|rows| differences(problem, point, rows));
        let slope = |(below, above): (f64, f64)| (above - below) / (high.0 - low.0);
        derivatives.push(below.into_iter().zip(above).map(slope).collect());
    }
    if problem.is_free() {
        let unit = problem.unit_hz(point);
        let slope = |(goal, row): (&Goal, &Row)| (row.growth - row.omega) / (goal.omega * unit) / goal.error;
        derivatives.push(problem.goals.iter().zip(&middle).map(slope).collect());
    }
    Ok(derivatives)
}

/// Leg of a search, as the library for least squares sees it.
struct Leg<'a> {
    problem: &'a Problem,
    memo: &'a Memo<'a>,
    reference: &'a Reference<'a>,
    bounds: Vec<MPPar>,
    config: MPConfig,
    /// Best point so far, with the root mean square of its weighted differences.
    best: (f64, Vec<f64>),
}

impl<'a> Leg<'a> {
    fn new(
        problem: &'a Problem,
        memo: &'a Memo<'_>,
        reference: &'a Reference<'_>,
        iterations: usize,
    ) -> Self {
        let bound = |limited: bool| MPPar {
            limited_low: limited,
            limited_up: limited,
            limit_low: 0.0,
            limit_up: 1.0,
            side: MPSide::User,
            ..MPPar::new()
        };
        let unit = problem.is_free().then(|| bound(false));
        let bounds = problem.variables.iter().map(|_| bound(true)).chain(unit).collect();
        let config = MPConfig {
            ftol: CONVERGED,
            xtol: CONVERGED,
            gtol: CONVERGED,
            max_iter: iterations,
            ..MPConfig::new()
        };
        Self { problem, memo, reference, bounds, config, best: (f64::INFINITY, reference.point.clone()) }
    }

    fn fill(&mut self, point: &[f64], deviates: &mut [f64]) {
        let Ok(rows) = self.reference.evaluate(self.memo, point) else { return deviates.fill(INVALID) };
        deviates.copy_from_slice(&differences(self.problem, point, &rows));
        let weighted_rms = weighted_rms(self.problem, point, &rows);
        if weighted_rms < self.best.0 {
            self.best = (weighted_rms, point.to_vec());
        }
    }
}

impl MPFitter for Leg<'_> {
    fn eval(&mut self, params: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        self.fill(params, deviates);
        Ok(())
    }

    fn number_of_points(&self) -> usize {
        self.problem.goals.len()
    }

    fn config(&self) -> &MPConfig {
        &self.config
    }

    fn parameters(&self) -> &[MPPar] {
        &self.bounds
    }

    fn jacobian(
        &mut self,
        params: &[f64],
        deviates: &mut [f64],
        derivs: &mut [Option<Vec<f64>>],
    ) -> MPResult<()> {
        self.fill(params, deviates);
        let columns = derivatives(self.problem, self.memo, self.reference, params)
            .map_err(|_| rmpfit::MPError::Eval)?;
        derivs.iter_mut().zip(columns).for_each(|(to, column)| *to = Some(column));
        Ok(())
    }
}
