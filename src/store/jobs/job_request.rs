//! Request of a job, and its form in the table of jobs.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::job_kind::JobKind;
use crate::analysis::error::Violation;
use crate::analysis::resolved::{
    ResolvedBranches, ResolvedCampaign, ResolvedCaseStudy, ResolvedModalAnalysis, ResolvedRunUps,
    ResolvedStudy, ResolvedSweep,
};
use crate::impeller::ImpellerParameters;
use crate::store::error::StoreError;

/// Request of a job: checked, and with every default filled in.
#[derive(Debug, Clone, PartialEq)]
pub enum JobRequest {
    /// Contact simulations over speeds.
    Sweep(Box<ResolvedSweep>),
    /// Natural frequencies over speeds.
    ModalAnalysis(Box<ResolvedModalAnalysis>),
    /// Model generated from the parameters of the generator.
    ModelGeneration(Box<ImpellerParameters>),
    /// Study of errors and times over a grid of settings.
    Study(Box<ResolvedStudy>),
    /// Case study: detailed results at chosen speeds.
    CaseStudy(Box<ResolvedCaseStudy>),
    /// Branches of periodic responses over a parameter of their scene.
    Branches(Box<ResolvedBranches>),
    /// Run-ups: a scene whose speed changes.
    RunUps(Box<ResolvedRunUps>),
    /// Contact simulations over speeds, of many designs of a scene.
    Campaign(Box<ResolvedCampaign>),
}

/// Version of the form in which requests are stored; a change of it needs a migration.
const SCHEMA: u32 = 1;

/// Request as it is stored.
#[derive(Serialize, Deserialize)]
struct Kept<R> {
    schema: u32,
    /// Number of the last lists of speeds that `refine` has added.
    rounds: u32,
    request: R,
}

impl JobRequest {
    /// Kind of the job.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Sweep(_) => JobKind::Sweep,
            Self::ModalAnalysis(_) => JobKind::ModalAnalysis,
            Self::ModelGeneration(_) => JobKind::ModelGeneration,
            Self::Study(_) => JobKind::Study,
            Self::CaseStudy(_) => JobKind::CaseStudy,
            Self::Branches(_) => JobKind::Branches,
            Self::RunUps(_) => JobKind::RunUp,
            Self::Campaign(_) => JobKind::Campaign,
        }
    }

    /// Whether the whole job must be computed on processors with one kind of vectors.
    pub fn is_of_one_kind(&self) -> bool {
        matches!(self, Self::Sweep(request) if request.is_of_one_kind())
    }

    /// Model that the job computes from, if it does.
    pub fn model(&self) -> Option<&str> {
        match self {
            Self::Sweep(request) => Some(request.model()),
            Self::ModalAnalysis(request) => Some(request.model()),
            Self::ModelGeneration(_) => None,
            Self::Study(request) => Some(request.model()),
            Self::CaseStudy(case) => Some(case.sweep().model()),
            Self::Branches(branches) => Some(branches.sweep().model()),
            Self::RunUps(asked) => Some(asked.sweep().model()),
            Self::Campaign(campaign) => Some(campaign.sweep().model()),
        }
    }

    /// Second model that the job computes from, if it compares two.
    pub fn compared_model(&self) -> Option<&str> {
        match self {
            Self::Campaign(campaign) => campaign.compared_model(),
            _ => None,
        }
    }

    /// Number of speeds by now, of all designs together.
    pub fn speeds(&self) -> u32 {
        match self {
            Self::Sweep(request) => request.speeds().count(),
            Self::ModalAnalysis(request) => request.speeds().count(),
            Self::ModelGeneration(_) => 0,
            // Each run counts as one speed.
            Self::RunUps(asked) => asked.runs(),
            Self::Study(request) => request.speeds().count(),
            Self::CaseStudy(case) => case.speeds().len() as u32,
            Self::Branches(branches) => branches.sweep().speeds().count(),
            Self::Campaign(campaign) => campaign.simulations(),
        }
    }

    /// Largest number of speeds that the request may reach, as far as it tells.
    pub fn speeds_at_most(&self) -> u32 {
        match self {
            Self::Campaign(campaign) => campaign.simulations_at_most(),
            other => other.speeds(),
        }
    }

    /// Number `modes_per_speed` of the reduction that the results rest on, if there is one and it is known.
    pub fn modes_per_speed(&self) -> Option<u32> {
        match self {
            Self::Sweep(request) => request.modes().given(),
            Self::ModalAnalysis(request) => request.modes().given(),
            Self::CaseStudy(case) => case.sweep().modes().given(),
            Self::Branches(branches) => branches.sweep().modes().given(),
            Self::RunUps(asked) => asked.sweep().modes().given(),
            Self::Campaign(campaign) => campaign.sweep().modes().given(),
            Self::ModelGeneration(_) | Self::Study(_) => None,
        }
    }

    pub(super) fn to_json(&self) -> Result<String, serde_json::Error> {
        match self {
            Self::Sweep(request) => kept(request, request.speeds().rounds()),
            Self::ModalAnalysis(request) => kept(request, 0),
            Self::ModelGeneration(parameters) => kept(parameters, 0),
            Self::Study(request) => kept(request, 0),
            Self::CaseStudy(case) => kept(case, case.sweep().speeds().rounds()),
            Self::Branches(branches) => kept(branches, 0),
            Self::RunUps(asked) => kept(asked, 0),
            Self::Campaign(campaign) => kept(campaign, 0),
        }
    }

    pub(in crate::store) fn from_json(kind: JobKind, json: &str) -> Result<Self, StoreError> {
        Ok(match kind {
            JobKind::Sweep => {
                let (request, rounds) = read(json)?;
                Self::Sweep(Box::new(ResolvedSweep::stored(request, rounds).map_err(unsound)?))
            }
            JobKind::ModalAnalysis => {
                Self::ModalAnalysis(Box::new(ResolvedModalAnalysis::stored(read(json)?.0).map_err(unsound)?))
            }
            JobKind::Study => Self::Study(Box::new(ResolvedStudy::stored(read(json)?.0).map_err(unsound)?)),
            JobKind::CaseStudy => {
                let (settings, rounds) = read(json)?;
                Self::CaseStudy(Box::new(ResolvedCaseStudy::stored(settings, rounds).map_err(unsound)?))
            }
            JobKind::Branches => {
                Self::Branches(Box::new(ResolvedBranches::stored(read(json)?.0).map_err(unsound)?))
            }
            JobKind::RunUp => Self::RunUps(Box::new(ResolvedRunUps::stored(read(json)?.0).map_err(unsound)?)),
            JobKind::Campaign => {
                Self::Campaign(Box::new(ResolvedCampaign::stored(read(json)?.0).map_err(unsound)?))
            }
            JobKind::ModelGeneration => Self::ModelGeneration(read(json)?.0),
        })
    }
}

