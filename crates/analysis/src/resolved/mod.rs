//! Requests as they are stored and run: parsed and held against a model by `resolve`, and sound from then on. Stored requests are parsed again by the
//! functions `stored`, without the model.
//!
//! Speeds are numbers, defaults are filled in, alternatives are enums. The request can be had back, as the `settings` of results, and asked for
//! again.

pub mod branches;
pub mod campaign;
pub mod case_study;
pub mod distribution;
pub mod knobs;
pub mod modal_analysis;
pub mod run_up;
pub mod scene;
pub mod sensor;
pub mod speeds;
pub mod study;
pub mod sweep;
pub mod trial;

pub use branches::ResolvedBranches;
pub use campaign::ResolvedCampaign;
pub use case_study::ResolvedCaseStudy;
pub use distribution::Distribution;
pub use knobs::{Aim, Modes};
pub use modal_analysis::ResolvedModalAnalysis;
pub use run_up::ResolvedRunUps;
pub use scene::Scene;
pub use sensor::ResolvedSensor;
pub use speeds::ResolvedSpeeds;
pub use study::ResolvedStudy;
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
