//! What a service answered: as far as it is used, and whole.

use std::ops::Deref;

use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// What is used of an answer, beside all of it.
#[derive(Debug, Clone)]
pub(in crate::cli) struct Answer<T> {
    used: T,
    /// All of it, for scripts.
    pub(in crate::cli) body: Value,
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for Answer<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let body = Value::deserialize(deserializer)?;
        let used = T::deserialize(&body).map_err(D::Error::custom)?;
        Ok(Self { used, body })
    }
}

impl<T> Deref for Answer<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.used
    }
}
