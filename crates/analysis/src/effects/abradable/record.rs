//! Record of the wear of an abradable coating.

use super::result::WearReport;
use crate::effects::effect::Ran;
use crate::result::Point;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    point.wear = ran.run.coating.as_ref().map(WearReport::of);
}
