//! Fit whose request was checked.

use std::f64::consts::TAU;

use rubmap_model::impeller::ImpellerParameters;
use rubmap_numerics::sampling::sobol_point;
use rubmap_numerics::sector_fourier::harmonic_count;
use serde_json::Value;

use crate::error::FitError;
use crate::request::{FitRequest, Target, Unit};

/// Number of modes beyond the highest family of the targets: room for families that change order.
const MARGIN: usize = 3;

/// Largest number of starting points, and of iterations.
const MOST: usize = 1000;

/// Highest family: beyond it a reduction would be cheaper than a search for modes.
const MOST_FAMILIES: usize = 50;

/// Parameter that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name of the parameter, as `material.youngs_modulus`.
    pub name: String,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// Target of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Nodal diameter.
    pub nodal_diameter: usize,
    /// Family, from 0.
    pub family: usize,
    /// Speed: rad/s, or radians in the unit of time of a free unit.
    pub speed: f64,
    /// Circular frequency: rad/s, or radians in the unit of time of a free unit.
    pub omega: f64,
    /// Relative standard error of the frequency.
    pub error: f64,
    /// Relative difference up to which the target is met.
    pub tolerance: f64,
}

/// Fit whose request was checked.
#[derive(Debug, Clone)]
pub struct Problem {
    /// Request as given.
    pub request: FitRequest,
    /// Parameters that vary, by name.
    pub variables: Vec<Variable>,
    /// Targets in the order of the request.
    pub goals: Vec<Goal>,
    /// Parameters of the wheel as the request gives them.
    wheel: Value,
}

impl Problem {
    /// Checks a request.
    ///
    /// # Errors
    /// [`FitError`] names the first field at fault.
    pub fn new(request: FitRequest) -> Result<Self, FitError> {
        let parameters = request.wheel.resolve()?;
        let wheel = serde_json::to_value(&parameters)
            .map_err(|error| FitError::Syntax { field: "wheel".to_owned(), message: error.to_string() })?;
        count("starts", request.starts)?;
        count("iterations", request.iterations)?;
        count("candidates", request.candidates)?;
        if request.candidates < request.starts {
            return Err(FitError::Value {
                field: "candidates".to_owned(),
                value: request.candidates.to_string(),
                requirement: "must be at least `starts`, which are chosen among them",
            });
        }
        if let Some(tolerance) = request.tolerance {
            relative("tolerance", tolerance)?;
        }
        let variables = request
            .vary
            .iter()
            .map(|(name, &bounds)| variable(&wheel, name, bounds))
            .collect::<Result<Vec<_>, _>>()?;
        if variables.is_empty() {
            let requirement = "must name at least one parameter of the generator";
            return Err(FitError::Value {
                field: "vary".to_owned(),
                value: format!("{} parameters", variables.len()),
                requirement,
            });
        }
        let goals = (request.targets.iter().enumerate())
            .map(|(index, target)| goal(&request, &parameters, index, target))
            .collect::<Result<Vec<_>, _>>()?;
        refuse_same_modes(&request.targets)?;
        let problem = Self { request, variables, goals, wheel };
        let names: Vec<String> = problem.unknowns();
        if problem.goals.len() < names.len() {
            return Err(FitError::TooFewTargets {
                targets: problem.goals.len(),
                unknowns: names.len(),
                names: names.join(", "),
            });
        }
        Ok(problem)
    }

    /// Names of the unknowns: the parameters that vary, then a free unit.
    pub fn unknowns(&self) -> Vec<String> {
        let unit = (self.is_free()).then(|| "unit".to_owned());
        self.variables.iter().map(|variable| variable.name.clone()).chain(unit).collect()
    }

    /// Whether the unit of the targets is fitted.
    pub fn is_free(&self) -> bool {
        self.request.unit == Unit::Free
    }

