//! The effects of a scene in the terms of the physics.

use std::f64::consts::TAU;

use faer::c64;

use super::request::{Component, SweepRequest};
use super::scene::{
    Abradable, CasingMode, FlexibleCasing as FlexibleCasingRequest, Initial, Mistuning, Probe, Scene,
    Symmetry,
};
use super::stepping::Stepping;
use super::symmetry::repeats;
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap_wheel::dynamics::contact::flexibility::outward_normals;
use rubmap_wheel::dynamics::contact::friction::sliding_directions;
use rubmap_wheel::dynamics::effects::{Effects, Friction};
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing, Ring};
use rubmap_wheel::dynamics::initial::{InitialMode, InitialWave};
use rubmap_wheel::dynamics::mistuning::{normal_deviations, normal_numbers};
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::oscillators::Direction;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::schemes::{Scheme, exact_modal};
use rubmap_wheel::dynamics::sector::ContactNode;

/// What [`Effects`] borrows.
#[derive(Debug, Default)]
pub(super) struct SceneEffects {
    /// μ and n + μt.
    friction: Option<(f64, Vec<Direction>)>,
    coating: Option<Coating>,
    flexible_casing: Option<FlexibleCasing>,
    orbit: Option<Orbit>,
    mistuning: Option<Vec<f64>>,
    excitation: Vec<EngineOrderExcitation>,
    energies: bool,
}

impl SceneEffects {
    /// The effects that `scene` names, on `wheel` or the part of it that is simulated.
    pub(super) fn of(
        scene: &Scene,
        contact_nodes: &[ContactNode],
        wheel: &ModalWheel,
        ramp_revolutions: f64,
    ) -> Result<Self, String> {
        let sectors = wheel.around();
        let friction = match &scene.friction {
            Some(friction) => {
                let directions = sliding_directions(contact_nodes, friction.coefficient);
                Some((friction.coefficient, directions.map_err(|error| error.to_string())?))
            }
            None => None,
        };
        let coating = coating(scene, contact_nodes, sectors)?;
        let excitation = scene.engine_order_excitation.iter().map(|excitation| EngineOrderExcitation {
            order: excitation.order,
            directions: (excitation.contact_nodes.iter())
                .map(|&node| direction(contact_nodes, node, excitation.component))
                .collect(),
            amplitude: excitation.amplitude,
            phase_rad: excitation.phase_rad,
            ramp_revolutions,
        });
        Ok(Self {
            friction,
            coating,
            flexible_casing: scene.flexible_casing.as_ref().map(flexible_casing),
            orbit: scene.orbit.as_ref().map(|orbit| Orbit {
                radius: orbit.radius,
                whirl_ratio: orbit.whirl_ratio,
                phase_rad: orbit.phase_rad,
            }),
            mistuning: scene.mistuning.as_ref().map(|mistuning| deviations(mistuning, sectors)),
            excitation: excitation.collect(),
            energies: scene.symmetry == Symmetry::Probe,
        })
    }

    /// As a simulation takes them.
    pub(super) fn borrow(&self) -> Effects<'_> {
        Effects {
            friction: (self.friction.as_ref())
                .map(|(coefficient, directions)| Friction { coefficient: *coefficient, directions }),
            coating: self.coating.as_ref(),
            flexible_casing: self.flexible_casing.as_ref(),
            orbit: self.orbit,
            mistuning: self.mistuning.as_deref(),
            excitation: &self.excitation,
            energies: self.energies,
        }
    }
}

/// The coating of a scene on a wheel of `sectors`.
pub(super) fn coating(
    scene: &Scene,
    contact_nodes: &[ContactNode],
    sectors: usize,
) -> Result<Option<Coating>, String> {
    let Some(coating) = &scene.abradable else { return Ok(None) };
    let Abradable { modulus, yield_stress, hardening, thickness, rods_around } = *coating;
    let material = CoatingMaterial { modulus, yield_stress, hardening };
    Coating::new(material, thickness, rods_around as usize, contact_nodes, sectors)
        .map(Some)
        .map_err(|error| error.to_string())
}

/// What rotation does to the modes of the wheel.
pub(super) fn rotation(scene: &Scene) -> RotationEffects {
    RotationEffects { stiffening: scene.centrifugal_stiffening, coriolis: scene.coriolis }
}

