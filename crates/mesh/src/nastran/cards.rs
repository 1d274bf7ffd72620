//! Cards out of lines: short, long and free format, comments and continuations.

use crate::error::{MeshFileError, MeshProblem};

use super::card::Card;
use super::lines::{Line, Lines};
use super::place::Place;

/// Columns of a short field.
const SHORT: usize = 8;

/// Fields of a short line, between its name and its mark of continuation.
const FIELDS: usize = 8;

/// Rest of the cards.
pub(super) struct Cards<'a> {
    lines: Lines<'a>,
    /// First line of the next card.
    next: Option<Piece>,
    ended: bool,
}

/// Line of a card, taken apart.
struct Piece {
    first: String,
    fields: Vec<String>,
    /// Mark of continuation at the end.
    mark: String,
    place: Place,
}

impl<'a> Cards<'a> {
    /// All cards of the lines.
    pub(super) fn new(lines: Lines<'a>) -> Self {
        Self { lines, next: None, ended: false }
    }

    /// Whether ENDDATA is there.
    pub(super) fn has_ended(&self) -> bool {
        self.ended
    }

    /// Error at the last line.
    pub(super) fn error(&self, problem: MeshProblem) -> MeshFileError {
        self.lines.place().error(problem, "")
    }

    /// Next card, with its continuations.
    pub(super) fn next(&mut self) -> Result<Option<Card>, MeshFileError> {
        let first = match self.next.take() {
            Some(piece) => Some(piece),
            None => self.piece()?,
        };
        let Some(first) = first else { return Ok(None) };
        if first.continues() {
            let expected = "a card before its continuation".to_owned();
            return Err(first.place.error(MeshProblem::Expected { expected }, ""));
        }
        let name = first.first.replace('*', "").trim().to_uppercase();
        let Piece { mut fields, mut mark, place, .. } = first;
        while let Some(piece) = self.piece()? {
            if !piece.continues() {
                self.next = Some(piece);
                break;
            }
            let (before, here) = (label(&mark), label(&piece.first));
            if !before.is_empty() && !here.is_empty() && before != here {
                let expected = format!("the continuation {mark} behind its card");
                return Err(piece.place.error(MeshProblem::Expected { expected }, &name));
            }
            if !piece.first.starts_with('*') {
                // Two long lines stand for one short line, of which the second may be missing.
                fields.resize(fields.len().next_multiple_of(FIELDS), String::new());
            }
            fields.extend(piece.fields);
            mark = piece.mark;
        }
        Ok(Some(Card { name, fields, place }))
    }

    /// Next line that is not empty, before ENDDATA.
    fn piece(&mut self) -> Result<Option<Piece>, MeshFileError> {
        while !self.ended {
            let Some(line) = self.lines.next()? else { break };
            let Some(piece) = Piece::of(line)? else { continue };
            if !piece.first.eq_ignore_ascii_case("ENDDATA") {
                return Ok(Some(piece));
            }
            self.ended = true;
        }
        Ok(None)
    }
}

/// Mark without its sign.
fn label(mark: &str) -> &str {
    mark.trim_start_matches(['+', '*']).trim()
}

impl Piece {
    /// Line taken apart; none of a line that is empty or a comment.
    fn of(Line { text, place }: Line) -> Result<Option<Self>, MeshFileError> {
        let text = text.split('$').next().unwrap_or_default();
        if text.trim().is_empty() {
            return Ok(None);
        }
        if text.contains(',') {
            return Self::free(text, place).map(Some);
        }
        let text = in_columns(text);
        let columns =
            |from: usize, to: usize| text.get(from..to.min(text.len())).unwrap_or_default().trim().to_owned();
        let first = columns(0, SHORT);
        let width = if first.contains('*') { 2 * SHORT } else { SHORT };
        let count = FIELDS * SHORT / width;
        let field = |k: usize| columns(SHORT + k * width, SHORT + (k + 1) * width);
        let fields = (0..count).map(field).collect();
        let mark = columns(SHORT * (FIELDS + 1), SHORT * (FIELDS + 2));
        Ok(Some(Self { first, fields, mark, place }))
    }

    /// Line with commas.
    fn free(text: &str, place: Place) -> Result<Self, MeshFileError> {
        let mut words = text.split(',').map(|word| word.trim().to_owned());
        let first = words.next().unwrap_or_default();
        let count = if first.contains('*') { FIELDS / 2 } else { FIELDS };
        let mut fields: Vec<String> = words.by_ref().take(count).collect();
        fields.resize(count, String::new());
        let mark = words.next().unwrap_or_default();
        let is_field = mark.starts_with(|c: char| c.is_ascii_digit() || ['-', '.'].contains(&c));
        if is_field || words.any(|word| !word.is_empty()) {
            let expected = format!("no more than {count} fields between commas, and a line of continuation");
            return Err(place.error(MeshProblem::Expected { expected }, &first));
        }
        Ok(Self { first, fields, mark, place })
    }

    /// Whether the line continues a card.
    fn continues(&self) -> bool {
        self.first.is_empty() || self.first.starts_with(['+', '*'])
    }
}

/// Text of one byte per column, with tabs replaced by blanks up to the next field.
fn in_columns(text: &str) -> String {
    let mut columns = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\t' => {
                let to = (columns.len() + 1).next_multiple_of(SHORT);
                columns.extend(std::iter::repeat_n(' ', to - columns.len()));
            }
            character if character.is_ascii() => columns.push(character),
            _ => columns.push('?'),
        }
    }
    columns
}
