//! Requests of users, as they come over the wire.

pub mod accuracy;
pub mod auto_or;
pub mod branches;
pub mod campaign;
pub mod case_study;
pub mod integration;
pub mod modal_analysis;
mod omit;
pub mod record;
pub mod run_up;
pub mod scene;
pub mod sensor;
pub mod setting;
pub mod speeds;
pub mod study;
pub mod sweep;

pub use accuracy::{Accuracy, AccuracyOf, Budget};
pub use auto_or::AutoOr;
pub use branches::{Along, BranchParameter, BranchesRequest, BranchesSettings};
pub use campaign::{
    CampaignRequest, CampaignSettings, Change, Design, DesignKind, DistributionKind, Parameter, Severity,
    Threshold,
};
pub use case_study::{CaseSpeed, CaseStudyRequest, CaseStudySettings};
pub use integration::{Integration, SchemeChoice, SteadyChoice};
pub use modal_analysis::ModalAnalysisRequest;
pub use record::{HistoriesRequest, HistorySpeeds, Record, Recorded, RecordedQuantity, StressRequest};
pub use run_up::{RunUpIntegration, RunUpRequest, RunUpSettings, RunUpSpeed, SpeedCourse, SpeedPoint};
pub use scene::Scene;
pub use sensor::{Component, Gauge, Sensor};
pub use setting::Setting;
pub use speeds::{HIGHEST_SPEED, LOWEST_SPEED, MAX_SPEEDS, SpeedSet, SpeedUnit, Speeds};
pub use study::{Grid, StudyIntegration, StudyRecord, StudyRequest};
pub use sweep::{SweepDirection, SweepRequest};
