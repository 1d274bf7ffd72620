//! Data of points and cells: numbers of nodes and elements, and sets.

use roxmltree::Node;

use super::arrays::Arrays;
use super::numbers::Type;
use crate::error::{MeshFileError, MeshProblem};
use crate::fields::quoted;

/// Arrays of points that are numbers of nodes; the first found is taken.
pub(super) const NODE_NUMBERS: [&str; 5] =
    ["node", "node_id", "GlobalNodeId", "GlobalNodeIds", "vtkOriginalPointIds"];
/// Arrays of cells that are numbers of elements; the first found is taken.
pub(super) const ELEMENT_NUMBERS: [&str; 5] =
    ["element", "element_id", "GlobalElementId", "GlobalElementIds", "vtkOriginalCellIds"];
/// Arrays of cells whose values make sets; the first found is taken.
const ELEMENT_SETS: [&str; 5] = ["material", "set", "PhysicalIds", "gmsh:physical", "CellEntityIds"];

/// Arrays of integers, one for each point or cell.
pub(super) struct Integers<'x, 'd> {
    arrays: Vec<(&'x str, Node<'x, 'd>)>,
    count: usize,
}

impl<'x, 'd> Integers<'x, 'd> {
    /// Arrays with a name in a section of a piece, such as `PointData`, with so many integers each.
    pub(super) fn of(piece: Node<'x, 'd>, section: &str, count: usize) -> Self {
        let is_one = |array: &Node| {
            array.has_tag_name("DataArray")
                && matches!(array.attribute("NumberOfComponents"), None | Some("1" | "0"))
                && Type::of(*array).is_ok_and(Type::is_integer)
        };
        let sections = piece.children().filter(|child| child.has_tag_name(section));
        let arrays = sections.flat_map(|section| section.children()).filter(is_one);
        let named = arrays.filter_map(|array| Some((array.attribute("Name")?, array)));
        Self { arrays: named.filter(|(name, _)| !name.is_empty()).collect(), count }
    }

    /// Integers of the first array that is there, with its name.
    fn first(&self, names: &[&str], arrays: &Arrays) -> Result<Option<(&'x str, Vec<i64>)>, MeshFileError> {
        let named = |name: &&str| self.arrays.iter().find(|(found, _)| found == name);
        let Some(&(name, array)) = names.iter().find_map(named) else { return Ok(None) };
        self.values(name, array, arrays).map(|values| Some((name, values)))
    }

    /// Integers of an array.
    fn values(&self, name: &str, array: Node, arrays: &Arrays) -> Result<Vec<i64>, MeshFileError> {
        let numbers = arrays.numbers(array, self.count)?;
        numbers.integers().map_err(|problem| problem.at(0, &quoted(name)))
    }

    /// Numbers of the points or cells by an array of one of these names, or else from 1.
    pub(super) fn ids(&self, names: &[&str], arrays: &Arrays) -> Result<Vec<u64>, MeshFileError> {
        let Some((name, values)) = self.first(names, arrays)? else {
            return Ok((1..).take(self.count).collect());
        };
        let id = |value: i64| {
            let not =
                MeshProblem::NotA { text: value.to_string(), expected: "a number of a node or element" };
            u64::try_from(value).map_err(|_| not.at(0, name))
        };
        values.into_iter().map(id).collect()
    }

    /// Sets of points: arrays of zeros and ones, other than those that are numbers of nodes. Each is a name and a flag for each point.
    pub(super) fn flags(&self, arrays: &Arrays) -> Result<Vec<(&'x str, Vec<bool>)>, MeshFileError> {
        let mut found = Vec::new();
        for &(name, array) in self.arrays.iter().filter(|(name, _)| !NODE_NUMBERS.contains(name)) {
            let values = self.values(name, array, arrays)?;
            if values.iter().all(|value| matches!(value, 0 | 1)) && values.contains(&1) {
                found.push((name, values.into_iter().map(|value| value == 1).collect()));
            }
        }
        Ok(found)
    }

    /// Name of the set of each cell, if the file has sets of cells.
    pub(super) fn sets(&self, arrays: &Arrays) -> Result<Option<Vec<String>>, MeshFileError> {
        let found = self.first(&ELEMENT_SETS, arrays)?;
        Ok(found.map(|(name, values)| values.iter().map(|value| format!("{name} {value}")).collect()))
    }
}
