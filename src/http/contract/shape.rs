//! Shape of a JSON value, read from a JSON schema and described in words.

use serde_json::Value;

/// Shape that a JSON value must have.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shape {
    /// `null`.
    Null,
    /// `true` or `false`.
    Truth,
    /// A whole number from `least` to `most`.
    Whole { least: i128, most: i128 },
    /// A number within bounds.
    Number(Bounds),
    /// A text of at most `longest` characters.
    Text { longest: Option<usize> },
    /// A text that is one of these words.
    Word(Vec<String>),
    /// A list of `shortest` to `longest` entries.
    List { entries: Box<Shape>, shortest: usize, longest: Option<usize> },
    /// An object that has these fields and no others.
    Object(Vec<Field>),
    /// An object whose fields have any names and values of this shape.
    Named(Box<Shape>),
    /// A value of one of these shapes.
    OneOf(Vec<Shape>),
}

/// A field of an object.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub(super) name: String,
    pub(super) required: bool,
    pub(super) shape: Shape,
}

/// Bounds of a number.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Bounds {
    least: Option<f64>,
    most: Option<f64>,
    above: Option<f64>,
    below: Option<f64>,
}

/// A value that is neither list nor object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scalar<'a> {
    Null,
    Truth(bool),
    Whole(i128),
    Number(f64),
    Text(&'a str),
}

impl Shape {
    /// Reads the shape from a schema; `schemas` has those that it may refer to.
    pub(super) fn of(schema: &Value, schemas: &Value) -> Self {
        if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
            return Self::of(&schemas[name], schemas);
        }
        if let Some(choices) = schema["oneOf"].as_array() {
            return Self::OneOf(choices.iter().map(|choice| Self::of(choice, schemas)).collect());
        }
        match &schema["type"] {
            Value::Array(types) => {
                let types = types.iter().filter_map(Value::as_str);
                Self::OneOf(types.map(|name| Self::of_type(name, schema, schemas)).collect())
            }
            name => Self::of_type(name.as_str().unwrap_or_default(), schema, schemas),
        }
    }

    fn of_type(name: &str, schema: &Value, schemas: &Value) -> Self {
        let size = |keyword: &str| schema[keyword].as_u64().map(|size| size as usize);
        let words = |list: &Value| -> Vec<String> {
            list.as_array()
                .into_iter()
                .flatten()
                .filter_map(|word| word.as_str().map(ToOwned::to_owned))
                .collect()
        };
        match name {
            "boolean" => Self::Truth,
            "integer" => {
                // Formats of OpenAPI are signed; what the service counts is not.
                let most = if schema["format"] == "int32" { u32::MAX.into() } else { u64::MAX.into() };
                let bound = |keyword: &str| schema[keyword].as_i64().map(i128::from);
                let most = bound("maximum").unwrap_or(most);
                Self::Whole { least: bound("minimum").unwrap_or(0), most }
            }
            "number" => Self::Number(Bounds {
                least: schema["minimum"].as_f64(),
                most: schema["maximum"].as_f64(),
                above: schema["exclusiveMinimum"].as_f64(),
                below: schema["exclusiveMaximum"].as_f64(),
            }),
            "string" if schema["enum"].is_array() => Self::Word(words(&schema["enum"])),
            "string" => Self::Text { longest: size("maxLength") },
            "array" => Self::List {
                entries: Box::new(Self::of(&schema["items"], schemas)),
                shortest: size("minItems").unwrap_or(0),
                longest: size("maxItems"),
            },
            "object" if schema["additionalProperties"].is_object() => {
                Self::Named(Box::new(Self::of(&schema["additionalProperties"], schemas)))
            }
            "object" => {
                let required = words(&schema["required"]);
                let fields = schema["properties"].as_object().into_iter().flatten();
                Self::Object(
                    fields
                        .map(|(name, schema)| Field {
                            name: name.clone(),
                            required: required.contains(name),
                            shape: Self::of(schema, schemas),
                        })
                        .collect(),
                )
            }
            _ => Self::Null,
        }
    }

    /// Whether the shape admits this value.
    pub(super) fn admits(&self, value: Scalar) -> bool {
        match (self, value) {
            (Self::OneOf(choices), value) => choices.iter().any(|choice| choice.admits(value)),
            (Self::Null, Scalar::Null) | (Self::Truth, Scalar::Truth(_)) => true,
            (Self::Whole { least, most }, Scalar::Whole(number)) => (least..=most).contains(&&number),
            (Self::Number(bounds), Scalar::Whole(number)) => bounds.contain(number as f64),
            (Self::Number(bounds), Scalar::Number(number)) => bounds.contain(number),
            (Self::Text { longest }, Scalar::Text(text)) => {
                longest.is_none_or(|longest| text.chars().nth(longest).is_none())
            }
            (Self::Word(words), Scalar::Text(text)) => words.iter().any(|word| word == text),
            _ => false,
        }
    }

    /// List that the shape admits: the shape of its entries, and their least and greatest number.
    pub(super) fn list(&self) -> Option<(&Self, usize, usize)> {
        match self {
            Self::OneOf(choices) => choices.iter().find_map(Self::list),
            Self::List { entries, shortest, longest } => {
                Some((entries.as_ref(), *shortest, longest.unwrap_or(usize::MAX)))
            }
            _ => None,
        }
    }

    /// Fields of the object that the shape admits.
    pub(super) fn fields(&self) -> Option<&[Field]> {
        match self {
            Self::OneOf(choices) => choices.iter().find_map(Self::fields),
            Self::Object(fields) => Some(fields),
            _ => None,
        }
    }

    /// Shape of the values of an object whose fields have any names, if the shape admits one.
    pub(super) fn named(&self) -> Option<&Self> {
        match self {
            Self::OneOf(choices) => choices.iter().find_map(Self::named),
            Self::Named(values) => Some(values),
            _ => None,
        }
    }
}

