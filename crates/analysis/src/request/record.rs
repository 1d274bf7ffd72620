//! Requests for recordings beside spectra.

use std::collections::BTreeMap;

use rubmap_solid::material::GivenStrengths;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Recordings of a sweep beside spectra.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Histories of some speeds of the sweep, which are simulated once more for them when all are finished: to the bit, since recording changes no
    /// run. A plan counts the speeds that are named by index.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub histories: Option<HistoriesRequest>,
    /// Stress of every speed, and the margin that it leaves: the largest von Mises stress over the last revolution, and the most
    /// utilised places. Needs a model with a mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<StressRequest>,
}

/// Stress of every speed; `{}` asks for it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct StressRequest {
    /// Radius about the contact nodes of any blade within which nodes are left out, in the model's unit of length: forces act on points there, and no
    /// stress is claimed. Default: the mean distance of neighbouring contact nodes; a model with one contact node has no default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excluded_radius: Option<f64>,
    /// Strengths of materials by the name of their element set, in place of those that the model has.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub strengths: BTreeMap<String, GivenStrengths>,
}

impl Record {
    /// Whether states are to be recorded.
    pub fn wants_states(&self) -> bool {
        self.histories.as_ref().is_some_and(HistoriesRequest::wants_states)
    }

    pub(crate) fn is_nothing(&self) -> bool {
        *self == Self::default()
    }
}

/// Histories to record: speeds, revolutions and quantities.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct HistoriesRequest {
    /// Indices of speeds in the request, or `critical` (default) for the critical speeds of all sensors.
    #[serde(default)]
    pub speeds: HistorySpeeds,
    /// Whole revolutions after which recording begins and ends, as in a case study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 2, max_items = 2))]
    pub revolutions: Option<[u32; 2]>,
    /// Quantities to record, as in a case study.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 6))]
    pub quantities: Vec<RecordedQuantity>,
}

impl HistoriesRequest {
    /// Revolutions and quantities to record.
    pub(crate) fn recorded(&self) -> Recorded {
        Recorded { revolutions: self.revolutions, quantities: self.quantities.clone() }
    }

    /// Whether states are to be recorded.
    pub fn wants_states(&self) -> bool {
        self.recorded().wants(RecordedQuantity::State)
    }
}

/// Revolutions and quantities to record.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Recorded {
    /// Whole revolutions after which recording begins and ends; default: the window, or the period that stands for it; with `state` the last revolution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 2, max_items = 2))]
    pub revolutions: Option<[u32; 2]>,
    /// Quantities to record; default: everything but `state`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 6))]
    pub quantities: Vec<RecordedQuantity>,
}

/// Quantity that can be recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum RecordedQuantity {
    /// Displacements of the sensors.
    Displacement,
    /// Velocities of the sensors.
    Velocity,
    /// Force on every contact node of every blade.
    ContactForce,
    /// Number of nodes in contact, and length of the contact lines that touches.
    Contact,
    /// Energy and its parts.
    Energy,
    /// State of the whole wheel, in the coordinates of the reduction, which `GET /v1/jobs/{id}/fields` needs. It is large, and recorded only if it is
    /// named.
    State,
}

impl Recorded {
    /// Whether `quantity` is asked for.
    pub fn wants(&self, quantity: RecordedQuantity) -> bool {
        let by_default = self.quantities.is_empty() && quantity != RecordedQuantity::State;
        by_default || self.quantities.contains(&quantity)
    }
}

/// Speeds of a sweep whose histories are recorded: by index, or the critical ones.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum HistorySpeeds {
    /// Critical speeds of all sensors, once they are known.
    #[default]
    Critical,
    /// Indices of speeds, counted from 0 in the order of the request.
    Indices(Vec<u32>),
}

const CRITICAL: &str = "critical";

impl Serialize for HistorySpeeds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Critical => serializer.serialize_str(CRITICAL),
            Self::Indices(indices) => indices.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for HistorySpeeds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = HistorySpeeds;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"critical\" or a list of indices of speeds")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
                if text == CRITICAL {
                    Ok(HistorySpeeds::Critical)
                } else {
                    Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
                }
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
                let list = serde::de::value::SeqAccessDeserializer::new(list);
                Vec::deserialize(list).map(HistorySpeeds::Indices)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

#[cfg(feature = "schema")]
mod schema {
    use utoipa::{PartialSchema, ToSchema};

    use super::{CRITICAL, HistorySpeeds};

    impl PartialSchema for HistorySpeeds {
        fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::schema::Schema> {
            use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, OneOfBuilder, Type};
            let index =
                ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0)).maximum(Some(u32::MAX));
            OneOfBuilder::new()
                .description(Some(
                    "Indices of speeds in the request, or `critical` for the critical speeds of all sensors.",
                ))
                .item(ObjectBuilder::new().schema_type(Type::String).enum_values(Some([CRITICAL])))
                .item(ArrayBuilder::new().items(index))
                .into()
        }
    }

    impl ToSchema for HistorySpeeds {}
}
