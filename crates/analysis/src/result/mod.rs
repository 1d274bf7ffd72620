//! Results of computations: numbers with their credentials.

pub mod choice;
pub mod contact;
pub mod errors;
pub mod geometry;
pub mod histories;
pub mod level;
pub mod plan;
pub mod point;
pub mod reduction;
pub mod refinement;
pub mod steady;
pub mod stress;
pub mod surface;
pub mod sweep;
pub mod sweep_stress;
pub mod tip;
pub mod trial;
pub mod validity;
pub mod verdict;
pub mod wheel;

pub use crate::kinds::branches::result::{
    Bifurcation, BifurcationKind, BranchEnd, BranchLeg, BranchMaximum, BranchPoint, BranchTrack, Branches,
    BranchesHead, Track,
};
pub use crate::kinds::campaign::result::{
    Campaign, CampaignDesign, CampaignPlan, CampaignThreshold, Comparison, DesignOutcome, Difference,
    DifferenceVerdict, LimitsMet, ParameterSensitivity, Sensitivities, ThresholdShare, severity_column,
    severity_unit,
};
pub use crate::kinds::modal_analysis::backbone_curves::{BackboneCurve, BackbonePoint, Backbones};
pub use crate::kinds::modal_analysis::interference::{
    AskedInterference, FoldedOrder, Interference, InterferingMode, NearestOrder,
};
pub use crate::kinds::modal_analysis::result::{AbsoluteFrequencies, Campbell, FollowedFamilies, WaveTables};
pub use crate::kinds::run_up::result::{
    LargestOfRun, PassingRate, PlannedRunUp, RunUp, RunUpEnd, RunUpFrame, RunUpLeg, RunUpPlan, RunUps,
    Spectrogram,
};
pub use crate::kinds::study::result::{
    Histories, HistoryLine, SpeedStudy, StepOrder, StudyPlan, StudyReduction, StudyRun, WorkPrecision, front,
};
pub use choice::{Choice, Chosen, ModesChoice, Pilot, TriedModes};
pub use contact::{ContactForces, ContactSummary, ForceMap, ForceRow};
pub use errors::{Control, ErrorEstimate, Errors, PointError, Quantity};
pub use geometry::{ContactPlace, NodeKind, SectorGeometry, SectorNode};
pub use histories::{ContactHistory, EnergyHistory, SensorHistory, SpeedHistories, TipPlace};
pub use level::{LevelSpeed, LevelValue, SweepLevel};
pub use plan::{
    BranchesPlan, CostRange, Estimate, GaugeEnd, Machine, ModalAnalysisPlan, PlacedSensor, PlannedEffect,
    PlannedPoint, PlannedResponse, ReductionState, Spent, SweepPlan,
};
pub use point::{
    EnergyReport, Point, PointStatus, SchemeReport, SensorResponse, SensorSpectrum, SpeedResult, SpeedSpectra,
};
pub use reduction::{
    FrequencyDifference, LargestDifference, PreliminaryStiffening, ReductionReport, StiffeningReport,
    StiffeningVerdict,
};
pub use refinement::{Refinement, Unresolvable, Unresolved};
pub use steady::{FloquetMultiplier, MarchReport, Stability, SteadyReport};
pub use stress::{
    LeadingPlace, PointStress, Strengths, StressCycle, StressPeak, drawn_stress_unit, most_utilised_first,
    stress_unit,
};
pub use surface::{FieldSurface, SurfaceColour};
pub use sweep::{CriticalSpeed, CriticalSpeeds, InteractionMap};
pub use sweep_stress::{SpeedStress, SweepStress};
pub use tip::TipResponse;
pub use trial::{Cost, Trial};
pub use validity::{Validity, ValidityCheck, ValidityLack, ValidityMeasure, ValidityVerdict};
pub use verdict::{
    JudgedSpeed, JudgedValue, LimitKind, OpenKind, OpenQuestion, Position, RangePosition, RangeVerdict,
    Standing, SweepVerdict, VerdictWord, WorstValue,
};
pub use wheel::{SensorView, WheelCriticalSpeed, WheelCriticalSpeeds};

pub use crate::effects::abradable::result::{WearMap, WearReport};
pub use crate::effects::casing::result::{
    AngularGap, FilledHeight, FoundShape, MeasuredCasing, MeasuredSurvey, Outlier, Overshoot,
};
pub use crate::effects::symmetry::result::FoundSymmetry;
pub use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
pub use rubmap_wheel::response::coincidence::Coincidence;
pub use rubmap_wheel::response::settling::{Settling, Verdict};
pub use rubmap_wheel::response::side_bands::SideBands;
pub use rubmap_wheel::response::symmetry_breaking::SymmetryBreaking;
pub use rubmap_wheel::response::veerings::{Course, Veering};
pub use rubmap_wheel::response::waves::{Table, Wave};
