//! Material properties as MP, MPTEMP and MPDATA state them: values by material, label and temperature.

use std::collections::BTreeMap;

use super::command::Fields;
use super::table::Table;
use crate::error::MeshProblem;
use crate::fields::{integer, quoted, real};

/// Properties of all materials.
#[derive(Default)]
pub(super) struct Properties {
    /// Temperatures by location, as MPTEMP set them last.
    temperatures: BTreeMap<u64, f64>,
    /// Tables by material and label.
    pub(super) materials: BTreeMap<u64, BTreeMap<String, Table>>,
}

/// Places of a command's fields, which the form with a release, such as `MPDATA,R5.0`, moves.
struct Places {
    label: usize,
    material: usize,
    location: usize,
    values: usize,
}

impl Places {
    /// Places in the form of CDWRITE, `MPDATA,R5.0,1,EX,1,1,2.1E11`, or of the command itself, `MPDATA,EX,1,1,2.1E11`.
    fn of(fields: &Fields) -> Self {
        let with_release = is_release(fields);
        let label = if with_release { 3 } else { 1 };
        Self { label, material: label + 1, location: label + 2, values: label + 3 }
    }
}

/// Whether the first field is a release, such as `R5.0`.
fn is_release(fields: &Fields) -> bool {
    let mut letters = fields.get(1).chars();
    letters.next().is_some_and(|c| c.eq_ignore_ascii_case(&'r'))
        && letters.next().is_some_and(|c| c.is_ascii_digit())
}

/// Location of the first value, 1 where it is left out.
fn location(text: &str) -> Result<u64, MeshProblem> {
    if text.is_empty() { Ok(1) } else { integer(text, "a location in a table") }
}

/// Values with their locations; those left out are passed over.
fn values(fields: &[&str], first: u64) -> Result<Vec<(u64, f64)>, MeshProblem> {
    let stated = (0..).zip(fields).filter(|(_, text)| !text.is_empty());
    stated.map(|(k, text)| Ok((first.saturating_add(k), real(text, "a value")?))).collect()
}

impl Properties {
    /// Takes the command MPTEMP.
    pub(super) fn temperatures(&mut self, fields: &Fields) -> Result<(), MeshProblem> {
        let place = if is_release(fields) { 3 } else { 1 };
        let first = location(fields.get(place))?;
        if first == 1 {
            self.temperatures.clear();
        }
        self.temperatures.extend(values(fields.from(place + 1), first)?);
        Ok(())
    }

    /// Takes the command MPDATA.
    pub(super) fn data(&mut self, fields: &Fields, line: u64) -> Result<(), MeshProblem> {
        let places = Places::of(fields);
        let first = location(fields.get(places.location))?;
        let values = values(fields.from(places.values), first)?;
        let temperatures = &self.temperatures;
        let rows: Vec<_> = values
            .into_iter()
            .map(|(location, value)| (location, (temperatures.get(&location).copied(), value)))
            .collect();
        let table = self.table(fields, &places, line)?;
        if first == 1 {
            table.clear(line);
        }
        table.extend(rows);
        Ok(())
    }

    /// Takes the command `MP,EX,1,2.1E11`.
    pub(super) fn constant(&mut self, fields: &Fields, line: u64) -> Result<(), MeshProblem> {
        let places = Places::of(fields);
        let coefficients = values(fields.from(places.location), 0)?;
        if coefficients.iter().any(|&(power, value)| power > 0 && value != 0.0) {
            return Err(MeshProblem::NotCarried {
                what: format!("{} as a polynomial of temperature", quoted(fields.get(places.label))),
                advice: "give a table of values by MPTEMP and MPDATA",
            });
        }
        let value = coefficients.first().map_or(0.0, |&(_, value)| value);
        let table = self.table(fields, &places, line)?;
        table.clear(line);
        table.extend(vec![(1, (None, value))]);
        Ok(())
    }

    /// Takes the command TB, which begins a table of another material model.
    pub(super) fn model(&mut self, fields: &Fields, line: u64) -> Result<(), MeshProblem> {
        let material = integer(fields.get(2), "a material number")?;
        let name = format!("TB,{}", quoted(&fields.upper(1)));
        self.materials.entry(material).or_default().entry(name).or_insert_with(|| Table::new(line));
        Ok(())
    }

    /// Table that a command is about.
    fn table(&mut self, fields: &Fields, places: &Places, line: u64) -> Result<&mut Table, MeshProblem> {
        let material = integer(fields.get(places.material), "a material number")?;
        let tables = self.materials.entry(material).or_default();
        Ok(tables.entry(fields.upper(places.label)).or_insert_with(|| Table::new(line)))
    }
}
