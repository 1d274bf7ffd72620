//! Part of a map that is drawn.

/// Part of an interaction map; all of it without bounds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Window {
    /// Lowest and highest speed, revolutions per minute.
    pub speeds_rpm: Option<(f64, f64)>,
    /// Lowest and highest engine order.
    pub engine_orders: Option<(f64, f64)>,
}

impl Window {
    /// Range of speeds in rpm: the requested one, or `whole` unless the request is a valid range.
    pub(super) fn speeds(&self, whole: (f64, f64)) -> (f64, f64) {
        range(self.speeds_rpm).unwrap_or(whole)
    }

    pub(super) fn orders(&self, whole: (f64, f64)) -> (f64, f64) {
        range(self.engine_orders).unwrap_or(whole)
    }

    pub(super) fn has_speed(&self, rpm: f64) -> bool {
        range(self.speeds_rpm).is_none_or(|(low, high)| (low..=high).contains(&rpm))
    }

    pub(super) fn has_order(&self, order: f64) -> bool {
        range(self.engine_orders).is_none_or(|(low, high)| (low..=high).contains(&order))
    }
}

fn range(asked: Option<(f64, f64)>) -> Option<(f64, f64)> {
    asked.filter(|(low, high)| low.is_finite() && high.is_finite() && *low >= 0.0 && low < high)
}
