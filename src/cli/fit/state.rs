//! State of a fit on disk: a line of JSON for the request, and one for every evaluation that is done.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, Write};
use std::path::Path;

use anyhow::{Context, bail};
use rubmap_fit::{Evaluation, FitRequest, Target, Unit};
use serde::{Deserialize, Serialize};

use crate::impeller::ImpellerRequest;

/// Name of the file.
const FILE: &str = "evaluations.jsonl";

/// Parts of a request on which evaluations depend, and the program that made them: fits that differ in others share what they have.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    program: String,
    wheel: ImpellerRequest,
    vary: BTreeMap<String, [f64; 2]>,
    unit: Unit,
    targets: Vec<Target>,
}

impl Head {
    fn of(request: &FitRequest) -> Self {
        let FitRequest { wheel, vary, unit, targets, .. } = request.clone();
        Self { program: crate::version::LINE.to_owned(), wheel, vary, unit, targets }
    }
}

/// State of a fit on disk, locked against others.
pub(super) struct State(File);

impl State {
    /// Opens the state in a folder, which is made if missing; returns the evaluations that are there. A last line that is not whole is
    /// dropped.
    ///
    /// # Errors
    /// A file that cannot be used, another fit that is at work there, or the state of another fit.
    pub(super) fn open(folder: &Path, request: &FitRequest) -> anyhow::Result<(Self, Vec<Evaluation>)> {
        fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let path = folder.join(FILE);
        let place = path.display();
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = file.with_context(|| format!("cannot open {place}"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                bail!(
                    "another fit is at work in {}: wait for its end, or give another folder",
                    folder.display()
                )
            }
            Err(TryLockError::Error(error)) => {
                return Err(error).with_context(|| format!("cannot lock {place}"));
            }
        }
        let text = fs::read(&path).with_context(|| format!("cannot read {place}"))?;
        let head = Head::of(request);
        let mut lines = text.split_inclusive(|&byte| byte == b'\n').filter(|line| line.ends_with(b"\n"));
        let mut whole = 0;
        let mut known = Vec::new();
        if let Some(line) = lines.next() {
            match serde_json::from_slice::<Head>(line) {
                Ok(found) if found == head => whole = line.len(),
                Ok(found) if found.program != head.program => bail!(
                    "{place} is of another version of this program, whose last digits may differ: delete it, or give another folder"
                ),
                Ok(_) => bail!(
                    "{place} is of another fit (another wheel, other bounds or other targets): delete it, or give another folder"
                ),
                Err(error) => {
                    bail!("{place} is no state of a fit ({error}): delete it, or give another folder")
                }
            }
            for line in lines {
                let Ok(evaluation) = serde_json::from_slice(line) else { break };
                known.push(evaluation);
                whole += line.len();
            }
        }
        let failed = || format!("cannot write {place}");
        file.set_len(whole as u64).with_context(failed)?;
        file.seek(io::SeekFrom::End(0)).with_context(failed)?;
        let mut state = Self(file);
        if whole == 0 {
            state.line(&head).with_context(failed)?;
        }
        Ok((state, known))
    }

    /// Appends an evaluation.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn append(&mut self, evaluation: &Evaluation) -> io::Result<()> {
        self.line(evaluation)
    }

    /// Appends a line in one piece: a kill leaves it whole, or as a last line without its end.
    fn line(&mut self, value: &impl Serialize) -> io::Result<()> {
        let mut line = serde_json::to_vec(value)?;
        line.push(b'\n');
        self.0.write_all(&line)
    }
}

#[cfg(test)]
mod tests {
    use rubmap_fit::Outcome;
    use serde_json::json;

    use super::*;

    fn request(rim: f64) -> FitRequest {
        serde_json::from_value(json!({
            "wheel": {"rim_thickness": rim},
            "vary": {"rim_thickness": [5.0, 9.0]},
            "unit": "hz_and_rpm",
            "targets": [{"nodal_diameter": 0, "family": 1, "speed": 0.1, "frequency": 3000.0}],
        }))
        .unwrap()
    }

    fn evaluation(at: f64) -> Evaluation {
        Evaluation { from: vec![0.1], at: vec![at], outcome: Outcome::Failed("no wheel".to_owned()) }
    }

    #[test]
    fn a_state_that_was_cut_goes_on_after_its_last_whole_line() {
        let folder = tempfile::tempdir().unwrap();
        let (mut state, known) = State::open(folder.path(), &request(7.0)).unwrap();
        assert!(known.is_empty());
        let all = [evaluation(1.0 / 3.0), evaluation(0.1 + 0.2), evaluation(0.7)];
        all.iter().for_each(|evaluation| state.append(evaluation).unwrap());
        let other = State::open(folder.path(), &request(7.0)).err().unwrap().to_string();
        assert!(other.contains("another fit is at work"), "{other}");
        drop(state);

        let path = folder.path().join(FILE);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() - 5]).unwrap();
        let (mut state, known) = State::open(folder.path(), &request(7.0)).unwrap();
        assert_eq!(known, all[..2]);
        state.append(&all[2]).unwrap();
        drop(state);
        assert_eq!(fs::read(&path).unwrap(), whole);

        // The number of starts does not bear on evaluations.
        let more = FitRequest { starts: 9, ..request(7.0) };
        assert_eq!(State::open(folder.path(), &more).unwrap().1, all);
    }

    #[test]
    fn the_state_of_another_fit_is_refused_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (mut state, _) = State::open(folder.path(), &request(7.0)).unwrap();
        state.append(&evaluation(0.5)).unwrap();
        drop(state);
        let refused = State::open(folder.path(), &request(8.0)).err().unwrap().to_string();
        assert!(refused.contains("of another fit"), "{refused}");
        assert_eq!(State::open(folder.path(), &request(7.0)).unwrap().1.len(), 1);
    }
}
