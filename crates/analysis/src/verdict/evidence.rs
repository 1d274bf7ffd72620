//! Evidence on which a verdict is made.

use super::hidden::Maximum;
use super::limit::Asked;
use super::points::Finished;
use crate::result::{ErrorEstimate, Point, WheelCriticalSpeed};
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Finished speeds of a sweep, in any order, and the knowledge beside them.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// Finished speeds.
    pub points: &'a [Point],
    /// Errors of the speeds, once control runs have told them.
    pub errors: Option<&'a ErrorEstimate>,
    /// Linear critical speeds that the scene can drive, once the sweep has succeeded: speeds may be added until then.
    pub driven: Option<&'a [DrivenCrossing]>,
    /// Whether the job still works on the sweep: it is neither successful nor cancelled nor failed.
    pub unfinished: bool,
}

/// Sweep as it is seen by all its ranges.
pub(super) struct Seen<'a> {
    pub(super) finished: &'a Finished<'a>,
    pub(super) peaks: &'a [WheelCriticalSpeed],
    /// Maxima that are not resolved.
    pub(super) maxima: &'a [Maximum],
    /// Linear critical speeds that the scene can drive; none before the sweep has succeeded.
    pub(super) driven: Option<&'a [DrivenCrossing]>,
    pub(super) unfinished: bool,
    pub(super) asked: &'a Asked,
}
