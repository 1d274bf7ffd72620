//! Fit and its result.

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use rubmap_model::impeller::ImpellerParameters;
use rubmap_wheel::revision::VERSION;
use serde::{Deserialize, Serialize};

use crate::error::FitError;
use crate::evaluation::{Evaluation, Keeper, Memo, Row};
use crate::identify::Knowledge;
use crate::problem::{Goal, Problem};
use crate::request::{FitRequest, Target};
use crate::search::{End, derivatives, search, starts};

/// Result of a fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FitResult {
    /// Whether all targets are met within their tolerances.
    pub met: bool,
    /// Root mean square of the differences, %.
    pub rms_percent: f64,
    /// Largest magnitude of a difference, %.
    pub largest_percent: f64,
    /// Size of the targets' unit in Hz, where it was fitted.
    pub unit_hz: Option<f64>,
    /// Whether a target's speed, in the fitted unit, exceeds `top_speed_rad_s` of the wheel.
    pub above_top_speed: bool,
    /// Targets in the order of the request.
    pub targets: Vec<TargetResult>,
    /// Unknowns: the parameters that vary by name, then `unit`, a free unit in Hz.
    pub unknowns: Vec<VariableResult>,
    /// Singular values of the derivatives of the weighted differences by the unknowns (parameters as fractions of their bounds, the unit as
    /// its logarithm), descending.
    pub singular_values: Vec<f64>,
    /// Index of the starting point with the best end, from 0.
    pub best_start: usize,
    /// Starting points with their ends, the wheel's own values first.
    pub starts: Vec<StartResult>,
    /// Parameters of the wheel that was found, as `rubmap generate --parameters` reads them.
    pub parameters: ImpellerParameters,
    /// Request of the fit, with its defaults.
    pub request: FitRequest,
    /// Version of the program.
    pub version: String,
}

/// Target and what was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetResult {
    /// Nodal diameter.
    pub nodal_diameter: usize,
    /// Family, from 1.
    pub family: usize,
    /// Speed in the unit of the request.
    pub speed: f64,
    /// Frequency asked for, in the unit of the request.
    pub frequency: f64,
    /// Frequency found, in the unit of the request.
    pub found: f64,
    /// Difference found/asked − 1, %.
    pub difference_percent: f64,
    /// Largest magnitude of the difference at which the target is met, %.
    pub tolerance_percent: f64,
    /// Whether the target is met.
    pub met: bool,
    /// Rank of the mode in its nodal diameter at the target's speed, from 1.
    pub rank: usize,
    /// Modal assurance of the family's shape at the starting point with the mode that has it now; none where the starting point's mesh is not
    /// valid for the wheel found.
    pub assurance: Option<f64>,
    /// Rank at which the family's shape at the starting point is found now, from 1: another than `rank` where the order of families changed on
    /// the way, and the target was given to another shape.
    pub rank_by_shape: Option<usize>,
}

/// Unknown and what was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariableResult {
    /// Name of the parameter, or `unit`.
    pub name: String,
    /// Value found.
    pub value: f64,
    /// Standard deviation of the value if every target has its `error`; none where the targets do not determine the value.
    pub standard_deviation: Option<f64>,
    /// Lower and upper bound; none for a free unit.
    pub bounds: Option<[f64; 2]>,
    /// Bound at which the value lies: the targets would have it beyond.
    pub at: Option<Bound>,
}

/// Bound of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// Lower bound.
    Low,
    /// Upper bound.
    High,
}

/// Starting point and its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StartResult {
    /// Values of the parameters at the start, in the order of their names.
    pub from: Vec<f64>,
    /// Values of the parameters at the end; none where the start gives no valid wheel.
    pub to: Option<Vec<f64>>,
    /// Root mean square of the weighted differences at the end: 1 where targets are missed by their errors.
    pub weighted_rms: Option<f64>,
    /// Number of iterations.
    pub iterations: usize,
    /// Number of legs of the search: more than 1 where the order of families, or the end of the clamp on the mesh, changed.
    pub legs: usize,
    /// Reason why the start gives no valid wheel.
    pub failure: Option<String>,
}

/// Distance from a bound, as a fraction of the bounds, at which a parameter counts as at it.
const AT_BOUND: f64 = 1e-6;

