//! Run of the table: every claim with what was computed of it.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use rubmap_wheel::revision::REVISION;
use serde::Serialize;

use crate::claim::{Check, Claim, NO_REFERENCE};

/// Run of the table, or of some of its rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Date and time of the run, as RFC 3339 has them.
    pub date: String,
    /// Version of the program.
    pub version: String,
    /// Revision of the numerics.
    pub revision: u32,
    /// Machine of the run.
    pub machine: Machine,
    /// Whether every row that was computed has passed.
    pub passed: bool,
    /// Rows, in the order of the table.
    pub rows: Vec<Row>,
}

/// Machine that computed a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Machine {
    /// Operating system.
    pub system: &'static str,
    /// Architecture of the processor.
    pub architecture: &'static str,
    /// Number of processors that the program may use.
    pub processors: usize,
    /// Kind of vectors that the loops ran on.
    pub vectors: String,
}

/// Claim with what was computed of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Name of the row.
    pub name: &'static str,
    /// Claim, in a sentence.
    pub claim: &'static str,
    /// Reference, and where it is from.
    pub reference: &'static str,
    /// Quantity that is compared.
    pub quantity: &'static str,
    /// Verdict.
    pub verdict: Verdict,
    /// Error of the program, relative; none where the program did not compute it.
    pub error: Option<f64>,
    /// Largest error with which the claim holds; none where a test has it.
    pub limit: Option<f64>,
    /// Reason for the limit, or limit and reason of the test.
    pub reason: &'static str,
    /// Reason why nothing was computed, if the computation failed.
    pub failure: Option<String>,
    /// Duration of the computation, s.
    pub seconds: f64,
    /// Command that computes the row again.
    pub repeat: String,
}

/// Verdict on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Error within its limit.
    Passed,
    /// Error beyond its limit, or a computation that failed.
    Failed,
    /// Claim that a test of the repository computes.
    ByTest,
    /// Claim without an independent reference.
    NoReference,
}

impl Verdict {
    /// Verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::ByTest => "by test",
            Self::NoReference => NO_REFERENCE,
        }
    }
}

impl Row {
    /// Computes a claim, if the program computes it.
    pub fn of(claim: &Claim) -> Self {
        let begun = Instant::now();
        let (verdict, error, limit, reason, failure) = match claim.check {
            Check::Computed(computed) => {
                let (verdict, error, failure) = match (computed.error)(1.0) {
                    Ok(error) if error <= computed.limit => (Verdict::Passed, Some(error), None),
                    Ok(error) => (Verdict::Failed, Some(error), None),
                    Err(failure) => (Verdict::Failed, None, Some(format!("{failure:#}"))),
                };
                (verdict, error, Some(computed.limit), computed.reason, failure)
            }
            Check::Test { limit, .. } | Check::Consistency { limit, .. } => {
                (Verdict::ByTest, None, None, limit, None)
            }
            Check::None => (Verdict::NoReference, None, None, "", None),
        };
        Self {
            name: claim.name,
            claim: claim.claim,
            reference: claim.reference,
            quantity: claim.quantity,
            verdict,
            error,
            limit,
            reason,
            failure,
            seconds: begun.elapsed().as_secs_f64(),
            repeat: repeat(claim),
        }
    }
}

/// Command that computes a claim again; empty where none does.
pub(crate) fn repeat(claim: &Claim) -> String {
    match claim.check {
        Check::Computed(_) => format!("rubmap validate --only {}", claim.name),
        Check::Test { file, name, .. } | Check::Consistency { file, name, .. } => {
            // A suite is a folder or a file of `tests`, or a crate.
            let mut parts = file.split('/');
            let suite = match (parts.next(), parts.next()) {
                (Some("crates"), Some(package)) => format!("-p rubmap-{package}"),
                (_, Some(suite)) => {
                    let stem = Path::new(suite).file_stem().unwrap_or_default().to_string_lossy();
                    format!("--test {stem}")
                }
                _ => String::new(),
            };
            format!("cargo test --release {suite} {name}")
        }
        Check::None => String::new(),
    }
}

