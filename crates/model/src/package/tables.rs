//! Tables `nodes.csv`, `dofs.csv` and `elements.csv`: comma-separated, header optional, white space, blank lines and CRLF tolerated.
//!
//! No field has a comma or a line end in it, so a line is a row. The crate `csv` (1.4) is not used: it takes an unclosed quote to make the
//! rest of the file one field, which it holds in memory; it counts a row behind blank lines from the first of them, and leaves quotes
//! behind a space where they are.

use std::collections::HashMap;
use std::io::Read;
use std::sync::Arc;

use rubmap_solid::element::ElementKind;

use super::error::TableProblem;
use super::lines::{Fault, Lines};
use super::quote::quoted;
use super::raw::{ManifestMesh, RawDof, RawElement, RawNode};

type TableFault = Fault<TableProblem>;

/// Rows of a table and the line of each.
#[derive(Debug)]
pub(super) struct Table<T> {
    pub(super) rows: Vec<T>,
    pub(super) lines: Vec<u64>,
}

pub(super) fn read_nodes(source: impl Read, limit: usize) -> Result<Table<RawNode>, TableFault> {
    const COLUMNS: &str = "id,x,y,z";
    read(source, limit, COLUMNS, |text| {
        let [id, x, y, z] = fields(text, COLUMNS)?;
        let position = [number("x", x)?, number("y", y)?, number("z", z)?];
        Ok(RawNode { id: node_id(id)?, position })
    })
}

pub(super) fn read_dofs(source: impl Read, limit: usize) -> Result<Table<RawDof>, TableFault> {
    const COLUMNS: &str = "node,component";
    read(source, limit, COLUMNS, |text| {
        let [node, component] = fields(text, COLUMNS)?;
        let node = node_id(node)?;
        match component {
            "1" => Ok(RawDof { node, component: 1 }),
            "2" => Ok(RawDof { node, component: 2 }),
            "3" => Ok(RawDof { node, component: 3 }),
            other => Err(TableProblem::BadComponent { text: quoted(other) }),
        }
    })
}

/// Reads elements, whose sets must be among those of `mesh`.
pub(super) fn read_elements(
    source: impl Read,
    limit: usize,
    mesh: &ManifestMesh,
) -> Result<Table<RawElement>, TableFault> {
    const COLUMNS: &str = "id,type,set,n1,n2";
    let sets: HashMap<&str, Arc<str>> =
        mesh.sets.keys().map(|name| (name.as_str(), Arc::from(name.as_str()))).collect();
    read(source, limit, COLUMNS, |text| {
        let mut words = text.split(',').map(unquoted);
        let mut word = || words.next().unwrap_or_default();
        let (id, kind, set) = (word(), word(), word());
        let id = id.parse().map_err(|_| TableProblem::BadElementId { text: quoted(id) })?;
        let Some(kind) = ElementKind::named(kind) else {
            return Err(TableProblem::UnknownElementType { element: id, text: quoted(kind) });
        };
        let Some(set) = sets.get(set) else {
            return Err(TableProblem::ElementWithoutMaterial { element: id, set: quoted(set) });
        };
        let found = words.clone().count();
        if found != kind.nodes() {
            return Err(TableProblem::ElementNodeCount {
                element: id,
                kind: kind.name(),
                found,
                expected: kind.nodes(),
            });
        }
        let nodes = words.map(node_id).collect::<Result<_, _>>()?;
        Ok(RawElement { id, kind, set: Arc::clone(set), nodes })
    })
}

fn read<T>(
    source: impl Read,
    limit: usize,
    columns: &'static str,
    parse: impl Fn(&str) -> Result<T, TableProblem>,
) -> Result<Table<T>, TableFault> {
    let mut lines = Lines::new(source);
    let mut table = Table { rows: Vec::new(), lines: Vec::new() };
    let mut header_possible = true;
    while let Some(bytes) = lines.next(|limit| TableProblem::LineTooLong { limit })? {
        let text = String::from_utf8_lossy(bytes);
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() {
            continue;
        }
        let row = if std::mem::take(&mut header_possible) && is_header(text) {
            check_header(text, columns).map(|()| None)
        } else if table.rows.len() == limit {
            Err(TableProblem::TooManyRows { limit })
        } else {
            parse(text).map(Some)
        };
        match row {
            Err(problem) => return Err(Fault::At { line: lines.number(), problem }),
            Ok(None) => {}
            Ok(Some(row)) => {
                table.rows.push(row);
                table.lines.push(lines.number());
            }
        }
    }
    if table.rows.is_empty() {
        return Err(Fault::At { line: lines.number().max(1), problem: TableProblem::Empty });
    }
    Ok(table)
}

