//! What the effects of a scene add to a step.

use serde::{Deserialize, Serialize};

use super::wheel::STEPS;
use crate::calibration::size::StepSize;
use crate::calibration::wheel::{Case, SPEED, StepSeconds, Wheel, measure};
use crate::effects::flexible_casing;
use crate::resolved::Scene;
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap_wheel::dynamics::contact::friction::sliding_directions;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::{Effects, Friction};
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap_wheel::dynamics::mistuning::normal_deviations;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::schemes::Scheme;

/// One value for each part of the price of a scene's effects.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Parts<T> {
    /// Whatever the effects are, the loop of scenes with effects and blades that no longer move alike; what an orbit costs.
    any: T,
    /// Other forces than contact on the modes: two passes over the mode shapes instead of one. What excitation costs, and
    /// Coriolis forces and mistuning share.
    driven: T,
    mistuning: T,
    coriolis: T,
    friction: T,
    abradable: T,
    flexible_casing: T,
}

impl<T: Copy> Parts<T> {
    fn each(self) -> [T; 7] {
        let Self { any, driven, mistuning, coriolis, friction, abradable, flexible_casing } = self;
        [any, driven, mistuning, coriolis, friction, abradable, flexible_casing]
    }
}

impl Parts<f64> {
    /// What the cost of each part grows with.
    fn sizes(wheel: &ModalWheel, scheme: Scheme, nodes: usize, waves: usize) -> Self {
        let integrated = wheel
            .harmonics
            .iter()
            .map(|h| (scheme.integrated_modes(h.omega.len()), if h.single { 1 } else { 2 }));
        let unknowns = integrated.clone().map(|(modes, parts)| modes * parts).sum();
        // A pair reads the real and the imaginary part of its matrix.
        let squares: usize = integrated.map(|(modes, parts)| modes * modes * parts).sum();
        let size = StepSize { sectors: wheel.sectors, nodes, unknowns };
        let gaps = (size.sectors * nodes.next_multiple_of(8)) as f64;
        Self {
            any: gaps,
            driven: size.products(),
            mistuning: (size.sectors * unknowns) as f64,
            coriolis: squares as f64,
            friction: gaps,
            abradable: gaps,
            flexible_casing: waves as f64 * gaps,
        }
    }
}

/// How much of each part a scene has; 0 of what it does not name.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct EffectSizes(Parts<f64>);

impl EffectSizes {
    /// Those of `scene` on `wheel`, or the part of it that is simulated, with `nodes` contact nodes a sector that may touch.
    pub(crate) fn of(scene: &Scene, wheel: &ModalWheel, scheme: Scheme, nodes: usize) -> Self {
        let waves = scene.flexible_casing.as_ref().map_or(0, |casing| flexible_casing(casing).waves.len());
        let sizes = Parts::sizes(wheel, scheme, nodes, waves);
        let [mistuned, friction, abradable] =
            [scene.mistuning.is_some(), scene.friction.is_some(), scene.abradable.is_some()];
        let driven = scene.coriolis || mistuned || !scene.engine_order_excitation.is_empty();
        let any = driven || friction || abradable || waves > 0 || scene.orbit.is_some();
        let if_named = |named: bool, size: f64| if named { size } else { 0.0 };
        Self(Parts {
            any: if_named(any, sizes.any),
            driven: if_named(driven, sizes.driven),
            mistuning: if_named(mistuned, sizes.mistuning),
            coriolis: if_named(scene.coriolis, sizes.coriolis),
            friction: if_named(friction, sizes.friction),
            abradable: if_named(abradable, sizes.abradable),
            flexible_casing: sizes.flexible_casing,
        })
    }
}

/// Nanoseconds that each part adds to a step, per unit of its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct EffectCosts(Parts<Added>);

#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Added {
    free: f64,
    /// In a step in which something touches.
    contact: f64,
}

impl EffectCosts {
    /// Seconds that effects add to a step, if nothing ever touches and if something always does.
    pub(super) fn seconds(&self, sizes: EffectSizes) -> (f64, f64) {
        let parts = self.0.each().into_iter().zip(sizes.0.each());
        let (free, contact) = parts.fold((0.0, 0.0), |(free, contact), (added, size)| {
            (free + size * added.free, contact + size * added.contact)
        });
        (1e-9 * free, 1e-9 * contact)
    }

    /// Measures this machine, on the calling thread: every effect alone, on one wheel.
    pub(super) fn measure() -> Self {
        let wheel = Wheel::new(SECTORS, NODES, MODES);
        let sizes = Parts::sizes(wheel.modal(), Scheme::ExactModal, NODES, WAVES);
        let effects = SampleEffects::new(&wheel);
        let turning = wheel.clone().turning();
        let [none, orbit, driven, mistuning, coriolis, friction, abradable, flexible_casing] = measure([
            Case::of(&wheel, Effects::default()),
            Case::of(&wheel, effects.orbit()),
            Case::of(&wheel, effects.driven()),
            Case::of(&wheel, effects.mistuning()),
            Case::of(&turning, Effects::default()),
            Case::of(&wheel, effects.friction()),
            Case::of(&wheel, effects.abradable()),
            Case::of(&wheel, effects.flexible_casing()),
        ]);
        let per = |seconds: f64, size: f64| 1e9 * seconds.max(0.0) / size;
        let over = |base: StepSeconds, found: StepSeconds, size: f64| Added {
            free: per(found.free - base.free, size),
            contact: per(found.contact - base.contact, size),
        };
        // The same forces whether or not something touches.
        let mistuned = per(mistuning.free - driven.free, sizes.mistuning);
        Self(Parts {
            any: over(none, orbit, sizes.any),
            driven: over(orbit, driven, sizes.driven),
            mistuning: Added { free: mistuned, contact: mistuned },
            coriolis: over(driven, coriolis, sizes.coriolis),
            friction: over(orbit, friction, sizes.friction),
            abradable: over(orbit, abradable, sizes.abradable),
            flexible_casing: over(orbit, flexible_casing, sizes.flexible_casing),
        })
    }
}

