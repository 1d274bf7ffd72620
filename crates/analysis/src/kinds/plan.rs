//! Plans of jobs of any kind, and what they rest on.

use std::sync::Arc;

use serde::Serialize;
use serde::ser::Error;

use crate::calibration::Calibration;
use crate::model::{ModelFacts, ReducedSector};
use crate::result::{Chosen, Estimate, Machine, PlacedSensor};

/// Machines that a job is planned for.
#[derive(Debug, Clone)]
pub struct Capacity {
    /// Representative machine: the one with most threads.
    pub machine: Machine,
    /// Costs of steps on that machine.
    pub costs: Arc<Calibration>,
    /// Number of threads of all machines.
    pub threads: usize,
}

/// Model that a job computes from, as far as it is known.
#[derive(Debug, Clone)]
pub struct PlannedModel {
    /// Facts of the model.
    pub facts: ModelFacts,
    /// Reduction that the job will rest on, if it is stored.
    pub reduced: Option<Arc<ReducedSector>>,
}

/// Knowledge that a plan rests on.
#[derive(Debug, Clone)]
pub struct Grounds {
    /// Models of the job, in the order of [`ResolvedJob::models`](super::kind::ResolvedJob::models).
    pub models: Vec<PlannedModel>,
    /// Machines that will compute; `None` for a job that integrates nothing.
    pub capacity: Option<Capacity>,
    /// Positions of the sensors that name a node or a point.
    pub placed_sensors: Vec<PlacedSensor>,
    /// Settings that stored runs choose for the accuracy or the budget asked for.
    pub choice: Option<Chosen>,
}

impl Grounds {
    /// Machines that will compute.
    ///
    /// # Errors
    /// If they are not known, which is a defect of the caller for a job that integrates.
    pub(crate) fn capacity(&self) -> serde_json::Result<&Capacity> {
        self.capacity
            .as_ref()
            .ok_or_else(|| Error::custom("the machines of a job that integrates are not known"))
    }
}

/// Plan of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Plan as JSON text.
    pub text: String,
    /// Cost of the whole job, if it can be told.
    pub estimate: Option<Estimate>,
}

impl Plan {
    /// Plan written as JSON.
    ///
    /// # Errors
    /// If it cannot be written, which is a defect.
    pub fn of(plan: &impl Serialize, estimate: Option<Estimate>) -> serde_json::Result<Self> {
        Ok(Self { text: serde_json::to_string(plan)?, estimate })
    }
}
