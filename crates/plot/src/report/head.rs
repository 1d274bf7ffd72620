//! What stands at the top of a report.

/// What stands at the top of a report.
#[derive(Debug, Clone, Default)]
pub struct Head {
    /// What it is about.
    pub title: String,
    /// Facts about job, model and program: names and values.
    pub facts: Vec<(&'static str, String)>,
    /// What its owner has noted.
    pub notes: Option<String>,
}
