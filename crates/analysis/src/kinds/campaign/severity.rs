//! Severity of a speed of a design.

use crate::request::Severity;
use crate::result::{Point, PointStatus};
use rubmap_wheel::response::settling::Verdict;

/// Whether the motion was still changing when its revolutions ended. Wear counts as it is by then.
pub(super) fn is_unsettled(of: Severity, point: &Point) -> bool {
    let verdict = point.settling.as_ref().map(|settling| settling.verdict);
    of != Severity::Wear && point.status == PointStatus::Completed && verdict == Some(Verdict::NotSettled)
}

/// Severity of a completed, settled speed; none for other speeds, and where it is not known.
pub(super) fn severity(of: Severity, point: &Point) -> Option<f64> {
    if point.status != PointStatus::Completed || is_unsettled(of, point) {
        return None;
    }
    match of {
        Severity::Amplitude => {
            point.responses.iter().map(|response| response.half_peak_to_peak).max_by(f64::total_cmp)
        }
        Severity::Tip => Some(point.tip?.half_peak_to_peak),
        Severity::ContactForce => Some(point.contact.as_ref()?.peak_node_force),
        Severity::Wear => Some(point.wear?.deepest),
        Severity::Stress => Some(point.stress.as_ref()?.largest.von_mises),
        Severity::Utilisation => point.utilisation(),
    }
}
