//! Checks of a friction coefficient.

use crate::model::ModelFacts;
use crate::resolve::findings::Findings;
use crate::resolved::ResolvedSweep;

/// The coefficient in a request.
pub(super) const AT: &str = "/scene/friction/coefficient";

/// What can be said of friction before a wheel is reduced; whether it jams is found out at every speed.
pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, _: &ModelFacts) {
    let Some(friction) = &request.scene.friction else { return };
    found.require((0.0..=1.0).contains(&friction.coefficient), AT, "a friction coefficient lies in [0, 1]");
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
            request.scene.friction = Some(Friction { coefficient });
            let mut found = Findings::default();
            check(&mut found, &request, &ModelFacts::of_ten_sectors(16));
            assert_eq!(found.refused(AT), refused, "{coefficient}");
            assert_eq!(found.0.len(), usize::from(refused), "{coefficient}");
        }
    }
}
