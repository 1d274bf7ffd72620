//! Fields of a command.

/// Fields of a command, without blanks around them.
pub(super) struct Fields<'a>(Vec<&'a str>);

impl<'a> Fields<'a> {
    /// Fields of a line, without its comment.
    pub(super) fn of(line: &'a str) -> Self {
        let command = line.split('!').next().unwrap_or_default();
        Self(command.split(',').map(str::trim).collect())
    }

    /// Field at a place, from 0, which is the command's name; empty where it is left out.
    pub(super) fn get(&self, place: usize) -> &'a str {
        self.0.get(place).copied().unwrap_or_default()
    }

    /// Field in capitals.
    pub(super) fn upper(&self, place: usize) -> String {
        self.get(place).to_uppercase()
    }

    /// Fields from a place on.
    pub(super) fn from(&self, place: usize) -> &[&'a str] {
        self.0.get(place..).unwrap_or_default()
    }

    /// Whether a field is there and has text.
    pub(super) fn has(&self, place: usize) -> bool {
        !self.get(place).is_empty()
    }
}
