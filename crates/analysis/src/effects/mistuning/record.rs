//! Record of the work of mistuning.

use crate::effects::effect::Ran;
use crate::result::Point;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if let Some(energy) = &mut point.energy {
        energy.mistuning_work = Some(ran.parts * ran.run.energy.effects().mistuning);
    }
}
