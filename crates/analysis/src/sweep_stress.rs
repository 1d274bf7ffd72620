//! Stress over the speeds of a sweep.

use crate::model::ModelFacts;
use crate::resolved::ResolvedSweep;
use crate::result::Strengths;
use crate::result::point::Point;
use crate::result::sweep_stress::{SpeedStress, SweepStress};
use rubmap_wheel::revision::VERSION;

/// Strengths by which a sweep is judged: those that it gives itself in place of the model's.
pub fn strengths_of_sweep(request: &ResolvedSweep, facts: &ModelFacts) -> Vec<Strengths> {
    let given = request.strengths();
    let of_set = |set: &Strengths| given(&set.set).map_or_else(|| set.clone(), |given| set.given(given));
    facts.mesh.iter().flat_map(|mesh| &mesh.sets).map(of_set).collect()
}

/// Stress of the points that have any; the facts of the model give the strengths of its materials.
pub fn sweep_stress(request: &ResolvedSweep, facts: &ModelFacts, points: &[Point]) -> SweepStress {
    SweepStress {
        speeds: points.iter().filter_map(SpeedStress::of).collect(),
        strengths: strengths_of_sweep(request, facts),
        units: facts.units.clone(),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    }
}
