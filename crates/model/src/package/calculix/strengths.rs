//! Strengths of materials, which decks do not have: a JSON file of them by material or element set.

use std::collections::BTreeMap;
use std::path::Path;

use rubmap_solid::material::{GivenStrengths, Material};

use super::error::{CalculixError, ModelProblem};
use super::text::normal;
use crate::package::quote::{bounded_message, quoted};

/// Strengths by the name of a material or an element set, as CalculiX compares names.
#[derive(Debug, Default)]
pub(super) struct Strengths(BTreeMap<String, GivenStrengths>);

impl Strengths {
    /// Reads the strengths in `path`; none without a path.
    pub(super) fn read(path: Option<&Path>) -> Result<Self, CalculixError> {
        let Some(path) = path else { return Ok(Self::default()) };
        let text =
            std::fs::read(path).map_err(|source| CalculixError::Io { path: path.to_owned(), source })?;
        let mut json = serde_json::Deserializer::from_slice(&text);
        let read: BTreeMap<String, GivenStrengths> =
            serde_path_to_error::deserialize(&mut json).map_err(|error| ModelProblem::Strengths {
                file: path.to_owned(),
                message: bounded_message(&error.to_string()),
            })?;
        Ok(Self(read.into_iter().map(|(name, strength)| (normal(&name), strength)).collect()))
    }

    /// Gives a material the strengths listed for its set, or else for the material itself.
    pub(super) fn give(&self, set: &str, material: &str, to: &mut Material) {
        if let Some(strength) = self.0.get(set).or_else(|| self.0.get(material)) {
            *to = to.with_strengths(strength);
        }
    }

    /// Refuses strengths under a name that is not among `names`.
    pub(super) fn check(&self, names: &[&str]) -> Result<(), ModelProblem> {
        match self.0.keys().find(|name| !names.contains(&name.as_str())) {
            None => Ok(()),
            Some(unknown) => Err(ModelProblem::StrengthOfNothing {
                name: quoted(unknown),
                known: names.iter().take(MOST_NAMED).map(|name| quoted(name)).collect(),
            }),
        }
    }
}

/// Largest number of names that an error lists.
const MOST_NAMED: usize = 20;
