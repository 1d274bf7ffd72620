//! Unstructured grids of VTK in XML (.vtu), of one piece, in every encoding but those compressed other than by zlib.
//!
//! Points are numbered from 1 unless an array of integers has the numbers of nodes: `node`, `node_id`, `GlobalNodeId`, `GlobalNodeIds` or
//! `vtkOriginalPointIds`; cells likewise by `element`, `element_id`, `GlobalElementId`, `GlobalElementIds` or `vtkOriginalCellIds`. Arrays
//! of points that are zeros and ones are node sets; the first array of cells among `material`, `set`, `PhysicalIds`, `gmsh:physical` and
//! `CellEntityIds` makes element sets, such as `material 1`.

mod arrays;
mod cells;
mod data;
mod document;
mod numbers;
mod source;
#[cfg(test)]
mod tests;

use arrays::Arrays;
use data::{ELEMENT_NUMBERS, Integers, NODE_NUMBERS};
use roxmltree::Node;

use crate::error::{MeshFileError, MeshProblem};
use crate::fields::quoted;
use crate::format::MeshFormat;
use crate::mesh_file::{FileElement, MeshFile};

/// Reads a grid.
///
/// # Errors
/// [`MeshFileError`] with the array or section at fault.
pub(crate) fn read(bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let (text, appended) = document::cut(bytes)?;
    let document = document::parsed(&text)?;
    let root = document.root_element();
    let piece = piece(root)?;
    let arrays = Arrays::of(root, appended, bytes.len()).map_err(|problem| problem.at(0, "VTKFile"))?;
    let mut mesh = MeshFile::new(MeshFormat::Vtu);
    let (ids, positions) = read_points(piece, &arrays, &mut mesh)?;
    read_cells(piece, &arrays, (&ids, &positions), &mut mesh)?;
    crate::whole::check(&mesh, cells::CARD)?;
    Ok(mesh)
}

/// Piece of the grid, of which a file has one.
fn piece<'x, 'd>(root: Node<'x, 'd>) -> Result<Node<'x, 'd>, MeshFileError> {
    let kind = root.attribute("type").unwrap_or_default();
    if !root.has_tag_name("VTKFile") || kind != "UnstructuredGrid" {
        let what = format!("a VTK file of type \"{}\"", quoted(kind));
        let advice = "save the mesh as one UnstructuredGrid (.vtu)";
        return Err(MeshProblem::NotCarried { what, advice }.at(0, "VTKFile"));
    }
    let grids = root.children().filter(|child| child.has_tag_name("UnstructuredGrid"));
    let mut pieces = grids.flat_map(|grid| grid.children()).filter(|child| child.has_tag_name("Piece"));
    let missing = || MeshProblem::Expected { expected: "a Piece of an UnstructuredGrid".to_owned() };
    let piece = pieces.next().ok_or_else(|| missing().at(0, "UnstructuredGrid"))?;
    if pieces.next().is_some() {
        let what = "a grid of several pieces".to_owned();
        let advice = "merge them into one, in ParaView by Clean to Grid, and save that";
        return Err(MeshProblem::NotCarried { what, advice }.at(0, "Piece"));
    }
    Ok(piece)
}

/// Count that a piece states.
fn count(piece: Node, name: &str) -> Result<usize, MeshFileError> {
    let text = piece.attribute(name).unwrap_or_default().trim();
    let not = MeshProblem::NotA { text: quoted(text), expected: "a number of points or cells" };
    text.parse().map_err(|_| not.at(0, name))
}

/// Array in a section of a piece, by its name if one is given.
fn array<'x, 'd>(
    piece: Node<'x, 'd>,
    section: &str,
    name: Option<&str>,
) -> Result<Node<'x, 'd>, MeshFileError> {
    let sections = piece.children().filter(|child| child.has_tag_name(section));
    let mut arrays = sections.flat_map(|section| section.children()).filter(|child| {
        child.has_tag_name("DataArray") && (name.is_none() || child.attribute("Name") == name)
    });
    let expected = || name.map_or("a DataArray".to_owned(), |name| format!("a DataArray named {name}"));
    arrays.next().ok_or_else(|| MeshProblem::Expected { expected: expected() }.at(0, section))
}

