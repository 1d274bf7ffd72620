//! Problems that a service reports (RFC 9457).

use std::fmt::{self, Display, Formatter};

use serde::Deserialize;

/// Problem, as far as it is shown.
#[derive(Debug, Clone, Deserialize)]
pub(in crate::cli) struct Problem {
    /// Kind of the problem, a URI.
    #[serde(default)]
    pub(super) r#type: String,
    title: String,
    #[serde(default)]
    detail: String,
    #[serde(default)]
    pub(super) retry_after_s: Option<u32>,
    #[serde(default)]
    errors: Vec<ProblemItem>,
}

#[derive(Debug, Clone, Deserialize)]
struct ProblemItem {
    pointer: Option<String>,
    parameter: Option<String>,
    file: Option<String>,
    detail: String,
}

impl Display for Problem {
    /// Writes the problem as one text: what it is about, and all its items as a list; where it has none, its detail.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.errors.is_empty() {
            return f.write_str(if self.detail.is_empty() { &self.title } else { &self.detail });
        }
        f.write_str(&self.title)?;
        for item in &self.errors {
            // The detail of an item about a file begins with its place.
            let place = item.pointer.as_deref().or(item.parameter.as_deref());
            match place.filter(|place| item.file.is_none() && !place.is_empty()) {
                Some(place) => write!(f, "\n  {place}: {}", item.detail)?,
                None => write!(f, "\n  {}", item.detail)?,
            }
        }
        Ok(())
    }
}
