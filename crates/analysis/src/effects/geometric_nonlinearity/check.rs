//! Checks of blades that bend far.

use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;
use rubmap_wheel::dynamics::bending::MOST_COORDINATES;

const AT: &str = "/scene/geometric_nonlinearity";

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, facts: &ModelFacts) {
    let Some(asked) = &request.scene.geometric_nonlinearity else { return };
    check_bending(found, (asked.coordinates, AT), request.fields(), facts);
    found.require(
        request.scene.friction.is_none(),
        "/scene/friction",
        "friction cannot be combined with blades that bend far: remove `friction` or `geometric_nonlinearity` from the scene",
    );
}

/// Checks the bending of second order in so many coordinates, asked for at a pointer.
pub(crate) fn check_bending(
    found: &mut Findings,
    (coordinates, at): (u32, &str),
    fields: Option<bool>,
    facts: &ModelFacts,
) {
    found.require(
        facts.mesh.is_some(),
        at,
        format!(
            "the model has no mesh, from which the bending of blades is computed: upload a package with elements, or remove `{}`",
            at[1..].replace('/', ".")
        ),
    );
    found.require(
        fields != Some(false),
        "/fields",
        format!(
            "`{}` needs the fields of the whole wheel: remove `fields` or set it to true",
            at[1..].replace('/', ".")
        ),
    );
    found.require(
        (1..=MOST_COORDINATES as u32).contains(&coordinates),
        &format!("{at}/coordinates"),
        format!("between 1 and {MOST_COORDINATES} coordinates"),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolved::from_json;

    #[test]
    fn refusals_point_at_their_fields() {
        let pointers = |scene: serde_json::Value| {
            let request = from_json::sweep(serde_json::json!({
                "model": "", "speeds": {"values": [1.0], "unit": "rad_s"}, "scene": scene, "integration": {}
            }));
            let mut found = Findings::default();
            check(&mut found, &request, &ModelFacts::of_ten_sectors(16));
            found.0.into_iter().map(|violation| violation.pointer).collect::<Vec<_>>()
        };
        // The model has no mesh.
        let bent = |coordinates: u32| serde_json::json!({"include": "full", "coordinates": coordinates});
        assert_eq!(pointers(serde_json::json!({})), [""; 0]);
        assert_eq!(pointers(serde_json::json!({"geometric_nonlinearity": bent(4)})), [AT]);
        for coordinates in [0, 9] {
            let refused = pointers(serde_json::json!({"geometric_nonlinearity": bent(coordinates)}));
            assert_eq!(refused, [AT.to_owned(), format!("{AT}/coordinates")]);
        }
        let friction = serde_json::json!({"coefficient": 0.1});
        let refused = pointers(serde_json::json!({"geometric_nonlinearity": bent(2), "friction": friction}));
        assert_eq!(refused, [AT, "/scene/friction"]);
    }
}