const SECTORS: usize = 10;
const NODES: usize = 10;
const MODES: usize = 60;
const WAVES: usize = 8;

/// Effects for the synthetic wheel, of such sizes that it keeps touching.
struct SampleEffects {
    sliding: Vec<Direction>,
    coating: Coating,
    casing: FlexibleCasing,
    deviations: Vec<f64>,
    excitation: [EngineOrderExcitation; 1],
}

impl SampleEffects {
    fn new(wheel: &Wheel) -> Self {
        // So hard that it is never worn, and so springy that blades are deep in it.
        let material = CoatingMaterial { modulus: 1e6, yield_stress: 9e5, hardening: 1e6 };
        let wave = |n: usize| CasingWave {
            nodal_diameter: n as u32,
            omega: SPEED * (4.0 + n as f64),
            modal_mass: 1.0,
        };
        Self {
            sliding: sliding_directions(wheel.contact_nodes(), FRICTION)
                .expect("tips that face outwards slide"),
            coating: Coating::new(material, 2.0, STEPS, wheel.contact_nodes(), SECTORS)
                .expect("the constants are those of a coating"),
            casing: FlexibleCasing { waves: (0..WAVES).map(wave).collect(), damping_ratio: 0.01 },
            deviations: normal_deviations(0.02, 1, SECTORS),
            excitation: [EngineOrderExcitation {
                order: 4,
                directions: vec![Direction { node: 0, components: [0.0, 0.0, 1.0] }],
                amplitude: 1.0,
                phase_rad: 0.0,
                ramp_revolutions: 0.5,
            }],
        }
    }

    fn driven(&self) -> Effects<'_> {
        Effects { excitation: &self.excitation, ..Effects::default() }
    }

    fn mistuning(&self) -> Effects<'_> {
        Effects { mistuning: Some(&self.deviations), ..Effects::default() }
    }

    fn friction(&self) -> Effects<'_> {
        let friction = Friction { coefficient: FRICTION, directions: &self.sliding };
        Effects { friction: Some(friction), ..Effects::default() }
    }

    fn abradable(&self) -> Effects<'_> {
        Effects { coating: Some(&self.coating), ..Effects::default() }
    }

    fn flexible_casing(&self) -> Effects<'_> {
        Effects { flexible_casing: Some(&self.casing), ..Effects::default() }
    }

    fn orbit(&self) -> Effects<'_> {
        let orbit = Orbit { radius: 0.05, whirl_ratio: 0.4, phase_rad: 0.0 };
        Effects { orbit: Some(orbit), ..Effects::default() }
    }
}

const FRICTION: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_with_an_effect_touch_and_run_to_the_end() {
        let wheel = Wheel::new(SECTORS, NODES, MODES);
        let effects = SampleEffects::new(&wheel);
        wheel.assert_rubbing(effects.driven(), "excitation");
        wheel.assert_rubbing(effects.mistuning(), "mistuning");
        wheel.assert_rubbing(effects.friction(), "friction");
        wheel.assert_rubbing(effects.abradable(), "abradable");
        wheel.assert_rubbing(effects.flexible_casing(), "flexible casing");
        wheel.assert_rubbing(effects.orbit(), "orbit");
        wheel.turning().assert_rubbing(Effects::default(), "coriolis");
    }

    #[test]
    fn a_scene_pays_for_what_it_names() {
        let wheel = Wheel::new(4, 2, 8);
        let of = |scene: serde_json::Value| {
            let scene = crate::resolved::from_json::scene(scene);
            EffectSizes::of(&scene, wheel.modal(), Scheme::ExactModal, 2).0
        };
        assert_eq!(of(serde_json::json!({})), Parts::default());
        // 8 modes of the nodal diameters 0, ±1 and 2; 4 × 8 padded gaps.
        assert_eq!(
            of(serde_json::json!({"coriolis": true, "orbit": {"radius": 0.1}})),
            Parts { any: 32.0, driven: 32.0 * 4.0, coriolis: 4.0 * 64.0, ..Parts::default() }
        );
        let mode = serde_json::json!({"nodal_diameter": 2, "frequency_hz": 100.0, "modal_mass": 1.0});
        assert_eq!(
            of(
                serde_json::json!({"mistuning": {"spread": 0.01}, "flexible_casing": {"modes": [mode, mode]}})
            ),
            Parts {
                any: 32.0,
                driven: 32.0 * 4.0,
                mistuning: 4.0 * 32.0,
                flexible_casing: 2.0 * 32.0,
                ..Parts::default()
            }
        );
    }
}
