//! Checks of Coriolis forces.

use crate::model::ModelFacts;
use crate::resolve::findings::Findings;

/// Checks Coriolis forces that are asked for at `pointer` of a request.
pub(crate) fn check(found: &mut Findings, coriolis: bool, pointer: &str, facts: &ModelFacts) {
    found.require(
        !coriolis || facts.gyroscopic,
        pointer,
        "the model has no gyroscopic matrix, so there are no Coriolis forces to simulate: set this to false, or upload a \
         package with the entry `gyroscopic`",
    );
}
