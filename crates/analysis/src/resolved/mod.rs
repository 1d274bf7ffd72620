//! Requests as they are stored and run: parsed and held against a model by `resolve`, and sound from then on. Stored requests are parsed again by the
//! functions `stored`, without the model.
//!
//! Speeds are numbers, defaults are filled in, alternatives are enums. The request can be had back, as the `settings` of results, and asked for
//! again.

pub mod knobs;
pub mod scene;
pub mod sensor;
pub mod speeds;
pub mod sweep;
pub mod trial;

pub use crate::kinds::branches::resolved::ResolvedBranches;
pub use crate::kinds::campaign::distribution::Distribution;
pub use crate::kinds::campaign::resolved::ResolvedCampaign;
pub use crate::kinds::case_study::resolved::ResolvedCaseStudy;
pub use crate::kinds::modal_analysis::resolved::ResolvedModalAnalysis;
pub use crate::kinds::run_up::resolved::ResolvedRunUps;
pub use crate::kinds::study::resolved::ResolvedStudy;
pub use knobs::{Aim, Modes};
pub use scene::Scene;
pub use sensor::ResolvedSensor;
pub use speeds::ResolvedSpeeds;
pub use sweep::ResolvedSweep;
pub use trial::TrialRequest;

#[cfg(test)]
pub(crate) mod from_json {
    use serde_json::Value;

    use super::{ResolvedSweep, Scene};

    /// Sound scene, checked against no model.
    pub(crate) fn scene(asked: Value) -> Scene {
        Scene::of(serde_json::from_value(asked).unwrap(), &mut |violation| panic!("{violation:?}"))
    }

    /// Sound sweep, checked against no model.
    pub(crate) fn sweep(asked: Value) -> ResolvedSweep {
        ResolvedSweep::stored(serde_json::from_value(asked).unwrap(), 0).unwrap()
    }
}
