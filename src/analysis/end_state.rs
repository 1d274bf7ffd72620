//! Where the wheel is when a run ends: what the next speed of a sweep up or down starts from.

use serde::{Deserialize, Serialize};

/// The wheel at the end of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EndState(pub Vec<f64>);
