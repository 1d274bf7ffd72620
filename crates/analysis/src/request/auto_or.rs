//! A whole number that the program may choose.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Largest number of steps per revolution, given or chosen.
pub(crate) const MOST_STEPS: u32 = 10_000_000;

/// A whole number, or `"auto"`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum AutoOr {
    /// Chosen by the program.
    #[default]
    Auto,
    /// Given number.
    Fixed(u32),
}

impl Serialize for AutoOr {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Auto => serializer.serialize_str("auto"),
            Self::Fixed(number) => serializer.serialize_u32(*number),
        }
    }
}

impl<'de> Deserialize<'de> for AutoOr {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = AutoOr;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"auto\" or a whole number")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
                if text == "auto" {
                    Ok(AutoOr::Auto)
                } else {
                    Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
                }
            }

            fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<Self::Value, E> {
                u32::try_from(number)
                    .map(AutoOr::Fixed)
                    .map_err(|_| E::invalid_value(serde::de::Unexpected::Unsigned(number), &self))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

#[cfg(feature = "schema")]
mod schema {
    use utoipa::{PartialSchema, ToSchema};

    use super::{AutoOr, MOST_STEPS};

    impl PartialSchema for AutoOr {
        fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::schema::Schema> {
            use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, Type};
            OneOfBuilder::new()
                .description(Some("A whole number, or `auto` for one that the program chooses."))
                .item(ObjectBuilder::new().schema_type(Type::String).enum_values(Some(["auto"])))
                .item(
                    ObjectBuilder::new()
                        .schema_type(Type::Integer)
                        .minimum(Some(1))
                        .maximum(Some(MOST_STEPS)),
                )
                .into()
        }
    }

    impl ToSchema for AutoOr {}
}
