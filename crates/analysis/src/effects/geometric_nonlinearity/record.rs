//! Record of the work of blades that stiffen.

use crate::effects::effect::Ran;
use crate::result::{Point, PointStatus};

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if !ran.request.scene.blades_stiffen() {
        return;
    }
    if let (PointStatus::Diverged, Some(message)) = (point.status, &mut point.message) {
        *message +=
            "; the energy of blades that stiffen is of fourth order in their bending and may not hold so far";
    }
    if let Some(energy) = &mut point.energy {
        energy.bending_work = Some(ran.parts * ran.run.energy.effects().stiffening);
        energy.bending_residual = ran.run.energy.stiffening_residual();
    }
}
