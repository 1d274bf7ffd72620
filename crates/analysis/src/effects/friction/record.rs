//! Record of friction.

use crate::effects::effect::Ran;
use crate::result::Point;
use rubmap_numerics::complementarity::ComplementarityError;
use rubmap_wheel::dynamics::integrate::Outcome;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if let Some(energy) = &mut point.energy {
        energy.friction_heat = Some(ran.parts * ran.run.energy.effects().friction_heat);
    }
    let disc = ran.request.scene.has_disc();
    if disc {
        let (sticking, sliding) = (ran.run.statistics.sticking, ran.run.statistics.sliding);
        point.sticking_share =
            (sticking + sliding > 0).then(|| sticking as f64 / (sticking + sliding) as f64);
    }
    let (Outcome::ContactFailed { error, .. }, Some(message)) = (&ran.run.outcome, &mut point.message) else {
        return;
    };
    match error {
        ComplementarityError::NotPMatrix { .. } => {
            message.push_str(": tips jam together with this friction; lower /scene/friction/coefficient");
        }
        ComplementarityError::NotSolved { .. } if disc => {
            message.push_str(
                ": whether tips stick or slide could not be told; lower /scene/friction/coefficient, take more steps, or the law \
                 sliding",
            );
        }
        _ => {}
    }
}
