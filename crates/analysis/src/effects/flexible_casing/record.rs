//! Record of the amplitude and the energies of an elastic casing.

use crate::effects::effect::Ran;
use crate::result::Point;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    point.casing_amplitude = ran.run.statistics.casing_amplitude.filter(|value| value.is_finite());
    if let Some(energy) = &mut point.energy {
        let effects = ran.run.energy.effects();
        energy.casing_work = Some(ran.parts * effects.casing);
        energy.casing_loss = Some(ran.parts * effects.casing_loss);
    }
}
