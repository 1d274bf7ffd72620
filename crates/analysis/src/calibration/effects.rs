//! Computing time that the effects of a scene add to a step.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::calibration::size::EffectSize;
use crate::calibration::wheel::{Case, StepSeconds, Wheel, measure};
use crate::effects::effect::{Acts, Effect, Price, SampleOn};
use crate::effects::physics::Physics;
use crate::effects::table::{EFFECTS, named};
use crate::effects::{coriolis, engine_order_excitation, orbit};
use crate::resolved::Scene;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::Scheme;

/// Part that any effect adds, whichever it is: the loop of scenes with effects and with blades that no longer move alike. Measured with an
/// orbit.
const ANY: &str = "any";
/// Part that forces on the modes other than contact add, which are then summed and counted. Measured with an excitation; Coriolis forces
/// and mistuning share it.
const DRIVEN: &str = "driven";

/// Effects with a price of their own.
fn priced() -> impl Iterator<Item = (&'static Effect, &'static Price)> {
    EFFECTS.iter().flat_map(|effect| effect.price.into_iter().flatten().map(|price| (*effect, price)))
}

/// Sizes of the parts of the price of a scene: of those that all effects share, and of those that single effects add.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct EffectSizes(BTreeMap<&'static str, f64>);

impl EffectSizes {
    /// Sizes for `scene` on `wheel`, or the part of it that is simulated, with `nodes` contact nodes a sector that may touch.
    pub(crate) fn of(scene: &Scene, wheel: &ModalWheel, scheme: Scheme, nodes: usize) -> Self {
        let size = EffectSize::of(wheel, scheme, nodes);
        let mut sizes = BTreeMap::new();
        for effect in named(scene) {
            if effect.acts != Acts::Elsewhere {
                sizes.insert(ANY, size.gaps() as f64);
            }
            if effect.acts == Acts::OnModes {
                sizes.insert(DRIVEN, size.step.products());
            }
            for price in effect.price.into_iter().flatten() {
                let amount = (price.amount)(scene);
                if amount > 0 {
                    sizes.insert(price.part, amount as f64 * (price.grows_with)(size));
                }
            }
        }
        Self(sizes)
    }

    /// Sizes with the Euler force added: another force on the modes and, with Coriolis forces, another product as theirs.
    pub(crate) fn with_euler_force(mut self, wheel: &ModalWheel, scheme: Scheme, nodes: usize) -> Self {
        let size = EffectSize::of(wheel, scheme, nodes);
        self.0.insert(ANY, size.gaps() as f64);
        self.0.insert(DRIVEN, size.step.products());
        if let Some(coriolis) = self.0.get_mut(coriolis::EFFECT.name) {
            *coriolis *= 2.0;
        }
        self
    }
}

/// Computing time that each part adds to a step, ns per unit of its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "BTreeMap<String, Added>")]
pub(super) struct EffectCosts(BTreeMap<String, Added>);

#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Added {
    free: f64,
    /// Time added to a step with contact.
    contact: f64,
}