fn fields<'a, const C: usize>(text: &'a str, columns: &'static str) -> Result<[&'a str; C], TableProblem> {
    let mut all = [""; C];
    let mut found = 0;
    for field in text.split(',') {
        if let Some(slot) = all.get_mut(found) {
            *slot = unquoted(field);
        }
        found += 1;
    }
    if found == C { Ok(all) } else { Err(TableProblem::FieldCount { found, expected: C, columns }) }
}

/// Whether a line is a header, which names its first column; a row starts with a number.
fn is_header(text: &str) -> bool {
    let first = unquoted(text.split(',').next().unwrap_or_default());
    first.starts_with(|c: char| c.is_alphabetic() || c == '#' || c == '_') && first.parse::<f64>().is_err()
}

/// Names of cylindrical coordinates, where Cartesian ones are read.
const CYLINDRICAL: [&str; 6] = ["r", "rho", "radius", "theta", "phi", "angle"];

/// Checks a header: it may use any names, but not ours in another order, nor those of other coordinates, as the columns would be read wrongly.
fn check_header(text: &str, columns: &'static str) -> Result<(), TableProblem> {
    let names =
        || text.split(',').map(|name| unquoted(name).trim_start_matches('#').trim().to_ascii_lowercase());
    let is_cartesian = columns.split(',').any(|column| column == "x");
    if is_cartesian && let Some(name) = names().find(|name| CYLINDRICAL.contains(&name.as_str())) {
        return Err(TableProblem::HeaderCylindrical { name, columns });
    }
    let misplaced = names()
        .zip(columns.split(','))
        .any(|(name, expected)| name != expected && columns.split(',').any(|column| column == name));
    if misplaced { Err(TableProblem::HeaderOrder { columns }) } else { Ok(()) }
}

fn unquoted(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(field, str::trim)
}

fn node_id(text: &str) -> Result<u64, TableProblem> {
    text.parse().map_err(|_| TableProblem::BadId { text: quoted(text) })
}

fn number(column: &'static str, text: &str) -> Result<f64, TableProblem> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite());
    value.ok_or_else(|| TableProblem::BadNumber { column, text: quoted(text) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_reads_the_same_however_it_is_laid_out() {
        let plain = read_nodes("1,0.5,-2,3e-1\n7,1,2,3\n".as_bytes(), 9).expect("plain");
        assert_eq!(plain.lines, [1, 2]);
        let laid_out = "\u{feff}Id, X, Y, Z\r\n\r\n  1 , 0.5, -2.0 ,0.3\r\n   \r\n\"7\",\"1\",\"2\",\"3\"";
        let laid_out = read_nodes(laid_out.as_bytes(), 9).expect("laid out");
        assert_eq!(laid_out.rows, plain.rows);
        assert_eq!(laid_out.lines, [3, 5]);
    }

    #[test]
    fn a_wrong_line_is_named() {
        let fault = |text: &str| match read_dofs(text.as_bytes(), 3) {
            Err(Fault::At { line, problem }) => (line, problem.to_string()),
            other => panic!("{other:?}"),
        };
        assert_eq!(fault("1,1\n1,4\n"), (2, "component \"4\" is not 1, 2 or 3".into()));
        assert_eq!(fault("component,node\n1,1\n").0, 1);
        assert_eq!(fault("1,1\n\n2;2\n").0, 3);
        assert_eq!(
            fault("1,1\n1,2\n1,3\n2,1\n"),
            (4, "the table has more than the 3 rows this server accepts".into())
        );
        assert_eq!(fault("node,component\n"), (1, "the table has no rows".into()));
        assert_eq!(
            fault("1,1\nnode,component\n"),
            (2, "\"node\" is not a node id (an integer from 0)".into())
        );
    }
}
