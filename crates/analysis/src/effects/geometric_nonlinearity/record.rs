//! Record of the work of blades that stiffen.

use super::request::Bending;
use crate::effects::effect::Ran;
use crate::result::Point;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    let stiffens =
        ran.request.scene.geometric_nonlinearity.as_ref().is_some_and(|of| of.include == Bending::Full);
    if let Some(energy) = &mut point.energy
        && stiffens
    {
        energy.bending_work = Some(ran.parts * ran.run.energy.effects().stiffening);
        energy.bending_residual = ran.run.energy.stiffening_residual();
    }
}
