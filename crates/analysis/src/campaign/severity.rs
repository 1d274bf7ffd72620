//! How bad a speed of a design is.

use crate::request::Severity;
use crate::result::{Point, PointStatus};

/// The severity of a completed speed; none of another, and where it is not known.
pub(super) fn severity(of: Severity, point: &Point) -> Option<f64> {
    if point.status != PointStatus::Completed {
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