/// The wheel of a scene at a speed, or the part of it that the scene repeats.
pub(super) fn wheel_of(
    scene: &Scene,
    reduced: &ReducedWheel,
    speed_rad_s: f64,
) -> Result<ModalWheel, ModelError> {
    let parts = match scene.symmetry {
        Symmetry::Exact => repeats(scene, reduced.sectors as u32) as usize,
        Symmetry::Full | Symmetry::Probe => 1,
    };
    Ok(ModalWheel::at(reduced, speed_rad_s, rotation(scene))?.part(parts))
}

/// The direction of a component at a contact node.
pub(super) fn direction(contact_nodes: &[ContactNode], node: u32, component: Component) -> Direction {
    let node = node as usize;
    let components = match component {
        Component::Radial => [1.0, 0.0, 0.0],
        Component::Tangential => [0.0, 1.0, 0.0],
        Component::Axial => [0.0, 0.0, 1.0],
        Component::Normal => contact_nodes[node].normal,
    };
    Direction { node, components }
}

/// The casing's waves; of a ring or as given.
pub(super) fn flexible_casing(casing: &FlexibleCasingRequest) -> FlexibleCasing {
    let given = casing.modes.iter().flatten().map(|mode: &CasingMode| CasingWave {
        nodal_diameter: mode.nodal_diameter,
        omega: TAU * mode.frequency_hz,
        modal_mass: mode.modal_mass,
    });
    let ring = casing.ring.iter().flat_map(|ring| {
        let section = Ring {
            radius: ring.radius,
            modulus: ring.modulus,
            density: ring.density,
            area: ring.area,
            second_moment: ring.second_moment,
        };
        section.waves(ring.n_max)
    });
    FlexibleCasing { waves: given.chain(ring).collect(), damping_ratio: casing.damping_ratio }
}

/// δ of every sector.
pub(super) fn deviations(mistuning: &Mistuning, sectors: usize) -> Vec<f64> {
    match (&mistuning.deviations, mistuning.spread) {
        (Some(given), _) => given.clone(),
        (None, spread) => normal_deviations(spread.unwrap_or(0.0), mistuning.seed.unwrap_or(0), sectors),
    }
}

/// The modes that a scene starts with.
pub(super) fn initial(
    request: &SweepRequest,
    wheel: &ModalWheel,
    contact_nodes: &[ContactNode],
    casing: Option<&Casing>,
    stepping: &Stepping,
) -> Result<Vec<InitialMode>, String> {
    if request.scene.symmetry == Symmetry::Probe {
        return Ok(asymmetry(request, wheel, casing));
    }
    let Some(initial) = &request.scene.initial else { return Ok(Vec::new()) };
    let (harmonic, family) = (initial.nodal_diameter as usize / wheel.repeats, initial.family as usize - 1);
    let modes = &wheel.harmonics[harmonic];
    if family >= modes.omega.len() {
        return Err(format!(
            "nodal diameter {} of the reduced wheel has {} modal families, not {}",
            initial.nodal_diameter,
            modes.omega.len(),
            initial.family
        ));
    }
    check_integrated(initial, modes.omega[family], wheel, casing.is_some(), stepping)?;
    let wave = match initial.wave {
        super::scene::InitialWave::Standing => InitialWave::Standing,
        super::scene::InitialWave::Forward => InitialWave::Forward,
        super::scene::InitialWave::Backward => InitialWave::Backward,
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
) -> Result<(), String> {
    let step = TAU / (wheel.speed_rad_s * stepping.discretisation.per_revolution as f64);
    let (family, diameter) = (initial.family, initial.nodal_diameter);
    match stepping.scheme {
        Scheme::MasslessBoundary { kept_modes } if family as usize > kept_modes => Err(format!(
            "the initial mode is family {family} of nodal diameter {diameter}, of which {kept_modes} are kept: keep more, or take \
             another scheme"
        )),
        Scheme::ExactModal if touching && omega * step > exact_modal::FOLLOWS => Err(format!(
            "the initial mode, family {family} of nodal diameter {diameter}, is too fast for the step and would follow statically: \
             take more steps_per_revolution"
        )),
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
) -> Result<(), String> {
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
    Err(format!(
        "the initial mode stands inside the casing at rest: at this speed /scene/initial/amplitude is at most {:.6e}",
        initial.amplitude * fits
    ))
}

/// The lowest mode of every nodal diameter that the symmetry of the scene keeps at rest, at a phase of its own.
fn asymmetry(request: &SweepRequest, wheel: &ModalWheel, casing: Option<&Casing>) -> Vec<InitialMode> {
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
