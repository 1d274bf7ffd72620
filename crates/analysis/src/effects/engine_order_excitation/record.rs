//! Record of the work of forces at engine orders.

use crate::effects::effect::Ran;
use crate::result::Point;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if let Some(energy) = &mut point.energy {
        energy.excitation_work = Some(ran.parts * ran.run.energy.effects().excitation);
    }
}
