//! Checks of a friction coefficient.

use super::request::FrictionLaw;
use crate::model::ModelFacts;
use crate::request::SchemeChoice;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;

/// JSON pointers to the coefficient in a request, and to the law.
pub(super) const AT: &str = "/scene/friction/coefficient";
const LAW: &str = "/scene/friction/law";

/// Checks what can be said of friction before a wheel is reduced; whether it jams is found out at every speed.
pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, _: &ModelFacts) {
    let Some(friction) = &request.scene.friction else { return };
    found.require((0.0..=1.0).contains(&friction.coefficient), AT, "a friction coefficient lies in [0, 1]");
    if friction.law == FrictionLaw::Sliding {
        return;
    }
    found.require(
        request.scene.abradable.is_none(),
        LAW,
        "a disc of friction needs a rigid wall to stick to, not a coating that is worn: take the law sliding",
    );
    found.require(
        request.integration.scheme != SchemeChoice::MasslessBoundary,
        LAW,
        "tips stick by their velocity, which a boundary without mass has none of its own: take the scheme exact_modal, \
         central_differences or auto, or the law sliding",
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::friction::request::Friction;
    use crate::resolved::from_json;

    #[test]
    fn a_coefficient_lies_between_0_and_1() {
        let mut request = from_json::sweep(serde_json::json!({
            "model": "", "speeds": {"values": [1.0], "unit": "rad_s"}, "scene": {}, "integration": {}
        }));
        for (coefficient, refused) in
            [(0.0, false), (0.2, false), (1.0, false), (-0.1, true), (1.1, true), (f64::NAN, true)]
        {
            request.scene.friction = Some(Friction { coefficient, law: FrictionLaw::Sliding });
            let mut found = Findings::default();
            check(&mut found, &request, &ModelFacts::of_ten_sectors(16));
            assert_eq!(found.refused(AT), refused, "{coefficient}");
            assert_eq!(found.0.len(), usize::from(refused), "{coefficient}");
        }
    }

    #[test]
    fn a_disc_takes_no_coating_and_no_boundary_without_mass() {
        let pointers = |scheme: &str, coated: bool, law: &str| {
            let mut scene = serde_json::json!({"friction": {"coefficient": 0.1, "law": law}});
            if coated {
                scene["abradable"] = serde_json::json!({
                    "modulus": 2000.0, "yield_stress": 10.0, "hardening": 100.0, "thickness": 1.5
                });
            }
            let request = from_json::sweep(serde_json::json!({
                "model": "", "speeds": {"values": [1.0], "unit": "rad_s"}, "scene": scene,
                "integration": {"scheme": scheme}
            }));
            let mut found = Findings::default();
            check(&mut found, &request, &ModelFacts::of_ten_sectors(16));
            found.0.into_iter().map(|violation| violation.pointer).collect::<Vec<_>>()
        };
        for (scheme, coated, refusals) in [
            ("auto", false, 0),
            ("exact_modal", false, 0),
            ("central_differences", false, 0),
            ("massless_boundary", false, 1),
            ("auto", true, 1),
            ("massless_boundary", true, 2),
        ] {
            assert_eq!(pointers(scheme, coated, "disc"), vec![LAW; refusals], "{scheme} {coated}");
            assert!(pointers(scheme, coated, "sliding").is_empty());
        }
    }
}
