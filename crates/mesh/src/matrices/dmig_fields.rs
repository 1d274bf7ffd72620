//! Fields of DMIG entries, four at a time: every line of an entry has four or eight.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use crate::lines::Lines;

/// Four fields of a DMIG entry: name, column and its component first, then a row, its component and the entry each.
pub(super) struct Group<'a> {
    pub(super) line: u64,
    /// Whether an entry begins here.
    pub(super) first: bool,
    pub(super) fields: [&'a str; 4],
}

/// Calls `take` with each group of four fields of DMIG entries, in order.
pub(super) fn each_group(
    bytes: &[u8],
    mut take: impl FnMut(&Group<'_>) -> Result<(), MeshFileError>,
) -> Result<(), MeshFileError> {
    let mut inside = false;
    for (line, text) in Lines::new(bytes) {
        let text = text.split('$').next().unwrap_or_default().trim_end();
        if text.is_empty() {
            continue;
        }
        let (card, long, groups) = split(text);
        let begins = card.eq_ignore_ascii_case("DMIG");
        let continues = card.is_empty() || card.starts_with(['+', '*']);
        inside = begins || (inside && continues);
        if !inside {
            continue;
        }
        if !text.is_ascii() {
            let problem =
                MeshProblem::NotA { text: fields::quoted(text), expected: "a line of plain characters" };
            return Err(problem.at(line, "DMIG"));
        }
        let count = if long { 1 } else { 2 };
        for (index, fields) in groups.into_iter().take(count).enumerate() {
            take(&Group { line, first: begins && index == 0, fields })?;
        }
    }
    Ok(())
}

/// Card or mark of continuation, whether the fields are long, and the fields; absent ones are empty.
fn split(text: &str) -> (&str, bool, [[&str; 4]; 2]) {
    let mut fields = [[""; 4]; 2];
    let (card, long);
    if text.contains(',') {
        let mut words = text.split(',').map(str::trim);
        card = words.next().unwrap_or_default();
        long = card.contains('*');
        for (field, word) in fields.as_flattened_mut().iter_mut().zip(words) {
            *field = word;
        }
    } else {
        let part = |from: usize, to: usize| text.get(from..to.min(text.len())).unwrap_or_default().trim();
        card = part(0, 8);
        long = card.contains('*');
        let width = if long { 16 } else { 8 };
        for (index, field) in fields.as_flattened_mut().iter_mut().enumerate() {
            *field = part(8 + index * width, 8 + (index + 1) * width);
        }
    }
    let card = if card.starts_with('*') { card } else { card.trim_end_matches('*').trim_end() };
    (card, long, fields)
}
