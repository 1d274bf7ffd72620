//! `rubmap validate`: computes the claims of docs/validation.md beside their references.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use rubmap_validation::claim::{Check, Claim};
use rubmap_validation::manual::manual;
use rubmap_validation::report::{Machine, Report, Row, Verdict};
use rubmap_validation::table::claims;

use super::stdout::{narrate, print};
use crate::analysis::run::vectors;
use crate::numerics::vectors::choose_scalars;

/// Rows that are computed, and where the report is left.
#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    /// Folder for validation.json and validation.md; made if missing [default: none, the rows are printed]
    #[arg(long, conflicts_with = "manual")]
    out: Option<PathBuf>,
    /// Row that is computed, instead of all
    #[arg(long, conflicts_with = "manual")]
    only: Option<String>,
    /// Vectors that the loops run on
    #[arg(long, value_enum, default_value_t = Vectors::Processor)]
    vectors: Vectors,
    /// Print docs/validation.md and compute nothing
    #[arg(long)]
    manual: bool,
}

/// Vectors that the loops run on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Vectors {
    /// The widest that the processor has
    Processor,
    /// One number at a time
    Scalar,
}

/// Computes the rows and prints each as it is there; 1 if one fails.
///
/// # Errors
/// A row that is not in the table, or a folder that cannot be written to.
pub(super) fn run(args: &ValidateArgs) -> anyhow::Result<ExitCode> {
    if args.manual {
        print(manual().trim_end())?;
        return Ok(ExitCode::SUCCESS);
    }
    if args.vectors == Vectors::Scalar {
        choose_scalars()?;
    }
    let asked: Vec<&Claim> = claims().filter(|claim| is_asked(args, claim)).collect();
    if asked.is_empty() {
        bail!("there is no row {:?}: see docs/validation.md", args.only.as_deref().unwrap_or_default());
    }
    if let [claim] = asked[..]
        && !matches!(claim.check, Check::Computed(_))
    {
        bail!("{} is not computed by the program: see docs/validation.md for its test", claim.name);
    }
    if let Some(out) = &args.out {
        std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    }
    let mut rows = Vec::new();
    for claim in asked {
        let row = Row::of(claim);
        narrate(&line(&row))?;
        rows.push(row);
    }
    let date = chrono::Utc::now().to_rfc3339_opts(chrono::SecondsFormat::Secs, true);
    let report = Report::new(date, crate::version::LINE.to_owned(), this_machine(), rows);
    narrate(&summary(&report))?;
    if let Some(out) = &args.out {
        let files = [
            ("validation.json", serde_json::to_string_pretty(&report)? + "\n"),
            ("validation.md", report.markdown()),
        ];
        for (name, text) in files {
            let path = out.join(name);
            std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
        }
    }
    Ok(if report.passed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn this_machine() -> Machine {
    Machine {
        system: std::env::consts::OS,
        architecture: std::env::consts::ARCH,
        processors: std::thread::available_parallelism().map_or(1, Into::into),
        vectors: vectors(),
    }
}

fn is_asked(args: &ValidateArgs, claim: &Claim) -> bool {
    args.only.as_ref().is_none_or(|only| only == claim.name)
}

/// Line of a row: name, error of its limit, and verdict.
fn line(row: &Row) -> String {
    let verdict = row.verdict.words();
    let name = row.name;
    match (row.error, row.limit, &row.failure) {
        (Some(error), Some(limit), _) => format!("{name:42} {error:8.1e} of {limit:.0e}  {verdict}"),
        (_, _, Some(failure)) => format!("{name:42} {verdict}: {failure}"),
        _ if row.verdict == Verdict::ByTest => format!("{name:42} {verdict}: {}", row.repeat),
        _ => format!("{name:42} {verdict}"),
    }
}

/// Sentence that ends the run.
fn summary(report: &Report) -> String {
    let seconds: f64 = report.rows.iter().map(|row| row.seconds).sum();
    format!("{}, in {seconds:.1} s on vectors {}", report.counts(), report.machine.vectors)
}

#[cfg(test)]
mod tests {
    use rubmap_validation::claim::Subject;

    #[test]
    fn every_kind_of_job_has_a_row() {
        for kind in crate::kinds::all() {
            let subject = Subject::Kind(kind.name);
            assert!(
                super::claims().any(|claim| claim.covers.contains(&subject)),
                "{} has no row: crates/validation/src/rows",
                kind.name
            );
        }
    }
}
