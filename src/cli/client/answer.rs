//! Answers of a service: the part that is used, and all of it.

use std::ops::Deref;

use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// Answer of a service: the part that is used, and all of it.
#[derive(Debug, Clone)]
pub(in crate::cli) struct Answer<T> {
    used: T,
    /// Whole answer, for scripts.
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