impl Report {
    /// Report of rows that this program has computed on a machine, at a date.
    pub fn new(date: String, version: String, machine: Machine, rows: Vec<Row>) -> Self {
        let passed = rows.iter().all(|row| row.verdict != Verdict::Failed);
        Self { date, version, revision: REVISION, machine, passed, rows }
    }

    /// Numbers of rows by verdict, in words.
    pub fn counts(&self) -> String {
        let count = |verdict: Verdict| self.rows.iter().filter(|row| row.verdict == verdict).count();
        format!(
            "{} passed, {} failed, {} by tests of the repository, {} without a reference",
            count(Verdict::Passed),
            count(Verdict::Failed),
            count(Verdict::ByTest),
            count(Verdict::NoReference)
        )
    }

    /// Document of the run, in Markdown.
    pub fn markdown(&self) -> String {
        let Machine { system, architecture, processors, vectors } = &self.machine;
        let passed = if self.passed { "Passed" } else { "**Not passed**" };
        let mut text = format!(
            "# Validation\n\n{passed}, {}: rubmap {} (revision {} of the numerics) on {}, {system} on {architecture}, {processors} processors, vectors {vectors}.\n\n\
             | row | claim | reference | quantity | error | limit and its reason | verdict | how to repeat |\n|---|---|---|---|---|---|---|---|\n",
            self.counts(),
            self.version,
            self.revision,
            self.date
        );
        for row in &self.rows {
            let error =
                row.error.map_or_else(|| row.failure.clone().unwrap_or_default(), |e| format!("{e:.1e}"));
            let limit = row.limit.map_or_else(String::new, |limit| format!("{limit:.0e}: "));
            let repeat = if row.repeat.is_empty() { String::new() } else { format!("`{}`", row.repeat) };
            let cells = [
                row.name,
                row.claim,
                row.reference,
                row.quantity,
                &error,
                &(limit + row.reason),
                row.verdict.words(),
                &repeat,
            ];
            // Writing to a string cannot fail.
            let _ = writeln!(text, "| {} |", cells.map(cell).join(" | "));
        }
        text
    }
}

/// Text in a cell of a table of Markdown.
pub(crate) fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claim::Computed;

    fn row(error: fn(f64) -> anyhow::Result<f64>) -> Row {
        let check = Check::Computed(Computed { error, wrong: "", limit: 1e-3, reason: "round-off" });
        Row::of(&Claim { name: "row", covers: &[], claim: "", reference: "|x|", quantity: "", check })
    }

    #[test]
    fn what_is_beyond_its_limit_or_breaks_off_or_is_no_number_fails() {
        let rows = [
            row(|_| Ok(1e-3)),
            row(|_| Ok(1.1e-3)),
            row(|_| Ok(f64::NAN)),
            row(|_| anyhow::bail!("no modes")),
        ];
        let verdicts = rows.each_ref().map(|row| row.verdict);
        assert_eq!(verdicts, [Verdict::Passed, Verdict::Failed, Verdict::Failed, Verdict::Failed]);
        let report = |rows: &[Row]| {
            let machine = Machine { system: "", architecture: "", processors: 2, vectors: "Scalar".into() };
            Report::new("today".into(), "1.2.3".into(), machine, rows.to_vec())
        };
        assert!(report(&rows[..1]).passed && !report(&rows[..2]).passed);
        let report = report(&rows);
        let text = report.markdown();
        assert!(text.contains("**Not passed**, 1 passed, 3 failed, 0 by tests of the repository, 0 without a reference: rubmap 1.2.3"), "{text}");
        assert!(
            text.contains("\\|x\\|") && text.contains("no modes") && text.contains("1e-3: round-off"),
            "{text}"
        );
    }
}
