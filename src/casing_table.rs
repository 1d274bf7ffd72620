//! Measured shapes of a casing from text: tables of heights over angle and place along the chord.
//!
//! Two layouts, told apart by the header: *wide*, `angle_deg, 0, 0.5, 1` (shares of the chord) or `angle_deg, node0, node1, …`; and
//! *long*, `angle_deg, chord, height` or `angle_deg, node, height`, every row a point. `angle_rad` for rad. Fields are parted by comma,
//! semicolon or tab (with these two decimals may have commas); rows come in any order; lines with `#` are comments; an empty field, `nan` or `-` is a
//! height that is missing.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt;

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::analysis::result::MeasuredCasing;
use crate::analysis::run::{MeasuredLine, measured_casing};

/// Points that are read at most from a table.
const MOST_POINTS: usize = 200_000;
/// Lines along the chord that are read at most: as many as a request may have.
const MOST_LINES: usize = 8192;
/// Turns that angles may span: -180 to 180 degrees, 0 to 360, and a turn more.
const MOST_TURNS: f64 = 2.0;
/// Errors after which no more are looked for.
const MOST_ERRORS: usize = 100;

/// Error in a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableError {
    /// Line of the text, from 1; `None` where the error is not about one line.
    pub line: Option<u64>,
    /// Description of the error, and of what would be right.
    pub message: String,
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl TableError {
    fn whole(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }
}

/// Place along the chord at which heights of a column or a row stand.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Chord(f64),
    Node(u32),
}

/// Columns of a table, read from its header.
#[derive(Debug)]
struct Header {
    angle: usize,
    /// Angle in rad of one unit of the angles.
    unit_rad: f64,
    layout: Layout,
    /// Whether decimals may have a comma.
    comma: bool,
}

#[derive(Debug)]
enum Layout {
    /// Column and place of every line along the chord.
    Wide(Vec<(usize, Place)>),
    /// Columns of place and height, and whether places are contact nodes.
    Long { place: usize, height: usize, nodes: bool },
}

