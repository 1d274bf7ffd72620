//! The motion that a speed begins with.

use std::f64::consts::TAU;

use faer::c64;

use crate::not_runnable::NotRunnable;
use crate::request::{Initial, Probe, Symmetry};
use crate::resolved::ResolvedSweep;
use crate::stepping::Stepping;
use crate::symmetry::repeats;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::contact::flexibility::outward_normals;
use rubmap_wheel::dynamics::initial::{InitialMode, InitialWave};
use rubmap_wheel::dynamics::mistuning::normal_numbers;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::{Scheme, exact_modal};
use rubmap_wheel::dynamics::sector::ContactNode;

/// The modes that a scene starts with.
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
    let Some(initial) = &request.scene.initial else { return Ok(Vec::new()) };
    let (harmonic, family) = (initial.nodal_diameter as usize / wheel.repeats, initial.family as usize - 1);
    let modes = &wheel.harmonics[harmonic];
    if family >= modes.omega.len() {
        return Err(NotRunnable::NoSuchFamily {
            nodal_diameter: initial.nodal_diameter,
            families: modes.omega.len(),
            family: initial.family,
        });
    }
    check_integrated(initial, modes.omega[family], wheel, casing.is_some(), stepping)?;
    let wave = match initial.wave {
        crate::request::scene::InitialWave::Standing => InitialWave::Standing,
        crate::request::scene::InitialWave::Forward => InitialWave::Forward,
        crate::request::scene::InitialWave::Backward => InitialWave::Backward,
    };
    let mode = InitialMode::of_amplitude(wheel, harmonic, family, initial.amplitude, c64::ONE, wave);
    if let Some(casing) = casing {
        check_reach(initial, &mode, wheel, contact_nodes, casing)?;
    }
    Ok(vec![mode])
}

/// A mode that the scheme does not carry would be gone at once.
fn check_integrated(
    initial: &Initial,
    omega: f64,
    wheel: &ModalWheel,
    touching: bool,
    stepping: &Stepping,
) -> Result<(), NotRunnable> {
    let step = TAU / (wheel.speed_rad_s * stepping.discretisation.per_revolution as f64);
    let Initial { family, nodal_diameter, .. } = *initial;
    match stepping.scheme {
        Scheme::MasslessBoundary { kept_modes } if family as usize > kept_modes => {
            Err(NotRunnable::FamilyNotKept { family, nodal_diameter, kept_modes })
        }
        Scheme::ExactModal if touching && omega * step > exact_modal::FOLLOWS => {
            Err(NotRunnable::FamilyFollows { family, nodal_diameter })
        }
        _ => Ok(()),
    }
}

/// Blades that stand inside the casing would be thrown out in the first step, with energies that grow as 1/h².
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
            let restricted = casing.restriction.map_or(0.0, |restriction| growth * restriction.height(angle));
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

/// The lowest mode of every nodal diameter that the symmetry of the scene keeps at rest, at a phase of its own.
fn asymmetry(request: &ResolvedSweep, wheel: &ModalWheel, casing: Option<&Casing>) -> Vec<InitialMode> {
    let Probe { amplitude, seed } = request.scene.probe.clone().unwrap_or_default();
    let repeats = repeats(&request.scene, wheel.sectors as u32) as usize;
    let mut modes = lowest_modes(wheel, amplitude * wheel_reach(casing), seed);
    modes.retain(|mode| !wheel.harmonics[mode.harmonic].harmonic.is_multiple_of(repeats));
    modes
}

/// Amplitude of the perturbation that a twin starts from, relative to the reach of the wheel.
const PERTURBATION: f64 = 1e-7;

/// `modes` with a tiny perturbation of the lowest mode of every nodal diameter.
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

/// The lowest mode of every nodal diameter, standing, at a phase of its own.
fn lowest_modes(wheel: &ModalWheel, amplitude: f64, seed: u64) -> Vec<InitialMode> {
    let phases = normal_numbers(seed).take(wheel.harmonics.len());
    let mode = |(index, phase): (usize, f64)| {
        let phase = c64::new(phase.cos(), phase.sin());
        InitialMode::of_amplitude(wheel, index, 0, amplitude, phase, InitialWave::Standing)
    };
    phases.enumerate().map(mode).collect()
}

/// The length that an asymmetry is small against: the smallest clearance, or the restriction where that is zero; 1 without
/// a casing, where all motion is linear.
fn wheel_reach(casing: Option<&Casing>) -> f64 {
    let Some(casing) = casing else { return 1.0 };
    let smallest = casing.clearance.iter().copied().fold(f64::INFINITY, f64::min);
    match casing.restriction {
        Some(restriction) if smallest == 0.0 => restriction.highest(),
        _ => smallest,
    }
}