    /// Nodal diameters of the targets, ascending.
    pub(crate) fn nodal_diameters(&self) -> Vec<usize> {
        let mut found: Vec<usize> = self.goals.iter().map(|goal| goal.nodal_diameter).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Number of modes of each nodal diameter that are searched.
    pub(crate) fn modes(&self) -> usize {
        self.goals.iter().map(|goal| goal.family + 1).max().unwrap_or(1) + MARGIN
    }

    /// Size of the unit of the targets at a point, in Hz: 1 where it is known.
    pub(crate) fn unit_hz(&self, point: &[f64]) -> f64 {
        if self.is_free() { point.last().map_or(1.0, |unit| unit.exp()) } else { 1.0 }
    }

    /// Values of the parameters that vary at a point.
    pub(crate) fn values(&self, point: &[f64]) -> Vec<f64> {
        // Exact at the bounds.
        let value = |(variable, &at): (&Variable, &f64)| variable.low * (1.0 - at) + variable.high * at;
        self.variables.iter().zip(point).map(value).collect()
    }

    /// Parameters of the wheel with other values of those that vary.
    ///
    /// # Errors
    /// Message of the generator where they give no valid wheel.
    pub(crate) fn parameters(&self, values: &[f64]) -> Result<ImpellerParameters, String> {
        let mut wheel = self.wheel.clone();
        for (variable, &value) in self.variables.iter().zip(values) {
            if let Some(field) = wheel.pointer_mut(&pointer(&variable.name)) {
                *field = Value::from(value);
            }
        }
        let parameters: ImpellerParameters =
            serde_json::from_value(wheel).map_err(|error| error.to_string())?;
        parameters.validate().map_err(|error| error.to_string())?;
        Ok(parameters)
    }

    /// Candidates for starting points as fractions of the bounds, without a free unit: the wheel's own values where they are within the bounds and their
    /// nearest bounds elsewhere, then Sobol points.
    pub(crate) fn candidates(&self) -> Vec<Vec<f64>> {
        let own = self.variables.iter().map(|variable| {
            let value = self.wheel.pointer(&pointer(&variable.name)).and_then(Value::as_f64);
            let fraction = |value: f64| (value - variable.low) / (variable.high - variable.low);
            value.map_or(0.5, |value| fraction(value).clamp(0.0, 1.0))
        });
        let mut candidates = vec![own.collect()];
        let others = 0..self.request.candidates - 1;
        candidates.extend(others.map(|index| sobol_point(index, self.variables.len(), self.request.seed)));
        candidates
    }
}

fn pointer(name: &str) -> String {
    format!("/{}", name.replace('.', "/"))
}

fn variable(wheel: &Value, name: &str, [low, high]: [f64; 2]) -> Result<Variable, FitError> {
    let fixed = |reason| Err(FitError::Fixed { name: name.to_owned(), reason });
    match name {
        "splitter.leading_edge" => {
            return fixed(
                "the mesh rounds it to whole elements, so that frequencies jump with it; give it in `wheel`",
            );
        }
        "top_speed_rad_s" => return fixed("it is no property of the wheel; give it in `wheel`"),
        _ => {}
    }
    match wheel.pointer(&pointer(name)) {
        Some(Value::Number(number)) if number.is_f64() => {}
        Some(Value::Number(_)) => {
            return fixed(
                "it counts whole things, of which frequencies are no smooth function; give it in `wheel`",
            );
        }
        _ => {
            return fixed(
                "the generator has no such number; `rubmap generate --print-parameters` lists those it has",
            );
        }
    }
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(FitError::Value {
            field: format!("vary.{name}"),
            value: format!("[{low}, {high}]"),
            requirement: "must be two finite numbers, the lower bound first and below the upper one",
        });
    }
    Ok(Variable { name: name.to_owned(), low, high })
}

fn goal(
    request: &FitRequest,
    wheel: &ImpellerParameters,
    index: usize,
    target: &Target,
) -> Result<Goal, FitError> {
    let field = |name: &str| format!("targets[{index}].{name}");
    if target.nodal_diameter >= harmonic_count(wheel.sectors) {
        return Err(FitError::Value {
            field: field("nodal_diameter"),
            value: target.nodal_diameter.to_string(),
            requirement: "must not exceed half of the number of sectors",
        });
    }
    if !(1..=MOST_FAMILIES).contains(&target.family) {
        return Err(FitError::Value {
            field: field("family"),
            value: target.family.to_string(),
            requirement: "must lie between 1, the lowest mode of the nodal diameter, and 50",
        });
    }
    if !(target.speed >= 0.0 && target.speed.is_finite()) {
        return Err(FitError::Value {
            field: field("speed"),
            value: target.speed.to_string(),
            requirement: "must be a finite number that is not negative",
        });
    }
    positive(&field("frequency"), target.frequency)?;
    relative(&field("error"), target.error)?;
    let speed = match request.unit {
        Unit::HzAndRpm => target.speed * TAU / 60.0,
        Unit::Free => target.speed * TAU,
    };
    let top = wheel.top_speed_rad_s;
    // A speed in rpm and the same one in rad/s differ by their last digits.
    if request.unit == Unit::HzAndRpm && speed > top * (1.0 + 1e-9) {
        return Err(FitError::AboveTop { index, speed: target.speed, top: top * 60.0 / TAU });
    }
    Ok(Goal {
        nodal_diameter: target.nodal_diameter,
        family: target.family - 1,
        speed,
        omega: target.frequency * TAU,
        error: target.error,
        tolerance: request.tolerance.unwrap_or(2.0 * target.error),
    })
}

fn refuse_same_modes(targets: &[Target]) -> Result<(), FitError> {
    for (second, b) in targets.iter().enumerate() {
        let same =
            |a: &Target| (a.nodal_diameter, a.family, a.speed) == (b.nodal_diameter, b.family, b.speed);
        if let Some(first) = targets[..second].iter().position(same) {
            let first_frequency = targets[first].frequency;
            return Err(FitError::SameMode {
                first,
                second,
                nodal_diameter: b.nodal_diameter,
                family: b.family,
                speed: b.speed,
                first_frequency,
                second_frequency: b.frequency,
                percent: 100.0 * (b.frequency / first_frequency - 1.0).abs(),
            });
        }
    }
    Ok(())
}

fn positive(field: &str, value: f64) -> Result<(), FitError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let requirement = "must be a finite number above 0";
    Err(FitError::Value { field: field.to_owned(), value: value.to_string(), requirement })
}

/// Checks a relative error: 1 would be 100 %.
fn relative(field: &str, value: f64) -> Result<(), FitError> {
    if value > 0.0 && value <= 0.5 {
        return Ok(());
    }
    let requirement = "is relative (0.01 is 1 %): must lie above 0 and not exceed 0.5";
    Err(FitError::Value { field: field.to_owned(), value: value.to_string(), requirement })
}

fn count(field: &str, value: usize) -> Result<(), FitError> {
    if (1..=MOST).contains(&value) {
        return Ok(());
    }
    let requirement = "must lie between 1 and 1000";
    Err(FitError::Value { field: field.to_owned(), value: value.to_string(), requirement })
}
