//! `rubmap fit`: the generated wheel that has given frequencies.

mod report;
mod state;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::Context;
use clap::Args;
use rubmap_fit::{Evaluation, FitRequest, FitResult, Keeper, Problem, fit};

use super::client::new_file;
use super::stdout::narrate;
use super::terminal::{Bar, Terminal};
use state::State;

/// Exit codes and their meaning.
pub(super) const CODES: &str = "\
Exit codes:
  0  all targets are met within their tolerances
  1  some are not: the table says which and by how much; or a file or a request that cannot be used
  2  the command line is wrong";

/// Request of a fit, and where its result is left.
#[derive(Debug, Args)]
pub(super) struct FitArgs {
    /// JSON file: the wheel, the parameters that vary and their bounds, and the frequencies that it is to have
    request: PathBuf,
    /// Folder for the result (parameters.json for `generate --parameters`, fit.json) and for stored evaluations; made if missing. The same
    /// command resumes an interrupted fit
    #[arg(long, default_value = "./rubmap-fit")]
    out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
}

/// Makes the fit and prints its table; the exit code says whether all targets are met.
///
/// # Errors
/// A file or folder that cannot be used, or a request that makes no sense.
pub(super) fn run(args: &FitArgs) -> anyhow::Result<ExitCode> {
    let file = args.request.display();
    let text = fs::read_to_string(&args.request).with_context(|| format!("cannot read {file}"))?;
    let problem = FitRequest::from_json(&text).and_then(Problem::new).with_context(|| file.to_string())?;
    let (state, known) = State::open(&args.out, &problem.request)?;
    let terminal = Terminal::default();
    if !known.is_empty() {
        terminal.say(&format!("{} evaluations were there already", known.len()));
    }
    let threads = args.workers.map_or(0, usize::from);
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().context("cannot start threads")?;
    let progress = Progress::new(state, problem.request.starts, known.len(), terminal.bar("fit"));
    let result = pool.install(|| fit(&problem, known, &progress))?;
    save(&args.out, "parameters.json", &serde_json::to_string_pretty(&result.parameters)?)?;
    save(&args.out, "fit.json", &serde_json::to_string_pretty(&result)?)?;
    narrate(&report::table(&result))?;
    narrate(&report::closing(&result, &args.out))?;
    progress.finish()?;
    Ok(exit(&result))
}

fn exit(result: &FitResult) -> ExitCode {
    if result.met { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Writes a file, all or nothing.
fn save(folder: &Path, name: &str, text: &str) -> anyhow::Result<()> {
    let place = folder.join(name);
    let failed = || format!("cannot write {}", place.display());
    let part = new_file(folder).with_context(failed)?;
    fs::write(part.path(), format!("{text}\n")).with_context(failed)?;
    part.persist(&place).with_context(failed)?;
    Ok(())
}

/// Progress of a fit, and its state on disk.
struct Progress {
    starts: usize,
    inner: Mutex<Inner>,
}

struct Inner {
    state: State,
    bar: Bar,
    /// Number of evaluations, those that were there already included.
    evaluations: usize,
    /// Number of starting points that have come to their end.
    ended: usize,
    /// Root mean square of the weighted differences at the best end.
    best: f64,
    /// First error of the state on disk.
    failed: Option<std::io::Error>,
}

impl Progress {
    fn new(state: State, starts: usize, evaluations: usize, bar: Bar) -> Self {
        let inner = Inner { state, bar, evaluations, ended: 0, best: f64::INFINITY, failed: None };
        Self { starts, inner: Mutex::new(inner) }
    }

    /// Changes the numbers and shows them; `change` says whether the last search has ended.
    fn with(&self, change: impl FnOnce(&mut Inner) -> bool) {
        let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        let last = change(&mut inner);
        let Inner { evaluations, ended, best, .. } = *inner;
        let best = if best.is_finite() { format!(", best weighted rms {best:.3}") } else { String::new() };
        let words = format!("{evaluations} evaluations, {ended} of {} searches finished{best}", self.starts);
        inner.bar.show((100 * ended / self.starts) as u64, &words, last);
    }

    /// Returns the first error of the state on disk: the result is complete all the same, but another run could not go on from there.
    fn finish(self) -> anyhow::Result<()> {
        let failed = self.inner.into_inner().unwrap_or_else(PoisonError::into_inner).failed;
        failed.map_or(Ok(()), |error| Err(error).context("cannot write evaluations.jsonl"))
    }
}

impl Keeper for Progress {
    fn evaluated(&self, evaluation: &Evaluation) {
        self.with(|inner| {
            inner.evaluations += 1;
            if let Err(error) = inner.state.append(evaluation) {
                inner.failed.get_or_insert(error);
            }
            false
        });
    }

    fn ended(&self, _start: usize, weighted_rms: f64) {
        self.with(|inner| {
            inner.ended += 1;
            inner.best = inner.best.min(weighted_rms);
            inner.ended == self.starts
        });
    }
}
