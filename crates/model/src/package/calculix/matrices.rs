//! Files `.dof`, `.sti` and `.mas` as `*FREQUENCY, SOLVER=MATRIXSTORAGE` writes them.
//!
//! `.dof` has one line `node.direction` for each matrix row; the matrices have one line `row column value` for each
//! stored entry of one triangle, zeros included.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::error::{CalculixError, LineProblem, ModelProblem};
use super::text::TextLines;
use crate::package::error::{MatrixProblem, PackageError};
use crate::package::matrix_market::parse_entry;
use crate::package::quote::quoted;
use crate::package::raw::{RawDof, RawMatrix};
use crate::package::symmetric::{self, Mirror};

/// DOF of each matrix row, and the file they were read from.
#[derive(Debug)]
pub(super) struct DofList {
    pub(super) path: PathBuf,
    pub(super) dofs: Vec<RawDof>,
}

impl DofList {
    pub(super) fn read(path: &Path) -> Result<Self, CalculixError> {
        let mut lines = TextLines::open(path)?;
        let mut dofs = Vec::new();
        let mut seen = HashMap::new();
        while let Some(line) = lines.next()? {
            let word = line.trim();
            if word.is_empty() {
                continue;
            }
            let dof = word.split_once('.').and_then(|(node, component)| {
                let component = component.parse().ok().filter(|k| (1..=3).contains(k))?;
                Some(RawDof { node: node.parse().ok()?, component })
            });
            let Some(dof) = dof else {
                let text = quoted(word);
                return Err(lines.fault(LineProblem::NotA {
                    text,
                    expected: "a DOF (node.direction, direction 1 to 3)",
                }));
            };
            let RawDof { node, component } = dof;
            if seen.insert((node, component), dofs.len()).is_some() {
                return Err(lines.fault(LineProblem::DofRepeated { node, component }));
            }
            dofs.push(dof);
        }
        Ok(Self { path: path.to_owned(), dofs })
    }

    /// Position in `rest` of each DOF of this list.
    pub(super) fn places_in(&self, rest: &Self) -> Result<Vec<u32>, ModelProblem> {
        let places: HashMap<_, _> =
            (rest.dofs.iter().zip(0..)).map(|(d, k)| ((d.node, d.component), k)).collect();
        let other = |dof: &RawDof| ModelProblem::OtherDofs {
            file: self.path.clone(),
            rest: rest.path.clone(),
            node: dof.node,
            component: dof.component,
        };
        let place = |dof: &RawDof| places.get(&(dof.node, dof.component)).copied().ok_or_else(|| other(dof));
        let found = self.dofs.iter().map(place).collect::<Result<Vec<u32>, _>>()?;
        if found.len() < rest.dofs.len() {
            let mut present = vec![false; rest.dofs.len()];
            found.iter().for_each(|&k| present[k as usize] = true);
            let lacking = present.iter().position(|there| !there).unwrap_or(0);
            return Err(other(&rest.dofs[lacking]));
        }
        Ok(found)
    }
}

/// Reads a matrix over the rows of `dofs`, each moved to its position in `places` if given; returns it with the number of entries in its
/// file, zeros included.
pub(super) fn read(
    path: &Path,
    dofs: &DofList,
    places: Option<&[u32]>,
) -> Result<(RawMatrix, u64), CalculixError> {
    let size = dofs.dofs.len();
    let mut lines = TextLines::open(path)?;
    let mut entries = Vec::new();
    let mut held = 0;
    while let Some(line) = lines.next_bytes()? {
        let Some((row, column, value)) = parse_entry(line) else {
            if line.trim_ascii().is_empty() {
                continue;
            }
            let text = quoted(&String::from_utf8_lossy(line));
            return Err(lines.fault(LineProblem::NotA { text, expected: "a matrix entry: row column value" }));
        };
        if row.wrapping_sub(1) >= size as u64 || column.wrapping_sub(1) >= size as u64 {
            let dof_file = dofs.path.clone();
            return Err(lines.fault(LineProblem::OutOfRange { row, column, size, dof_file }));
        }
        if !value.is_finite() {
            return Err(lines.fault(LineProblem::NotFinite { row, column }));
        }
        let place = |k: u64| places.map_or((k - 1) as u32, |places| places[k as usize - 1]);
        let (row, column) = (place(row), place(column));
        held += 1;
        // CalculiX stores the zeros of its pattern; they would only cost room.
        if value != 0.0 {
            entries.push((row.max(column), row.min(column), value));
        }
    }
    let matrix =
        symmetric::from_triangle(Mirror::Symmetric, size, entries).map_err(|problem| match problem {
            MatrixProblem::Repeated { row, column, .. } => lines.fault(LineProblem::Repeated { row, column }),
            problem => PackageError::matrix(&path.display().to_string(), problem).into(),
        });
    Ok((matrix?, held))
}