fn kept<R: Serialize>(request: R, rounds: u32) -> Result<String, serde_json::Error> {
    serde_json::to_string(&Kept { schema: SCHEMA, rounds, request })
}

fn read<R: DeserializeOwned>(json: &str) -> Result<(R, u32), StoreError> {
    let Kept { schema, rounds, request } = serde_json::from_str(json)?;
    if schema != SCHEMA {
        return Err(StoreError::Unknown { column: "jobs.request", value: format!("schema {schema}") });
    }
    Ok((request, rounds))
}

fn unsound(violations: Vec<Violation>) -> StoreError {
    let value = violations.iter().map(|violation| format!("{}: {}", violation.pointer, violation.message));
    StoreError::Unknown { column: "jobs.request", value: value.collect::<Vec<_>>().join("; ") }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn sweep(speeds: serde_json::Value, rounds: u32) -> String {
        let request = json!({"model": "m", "modes_per_speed": 20, "scene": {"mistuning": {"spread": 0.01, "seed": 3}}, "speeds": speeds});
        json!({"schema": 1, "rounds": rounds, "request": request}).to_string()
    }

    #[test]
    fn what_is_kept_reads_as_it_was() {
        let list = |value: f64| json!({"values": [value], "unit": "hz"});
        for (speeds, rounds) in
            [(list(1.0), 0), (json!([list(1.0)]), 0), (json!([list(1.0), list(2.0), list(1.5)]), 2)]
        {
            let read = JobRequest::from_json(JobKind::Sweep, &sweep(speeds, rounds)).unwrap();
            assert_eq!(JobRequest::from_json(JobKind::Sweep, &read.to_json().unwrap()).unwrap(), read);
            let JobRequest::Sweep(request) = &read else { panic!("{read:?}") };
            assert_eq!((request.speeds().rounds(), read.speeds()), (rounds, rounds + 1));
        }
    }

    /// Defaults are filled in before a request is stored: a later change of a default changes no stored request.
    #[test]
    fn what_is_kept_marches_as_long_as_was_asked() {
        let integration = |kept: &JobRequest| {
            let kept: serde_json::Value = serde_json::from_str(&kept.to_json().unwrap()).unwrap();
            kept.pointer("/request/integration/revolutions").cloned()
        };
        let speeds = json!({"values": [1.0], "unit": "hz"});
        // Stored when 50 revolutions were the default, before a simulation could end by itself.
        let before = json!({
            "scheme": "auto", "kept_modes": "auto", "steps_per_revolution": "auto", "revolutions": 50,
            "ramp_revolutions": 1.0, "window_revolutions": 20
        });
        let request = json!({"model": "m", "modes_per_speed": 20, "scene": {}, "speeds": speeds, "integration": before});
        let kept = json!({"schema": 1, "rounds": 0, "request": request}).to_string();
        let read = JobRequest::from_json(JobKind::Sweep, &kept).unwrap();
        assert_eq!(integration(&read), Some(json!(50)));
        let JobRequest::Sweep(resolved) = &read else { panic!("{read:?}") };
        assert_eq!(resolved.unrefined().integration.revolutions(), 50);
        // New requests store the word `auto` instead of omitting the value.
        let now = JobRequest::from_json(JobKind::Sweep, &sweep(speeds, 0)).unwrap();
        assert_eq!(integration(&now), Some(json!("auto")));
    }

    #[test]
    fn what_cannot_have_been_kept_is_not_guessed_at() {
        let no_speed = sweep(json!({"values": [-1.0], "unit": "hz"}), 0);
        let later = sweep(json!({"values": [1.0], "unit": "hz"}), 0).replace("\"schema\":1", "\"schema\":9");
        for kept in [no_speed.as_str(), &later, "{}"] {
            assert!(JobRequest::from_json(JobKind::Sweep, kept).is_err(), "{kept}");
        }
    }
}
