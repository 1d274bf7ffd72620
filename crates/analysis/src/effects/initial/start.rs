//! Mode that moves when a run starts.

use std::f64::consts::TAU;

use faer::c64;

use super::request::{self, Initial};
use crate::not_runnable::NotRunnable;
use crate::resolved::ResolvedSweep;
use crate::stepping::Stepping;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::contact::flexibility::outward_normals;
use rubmap_wheel::dynamics::initial::{InitialMode, InitialWave};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::{Scheme, exact_modal};
use rubmap_wheel::dynamics::sector::ContactNode;

/// Mode that a scene starts with, if it names one.
pub(crate) fn initial_mode(
    request: &ResolvedSweep,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    casing: Option<&Casing>,
    stepping: &Stepping,
) -> Result<Option<InitialMode>, NotRunnable> {
    let Some(initial) = &request.scene.initial else { return Ok(None) };
    let (harmonic, family) = (initial.nodal_diameter as usize / wheel.repeats, initial.family as usize - 1);
    let modes = &wheel.harmonics[harmonic];
    if family >= modes.omega.len() {
        return Err(NotRunnable::NoSuchFamily {
            nodal_diameter: initial.nodal_diameter,
            families: modes.omega.len(),
            family: initial.family,
        });
    }
    check_integrated(initial, modes.omega[family], wheel, stepping)?;
    let wave = match initial.wave {
        request::InitialWave::Standing => InitialWave::Standing,
        request::InitialWave::Forward => InitialWave::Forward,
        request::InitialWave::Backward => InitialWave::Backward,
    };
    let mode = InitialMode::of_amplitude(wheel, harmonic, family, initial.amplitude, c64::ONE, wave);
    if let Some(casing) = casing {
        check_reach(initial, &mode, wheel, contact_nodes, casing)?;
    }
    Ok(Some(mode))
}

/// Checks that the scheme carries the mode: otherwise it would be gone at once.
fn check_integrated(
    initial: &Initial,
    omega: f64,
    wheel: &ModalWheel,
    stepping: &Stepping,
) -> Result<(), NotRunnable> {
    let step = TAU / (wheel.speed_rad_s * stepping.discretisation.per_revolution as f64);
    let Initial { family, nodal_diameter, .. } = *initial;
    match stepping.scheme {
        Scheme::MasslessBoundary { kept_modes } if family as usize > kept_modes => {
            Err(NotRunnable::FamilyNotKept { family, nodal_diameter, kept_modes })
        }
        Scheme::ExactModal if stepping.follow && omega * step > exact_modal::FOLLOWS => {
            Err(NotRunnable::FamilyFollows { family, nodal_diameter })
        }
        _ => Ok(()),
    }
}

/// Checks that no blade starts inside the casing: it would be thrown out in the first step, with energies that grow as 1/h².
fn check_reach(
    initial: &Initial,
    mode: &InitialMode,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    casing: &Casing,
) -> Result<(), NotRunnable> {
    let modes = &wheel.harmonics[mode.harmonic];
    let sectors = wheel.sectors as f64;
    let weight = if modes.single { (1.0 / sectors).sqrt() } else { (2.0 / sectors).sqrt() };
    let growth = casing.growth(0.0);
    let mut fits = f64::INFINITY;
    for (k, normal) in outward_normals(contact_nodes).iter().enumerate() {
        let shape = normal.of(modes.contact.as_ref(), mode.family) * mode.displacement * weight;
        for sector in 0..wheel.sectors {
            let turn = TAU * (mode.harmonic * sector) as f64 / sectors;
            let outward = shape.re * turn.cos() - shape.im * turn.sin();
            let angle = contact_nodes[k].position[1] + TAU * sector as f64 / wheel.around() as f64;
            let restricted = casing.restriction.as_ref();
            let restricted = restricted.map_or(0.0, |restriction| growth * restriction.height(angle, k));
            if outward > 0.0 {
                fits = fits.min((casing.clearance[k] - restricted).max(0.0) / outward);
            }
        }
    }
    if fits >= 1.0 {
        return Ok(());
    }
    Err(NotRunnable::InsideCasing { largest: initial.amplitude * fits })
}