impl Bounds {
    fn contain(&self, number: f64) -> bool {
        self.least.is_none_or(|least| number >= least)
            && self.most.is_none_or(|most| number <= most)
            && self.above.is_none_or(|above| number > above)
            && self.below.is_none_or(|below| number < below)
    }
}

/// Describes the shape, as in "expected a whole number from 1 to 100".
impl std::fmt::Display for Shape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Null => f.write_str("null"),
            Self::Truth => f.write_str("true or false"),
            Self::Whole { least, most } => write!(f, "a whole number from {least} to {most}"),
            Self::Number(bounds) => write!(f, "a number{bounds}"),
            Self::Text { longest: None } => f.write_str("a text"),
            Self::Text { longest: Some(longest) } => write!(f, "a text of at most {longest} characters"),
            Self::Word(words) => match &words[..] {
                [word] => write!(f, "{word:?}"),
                words => write!(f, "one of {}", words.join(", ")),
            },
            Self::List { shortest: 0, longest: None, .. } => f.write_str("a list"),
            Self::List { shortest: 0, longest: Some(longest), .. } => {
                write!(f, "a list of at most {longest} entries")
            }
            Self::List { shortest, longest: Some(longest), .. } if shortest == longest => {
                write!(f, "a list of {shortest} entries")
            }
            Self::List { shortest, longest: None, .. } => write!(f, "a list of at least {shortest} entries"),
            Self::List { shortest, longest: Some(longest), .. } => {
                write!(f, "a list of {shortest} to {longest} entries")
            }
            Self::Object(fields) if fields.is_empty() => f.write_str("an object without fields, {}"),
            Self::Object(fields) => {
                let (required, optional): (Vec<_>, Vec<_>) = fields.iter().partition(|field| field.required);
                match (names(required), names(optional)) {
                    (required, optional) if required.is_empty() => {
                        write!(f, "an object with any of the fields {optional}")
                    }
                    (required, optional) if optional.is_empty() => {
                        write!(f, "an object with the fields {required}")
                    }
                    (required, optional) => {
                        write!(f, "an object with the fields {required} and, if wanted, {optional}")
                    }
                }
            }
            Self::Named(values) => write!(f, "an object whose fields are {values}"),
            Self::OneOf(choices) => {
                for (index, choice) in choices.iter().enumerate() {
                    write!(f, "{}{choice}", if index == 0 { "" } else { ", or " })?;
                }
                Ok(())
            }
        }
    }
}

/// Joins the names of fields, as in "a, b, c".
pub(super) fn names<'a>(fields: impl IntoIterator<Item = &'a Field>) -> String {
    fields.into_iter().map(|field| field.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// Describes the bounds, as in " from 0 to 1" and " above 0 and below 1".
impl std::fmt::Display for Bounds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let (Some(least), Some(most)) = (self.least, self.most) {
            return write!(f, " from {} to {}", Brief(least), Brief(most));
        }
        let mut joint = "";
        for (words, bound) in [
            ("of at least", self.least),
            ("above", self.above),
            ("of at most", self.most),
            ("below", self.below),
        ] {
            if let Some(bound) = bound {
                write!(f, "{joint} {words} {}", Brief(bound))?;
                joint = " and";
            }
        }
        Ok(())
    }
}

/// Number that is written without strings of zeros.
struct Brief(f64);

impl std::fmt::Display for Brief {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(number) = self;
        if *number == 0.0 || (1e-4..1e7).contains(&number.abs()) {
            write!(f, "{number}")
        } else {
            write!(f, "{number:e}")
        }
    }
}

/// Describes the value, as in "not the text "fast"".
impl std::fmt::Display for Scalar<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Null => f.write_str("null"),
            Self::Truth(truth) => write!(f, "{truth}"),
            Self::Whole(number) => write!(f, "{number}"),
            Self::Number(number) => write!(f, "{}", Brief(*number)),
            Self::Text(text) => write!(f, "the text {:?}", super::super::problem::excerpt(text)),
        }
    }
}
