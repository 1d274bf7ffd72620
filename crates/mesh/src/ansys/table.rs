//! Values of a property by temperature.

use std::collections::BTreeMap;

use crate::error::MeshProblem;

/// Table of a property.
#[derive(Debug, Clone)]
pub(super) struct Table {
    /// Line of the file on which it begins.
    pub(super) line: u64,
    /// Temperature, if one is stated, and value by location.
    rows: BTreeMap<u64, (Option<f64>, f64)>,
}

impl Table {
    /// Table without values.
    pub(super) fn new(line: u64) -> Self {
        Self { line, rows: BTreeMap::new() }
    }

    /// Begins the table anew.
    pub(super) fn clear(&mut self, line: u64) {
        *self = Self::new(line);
    }

    /// Adds rows.
    pub(super) fn extend(&mut self, rows: Vec<(u64, (Option<f64>, f64))>) {
        self.rows.extend(rows);
    }

    /// Curve through the values, which does without a temperature where there is one value only.
    pub(super) fn curve(&self) -> Result<Curve, MeshProblem> {
        let mut rows: Vec<(f64, f64)> = Vec::new();
        for &(temperature, value) in self.rows.values() {
            let missing = || MeshProblem::Expected { expected: "a temperature for each value".to_owned() };
            let temperature = if self.rows.len() == 1 { 0.0 } else { temperature.ok_or_else(missing)? };
            rows.push((temperature, value));
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows.dedup_by(|a, b| a.0 == b.0);
        Ok(Curve(rows))
    }
}

/// Values over temperature, linear between them and constant beyond, as Ansys takes them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve(Vec<(f64, f64)>);

impl Curve {
    /// Curve of one value for all temperatures.
    pub(super) fn constant(value: f64) -> Self {
        Self(vec![(0.0, value)])
    }

    /// Temperatures, none where the value is the same at all.
    pub(super) fn temperatures(&self) -> impl Iterator<Item = f64> {
        let several = self.0.len() > 1;
        self.0.iter().filter(move |_| several).map(|row| row.0)
    }

    /// Value at a temperature, none of a curve without values.
    pub(super) fn at(&self, temperature: f64) -> Option<f64> {
        let above = self.0.partition_point(|row| row.0 < temperature);
        let below = above.checked_sub(1).and_then(|k| self.0.get(k));
        match (below, self.0.get(above)) {
            (Some(a), Some(b)) if b.0 > temperature => {
                Some(a.1 + (b.1 - a.1) * ((temperature - a.0) / (b.0 - a.0)))
            }
            (below, at) => at.or(below).map(|row| row.1),
        }
    }
}

/// Temperatures of curves together, rising, each once; one without a name where none of them depends on temperature.
pub(super) fn together(curves: &[&Curve]) -> Vec<Option<f64>> {
    let mut all: Vec<f64> = curves.iter().flat_map(|curve| curve.temperatures()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    if all.is_empty() { vec![None] } else { all.into_iter().map(Some).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_linear_between_temperatures() {
        let curve = Curve(vec![(0.0, 1.0), (10.0, 3.0)]);
        assert_eq!([-5.0, 0.0, 5.0, 10.0, 20.0].map(|t| curve.at(t)), [1.0, 1.0, 2.0, 3.0, 3.0].map(Some));
        assert_eq!(together(&[&curve, &Curve::constant(2.0)]), [Some(0.0), Some(10.0)]);
        assert_eq!(together(&[&Curve::constant(2.0)]), [None]);
        assert_eq!(Curve(Vec::new()).at(1.0), None);
    }
}
