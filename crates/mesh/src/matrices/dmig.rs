//! Matrices of Nastran on DMIG entries of bulk data or a punch file, in short, long and free fields.

use crate::error::{MeshFileError, MeshProblem};
use crate::fields;

use super::choice;
use super::dmig_fields::{self, Group};
use super::dof::{Dof, whole};
use super::raw::{RawEntry, RawMatrix, Rows, Triangles};

/// Name of the format.
pub(super) const FORMAT: &str = "Nastran DMIG";

/// Reads the matrix of a name, or the only one.
pub(super) fn read(bytes: &[u8], name: Option<&str>) -> Result<RawMatrix, MeshFileError> {
    let mut names: Vec<String> = Vec::new();
    dmig_fields::each_group(bytes, |group| {
        let [name, ..] = group.fields;
        if group.first && !names.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            names.push(name.to_owned());
        }
        Ok(())
    })?;
    let mut reader = Reader {
        name: choice::of(names, name, FORMAT)?,
        triangles: None,
        within: Within::Elsewhere,
        rows: Rows::default(),
        entries: Vec::new(),
    };
    dmig_fields::each_group(bytes, |group| {
        reader.take(group).map_err(|problem| problem.at(group.line, FORMAT))
    })?;
    let Some(triangles) = reader.triangles else {
        let expected = format!("a header DMIG {} 0", fields::quoted(&reader.name));
        return Err(MeshProblem::Expected { expected }.at(0, FORMAT));
    };
    Ok(RawMatrix { dofs: reader.rows.dofs, entries: reader.entries, triangles, marks_clamped: false })
}

/// Place inside the entries of a file.
enum Within {
    /// Header, or an entry of another matrix.
    Elsewhere,
    /// Column of the matrix, with its number.
    Column(u32),
}

/// Reader of one matrix.
struct Reader {
    name: String,
    triangles: Option<Triangles>,
    within: Within,
    rows: Rows,
    entries: Vec<RawEntry>,
}

impl Reader {
    fn take(&mut self, group: &Group<'_>) -> Result<(), MeshProblem> {
        let [first, second, third, fourth] = group.fields;
        if group.first {
            self.within = Within::Elsewhere;
            if !first.eq_ignore_ascii_case(&self.name) {
                return Ok(());
            }
            if whole(second, "a grid point or 0")? == 0 {
                return self.header(third, fourth);
            }
            self.within = Within::Column(self.rows.of(Dof::parsed(second, third)?)?);
            return Ok(());
        }
        let Within::Column(column) = self.within else { return Ok(()) };
        if group.fields.iter().all(|field| field.is_empty()) {
            return Ok(());
        }
        let row = self.rows.of(Dof::parsed(first, second)?)?;
        let number = |field: &str| {
            if field.is_empty() { Ok(0.0) } else { fields::real(field, "an entry") }
        };
        if number(fourth)? != 0.0 {
            return Err(complex());
        }
        self.entries.push(RawEntry::new(row, column, number(third)?, group.line));
        Ok(())
    }

    /// Takes form and type of the matrix from its header.
    fn header(&mut self, form: &str, kind: &str) -> Result<(), MeshProblem> {
        if self.triangles.is_some() {
            let expected = format!("one header of {}, not two", fields::quoted(&self.name));
            return Err(MeshProblem::Expected { expected });
        }
        self.triangles = Some(match whole(form, "the form of a matrix")? {
            1 => Triangles::Both,
            6 => Triangles::One,
            form => {
                let what = format!("a matrix of form {form}");
                let advice = "mass and stiffness matrices are of form 6 (symmetric) or 1 (square)";
                return Err(MeshProblem::NotCarried { what, advice });
            }
        });
        match whole(kind, "the type of the entries")? {
            1 | 2 => Ok(()),
            _ => Err(complex()),
        }
    }
}

/// Refusal of complex numbers.
fn complex() -> MeshProblem {
    let what = "a matrix of complex numbers".to_owned();
    MeshProblem::NotCarried { what, advice: "export it as real: type 1 or 2, without structural damping" }
}
