//! Record of the work of blades that stiffen.

use crate::effects::effect::Ran;
use crate::result::{Point, PointStatus};

/// Residual of the work of stiffening, as a share of its energy, above which a failed run is one whose blades bent too far: steps that follow the
/// motion leave less than a thousandth.
const TOO_FAR: f64 = 0.1;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if !ran.request.scene.blades_stiffen() {
        return;
    }
    let residual = ran.run.energy.stiffening_residual();
    let bent_too_far = match point.status {
        PointStatus::Diverged => true,
        PointStatus::Failed => residual.is_none_or(|residual| residual > TOO_FAR),
        PointStatus::Completed => false,
    };
    if let (true, Some(message)) = (bent_too_far, &mut point.message) {
        *message +=
            "; the energy of blades that stiffen is of fourth order in their bending and may not hold so far";
    }
    if let Some(energy) = &mut point.energy {
        energy.bending_work = Some(ran.parts * ran.run.energy.effects().stiffening);
        energy.bending_residual = residual;
    }
}
