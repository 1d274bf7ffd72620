//! Kinds of jobs that this service computes: those that compute from models, and the one that makes a model.

pub mod generation;

use std::ops::Deref;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use utoipa::openapi::schema::{ObjectBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use self::generation::MODEL_GENERATION;
use crate::analysis::kinds::kind::{Kind, Units};
use crate::analysis::kinds::list::KINDS;

/// Kind of a job, by its row in the list of kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JobKind(pub &'static Kind);

/// All kinds of jobs.
pub fn all() -> impl Iterator<Item = JobKind> {
    KINDS.iter().copied().chain([&MODEL_GENERATION]).map(JobKind)
}

/// Names of the kinds whose jobs are computed in these units.
pub fn names_of(units: Units) -> impl Iterator<Item = &'static str> {
    all().filter(move |kind| kind.units == units).map(|kind| kind.0.name)
}

impl JobKind {
    /// Kind of this name.
    pub fn named(name: &str) -> Option<Self> {
        all().find(|kind| kind.name == name)
    }
}

impl Deref for JobKind {
    type Target = Kind;

    fn deref(&self) -> &Kind {
        self.0
    }
}

impl Serialize for JobKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}

impl<'de> Deserialize<'de> for JobKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::named(&name).ok_or_else(|| D::Error::custom(format!("there is no kind of job {name:?}")))
    }
}

impl ToSchema for JobKind {}

impl PartialSchema for JobKind {
    fn schema() -> RefOr<Schema> {
        let about =
            all().map(|kind| format!("- `{}`: {}", kind.name, kind.about)).collect::<Vec<_>>().join("\n");
        ObjectBuilder::new()
            .schema_type(Type::String)
            .enum_values(Some(all().map(|kind| kind.name)))
            .description(Some(format!("Kind of a job.\n{about}")))
            .into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_names_of_its_own_and_reads_its_own_example() {
        let all: Vec<JobKind> = all().collect();
        for (index, kind) in all.iter().enumerate() {
            assert_eq!(JobKind::named(kind.name), Some(*kind));
            for other in &all[..index] {
                assert_ne!((kind.route, kind.operation), (other.route, other.operation));
            }
            let asked = (kind.read)(kind.example).unwrap();
            assert_eq!(JobKind(asked.kind()), *kind);
            let text = serde_json::to_string(kind).unwrap();
            assert_eq!(serde_json::from_str::<JobKind>(&text).unwrap(), *kind);
        }
        assert!(serde_json::from_str::<JobKind>("\"sweeps\"").is_err());
    }
}
