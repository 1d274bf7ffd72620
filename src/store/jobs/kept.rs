//! Resolved request of a job in the table of jobs.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::analysis::kinds::kind::ResolvedJob;
use crate::kinds::JobKind;
use crate::store::error::StoreError;

/// Version of the form in which requests are stored; a change of it needs a migration.
const SCHEMA: u32 = 1;

/// Request as it is stored.
#[derive(Serialize, Deserialize)]
struct Kept<'a> {
    schema: u32,
    /// Number of the last lists of speeds that `refine` has added.
    rounds: u32,
    #[serde(borrow)]
    request: &'a RawValue,
}

/// Writes the resolved request of a job.
pub(super) fn write(job: &dyn ResolvedJob) -> Result<String, serde_json::Error> {
    let text = job.text()?;
    let request = serde_json::from_str(&text)?;
    serde_json::to_string(&Kept { schema: SCHEMA, rounds: job.rounds(), request })
}

/// Reads the resolved request of a job of this `kind`.
pub(in crate::store) fn read(kind: JobKind, json: &str) -> Result<Arc<dyn ResolvedJob>, StoreError> {
    let unknown = |value: String| StoreError::Unknown { column: "jobs.request", value };
    let Kept { schema, rounds, request } = serde_json::from_str(json)?;
    if schema != SCHEMA {
        return Err(unknown(format!("schema {schema}")));
    }
    (kind.stored)(request.get(), rounds).map_err(|error| unknown(error.to_string()))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::analysis::resolved::ResolvedSweep;

    fn sweep(speeds: serde_json::Value, rounds: u32) -> String {
        let request = json!({"model": "m", "modes_per_speed": 20, "scene": {"mistuning": {"spread": 0.01, "seed": 3}}, "speeds": speeds});
        json!({"schema": 1, "rounds": rounds, "request": request}).to_string()
    }

    fn sweeps() -> JobKind {
        JobKind::named("sweep").unwrap()
    }

    fn read_sweep(kept: &str) -> ResolvedSweep {
        read(sweeps(), kept).unwrap().get::<ResolvedSweep>().unwrap().clone()
    }

    #[test]
    fn what_is_kept_reads_as_it_was() {
        let list = |value: f64| json!({"values": [value], "unit": "hz"});
        for (speeds, rounds) in
            [(list(1.0), 0), (json!([list(1.0)]), 0), (json!([list(1.0), list(2.0), list(1.5)]), 2)]
        {
            let first = read_sweep(&sweep(speeds, rounds));
            assert_eq!(read_sweep(&write(&first).unwrap()), first);
            assert_eq!((first.speeds().rounds(), first.speeds().count()), (rounds, rounds + 1));
        }
    }

    /// Defaults are filled in before a request is stored: a later change of a default changes no stored request.
    #[test]
    fn what_is_kept_marches_as_long_as_was_asked() {
        let integration = |kept: &ResolvedSweep| {
            let kept: serde_json::Value = serde_json::from_str(&write(kept).unwrap()).unwrap();
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
        let resolved = read_sweep(&kept);
        assert_eq!(integration(&resolved), Some(json!(50)));
        assert_eq!(resolved.unrefined().integration.revolutions(), 50);
        // New requests store the word `auto` instead of omitting the value.
        let now = read_sweep(&sweep(speeds, 0));
        assert_eq!(integration(&now), Some(json!("auto")));
    }

    #[test]
    fn what_cannot_have_been_kept_is_not_guessed_at() {
        let no_speed = sweep(json!({"values": [-1.0], "unit": "hz"}), 0);
        let later = sweep(json!({"values": [1.0], "unit": "hz"}), 0).replace("\"schema\":1", "\"schema\":9");
        for kept in [no_speed.as_str(), &later, "{}"] {
            assert!(read(sweeps(), kept).is_err(), "{kept}");
        }
    }
}