/// Makes a fit; evaluations that are `known` from an earlier call for the same request are not computed again. Starting points and columns of
/// derivatives run in parallel on the current rayon pool; no bit of the result depends on their number, nor on what was known.
///
/// # Errors
/// [`FitError::NoStart`] where no starting point gives a valid wheel.
pub fn fit(problem: &Problem, known: Vec<Evaluation>, keeper: &dyn Keeper) -> Result<FitResult, FitError> {
    let memo = Memo::new(known, keeper);
    let starts = starts(problem);
    let indices: Vec<usize> = (0..starts.len()).collect();
    let ends: Vec<Result<End<'_>, String>> = (indices.par_iter())
        .map(|&index| {
            let end = search(problem, &memo, &starts[index]);
            memo.keeper().ended(index, end.as_ref().map_or(f64::INFINITY, |end| end.weighted_rms));
            end
        })
        .collect();
    let reached = ends.iter().enumerate().filter_map(|(index, end)| Some((index, end.as_ref().ok()?)));
    let best = reached.min_by(|(_, a), (_, b)| a.weighted_rms.total_cmp(&b.weighted_rms));
    let failure = |message: &str| FitError::NoStart { starts: ends.len(), message: message.to_owned() };
    let Some((best_start, best)) = best else {
        let first = ends.first().and_then(|end| end.as_ref().err());
        return Err(failure(first.map_or("no starting point", |message| message)));
    };
    let point = &best.end.point;
    let knowledge = match derivatives(problem, &memo, &best.end, point) {
        Ok(columns) => Knowledge::of(&columns),
        // Without a valid wheel on either side of the end nothing is known.
        Err(_) => Knowledge { singular_values: Vec::new(), deviations: vec![None; point.len()] },
    };
    let unit = problem.unit_hz(point);
    let targets = targets(problem, &memo, best);
    let largest = targets.iter().fold(0.0f64, |largest, row| largest.max(row.difference_percent.abs()));
    let squares: f64 = targets.iter().map(|row| row.difference_percent.powi(2)).sum();
    let values = problem.values(point);
    let parameters = problem.parameters(&values).map_err(|message| failure(&message))?;
    let top = parameters.top_speed_rad_s * (1.0 + 1e-9);
    let start = |(from, end): (&Vec<f64>, &Result<End<'_>, String>)| {
        let from = problem.values(from);
        match end {
            Ok(end) => StartResult {
                from,
                to: Some(problem.values(&end.end.point)),
                weighted_rms: Some(end.weighted_rms),
                iterations: end.iterations,
                legs: end.legs,
                failure: None,
            },
            Err(message) => StartResult {
                from,
                to: None,
                weighted_rms: None,
                iterations: 0,
                legs: 0,
                failure: Some(message.clone()),
            },
        }
    };
    Ok(FitResult {
        met: targets.iter().all(|row| row.met),
        rms_percent: (squares / targets.len() as f64).sqrt(),
        largest_percent: largest,
        unit_hz: problem.is_free().then_some(unit),
        above_top_speed: problem.goals.iter().any(|goal| goal.speed * unit > top),
        targets,
        unknowns: unknowns(problem, point, &knowledge),
        singular_values: knowledge.singular_values,
        best_start,
        starts: starts.iter().zip(&ends).map(start).collect(),
        parameters,
        request: problem.request.clone(),
        version: VERSION.to_owned(),
    })
}

fn targets(problem: &Problem, memo: &Memo<'_>, best: &End<'_>) -> Vec<TargetResult> {
    let unit = problem.unit_hz(&best.end.point);
    let followed = best.start.evaluate(memo, &best.end.point).ok();
    let rows = problem.goals.iter().zip(&problem.request.targets).zip(&best.rows).enumerate();
    let row = |(index, ((goal, target), row)): (usize, ((&Goal, &Target), &Row))| {
        let followed = followed.as_ref().map(|rows| rows[index]);
        let ratio = row.omega / (goal.omega * unit);
        TargetResult {
            nodal_diameter: target.nodal_diameter,
            family: target.family,
            speed: target.speed,
            frequency: target.frequency,
            found: target.frequency * ratio,
            difference_percent: 100.0 * (ratio - 1.0),
            tolerance_percent: 100.0 * goal.tolerance,
            met: (ratio - 1.0).abs() <= goal.tolerance,
            rank: row.rank + 1,
            assurance: followed.map(|followed| followed.assurance),
            rank_by_shape: followed.map(|followed| followed.rank + 1),
        }
    };
    rows.map(row).collect()
}

fn unknowns(problem: &Problem, point: &[f64], knowledge: &Knowledge) -> Vec<VariableResult> {
    let values = problem.values(point);
    let mut unknowns: Vec<VariableResult> = (problem.variables.iter().enumerate())
        .map(|(index, variable)| VariableResult {
            name: variable.name.clone(),
            value: values[index],
            standard_deviation: knowledge.deviations[index].map(|s| s * (variable.high - variable.low)),
            bounds: Some([variable.low, variable.high]),
            at: match point[index] {
                at if at <= AT_BOUND => Some(Bound::Low),
                at if at >= 1.0 - AT_BOUND => Some(Bound::High),
                _ => None,
            },
        })
        .collect();
    if problem.is_free() {
        let value = problem.unit_hz(point);
        let standard_deviation = knowledge.deviations.last().copied().flatten().map(|s| s * value);
        let name = "unit".to_owned();
        unknowns.push(VariableResult { name, value, standard_deviation, bounds: None, at: None });
    }
    unknowns
}
