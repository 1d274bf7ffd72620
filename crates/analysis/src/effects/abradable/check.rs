//! Checks of an abradable coating.

use super::request::Abradable;
use crate::model::ModelFacts;
use crate::request::AutoOr;
use crate::resolve::findings::{Findings, between};
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::contact::coating::{LEAST_HARDENING, RODS_PER_SECTOR};

/// Largest number of rods of a coating, all rows together: the wear map of a result has a number for each.
const RODS: u32 = 1 << 20;

/// Checks the coating, and that time steps are fine enough for its rods.
pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(abradable) = &request.scene.abradable else { return };
    found.require(
        facts.contact_nodes >= 2,
        "/scene/abradable",
        "a coating covers what the line of contact nodes sweeps, and the model has a single one: export more",
    );
    check_material(found, abradable);
    let rods = abradable.rods_around;
    let least = u32::try_from(RODS_PER_SECTOR).unwrap_or(u32::MAX).saturating_mul(facts.sectors);
    let most = (RODS / facts.contact_nodes.max(1)).max(least);
    found.require(
        (least..=most).contains(&rods),
        "/scene/abradable/rods_around",
        format!(
            "between {least} and {most} rods: blades share none ({RODS_PER_SECTOR} for every sector), and the {} rows \
             together keep to {}",
            facts.contact_nodes,
            RODS
        ),
    );
    if let AutoOr::Fixed(steps) = request.integration.steps_per_revolution {
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
    use crate::resolved::from_json;

    /// Pointers of what is found in a coating with some values changed.
    fn abradable(changed: Value, integration: Value, contact_nodes: u32) -> Vec<String> {
        let mut coating =
            json!({"modulus": 2000.0, "yield_stress": 10.0, "hardening": 100.0, "thickness": 1.5});
        for (field, value) in changed.as_object().unwrap() {
            coating[field] = value.clone();
        }
        let request = from_json::sweep(json!({
            "model": "", "speeds": {"values": [1.0], "unit": "rad_s"},
            "scene": {"abradable": coating}, "integration": integration
        }));
        let mut found = Findings::default();
        check(&mut found, &request, &ModelFacts::of_ten_sectors(contact_nodes));
        found.0.into_iter().map(|violation| violation.pointer).collect()
    }

    #[test]
    fn sound_coatings_pass() {
        assert!(abradable(json!({}), json!({}), 16).is_empty());
        let fewest = json!({"rods_around": 40, "yield_stress": 0.0});
        assert!(abradable(fewest, json!({"steps_per_revolution": 40}), 2).is_empty());
    }

    #[test]
    fn names_what_is_wrong() {
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
