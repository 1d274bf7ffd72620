//! The effects of a scene by name, on and off, and what each adds.

use crate::request::Symmetry;
use crate::resolved::Scene;
use crate::result::PlannedEffect;

/// An effect that a scene may name.
struct Effect {
    /// Its field in the scene.
    name: &'static str,
    is_on: fn(&Scene) -> bool,
    /// What it adds to a run that would be without it.
    adds: &'static str,
}

/// All of them, one for each field of [`Scene`].
const EFFECTS: [Effect; 14] = [
    Effect {
        name: "centrifugal_stiffening",
        is_on: |scene| scene.centrifugal_stiffening,
        adds: "K(Ω) = K0 + Ω²K1 + Ω⁴K2 in the eigenproblems of every speed; nothing in a step",
    },
    Effect {
        name: "damping",
        is_on: |scene| scene.damping.is_some(),
        adds: "a decay in every mode's recursion, and its loss in the energy identity",
    },
    Effect {
        name: "casing",
        is_on: |scene| scene.casing.is_some(),
        adds: "a clearance for every contact node; with lobes, a table of their height at every step of a revolution",
    },
    Effect {
        name: "contact",
        is_on: |scene| scene.contact.is_some(),
        adds: "the gaps of all contact nodes in every step, and a complementarity problem in those in which one would close",
    },
    Effect {
        name: "coriolis",
        is_on: |scene| scene.coriolis,
        adds: "a product with the gyroscopic matrix of every nodal diameter in every step; the contact problem is no longer symmetric",
    },
    Effect {
        name: "friction",
        is_on: |scene| scene.friction.is_some(),
        adds: "a tangential force with every normal one; the contact problem is no longer symmetric",
    },
    Effect {
        name: "abradable",
        is_on: |scene| scene.abradable.is_some(),
        adds: "a worn depth for every rod, kept over the run, and another law of contact; steps that jump no rod",
    },
    Effect {
        name: "flexible_casing",
        is_on: |scene| scene.flexible_casing.is_some(),
        adds: "two waves of the casing for every n as further oscillators in the same contact problem",
    },
    Effect {
        name: "mistuning",
        is_on: |scene| scene.mistuning.is_some(),
        adds: "forces that couple the nodal diameters of every modal family in every step",
    },
    Effect {
        name: "engine_order_excitation",
        is_on: |scene| !scene.engine_order_excitation.is_empty(),
        adds: "harmonic forces on the modes in every step",
    },
    Effect {
        name: "orbit",
        is_on: |scene| scene.orbit.is_some(),
        adds: "a shift of every gap that moves with the axis",
    },
    Effect {
        name: "initial",
        is_on: |scene| scene.initial.is_some(),
        adds: "a mode that moves when the run starts; nothing in a step",
    },
    Effect {
        name: "symmetry",
        is_on: |scene| scene.symmetry != Symmetry::Full,
        adds: "exact: only the nodal diameters that the scene's symmetry lets move; probe: a seeded asymmetry at the start",
    },
    Effect { name: "probe", is_on: |scene| scene.probe.is_some(), adds: "size and seed of that asymmetry" },
];

/// Every effect there is, on or off in `scene`.
pub(super) fn effects_of(scene: &Scene) -> Vec<PlannedEffect> {
    let planned = |effect: &Effect| {
        let on = (effect.is_on)(scene);
        PlannedEffect { name: effect.name.to_owned(), on, adds: on.then(|| effect.adds.to_owned()) }
    };
    EFFECTS.iter().map(planned).collect()
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    use utoipa::PartialSchema;

    use super::*;

    #[test]
    fn every_field_of_a_scene_is_an_effect_of_the_list() {
        let schema = serde_json::to_value(crate::request::Scene::schema()).unwrap();
        let mut fields: Vec<&str> =
            schema["properties"].as_object().unwrap().keys().map(String::as_str).collect();
        let mut named = EFFECTS.map(|effect| effect.name);
        fields.sort_unstable();
        named.sort_unstable();
        assert_eq!(fields, named);
        assert!(effects_of(&Scene::default()).iter().all(|effect| !effect.on && effect.adds.is_none()));
    }
}
