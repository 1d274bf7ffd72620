//! Initial motion of a speed.

use crate::effects::initial::start::initial_mode;
use crate::effects::probe::start::{asymmetry, lowest_modes, wheel_reach};
use crate::effects::symmetry::request::Symmetry;
use crate::not_runnable::NotRunnable;
use crate::resolved::ResolvedSweep;
use crate::stepping::Stepping;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Modes of the initial state of a scene.
pub(super) fn initial(
    request: &ResolvedSweep,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    casing: Option<&Casing>,
    stepping: &Stepping,
) -> Result<Vec<InitialMode>, NotRunnable> {
    if request.scene.symmetry == Symmetry::Probe {
        return Ok(asymmetry(request, wheel, casing));
    }
    let mode = initial_mode(request, wheel, contact_nodes, casing, stepping)?;
    Ok(mode.into_iter().collect())
}

/// Amplitude of the perturbation that a twin starts from, relative to the reach of the wheel.
const PERTURBATION: f64 = 1e-7;

/// Adds a tiny perturbation of the lowest mode of every nodal diameter to `modes`.
pub(super) fn perturbed(
    mut modes: Vec<InitialMode>,
    wheel: &ModalWheel,
    casing: Option<&Casing>,
) -> Vec<InitialMode> {
    for added in lowest_modes(wheel, PERTURBATION * wheel_reach(casing), 1) {
        let same = |mode: &&mut InitialMode| (mode.harmonic, mode.family) == (added.harmonic, added.family);
        match modes.iter_mut().find(same) {
            Some(mode) => mode.displacement += added.displacement,
            None => modes.push(added),
        }
    }
    modes
}
