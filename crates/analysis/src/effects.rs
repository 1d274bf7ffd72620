//! The effects of a scene in the terms of the physics.

use std::f64::consts::TAU;

use super::symmetry::repeats;
use crate::not_runnable::NotRunnable;
use crate::request::{Abradable, CasingMode, Component, Symmetry};
use crate::resolved::{self, Mistuning, ResolvedSweep, Scene, WavesOf};
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingError, CoatingMaterial};
use rubmap_wheel::dynamics::contact::friction::sliding_directions;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::{Effects, Friction};
use rubmap_wheel::dynamics::error::ModelError;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing, Ring};
use rubmap_wheel::dynamics::mistuning::normal_deviations;
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::oscillators::ModalDamping;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
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
    ) -> Result<Self, NotRunnable> {
        let sectors = wheel.around();
        let friction = match &scene.friction {
            Some(friction) => {
                let directions = sliding_directions(contact_nodes, friction.coefficient);
                Some((friction.coefficient, directions?))
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
) -> Result<Option<Coating>, CoatingError> {
    let Some(coating) = &scene.abradable else { return Ok(None) };
    let Abradable { modulus, yield_stress, hardening, thickness, rods_around } = *coating;
    let material = CoatingMaterial { modulus, yield_stress, hardening };
    Coating::new(material, thickness, rods_around as usize, contact_nodes, sectors).map(Some)
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
pub(super) fn flexible_casing(casing: &resolved::FlexibleCasing) -> FlexibleCasing {
    let given = |mode: &CasingMode| CasingWave {
        nodal_diameter: mode.nodal_diameter,
        omega: TAU * mode.frequency_hz,
        modal_mass: mode.modal_mass,
    };
    let waves = match &casing.waves {
        WavesOf::Modes(modes) => modes.iter().map(given).collect(),
        WavesOf::Ring(ring) => {
            let section = Ring {
                radius: ring.radius,
                modulus: ring.modulus,
                density: ring.density,
                area: ring.area,
                second_moment: ring.second_moment,
            };
            section.waves(ring.n_max)
        }
    };
    FlexibleCasing { waves, damping_ratio: casing.damping_ratio }
}

/// δ of every sector.
pub(super) fn deviations(mistuning: &Mistuning, sectors: usize) -> Vec<f64> {
    match mistuning {
        Mistuning::Given(deviations) => deviations.clone(),
        Mistuning::Drawn { spread, seed } => normal_deviations(*spread, *seed, sectors),
    }
}

/// The damping of a scene.
pub(super) fn modal_damping(request: &ResolvedSweep) -> Option<ModalDamping> {
    let damping = request.scene.damping.as_ref()?;
    Some(ModalDamping { modal_ratio: damping.modal_ratio, family_ratios: damping.family_ratios.clone() })
}