/// Reads a table; reports all errors of its fields at once.
pub fn read(text: &[u8]) -> Result<MeasuredCasing, Vec<TableError>> {
    let one = |error: TableError| vec![error];
    let text = std::str::from_utf8(text)
        .map_err(|_| one(TableError::whole("the table is not UTF-8 text: save it as UTF-8")))?;
    let text = text.trim_start_matches('\u{feff}');
    let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let first = first.ok_or_else(|| one(TableError::whole("the table is empty")))?;
    let delimiter = [b'\t', b';'].into_iter().find(|&part| first.contains(char::from(part))).unwrap_or(b',');
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let names = reader.headers().map_err(|error| one(TableError::whole(error.to_string())))?;
    let line = names.position().map(csv::Position::line);
    let header = Header::of(names, delimiter != b',').map_err(|message| one(TableError { line, message }))?;
    // Keyed by the bits of their places, which have the order of the places as none is negative.
    let mut lines: BTreeMap<u64, MeasuredLine> = BTreeMap::new();
    let (mut errors, mut points) = (Vec::new(), 0);
    for record in reader.records() {
        let row = match record {
            Ok(record) => header.row(&record),
            Err(error) => {
                let line = error.position().map(csv::Position::line);
                let message = match error.kind() {
                    csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                        format!("{len} fields, where the header has {expected_len}")
                    }
                    _ => error.to_string(),
                };
                Err(TableError { line, message })
            }
        };
        match row {
            Ok(row) => {
                for (place, angle, height) in row {
                    points += 1;
                    let place = place.number();
                    let new = || MeasuredLine { place, points: Vec::new() };
                    lines.entry(place.to_bits()).or_insert_with(new).points.push((angle, height));
                }
            }
            Err(error) => errors.push(error),
        }
        if points > MOST_POINTS || lines.len() > MOST_LINES {
            let message = format!("at most {MOST_POINTS} heights on {MOST_LINES} lines");
            return Err(one(TableError::whole(message)));
        }
        if errors.len() >= MOST_ERRORS {
            break;
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let each_node = header.of_nodes();
    let lines: Vec<MeasuredLine> = lines.into_values().collect();
    if lines.is_empty() {
        return Err(one(TableError::whole("the table has no heights")));
    }
    let angles = || lines.iter().flat_map(|line| line.points.iter().map(|point| point.0));
    let span = angles().fold(f64::NEG_INFINITY, f64::max) - angles().fold(f64::INFINITY, f64::min);
    if span > MOST_TURNS * TAU {
        let turns = span / TAU;
        let message = format!(
            "angles span {turns:.0} turns: is their unit that of the header, angle_deg or angle_rad?"
        );
        return Err(one(TableError::whole(message)));
    }
    if let Some(name) = header.without_heights(&lines) {
        let message = format!("there is no height in the column {name}: leave it out");
        return Err(one(TableError::whole(message)));
    }
    if each_node && lines.iter().enumerate().any(|(node, line)| line.place != node as f64) {
        let message = "contact nodes count from 0 at the leading edge, and every one has its heights";
        return Err(one(TableError::whole(message)));
    }
    measured_casing(&lines, each_node).map_err(|(line, error)| {
        let name = if each_node { "contact node" } else { "the line at" };
        one(TableError::whole(match line {
            Some(line) => format!("{name} {} {error}", lines[line].place),
            None => error.to_string(),
        }))
    })
}

impl Place {
    /// Number by which places are sorted, never negative nor −0: share of the chord or contact node.
    fn number(self) -> f64 {
        match self {
            Self::Chord(share) => share.abs(),
            Self::Node(node) => node.into(),
        }
    }
}

impl Header {
    fn of(names: &StringRecord, comma: bool) -> Result<Self, String> {
        if names.len() > MOST_LINES + 1 {
            return Err(format!("at most {MOST_LINES} lines beside the angle"));
        }
        let names: Vec<String> = names.iter().map(str::to_lowercase).collect();
        if let Some(column) = names.iter().position(String::is_empty) {
            let rest = "leave away what parts it from the last one, in all rows";
            return Err(format!("column {} has no name: {rest}", column + 1));
        }
        let find = |name: &str| names.iter().position(|one| one == name);
        let (angle, unit_rad) = match (find("angle_deg"), find("angle_rad")) {
            (Some(column), None) => (column, 1f64.to_radians()),
            (None, Some(column)) => (column, 1.0),
            _ => return Err("the header names one column angle_deg or angle_rad".to_owned()),
        };
        let others = || names.iter().enumerate().filter(move |(column, _)| *column != angle);
        if let Some(height) = find("height") {
            let (place, nodes) = match (find("chord"), find("node")) {
                (Some(column), None) => (column, false),
                (None, Some(column)) => (column, true),
                _ => return Err("beside height the header names one column chord or node".to_owned()),
            };
            return match others().find(|(column, _)| *column != place && *column != height) {
                Some((_, name)) => {
                    Err(format!("a column {name} is not known beside angle, place and height"))
                }
                None => Ok(Self { angle, unit_rad, layout: Layout::Long { place, height, nodes }, comma }),
            };
        }
        let place = |name: &str| match name.strip_prefix("node") {
            Some(node) => node.trim().parse().ok().map(Place::Node),
            None => number(name, comma).map(Place::Chord),
        };
        let columns: Option<Vec<(usize, Place)>> =
            others().map(|(column, name)| Some((column, place(name)?))).collect();
        let columns = columns.filter(|columns| !columns.is_empty()).ok_or(
            "beside the angle the header names places along the chord (numbers from 0 to 1), contact nodes (node0, node1, …), \
             or chord and height",
        )?;
        let nodes = columns.iter().filter(|(_, place)| matches!(place, Place::Node(_))).count();
        let chord = |place: &Place| matches!(place, Place::Chord(share) if !(0.0..=1.0).contains(share));
        if nodes != 0 && nodes != columns.len() || columns.iter().any(|(_, place)| chord(place)) {
            return Err("columns are all contact nodes, or all places along the chord from 0 to 1".to_owned());
        }
        let twice =
            (1..columns.len()).find(|&k| columns[..k].iter().any(|(_, place)| *place == columns[k].1));
        match twice {
            Some(k) => Err(format!("the header names {} twice", names[columns[k].0])),
            None => Ok(Self { angle, unit_rad, layout: Layout::Wide(columns), comma }),
        }
    }

    /// Whether places are contact nodes.
    fn of_nodes(&self) -> bool {
        match &self.layout {
            Layout::Wide(columns) => columns.iter().any(|(_, place)| matches!(place, Place::Node(_))),
            Layout::Long { nodes, .. } => *nodes,
        }
    }

    /// Name of a column that has no heights.
    fn without_heights(&self, lines: &[MeasuredLine]) -> Option<String> {
        let Layout::Wide(columns) = &self.layout else { return None };
        let has = |place: Place| lines.binary_search_by(|line| line.place.total_cmp(&place.number())).is_ok();
        let (_, place) = columns.iter().find(|(_, place)| !has(*place))?;
        Some(match place {
            Place::Chord(share) => share.to_string(),
            Place::Node(node) => format!("node{node}"),
        })
    }

    /// Places, angles in rad and heights of a row, without missing heights.
    fn row(&self, record: &StringRecord) -> Result<Vec<(Place, f64, f64)>, TableError> {
        let wrong =
            |message: String| TableError { line: record.position().map(csv::Position::line), message };
        let value = |column: usize| {
            let text = &record[column];
            number(text, self.comma).ok_or_else(|| wrong(format!("{text:?} is no number")))
        };
        let height = |column: usize| {
            let missing = ["", "nan", "-"].contains(&record[column].to_lowercase().as_str());
            if missing { Ok(None) } else { value(column).map(Some) }
        };
        let angle = value(self.angle)? * self.unit_rad;
        match &self.layout {
            Layout::Wide(columns) => {
                let heights = columns.iter().map(|&(column, place)| Ok((place, height(column)?)));
                let heights: Vec<(Place, Option<f64>)> = heights.collect::<Result<_, TableError>>()?;
                Ok(heights.into_iter().filter_map(|(place, height)| Some((place, angle, height?))).collect())
            }
            Layout::Long { place, height: column, nodes } => {
                let at = value(*place)?;
                let place = match nodes {
                    false if (0.0..=1.0).contains(&at) => Place::Chord(at),
                    true if at >= 0.0 && at.fract() == 0.0 && at < f64::from(u32::MAX) => {
                        Place::Node(at as u32)
                    }
                    false => return Err(wrong(format!("{at} is no place along the chord from 0 to 1"))),
                    true => return Err(wrong(format!("{at} is no contact node, which count from 0"))),
                };
                Ok(height(*column)?.map(|height| (place, angle, height)).into_iter().collect())
            }
        }
    }
}

/// Reads a finite number.
fn number(text: &str, comma: bool) -> Option<f64> {
    let text = if comma { text.replace(',', ".") } else { text.to_owned() };
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(degrees: f64, share: f64) -> f64 {
        0.3 + 0.1 * (1.0 - share) * (2.0 * degrees.to_radians()).cos()
    }

    fn rows(of: impl Fn(f64) -> String) -> String {
        (0..36).map(|i| of(10.0 * f64::from(i))).collect()
    }

    fn message(text: &str) -> (Option<u64>, String) {
        let mut errors = read(text.as_bytes()).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:?}");
        let TableError { line, message } = errors.remove(0);
        (line, message)
    }

    /// Reads one table in all spellings.
    #[test]
    fn a_table_reads_the_same_however_it_is_laid_out() {
        let heights = |d: f64| (height(d, 0.0), height(d, 0.5), height(d, 1.0));
        let wide = rows(|d| {
            let (a, b, c) = heights(d);
            format!("{d},{a},{b},{c}\n")
        });
        let expected = read(format!("angle_deg,0,0.5,1\n{wide}").as_bytes()).unwrap();
        assert_eq!(expected.measured.angles_rad.len(), 36);
        assert_eq!(expected.measured.chord, Some(vec![0.0, 0.5, 1.0]));
        assert_eq!(expected.filled_count, 0);
        let long = |name: &str, place: fn(usize) -> String| {
            let rows = rows(|d| {
                let (a, b, c) = heights(d);
                [a, b, c].iter().enumerate().rev().map(|(k, h)| format!("{h},{},{d}\n", place(k))).collect()
            });
            format!("height,{name},angle_deg\n{rows}")
        };
        let radians = rows(|d| {
            let (a, b, c) = heights(d);
            format!("{},{a},{b},{c}\n", d.to_radians())
        });
        let european = wide.replace(',', ";").replace('.', ",");
        let spellings = [
            format!("\u{feff}# measured cold\r\nAngle_deg, 0, 0.5, 1\r\n{}", wide.replace('\n', "\r\n")),
            format!("angle_deg;0;0,5;1\n{european}"),
            format!("angle_deg\t0\t0.5\t1\n{}", wide.replace(',', "\t")),
            format!("angle_deg\t0\t0,5\t1\n{}", wide.replace(',', "\t").replace('.', ",")),
            format!("angle_rad,0,0.5,1\n{radians}"),
            format!("angle_deg,0,0.5,1\n{}360,0.4,0.35,0.3\n", wide),
            long("chord", |k| (0.5 * k as f64).to_string()),
        ];
        for text in spellings {
            assert_eq!(read(text.as_bytes()), Ok(expected.clone()), "{text}");
        }
        let by_node = long("node", |k| k.to_string());
        let by_column = format!("angle_deg,node0,node1,node2\n{wide}");
        for text in [by_node, by_column] {
            let found = read(text.as_bytes()).unwrap().measured;
            assert_eq!((found.chord, found.heights), (None, expected.measured.heights.clone()));
        }
    }

    #[test]
    fn missing_heights_are_filled_and_told() {
        let table =
            rows(|d| if d == 50.0 { "50,nan,0.3\n".into() } else { format!("{d},{},0.3\n", height(d, 0.0)) });
        let found = read(format!("angle_deg,0,1\n{table}").as_bytes()).unwrap();
        assert_eq!(found.filled_count, 1);
        let filled = &found.filled[0];
        assert!((filled.angle_rad.to_degrees() - 50.0).abs() < 1e-9 && filled.line == 0);
        assert!((filled.height - height(50.0, 0.0)).abs() < 1e-3, "{filled:?}");
    }

    #[test]
    fn what_is_wrong_is_said_where_it_is() {
        let good = rows(|d| format!("{d},0.3\n"));
        let of = |header: &str| message(&format!("{header}\n{good}"));
        assert_eq!(message("").1, "the table is empty");
        assert!(of("angle,0").1.contains("angle_deg or angle_rad"));
        assert!(of("angle_deg,leading").1.contains("places along the chord"));
        assert!(of("angle_deg,1.5").1.contains("from 0 to 1"));
        assert!(of("angle_deg,node1").1.contains("count from 0"));
        assert!(message("angle_deg,0,0.0\n1,2,3\n").1.contains("twice"));
        assert_eq!(
            message(&format!("angle_deg,0\n{good}45,much\n")),
            (Some(38), "\"much\" is no number".to_owned())
        );
        let (line, said) = message(&format!("angle_deg,0\n{good}45,1,2\n"));
        assert_eq!((line, said.as_str()), (Some(38), "3 fields, where the header has 2"));
        assert!(of("angle_deg,").1.contains("column 2 has no name"));
        assert!(message(&format!("angle_rad,0\n{good}")).1.contains("56 turns"));
        let empty = rows(|d| format!("{d},0.3,\n"));
        assert!(message(&format!("angle_deg,0,0.5\n{empty}")).1.contains("no height in the column 0.5"));
        assert!(message("angle_deg,0\n0,1\n90,1\n180,1\n").1.contains("the line at 0 has 3 heights"));
        assert!(message(&format!("angle_deg,0\n{good}10,0.4\n")).1.contains("two heights at 10"));
        let all = read(b"angle_deg,0\nx,1\n1,y\n").unwrap_err();
        assert_eq!(all.iter().map(|error| error.line).collect::<Vec<_>>(), [Some(2), Some(3)]);
        assert!(read(b"angle_deg,0\n\xff,1\n").unwrap_err()[0].message.contains("UTF-8"));
        assert!(message("angle_deg,chord,height\n0,2,1\n").1.contains("no place along the chord"));
        assert!(message("angle_deg,node,height\n0,0.5,1\n").1.contains("no contact node"));
    }
}
