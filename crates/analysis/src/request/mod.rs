//! Requests of users, as they come over the wire.

pub mod accuracy;
pub mod auto_or;
pub mod families;
pub mod integration;
pub(crate) mod omit;
pub mod operation;
pub mod record;
pub mod scene;
pub mod sensor;
pub mod setting;
pub mod speeds;
pub mod sweep;

pub use crate::kinds::branches::request::{Along, BranchParameter, BranchesRequest, BranchesSettings};
pub use crate::kinds::campaign::request::{
    CampaignRequest, CampaignSettings, Change, Design, DesignKind, DistributionKind, Parameter, Severity,
    Threshold,
};
pub use crate::kinds::case_study::request::{CaseSpeed, CaseStudyRequest, CaseStudySettings};
pub use crate::kinds::modal_analysis::request::{BackbonesRequest, ModalAnalysisRequest};
pub use crate::kinds::run_up::request::{
    RunUpIntegration, RunUpRequest, RunUpSettings, RunUpSpeed, SpeedCourse, SpeedPoint,
};
pub use crate::kinds::study::request::{Grid, StudyIntegration, StudyRecord, StudyRequest};
pub use accuracy::{Accuracy, AccuracyOf, Budget};
pub use auto_or::AutoOr;
pub use families::FamiliesBy;
pub use integration::{Integration, SchemeChoice, SteadyChoice};
pub use operation::{Limits, OperatingRange, Operation};
pub use record::{HistoriesRequest, HistorySpeeds, Record, Recorded, RecordedQuantity, StressRequest};
pub use scene::Scene;
pub use sensor::{Component, Gauge, Sensor};
pub use setting::Setting;
pub use speeds::{HIGHEST_SPEED, LOWEST_SPEED, MAX_SPEEDS, SpeedSet, SpeedUnit, Speeds};
pub use sweep::{SweepDirection, SweepRequest};
