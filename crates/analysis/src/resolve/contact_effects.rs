//! Friction and abradable coating of a request.

use super::findings::{Findings, between};
use super::limits;
use crate::model::ModelFacts;
use crate::request::{Abradable, AutoOr, Friction, Integration};
use rubmap_wheel::dynamics::contact::coating::{LEAST_HARDENING, RODS_PER_SECTOR};

/// What can be said of friction before a wheel is reduced; whether it jams is found out at every speed.
pub(super) fn check_friction(found: &mut Findings, friction: &Friction) {
    found.require(
        (0.0..=1.0).contains(&friction.coefficient),
        "/scene/friction/coefficient",
        "a friction coefficient lies in [0, 1]",
    );
}

/// The coating, and that time steps are fine enough for its rods.
pub(super) fn check_abradable(
    found: &mut Findings,
    abradable: &Abradable,
    integration: &Integration,
    facts: &ModelFacts,
) {
    found.require(
        facts.contact_nodes >= 2,
        "/scene/abradable",
        "a coating covers what the line of contact nodes sweeps, and the model has a single one: export more",
    );
    check_material(found, abradable);
    let rods = abradable.rods_around;
    let least = u32::try_from(RODS_PER_SECTOR).unwrap_or(u32::MAX).saturating_mul(facts.sectors);
    let most = (limits::RODS / facts.contact_nodes.max(1)).max(least);
    found.require(
        (least..=most).contains(&rods),
        "/scene/abradable/rods_around",
        format!(
            "between {least} and {most} rods: blades share none ({RODS_PER_SECTOR} for every sector), and the {} rows \
             together keep to {}",
            facts.contact_nodes,
            limits::RODS
        ),
    );
    if let AutoOr::Fixed(steps) = integration.steps_per_revolution {
        found.require(
            steps >= rods,
            "/integration/steps_per_revolution",
            format!("a step must not jump a rod of the coating: at least {rods} steps, or fewer rods_around"),
        );
    }
}

fn check_material(found: &mut Findings, abradable: &Abradable) {
    let Abradable { modulus, yield_stress, hardening, thickness, .. } = *abradable;
    let valid = |value: f64| limits::LENGTH.contains(&value);
    let range = limits::LENGTH;
    found.require(
        valid(modulus),
        "/scene/abradable/modulus",
        format!("Young's modulus of the coating lies {}", between(&range)),
    );
    found.require(
        valid(thickness),
        "/scene/abradable/thickness",
        format!("the coating's thickness is a length {}", between(&range)),
    );
    if !valid(modulus) {
        return;
    }
    found.require(
        yield_stress == 0.0 || (valid(yield_stress) && yield_stress < modulus),
        "/scene/abradable/yield_stress",
        format!(
            "the yield stress lies between 0 and the modulus {modulus}: a coating that yields at a strain of 1 is never worn"
        ),
    );
    found.require(
        valid(hardening) && hardening >= LEAST_HARDENING * modulus,
        "/scene/abradable/hardening",
        format!(
            "the hardening is at least {} of the modulus, {}, and at most {}: below, stresses no longer determine strains",
            LEAST_HARDENING,
            LEAST_HARDENING * modulus,
            range.end()
        ),
    );
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::error::Violation;
    use rubmap_wheel::dynamics::sector::Units;

    fn facts(contact_nodes: u32) -> ModelFacts {
        let unit = |name: &str| name.to_owned();
        let units = Units { length: unit("mm"), force: unit("N"), time: unit("s"), mass: unit("t") };
        let name = unit("wheel");
        ModelFacts {
            name,
            sectors: 10,
            contact_nodes,
            own_dofs: 900,
            speeds_rad_s: vec![0.0],
            units,
            gyroscopic: false,
            contact_radius: None,
            stiffening: None,
        }
    }

    fn friction(coefficient: f64) -> Vec<Violation> {
        let mut found = Findings::default();
        check_friction(&mut found, &Friction { coefficient });
        found.0
    }

    /// Pointers of what is found in a coating with some values changed.
    fn abradable(changed: Value, integration: Value, contact_nodes: u32) -> Vec<String> {
        let mut coating =
            json!({"modulus": 2000.0, "yield_stress": 10.0, "hardening": 100.0, "thickness": 1.5});
        for (field, value) in changed.as_object().unwrap() {
            coating[field] = value.clone();
        }
        let coating: Abradable = serde_json::from_value(coating).unwrap();
        let integration: Integration = serde_json::from_value(integration).unwrap();
        let mut found = Findings::default();
        check_abradable(&mut found, &coating, &integration, &facts(contact_nodes));
        found.0.into_iter().map(|violation| violation.pointer).collect()
    }

    #[test]
    fn sound_requests_pass() {
        for coefficient in [0.0, 0.2, 1.0] {
            assert!(friction(coefficient).is_empty());
        }
        assert!(abradable(json!({}), json!({}), 16).is_empty());
        let fewest = json!({"rods_around": 40, "yield_stress": 0.0});
        assert!(abradable(fewest, json!({"steps_per_revolution": 40}), 2).is_empty());
    }

    #[test]
    fn names_what_is_wrong() {
        for coefficient in [-0.1, 1.1, f64::NAN] {
            assert_eq!(friction(coefficient)[0].pointer, "/scene/friction/coefficient");
        }
        assert_eq!(abradable(json!({}), json!({}), 1), ["/scene/abradable"]);
        for (field, value) in [
            ("modulus", json!(0.0)),
            ("thickness", json!(-1.5)),
            ("yield_stress", json!(2000.0)),
            ("yield_stress", json!(-1.0)),
            ("hardening", json!(1e-4)),
            ("rods_around", json!(39)),
            ("rods_around", json!(u32::MAX)),
        ] {
            let found = abradable(json!({ field: value }), json!({}), 16);
            assert_eq!(found, [format!("/scene/abradable/{field}")]);
        }
        let coarse = json!({"steps_per_revolution": 1999});
        assert_eq!(abradable(json!({}), coarse, 16), ["/integration/steps_per_revolution"]);
    }
}
