//! Evaluations of a fit: frequencies of the targets at one point, kept for searches that go on later.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

/// Frequency of a target at one point of the unknowns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Natural frequency ω at the target's speed, rad/s.
    pub omega: f64,
    /// Growth dω/d ln Ω with the speed, rad/s.
    pub growth: f64,
    /// Rank of the mode in its nodal diameter at the target's speed, from 0.
    pub rank: usize,
    /// Modal assurance of the mode with the shape that is followed.
    pub assurance: f64,
}

/// Frequencies of all targets at one point, with shapes followed from another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluation {
    /// Point at which the families were named.
    pub from: Vec<f64>,
    /// Point of the evaluation: parameters as fractions of their bounds, then the logarithm of a free unit in Hz.
    pub at: Vec<f64>,
    /// Outcome of the evaluation.
    pub outcome: Outcome,
}

/// Outcome of an evaluation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Rows of the targets, in their order.
    Rows(Vec<Row>),
    /// Reason why the point gives no valid wheel.
    Failed(String),
}

/// Keeper of what a fit has computed, and listener to its progress.
pub trait Keeper: Sync {
    /// Takes an evaluation that was computed; called from any thread, in any order.
    fn evaluated(&self, evaluation: &Evaluation);

    /// Takes the end of the search from starting point `start`, from 0, and the root mean square of its weighted differences.
    fn ended(&self, start: usize, weighted_rms: f64);
}

/// Evaluations that are known, by their points to the last bit.
pub(crate) struct Memo<'a> {
    known: Mutex<HashMap<Vec<u64>, Outcome>>,
    keeper: &'a dyn Keeper,
}

impl<'a> Memo<'a> {
    /// Memo of the evaluations that are `known` already.
    pub(crate) fn new(known: Vec<Evaluation>, keeper: &'a dyn Keeper) -> Self {
        let entry = |known: Evaluation| (key(&known.from, &known.at), known.outcome);
        Self { known: Mutex::new(known.into_iter().map(entry).collect()), keeper }
    }

    /// Outcome of an evaluation, computed where it is not known.
    pub(crate) fn outcome(&self, from: &[f64], at: &[f64], compute: impl FnOnce() -> Outcome) -> Outcome {
        let key = key(from, at);
        if let Some(known) = self.lock().get(&key) {
            return known.clone();
        }
        let outcome = compute();
        let evaluation = Evaluation { from: from.to_vec(), at: at.to_vec(), outcome: outcome.clone() };
        self.keeper.evaluated(&evaluation);
        self.lock().insert(key, evaluation.outcome);
        outcome
    }

    /// Listener of the fit.
    pub(crate) fn keeper(&self) -> &dyn Keeper {
        self.keeper
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<Vec<u64>, Outcome>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn key(from: &[f64], at: &[f64]) -> Vec<u64> {
    from.iter().chain(at).map(|value| value.to_bits()).collect()
}
