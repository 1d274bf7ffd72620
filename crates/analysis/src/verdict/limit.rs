//! Values of a speed against the limits of the request, with their errors.

use std::collections::BTreeMap;

use crate::resolved::ResolvedSweep;
use crate::result::{
    ErrorEstimate, JudgedValue, LimitKind, OpenKind, OpenQuestion, Point, PointError, Standing,
};

/// Share of a limit from which on it counts as reached.
pub(super) const REACHED: f64 = 0.8;

/// Share of a limit, on either side of it, within which a value without a known error is open: errors of the default settings are smaller.
const UNKNOWN: f64 = 0.2;

/// Standing of a value against its limit, by its relative error e, if that is known: the value is one of v/(1 + e) to v (1 + e), and never below 0.
pub(super) fn standing(value: f64, allowed: f64, error: Option<f64>) -> Standing {
    let (above, below) = match error {
        Some(error) => (value / (1.0 + error) > allowed, value * (1.0 + error) <= allowed),
        None => (value > (1.0 + UNKNOWN) * allowed, value < (1.0 - UNKNOWN) * allowed),
    };
    match (above, below) {
        (true, _) => Standing::Passed,
        (false, false) => Standing::Open,
        (false, true) if value >= REACHED * allowed => Standing::Reached,
        (false, true) => Standing::Kept,
    }
}

/// Limits of a request with the errors of its speeds.
#[derive(Debug)]
pub(super) struct Asked {
    /// Quantities that are limited, and their limits.
    pub(super) limits: Vec<(LimitKind, f64)>,
    has_contact: bool,
    /// Errors by the index of their speed; none before there are any.
    errors: Option<BTreeMap<u32, PointError>>,
}

impl Asked {
    pub(super) fn of(request: &ResolvedSweep, errors: Option<&ErrorEstimate>) -> Self {
        let asked = request.limits.unwrap_or_default();
        let limits =
            LimitKind::ALL.into_iter().filter_map(|kind| Some((kind, kind.limit(&asked)?))).collect();
        let errors = errors.map(|errors| errors.points.iter().map(|point| (point.index, *point)).collect());
        Self { limits, has_contact: request.scene.contact.is_some(), errors }
    }

    /// Question that is open where the request has no limit.
    pub(super) fn none_given(&self) -> Option<OpenQuestion> {
        self.limits.is_empty().then(|| OpenQuestion {
            what: OpenKind::NoLimit,
            range: None,
            speeds: Vec::new(),
            finding: "the request gives no limit".to_owned(),
            remedy: "give `limits`: `clearance_consumption`, `tip_motion`, `utilisation` or `node_force`"
                .to_owned(),
        })
    }

    /// Values of a completed speed against the limits, as far as they are known.
    pub(super) fn values(&self, point: &Point) -> Vec<JudgedValue> {
        self.limits.iter().filter_map(|&(kind, allowed)| self.judged(point, kind, allowed)).collect()
    }

    /// Value of a completed speed against one limit; none where it is not known.
    pub(super) fn judged(&self, point: &Point, limit: LimitKind, allowed: f64) -> Option<JudgedValue> {
        let (value, error) = self.known(point, limit)?;
        Some(JudgedValue {
            limit,
            value,
            error: error.map(|error| error * value),
            allowed,
            above_percent: 100.0 * (value - allowed) / allowed,
            standing: standing(value, allowed, error),
        })
    }

    /// Value of a completed speed and its relative error, limited or not.
    pub(super) fn known(&self, point: &Point, quantity: LimitKind) -> Option<(f64, Option<f64>)> {
        let value = self.value(point, quantity).filter(|value| !value.is_nan())?;
        Some((value, self.error(point.index, quantity)))
    }

    fn value(&self, point: &Point, limit: LimitKind) -> Option<f64> {
        match limit {
            LimitKind::ClearanceConsumption => Some(point.contact.as_ref()?.clearance_consumption),
            LimitKind::TipMotion => Some(point.tip?.peak_motion()),
            LimitKind::Utilisation => point.utilisation(),
            // Nothing touches in a scene without contact.
            LimitKind::NodeForce if !self.has_contact => Some(0.0),
            LimitKind::NodeForce => Some(point.contact.as_ref()?.peak_node_force),
        }
    }

    /// Whether the error of a quantity is still to come from control runs that the request asks for.
    pub(super) fn awaits_errors(&self, request: &ResolvedSweep, limit: LimitKind) -> bool {
        limit != LimitKind::NodeForce && request.control_speeds() > 0 && self.errors.is_none()
    }

    /// Relative error of a value. No estimate is made of the force on a single node.
    fn error(&self, index: u32, limit: LimitKind) -> Option<f64> {
        let known = self.errors.as_ref()?.get(&index)?;
        let error = match limit {
            LimitKind::ClearanceConsumption | LimitKind::TipMotion => Some(known.estimated_error),
            LimitKind::Utilisation => known.estimated_stress_error,
            LimitKind::NodeForce => None,
        };
        error.filter(|error| *error >= 0.0)
    }
}
