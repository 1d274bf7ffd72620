//! Record of what became of the symmetry.

use super::request::Symmetry;
use crate::effects::effect::Ran;
use crate::result::Point;
use rubmap_wheel::dynamics::integrate::Outcome;
use rubmap_wheel::response::symmetry_breaking::judge;

pub(super) fn record(point: &mut Point, ran: &Ran<'_>) {
    if let (Symmetry::Probe, Outcome::Completed(history)) = (ran.request.scene.symmetry, &ran.run.outcome) {
        let grown = ran.request.integration.ramp_revolutions.ceil() as usize;
        point.symmetry_breaking = Some(judge(&history.energies, ran.repeats, grown));
    }
}
