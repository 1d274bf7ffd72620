//! Table of all effects, and questions to all of them.

use crate::effects::effect::{AboutToRun, Acts, Effect};
use crate::effects::list::effects;
use crate::effects::physics::{Physics, Surroundings};
use crate::not_runnable::NotRunnable;
use crate::resolved::Scene;
use crate::result::PlannedEffect;
use rubmap_wheel::dynamics::effects::Effects;

macro_rules! table {
    ($($(#[$($about:tt)*])* $effect:ident: $Asked:ty,)*) => {
        /// Every effect there is, in the order of the list.
        pub(crate) const EFFECTS: &[&Effect] = &[$(&crate::effects::$effect::EFFECT),*];
    };
}
effects!(table);

/// Effects that `scene` names.
pub(crate) fn named(scene: &Scene) -> impl Iterator<Item = &'static Effect> {
    EFFECTS.iter().copied().filter(|effect| (effect.is_on)(scene))
}

/// Every effect there is, on or off in `scene`.
pub(crate) fn planned(scene: &Scene) -> Vec<PlannedEffect> {
    let planned = |effect: &&Effect| {
        let on = (effect.is_on)(scene);
        PlannedEffect { name: effect.name.to_owned(), on, adds: on.then(|| effect.adds.to_owned()) }
    };
    EFFECTS.iter().map(planned).collect()
}

/// Whether anything else than contact acts on the modes.
pub(crate) fn is_driven(scene: &Scene) -> bool {
    named(scene).any(|effect| effect.acts == Acts::OnModes)
}

/// Checks that a wheel at a speed can stand the effects that its scene names.
pub(crate) fn check_at_speed(run: &AboutToRun<'_>) -> Result<(), NotRunnable> {
    let mut asked = named(&run.request.scene).filter_map(|effect| effect.at_speed.as_ref());
    asked.try_for_each(|asked| (asked.check)(run))
}

/// Effects of a scene in the terms of the physics, which [`Effects`] borrows.
pub(crate) struct SceneEffects(Vec<Box<dyn Physics>>);

impl SceneEffects {
    /// Converts the effects that `scene` names.
    pub(crate) fn of(scene: &Scene, surroundings: &Surroundings<'_>) -> Result<Self, NotRunnable> {
        let conversions = named(scene).filter_map(|effect| effect.convert);
        let converted = conversions.filter_map(|convert| convert(scene, surroundings).transpose());
        converted.collect::<Result<_, _>>().map(Self)
    }

    /// Effects as a simulation takes them.
    pub(crate) fn borrow(&self) -> Effects<'_> {
        let mut effects = Effects::default();
        self.0.iter().for_each(|effect| effect.join(&mut effects));
        effects
    }
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    use utoipa::PartialSchema;

    use super::*;

    #[test]
    fn every_field_of_a_scene_is_an_effect_of_the_table() {
        let schema = serde_json::to_value(crate::request::Scene::schema()).unwrap();
        let mut fields: Vec<&str> =
            schema["properties"].as_object().unwrap().keys().map(String::as_str).collect();
        let mut named: Vec<&str> = EFFECTS.iter().map(|effect| effect.name).collect();
        fields.sort_unstable();
        named.sort_unstable();
        assert_eq!(fields, named);
        assert!(planned(&Scene::default()).iter().all(|effect| !effect.on && effect.adds.is_none()));
    }
}
