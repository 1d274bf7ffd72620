//! Executive and case control: sets of nodes and the selected supports.

use std::collections::BTreeSet;

use crate::error::{MeshFileError, MeshProblem};

use super::lines::Lines;
use super::place::Place;

/// Case control, as far as a mesh is concerned.
#[derive(Default)]
pub(super) struct Control {
    /// Numbers, texts behind `=` and places of SET.
    pub(super) sets: Vec<(u64, String, Place)>,
    /// Sets of supports that are selected.
    pub(super) supports: BTreeSet<u64>,
}

/// Whether a file has executive or case control.
pub(super) fn is_there(bytes: &[u8]) -> bool {
    bytes.split(|&byte| byte == b'\n').any(|line| {
        let line = line.trim_ascii();
        let line = line.get(..line.len().min(40)).unwrap_or_default();
        let line = String::from_utf8_lossy(line).to_uppercase();
        is_begin(&line) || line.split([' ', '\t', '$']).next() == Some("CEND")
    })
}

/// Whether a line in capitals is BEGIN BULK.
fn is_begin(line: &str) -> bool {
    let rest = line.trim_start().strip_prefix("BEGIN");
    rest.is_some_and(|rest| rest.trim_start_matches([' ', '\t', ',']).starts_with("BULK"))
}

impl Control {
    /// Reads up to and with BEGIN BULK.
    pub(super) fn read(lines: &mut Lines<'_>) -> Result<Self, MeshFileError> {
        let mut control = Self::default();
        loop {
            let Some(text) = statement(lines)? else {
                let problem = MeshProblem::CutShort { expected: "BEGIN BULK".to_owned() };
                return Err(lines.place().error(problem, ""));
            };
            if is_begin(&text) {
                return Ok(control);
            }
            let Some((head, value)) = text.split_once('=') else { continue };
            let place = lines.place().clone();
            let mut words = head.split_whitespace();
            match (words.next(), words.next().map(str::parse), words.next()) {
                (Some("SET"), Some(Ok(id)), None) => {
                    continue_set(lines, value).map(|value| control.sets.push((id, value, place)))?
                }
                (Some("SPC"), None, None) => {
                    if let Ok(id) = value.trim().parse() {
                        control.supports.insert(id);
                    }
                }
                _ => {}
            }
        }
    }
}

/// Next line in capitals, without its comment.
fn statement(lines: &mut Lines<'_>) -> Result<Option<String>, MeshFileError> {
    let line = lines.next()?;
    Ok(line.map(|line| line.text.split('$').next().unwrap_or_default().trim().to_uppercase()))
}

/// Text of a set, with the lines that follow a comma at the end of a line.
fn continue_set(lines: &mut Lines<'_>, value: &str) -> Result<String, MeshFileError> {
    let mut value = value.to_owned();
    while value.trim_end().ends_with(',') {
        let Some(more) = statement(lines)? else { break };
        if !more.is_empty() {
            value += &more;
        }
    }
    Ok(value)
}
