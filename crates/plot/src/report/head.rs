//! Head of a report: title, facts and notes.

/// Head of a report.
#[derive(Debug, Clone, Default)]
pub struct Head {
    /// Title of the report.
    pub title: String,
    /// Facts about job, model and program: names and values.
    pub facts: Vec<(&'static str, String)>,
    /// Notes of the owner of the job.
    pub notes: Option<String>,
}
