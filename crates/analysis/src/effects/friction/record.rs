//! What a run says of friction.

use crate::effects::effect::Ran;
use crate::result::Point;
use rubmap_numerics::complementarity::ComplementarityError;
use rubmap_wheel::dynamics::integrate::Outcome;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if let Some(energy) = &mut point.energy {
        energy.friction_heat = Some(ran.parts * ran.run.energy.effects().friction_heat);
    }
    if let (Outcome::ContactFailed { error: ComplementarityError::NotPMatrix { .. }, .. }, Some(message)) =
        (&ran.run.outcome, &mut point.message)
    {
        message.push_str(": tips jam together with this friction; lower /scene/friction/coefficient");
    }
}
