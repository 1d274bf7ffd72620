//! Lines of the file, with those of included files in the place of INCLUDE.

use std::borrow::Cow;
use std::rc::Rc;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields::quoted;
use crate::include::Include;

use super::place::Place;

/// Most files open inside each other.
const DEEPEST: usize = 8;

/// Most files included in all: a file that includes another twice, which includes another twice, and so on, has an end.
const MOST: usize = 1000;

/// Most lines over which the name of a file is continued.
const LONGEST_NAME: usize = 16;

/// Line of text.
pub(super) struct Line {
    /// Text, without the end of the line.
    pub(super) text: String,
    /// Place of the line.
    pub(super) place: Place,
}

/// File that is being read.
struct Open<'a> {
    bytes: Cow<'a, [u8]>,
    at: usize,
    place: Place,
}

impl Open<'_> {
    fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        let line = String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).into_owned();
        self.at += length + 1;
        self.place.line += 1;
        Some(line)
    }
}

/// Rest of the lines.
pub(super) struct Lines<'a> {
    open: Vec<Open<'a>>,
    include: &'a Include<'a>,
    included: usize,
    last: Place,
}

impl<'a> Lines<'a> {
    /// All lines of a file.
    pub(super) fn new(bytes: &'a [u8], include: &'a Include<'a>) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let main = Open { bytes: Cow::Borrowed(bytes), at: 0, place: Place::default() };
        Self { open: vec![main], include, included: 0, last: Place::default() }
    }

    /// Place of the last line.
    pub(super) fn place(&self) -> &Place {
        &self.last
    }

    /// Next line.
    pub(super) fn next(&mut self) -> Result<Option<Line>, MeshFileError> {
        while let Some(file) = self.open.last_mut() {
            let Some(text) = file.next() else {
                self.open.pop();
                continue;
            };
            self.last = file.place.clone();
            match included(&text) {
                None => return Ok(Some(Line { text, place: self.last.clone() })),
                Some(name) => self.open(name)?,
            }
        }
        Ok(None)
    }

    /// Opens the file that the text behind INCLUDE names.
    fn open(&mut self, text: &str) -> Result<(), MeshFileError> {
        let place = self.last.clone();
        let failed = |problem| place.error(problem, "INCLUDE");
        let name = self.name(text).ok_or_else(|| {
            failed(MeshProblem::Expected { expected: "the name of a file, such as 'mesh.bdf'".to_owned() })
        })?;
        if self.open.len() > DEEPEST {
            return Err(failed(MeshProblem::TooDeep { limit: DEEPEST }));
        }
        self.included += 1;
        let refused = |reason| failed(MeshProblem::Include { name: quoted(&name), reason });
        if self.included > MOST {
            return Err(refused(format!("it is one of more than {MOST} included files")));
        }
        let bytes = (self.include)(&name).map_err(refused)?;
        let place = Place { line: 0, file: Some(Rc::from(name.as_str())) };
        self.open.push(Open { bytes: Cow::Owned(bytes), at: 0, place });
        Ok(())
    }

    /// Name of a file: in quotes, also over several lines, or a word.
    fn name(&mut self, text: &str) -> Option<String> {
        let text = text.trim();
        let quote = text.chars().next().filter(|first| ['\'', '"'].contains(first));
        let name = match quote {
            None => text.split([' ', '\t', '$']).next()?.to_owned(),
            Some(quote) => {
                let mut name = text.get(1..)?.to_owned();
                for _ in 0..LONGEST_NAME {
                    if name.contains(quote) {
                        break;
                    }
                    name += self.open.last_mut()?.next()?.trim();
                }
                name.split_once(quote)?.0.trim().to_owned()
            }
        };
        Some(name).filter(|name| !name.is_empty())
    }
}

/// Text behind INCLUDE.
fn included(text: &str) -> Option<&str> {
    const WORD: &str = "INCLUDE";
    let text = text.trim_start();
    let (word, rest) = text.split_at_checked(WORD.len())?;
    let is = word.eq_ignore_ascii_case(WORD) && rest.starts_with([' ', '\t', '\'', '"', ',', '=']);
    is.then(|| rest.trim_start_matches([' ', '\t', ',', '=']))
}
