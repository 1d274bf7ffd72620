//! Arrays of numbers or texts under a name.

use serde::Serialize;

use crate::analysis::request::Sensor;

/// Array of numbers or texts under a name, in the order of C.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Name of the array: the field of the JSON, or the column of a table.
    pub name: String,
    /// Length of every dimension; empty for a single value.
    pub shape: Vec<usize>,
    /// Elements, as many as the shape says.
    pub values: Values,
    /// Whether the request gave the name, whose end then says no unit.
    pub named_by_request: bool,
}

/// Elements of an array.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers; NaN where there is none.
    Real(Vec<f64>),
    /// Whole numbers; `None` where there is none.
    Whole(Vec<Option<u32>>),
    /// Truth values.
    Flag(Vec<bool>),
    /// Texts.
    Text(Vec<String>),
}

impl Array {
    /// Real numbers in one dimension; NaN where there is none.
    pub fn reals(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self::list(name, Values::Real(values.into_iter().collect()))
    }

    /// Real numbers some of which may be absent.
    pub fn some_reals(name: impl Into<String>, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        Self::reals(name, values.into_iter().map(|value| value.unwrap_or(f64::NAN)))
    }

    /// Whole numbers in one dimension.
    pub fn whole(name: impl Into<String>, values: impl IntoIterator<Item = u32>) -> Self {
        Self::some_whole(name, values.into_iter().map(Some))
    }

    /// Whole numbers some of which may be absent.
    pub fn some_whole(name: impl Into<String>, values: impl IntoIterator<Item = Option<u32>>) -> Self {
        Self::list(name, Values::Whole(values.into_iter().collect()))
    }

    /// Truth values in one dimension.
    pub fn flags(name: impl Into<String>, values: impl IntoIterator<Item = bool>) -> Self {
        Self::list(name, Values::Flag(values.into_iter().collect()))
    }

    /// Texts in one dimension; empty where there is none.
    pub fn texts(name: impl Into<String>, values: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self::list(name, Values::Text(values.into_iter().map(Into::into).collect()))
    }

    /// Words as they are in the JSON, in one dimension.
    pub fn words(name: impl Into<String>, values: impl IntoIterator<Item = impl Serialize>) -> Self {
        Self::texts(name, values.into_iter().map(|value| word(&value)))
    }

    /// Lists of words in one dimension, each list as one text with spaces between its words.
    pub fn word_lists<W: Serialize>(
        name: impl Into<String>,
        values: impl IntoIterator<Item = impl AsRef<[W]>>,
    ) -> Self {
        let list = |words: &[W]| words.iter().map(word).collect::<Vec<_>>().join(" ");
        Self::texts(name, values.into_iter().map(|words| list(words.as_ref())))
    }

    /// Single real number.
    pub fn real(name: impl Into<String>, value: f64) -> Self {
        Self { shape: Vec::new(), ..Self::reals(name, [value]) }
    }

    /// Single text.
    pub fn text(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self { shape: Vec::new(), ..Self::texts(name, [value]) }
    }

    /// Value of any other type as a single text: its JSON.
    pub fn json(name: impl Into<String>, value: &impl Serialize) -> Self {
        Self::text(name, serde_json::to_string(value).unwrap_or_default())
    }

    /// Sensors, each as a text in JSON.
    pub fn sensors<'a>(sensors: impl IntoIterator<Item = &'a Sensor>) -> Self {
        Self::texts(
            "sensors",
            sensors.into_iter().map(|sensor| serde_json::to_string(sensor).unwrap_or_default()),
        )
    }

    /// Lists of real numbers side by side: `[list][element]`. Shorter lists are filled with NaN.
    pub fn rows<'a>(name: impl Into<String>, rows: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let rows: Vec<&[f64]> = rows.into_iter().collect();
        let width = rows.iter().map(|row| row.len()).max().unwrap_or(0);
        let padded = rows
            .iter()
            .flat_map(|row| row.iter().copied().chain(std::iter::repeat_n(f64::NAN, width - row.len())));
        Self { shape: vec![rows.len(), width], ..Self::reals(name, padded) }
    }

    /// Array under a name that the request gave: its values are converted into no other unit.
    #[must_use]
    pub fn under_given_name(self) -> Self {
        Self { named_by_request: true, ..self }
    }

    /// Divides the first dimension into `parts` equal ones.
    #[must_use]
    pub fn in_parts(mut self, parts: usize) -> Self {
        let whole = self.shape.remove(0);
        self.shape.splice(0..0, [parts, whole.checked_div(parts).unwrap_or(0)]);
        self
    }

    /// Lists of lists of real numbers: `[a][b][c]`. Shorter lists are filled with NaN.
    pub fn cube(name: impl Into<String>, cube: &[Vec<Vec<f64>>]) -> Self {
        let parts = cube.len();
        Self::rows(name, cube.iter().flatten().map(Vec::as_slice)).in_parts(parts)
    }

    fn list(name: impl Into<String>, values: Values) -> Self {
        Self { name: name.into(), shape: vec![values.len()], values, named_by_request: false }
    }
}

impl Values {
    /// Number of elements.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Flag(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Word as it is in the JSON; empty for an absent one.
fn word(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(word)) => word,
        _ => String::new(),
    }
}
