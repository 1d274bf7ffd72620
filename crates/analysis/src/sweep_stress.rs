//! Stress over the speeds of a sweep.

use crate::model::ModelFacts;
use crate::resolved::ResolvedSweep;
use crate::result::Strengths;
use crate::result::point::Point;
use crate::result::sweep_stress::{SpeedStress, SweepStress};
use rubmap_wheel::revision::VERSION;

/// Stress of the points that have any; the facts of the model give the strengths of its materials.
pub fn sweep_stress(request: &ResolvedSweep, facts: &ModelFacts, points: &[Point]) -> SweepStress {
    SweepStress {
        speeds: points.iter().filter_map(SpeedStress::of).collect(),
        strengths: Strengths::of_sweep(request, facts),
        units: facts.units.clone(),
        settings: request.clone().into(),
        version: VERSION.to_owned(),
    }
}
