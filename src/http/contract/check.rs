//! Checks a JSON document against its shape while it is read, and finds everything that is wrong with its structure at once, each
//! at its RFC 6901 pointer. Nothing of the document is stored, and only values that have a place in the shape are descended into,
//! so that neither size nor depth of wrong values costs anything.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::super::problem::{EXCERPT, MOST_ITEMS, excerpt};
use super::shape::{Field, Scalar, Shape, names};
use crate::analysis::error::Violation;

/// Least similarity of a name that is suggested in place of an unknown one (Jaro; 1 is equal).
const ALIKE: f64 = 0.75;

/// Longest name of a field with any name, which pointers echo.
const LONGEST_NAME: usize = 256;

/// Violations found in a document.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// First violations, as many as are shown.
    pub(crate) first: Vec<Violation>,
    /// Number of all violations.
    pub(crate) total: usize,
    /// Number of violations that are fields that do not exist.
    pub(crate) unknown_fields: usize,
}

/// Checks `body` against `shape`.
///
/// # Errors
/// If `body` is not JSON.
pub(crate) fn check(shape: &Shape, body: &[u8]) -> serde_json::Result<Findings> {
    let mut reader = Reader { pointer: String::new(), found: Findings::default() };
    let mut deserializer = serde_json::Deserializer::from_slice(body);
    Place { shape, reader: &mut reader }.deserialize(&mut deserializer)?;
    deserializer.end()?;
    Ok(reader.found)
}

/// Position of the reader in a document, and its findings so far.
struct Reader {
    pointer: String,
    found: Findings,
}

impl Reader {
    fn refuse(&mut self, message: impl FnOnce() -> String) {
        if self.found.first.len() < MOST_ITEMS {
            self.found.first.push(Violation::new(&self.pointer, message()));
        }
        self.found.total += 1;
    }

    fn refuse_list(&mut self, shape: &Shape, entries: usize) {
        let entries = if entries == 1 { "1 entry".to_owned() } else { format!("{entries} entries") };
        self.refuse(|| format!("expected {shape}, not one of {entries}"));
    }

    fn refuse_twice(&mut self, name: &str) {
        self.within(name, |reader| {
            reader.refuse(|| "this field is given twice; give it once".to_owned());
        });
    }

    fn refuse_unknown_field(&mut self, name: &str, fields: &[Field]) {
        self.found.unknown_fields += 1;
        // A pointer echoes what it points at: a name of any length is rather cut in the message.
        if name.chars().nth(EXCERPT).is_some() {
            return self.refuse(|| format!("a field {:?} does not exist here", excerpt(name)));
        }
        self.within(name, |reader| {
            reader.refuse(|| format!("this field does not exist here; {}", what_exists(name, fields)));
        });
    }

    /// Does `work` one step further down in the document.
    fn within<T>(&mut self, step: impl std::fmt::Display, work: impl FnOnce(&mut Self) -> T) -> T {
        let above = self.pointer.len();
        // Writing to a String cannot fail.
        let _ = write!(self.pointer, "/{step}");
        let own = above + 1;
        if self.pointer[own..].contains(['~', '/']) {
            let escaped = self.pointer[own..].replace('~', "~0").replace('/', "~1");
            self.pointer.replace_range(own.., &escaped);
        }
        let done = work(self);
        self.pointer.truncate(above);
        done
    }
}

/// Checks an object whose fields have any names.
fn visit_named<'de, A: MapAccess<'de>>(
    shape: &Shape,
    reader: &mut Reader,
    mut object: A,
) -> Result<(), A::Error> {
    let mut given = BTreeSet::new();
    while let Some(name) = object.next_key::<String>()? {
        if name.chars().nth(LONGEST_NAME).is_some() {
            reader.refuse(|| format!("the name {:?} is too long", excerpt(&name)));
            object.next_value::<IgnoredAny>()?;
            continue;
        }
        reader.within(&name, |reader| object.next_value_seed(Place { shape, reader }))?;
        if let Some(name) = given.replace(name) {
            reader.refuse_twice(&name);
        }
    }
    Ok(())
}

fn what_exists(name: &str, fields: &[Field]) -> String {
    let alike = |field: &&Field| strsim::jaro(name, &field.name);
    let nearest = fields.iter().max_by(|a, b| alike(a).total_cmp(&alike(b)));
    match nearest.filter(|field| alike(field) >= ALIKE) {
        Some(field) => format!("did you mean `{}`?", field.name),
        None if fields.is_empty() => "there are no fields here".to_owned(),
        None => format!("those here are {}", names(fields)),
    }
}

/// Value to be checked against its shape.
struct Place<'a> {
    shape: &'a Shape,
    reader: &'a mut Reader,
}

impl Place<'_> {
    fn scalar(self, value: Scalar) {
        let shape = self.shape;
        if !shape.admits(value) {
            self.reader.refuse(|| format!("expected {shape}, not {value}"));
        }
    }
}

impl<'de> DeserializeSeed<'de> for Place<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Place<'_> {
    type Value = ();

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.shape)
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        self.scalar(Scalar::Null);
        Ok(())
    }

    fn visit_bool<E>(self, truth: bool) -> Result<(), E> {
        self.scalar(Scalar::Truth(truth));
        Ok(())
    }

    fn visit_i64<E>(self, number: i64) -> Result<(), E> {
        self.scalar(Scalar::Whole(number.into()));
        Ok(())
    }

    fn visit_u64<E>(self, number: u64) -> Result<(), E> {
        self.scalar(Scalar::Whole(number.into()));
        Ok(())
    }

    fn visit_f64<E>(self, number: f64) -> Result<(), E> {
        self.scalar(Scalar::Number(number));
        Ok(())
    }

    fn visit_str<E>(self, text: &str) -> Result<(), E> {
        self.scalar(Scalar::Text(text));
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let Self { shape, reader } = self;
        let Some((entries, shortest, longest)) = shape.list() else {
            reader.refuse(|| format!("expected {shape}, not a list"));
            while list.next_element::<IgnoredAny>()?.is_some() {}
            return Ok(());
        };
        let mut count = 0;
        while count < longest
            && reader
                .within(count, |reader| list.next_element_seed(Place { shape: entries, reader }))?
                .is_some()
        {
            count += 1;
        }
        while list.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        if !(shortest..=longest).contains(&count) {
            reader.refuse_list(shape, count);
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<(), A::Error> {
        let Self { shape, reader } = self;
        if let Some(shape) = shape.named() {
            return visit_named(shape, reader, object);
        }
        let Some(fields) = shape.fields() else {
            reader.refuse(|| format!("expected {shape}, not an object"));
            while object.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
            return Ok(());
        };
        let mut given = vec![false; fields.len()];
        while let Some(name) = object.next_key::<String>()? {
            match fields.iter().position(|field| field.name == name) {
                Some(index) if !given[index] => {
                    given[index] = true;
                    let shape = &fields[index].shape;
                    reader.within(&name, |reader| object.next_value_seed(Place { shape, reader }))?;
                    continue;
                }
                Some(_) => reader.refuse_twice(&name),
                None => reader.refuse_unknown_field(&name, fields),
            }
            object.next_value::<IgnoredAny>()?;
        }
        for (field, _) in fields.iter().zip(given).filter(|(field, given)| field.required && !given) {
            let Field { name, shape, .. } = field;
            reader
                .within(name, |reader| reader.refuse(|| format!("this field is missing; expected {shape}")));
        }
        Ok(())
    }
}