/// Error of a part without a measured cost.
#[derive(Debug, thiserror::Error)]
#[error("no cost of {0}")]
struct NoCost(&'static str);

impl TryFrom<BTreeMap<String, Added>> for EffectCosts {
    type Error = NoCost;

    fn try_from(costs: BTreeMap<String, Added>) -> Result<Self, NoCost> {
        let mut parts = [ANY, DRIVEN].into_iter().chain(priced().map(|(_, price)| price.part));
        parts.find(|&part| !costs.contains_key(part)).map_or(Ok(Self(costs)), |part| Err(NoCost(part)))
    }
}

impl EffectCosts {
    /// Computing time that effects add to a step, s: if nothing ever touches, and if something always does.
    pub(super) fn seconds(&self, sizes: &EffectSizes) -> (f64, f64) {
        let parts = sizes.0.iter().map(|(&part, size)| (self.0[part], size));
        let (free, contact) = parts.fold((0.0, 0.0), |(free, contact), (added, size)| {
            (free + size * added.free, contact + size * added.contact)
        });
        (1e-9 * free, 1e-9 * contact)
    }

    /// Measures this machine, on the calling thread: every effect alone, on one wheel.
    pub(super) fn measure() -> Self {
        let wheel = Wheel::new(SECTORS, NODES, MODES);
        let size = EffectSize::of(wheel.modal(), Scheme::ExactModal, NODES);
        let (orbit, forces) = (orbit::price::sample(), engine_order_excitation::price::sample());
        let samples: Vec<_> = priced().map(|(_, price)| (price.sample)(&wheel)).collect();
        let shared = [Case::of(&wheel, Effects::default()), alone(&wheel, &orbit), alone(&wheel, &forces)];
        let own = samples.iter().map(|sample| match &sample.on {
            SampleOn::Simulation(effect) => alone(&wheel, effect.as_ref()),
            SampleOn::Wheel(wheel) => Case::of(wheel, Effects::default()),
        });
        let found = measure(&shared.into_iter().chain(own).collect::<Vec<_>>());
        let (none, any, driven) = (found[0], found[1], found[2]);
        let own = priced().zip(&samples).zip(&found[shared.len()..]);
        let own = own.map(|(((effect, price), sample), &found)| {
            let base = if effect.acts == Acts::OnModes { driven } else { any };
            let size = sample.amount as f64 * (price.grows_with)(size);
            let mut added = Added::over(base, found, size);
            if price.same_in_contact {
                added.contact = added.free;
            }
            (price.part, added)
        });
        let shared = [
            (ANY, Added::over(none, any, size.gaps() as f64)),
            (DRIVEN, Added::over(any, driven, size.step.products())),
        ];
        Self(shared.into_iter().chain(own).map(|(part, added)| (part.to_owned(), added)).collect())
    }
}

impl Added {
    /// Time of `found` beyond `base`, per unit of `size`.
    fn over(base: StepSeconds, found: StepSeconds, size: f64) -> Self {
        let per = |seconds: f64| 1e9 * seconds.max(0.0) / size;
        Self { free: per(found.free - base.free), contact: per(found.contact - base.contact) }
    }
}

/// Case with a single effect.
fn alone<'a>(wheel: &'a Wheel, effect: &'a dyn Physics) -> Case<'a> {
    let mut effects = Effects::default();
    effect.join(&mut effects);
    Case::of(wheel, effects)
}

const SECTORS: usize = 10;
const NODES: usize = 10;
const MODES: usize = 60;

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn wheels_with_an_effect_touch_and_run_to_the_end() {
        let wheel = Wheel::new(SECTORS, NODES, MODES);
        let rub = |effect: &dyn Physics, what| wheel.assert_rubbing(alone(&wheel, effect).effects, what);
        rub(&orbit::price::sample(), "orbit");
        rub(&engine_order_excitation::price::sample(), "excitation");
        for (_, price) in priced() {
            match (price.sample)(&wheel).on {
                SampleOn::Simulation(sample) => rub(sample.as_ref(), price.part),
                SampleOn::Wheel(wheel) => wheel.assert_rubbing(Effects::default(), price.part),
            }
        }
    }

    #[test]
    fn a_scene_pays_for_what_it_names() {
        let wheel = Wheel::new(4, 2, 8);
        let of = |scene: Value| {
            let scene = crate::resolved::from_json::scene(scene);
            EffectSizes::of(&scene, wheel.modal(), Scheme::ExactModal, 2).0
        };
        assert_eq!(of(json!({})), BTreeMap::new());
        // 8 modes of the nodal diameters 0, ±1 and 2; 4 × 8 padded gaps.
        assert_eq!(
            of(json!({"coriolis": true, "orbit": {"radius": 0.1}})),
            BTreeMap::from([(ANY, 32.0), (DRIVEN, 32.0 * 4.0), ("coriolis", 4.0 * 64.0)])
        );
        let euler = |scene: Value| {
            let scene = crate::resolved::from_json::scene(scene);
            let sizes = EffectSizes::of(&scene, wheel.modal(), Scheme::ExactModal, 2);
            sizes.with_euler_force(wheel.modal(), Scheme::ExactModal, 2).0
        };
        assert_eq!(euler(json!({})), BTreeMap::from([(ANY, 32.0), (DRIVEN, 32.0 * 4.0)]));
        assert_eq!(
            euler(json!({"coriolis": true})),
            BTreeMap::from([(ANY, 32.0), (DRIVEN, 32.0 * 4.0), ("coriolis", 2.0 * 4.0 * 64.0)])
        );
        let mode = json!({"nodal_diameter": 2, "frequency_hz": 100.0, "modal_mass": 1.0});
        assert_eq!(
            of(json!({"mistuning": {"spread": 0.01}, "flexible_casing": {"modes": [mode, mode]}})),
            BTreeMap::from([
                (ANY, 32.0),
                (DRIVEN, 32.0 * 4.0),
                ("mistuning", 4.0 * 32.0),
                ("flexible_casing", 2.0 * 32.0)
            ])
        );
    }

    #[test]
    fn friction_has_a_price_of_either_law() {
        let wheel = Wheel::new(4, 2, 8);
        for (law, part) in [("sliding", "friction"), ("disc", "friction_disc")] {
            let scene = json!({"friction": {"coefficient": 0.1, "law": law}});
            let scene = crate::resolved::from_json::scene(scene);
            let sizes = EffectSizes::of(&scene, wheel.modal(), Scheme::ExactModal, 2).0;
            assert_eq!(sizes, BTreeMap::from([(ANY, 32.0), (part, 32.0)]));
        }
    }

    #[test]
    fn costs_that_lack_a_part_do_not_read() {
        let parts = [ANY, DRIVEN].into_iter().chain(priced().map(|(_, price)| price.part));
        let added = json!({"free": 1.0, "contact": 2.0});
        let whole: serde_json::Map<_, _> = parts.map(|part| (part.to_owned(), added.clone())).collect();
        assert!(serde_json::from_value::<EffectCosts>(whole.clone().into()).is_ok());
        for part in whole.keys() {
            let mut rest = whole.clone();
            rest.remove(part);
            let error = serde_json::from_value::<EffectCosts>(rest.into()).unwrap_err();
            assert_eq!(error.to_string(), format!("no cost of {part}"));
        }
    }
}
