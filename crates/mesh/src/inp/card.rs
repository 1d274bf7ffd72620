//! Keyword lines of a deck.

/// Keyword line, also called card.
#[derive(Debug, Clone)]
pub struct Card {
    /// Keyword such as `*NSET`, in capitals, without blanks.
    pub keyword: String,
    /// Number of its line.
    pub line: u64,
    /// Parameters as written.
    parameters: Vec<String>,
}

impl Card {
    /// Card of a line, with those that go on.
    pub fn parse(text: &str, line: u64) -> Self {
        let mut words = text.split(',');
        let keyword = normal(words.next().unwrap_or_default());
        Self { keyword, line, parameters: words.map(|word| word.trim().to_owned()).collect() }
    }

    /// Whether the card has a parameter without a value.
    pub fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|parameter| normal(parameter) == name)
    }

    /// Value of a parameter as written, without quotes.
    pub fn value_as_written(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find_map(|parameter| {
            let (key, value) = parameter.split_once('=')?;
            (normal(key) == name).then(|| value.trim().trim_matches('"'))
        })
    }

    /// Value of a parameter in its normal form.
    pub fn value(&self, name: &str) -> Option<String> {
        self.value_as_written(name).map(normal)
    }
}

/// Normal form of a name, as CalculiX compares names.
pub fn normal(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_uppercase).collect()
}
