//! Keyword lines of a deck.

/// Keyword line, also called card.
#[derive(Debug, Clone)]
pub(super) struct Card {
    /// Keyword such as `*NSET`, in capitals, without blanks.
    pub(super) keyword: String,
    /// Number of its line.
    pub(super) line: u64,
    /// Parameters as written.
    parameters: Vec<String>,
}

impl Card {
    pub(super) fn parse(text: &str, line: u64) -> Self {
        let mut words = text.split(',');
        let keyword = normal(words.next().unwrap_or_default());
        Self { keyword, line, parameters: words.map(|word| word.trim().to_owned()).collect() }
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

/// Normal form of a name, as CalculiX compares names.
pub(super) fn normal(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_uppercase).collect()
}
