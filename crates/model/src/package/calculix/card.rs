//! Keyword lines of a deck.

use super::text::normal;

/// Keyword line, also called card.
pub(super) struct Card {
    /// Keyword such as `*NSET`, in capitals, without blanks.
    pub(super) keyword: String,
    /// Parameters as written.
    parameters: Vec<String>,
}

impl Card {
    pub(super) fn parse(line: &str) -> Self {
        let mut words = line.split(',');
        let keyword = normal(words.next().unwrap_or_default());
        Self { keyword, parameters: words.map(|word| word.trim().to_owned()).collect() }
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|parameter| normal(parameter) == name)
    }

    pub(super) fn value_as_written(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find_map(|parameter| {
            let (key, value) = parameter.split_once('=')?;
            (normal(key) == name).then(|| value.trim().trim_matches('"'))
        })
    }

    pub(super) fn value(&self, name: &str) -> Option<String> {
        self.value_as_written(name).map(normal)
    }
}