/// Reads the points with their sets: number and position of each.
fn read_points(
    piece: Node,
    arrays: &Arrays,
    mesh: &mut MeshFile,
) -> Result<(Vec<u64>, Vec<[f64; 3]>), MeshFileError> {
    const CARD: &str = "Points";
    let count = count(piece, "NumberOfPoints")?;
    let points = array(piece, CARD, None)?;
    if points.attribute("NumberOfComponents") != Some("3") {
        let expected = "NumberOfComponents=\"3\"".to_owned();
        return Err(MeshProblem::Expected { expected }.at(0, CARD));
    }
    // A count so large is none of an array that is there.
    let numbers = arrays.numbers(points, count.saturating_mul(3))?;
    let coordinates = numbers.reals().map_err(|problem| problem.at(0, CARD))?;
    let positions = coordinates.as_chunks().0.to_vec();
    let integers = Integers::of(piece, "PointData", positions.len());
    let ids = integers.ids(&NODE_NUMBERS, arrays)?;
    for (&id, &position) in ids.iter().zip(&positions) {
        if mesh.nodes.insert(id, position).is_some() {
            return Err(MeshProblem::Twice { what: "node", id }.at(0, "PointData"));
        }
    }
    for (name, flags) in integers.flags(arrays)? {
        let nodes = ids.iter().zip(flags).filter_map(|(&id, flag)| flag.then_some(id)).collect();
        mesh.node_sets.insert(name.to_owned(), nodes);
    }
    Ok((ids, positions))
}

/// Reads the cells with their sets.
fn read_cells(
    piece: Node,
    arrays: &Arrays,
    (ids, positions): (&[u64], &[[f64; 3]]),
    mesh: &mut MeshFile,
) -> Result<(), MeshFileError> {
    let count = count(piece, "NumberOfCells")?;
    let integers = |name: &str, count: usize| {
        let numbers = arrays.numbers(array(piece, cells::CARD, Some(name))?, count)?;
        numbers.integers().map_err(|problem| problem.at(0, name))
    };
    let types = integers("types", count)?;
    let ends = integers("offsets", count)?;
    let length = ends.last().map_or(Some(0), |&end| usize::try_from(end).ok());
    let rising = || MeshProblem::Expected { expected: "ends of cells that rise".to_owned() }.at(0, "offsets");
    let points = integers("connectivity", length.ok_or_else(rising)?)?;
    let data = Integers::of(piece, "CellData", count);
    let numbers = data.ids(&ELEMENT_NUMBERS, arrays)?;
    let sets = data.sets(arrays)?;
    let mut begin = 0;
    for (k, ((&number, &end), &id)) in types.iter().zip(&ends).zip(&numbers).enumerate() {
        let end = usize::try_from(end).map_err(|_| rising())?;
        let cell = points.get(begin..end).ok_or_else(rising)?;
        begin = end;
        let found = cells::solid((id, number), cell, positions, mesh);
        let Some((kind, places)) = found.map_err(|problem| problem.at(0, cells::CARD))? else { continue };
        let node = |&place: &u64| ids.get(usize::try_from(place).ok()?).copied();
        let element = FileElement { kind, nodes: places.iter().filter_map(node).collect(), line: 0 };
        if mesh.elements.insert(id, element).is_some() {
            return Err(MeshProblem::Twice { what: "element", id }.at(0, "CellData"));
        }
        if let Some(set) = sets.as_ref().and_then(|sets| sets.get(k)) {
            mesh.element_sets.entry(set.clone()).or_default().insert(id);
        }
    }
    Ok(())
}
