use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rubmap_solid::defect::defect;
use rubmap_solid::element::ElementKind;
use rubmap_solid::topology::Topology;

use super::*;

/// Encodings of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Inline,
    AppendedRaw,
    AppendedBase64,
}

/// Way in which a test's file is written.
#[derive(Debug, Clone, Copy)]
struct Way {
    encoding: Encoding,
    wide: bool,
    zlib: bool,
}

const ASCII: Way = Way { encoding: Encoding::Ascii, wide: false, zlib: false };

/// Grid of a test.
struct Grid {
    points: Vec<[f64; 3]>,
    cells: Vec<(u8, Vec<i64>)>,
    point_data: Vec<(&'static str, Vec<i64>)>,
    cell_data: Vec<(&'static str, Vec<i64>)>,
}

impl Grid {
    fn of(points: Vec<[f64; 3]>, cells: Vec<(u8, Vec<i64>)>) -> Self {
        Self { points, cells, point_data: Vec::new(), cell_data: Vec::new() }
    }

    /// File of the grid.
    fn file(&self, way: Way) -> Vec<u8> {
        let mut appended = Vec::new();
        let mut array = |name: &str, kind: &str, components: usize, numbers: &[f64]| {
            let begin =
                format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
            let payload = payload(kind, numbers, way);
            match way.encoding {
                Encoding::Ascii => {
                    let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
                    format!("{begin} format=\"ascii\">\n{}\n</DataArray>\n", words.join(" "))
                }
                Encoding::Inline => {
                    format!("{begin} format=\"binary\">\n{}\n</DataArray>\n", base64(&payload))
                }
                Encoding::AppendedRaw | Encoding::AppendedBase64 => {
                    let offset = appended.len();
                    match way.encoding {
                        Encoding::AppendedRaw => appended.extend(payload.concat()),
                        _ => appended.extend(base64(&payload).into_bytes()),
                    }
                    format!("{begin} format=\"appended\" offset=\"{offset}\"/>\n")
                }
            }
        };
        let reals = |numbers: &[i64]| numbers.iter().map(|&number| number as f64).collect::<Vec<f64>>();
        let mut text = String::new();
        for (section, data) in [("PointData", &self.point_data), ("CellData", &self.cell_data)] {
            text += &format!("<{section}>\n");
            data.iter().for_each(|(name, numbers)| text += &array(name, "Int32", 1, &reals(numbers)));
            text += &format!("</{section}>\n");
        }
        text += "<Points>\n";
        text += &array("Points", "Float64", 3, &self.points.concat());
        text += "</Points>\n<Cells>\n";
        let mut end = 0;
        let mut ends = Vec::new();
        for (_, cell) in &self.cells {
            end += cell.len() as i64;
            ends.push(end);
        }
        let all: Vec<i64> = self.cells.iter().flat_map(|(_, cell)| cell.clone()).collect();
        text += &array("connectivity", "Int64", 1, &reals(&all));
        text += &array("offsets", "Int64", 1, &reals(&ends));
        let types: Vec<i64> = self.cells.iter().map(|cell| i64::from(cell.0)).collect();
        text += &array("types", "UInt8", 1, &reals(&types));
        let header = if way.wide { "UInt64" } else { "UInt32" };
        let compressor = if way.zlib { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let (points, cells) = (self.points.len(), self.cells.len());
        let begin = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"{header}\"{compressor}>\n<UnstructuredGrid>\n\
             <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
        );
        let mut bytes = format!("{begin}{text}</Cells>\n</Piece>\n</UnstructuredGrid>\n").into_bytes();
        if !appended.is_empty() {
            let encoding = if way.encoding == Encoding::AppendedRaw { "raw" } else { "base64" };
            bytes.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").into_bytes());
            bytes.extend(appended);
            bytes.extend(b"\n</AppendedData>\n");
        }
        bytes.extend(b"</VTKFile>\n");
        bytes
    }
}

/// Header and data, each a text of its own where they are compressed.
fn payload(kind: &str, numbers: &[f64], way: Way) -> Vec<Vec<u8>> {
    let bytes: Vec<u8> = numbers
        .iter()
        .flat_map(|&number| match kind {
            "Float64" => number.to_le_bytes().to_vec(),
            "Int32" => (number as i32).to_le_bytes().to_vec(),
            "UInt8" => vec![number as u8],
            _ => (number as i64).to_le_bytes().to_vec(),
        })
        .collect();
    let header = |number: usize| number.to_le_bytes()[..if way.wide { 8 } else { 4 }].to_vec();
    if !way.zlib {
        return vec![[header(bytes.len()), bytes].concat()];
    }
    const BLOCK: usize = 40;
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(zlib).collect();
    let sizes = blocks.iter().flat_map(|block| header(block.len()));
    let head = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().flat_map(header);
    vec![head.chain(sizes).collect(), blocks.concat()]
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

fn base64(parts: &[Vec<u8>]) -> String {
    parts.iter().map(|part| STANDARD.encode(part)).collect()
}

fn ways() -> Vec<Way> {
    let mut ways = vec![ASCII];
    for encoding in [Encoding::Inline, Encoding::AppendedRaw, Encoding::AppendedBase64] {
        for (wide, zlib) in [(false, false), (false, true), (true, false), (true, true)] {
            ways.push(Way { encoding, wide, zlib });
        }
    }
    ways
}

fn refusal(bytes: &[u8]) -> String {
    read(bytes).expect_err("a refusal").to_string()
}

/// Text of a file in ASCII with a part replaced.
fn replaced(grid: &Grid, from: &str, to: &str) -> String {
    let text = String::from_utf8(grid.file(ASCII)).expect("text");
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

fn cube() -> Grid {
    let points = Topology::of(ElementKind::C3D8).nodes();
    let mut grid = Grid::of(points, vec![(9, vec![0, 1, 2, 3]), (12, (0..8).collect())]);
    grid.point_data = vec![
        ("GlobalNodeId", (11..19).collect()),
        ("held", vec![1, 1, 0, 0, 0, 0, 0, 1]),
        ("sector", vec![0; 8]),
        ("body", vec![1, 2, 1, 1, 1, 1, 1, 1]),
    ];
    grid.cell_data = vec![("gmsh:physical", vec![5, -6]), ("CellEntityIds", vec![1, 2])];
    grid
}

#[test]
fn every_encoding_gives_the_same_mesh() {
    let expected = read(&cube().file(ASCII)).expect("a mesh");
    assert_eq!(expected.nodes[&11], [-1.0; 3]);
    assert_eq!(expected.elements[&2].nodes, (11..19).collect::<Vec<u64>>());
    assert_eq!(expected.elements[&2].kind, ElementKind::C3D8I);
    assert_eq!(expected.node_sets.len(), 1);
    assert_eq!(expected.node_sets["held"], [11, 12, 18]);
    assert_eq!(expected.element_sets.len(), 1);
    assert!(expected.element_sets["gmsh:physical -6"].contains(&2));
    assert_eq!(expected.left_out["quadrilateral"], 1);
    assert_eq!(expected.notes.len(), 1);
    for way in ways() {
        assert_eq!(read(&cube().file(way)).as_ref(), Ok(&expected), "{way:?}");
    }
}

#[test]
fn all_may_stand_on_one_line() {
    let file = cube().file(ASCII);
    let text = String::from_utf8(file.clone()).unwrap();
    let body = &text[text.find("<VTKFile").unwrap()..];
    let line = format!("<?xml version=\"1.0\" encoding=\"utf-8\"?>{}", body.replace('\n', " "));
    let none = |_: &str| Err(String::new());
    assert_eq!(crate::read(line.as_bytes(), &none), read(&file));
}

#[test]
fn cells_of_every_type() {
    use ElementKind::{C3D4, C3D5, C3D6, C3D8I, C3D10, C3D13, C3D15, C3D20};
    // Edges of VTK's quadratic cells are those of CalculiX, so that only the corners of wedges tell the orders apart.
    for (number, kind) in
        [(10, C3D4), (12, C3D8I), (13, C3D6), (14, C3D5), (24, C3D10), (25, C3D20), (26, C3D15), (27, C3D13)]
    {
        let points = Topology::of(kind).nodes();
        let grid = Grid::of(points.clone(), vec![(number, (0..points.len() as i64).collect())]);
        let mesh = read(&grid.file(ASCII)).expect("a mesh");
        let element = &mesh.elements[&1];
        let positions: Vec<[f64; 3]> = element.nodes.iter().map(|node| mesh.nodes[node]).collect();
        assert_eq!((element.kind, defect(kind, &positions)), (kind, None));
        assert_eq!(positions, points);
    }
    // VTK's wedge is seen from the other side.
    for (number, order) in
        [(13, vec![0, 2, 1, 3, 5, 4]), (26, vec![0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13])]
    {
        let kind = if number == 13 { C3D6 } else { C3D15 };
        let grid = Grid::of(Topology::of(kind).nodes(), vec![(number, order)]);
        let mesh = read(&grid.file(ASCII)).expect("a mesh");
        assert_eq!(mesh.elements[&1].nodes, (1..=kind.nodes() as u64).collect::<Vec<u64>>());
    }
    let corners = Topology::of(C3D8I).nodes();
    let voxel = [0, 1, 3, 2, 4, 5, 7, 6].map(|k: usize| corners[k]).to_vec();
    let mesh = read(&Grid::of(voxel, vec![(11, (0..8).collect())]).file(ASCII)).expect("a mesh");
    let positions: Vec<[f64; 3]> = mesh.elements[&1].nodes.iter().map(|node| mesh.nodes[node]).collect();
    assert_eq!(positions, corners);
    let collapsed = Grid::of(corners, vec![(12, vec![0, 1, 2, 2, 4, 5, 6, 6])]);
    assert_eq!(read(&collapsed.file(ASCII)).expect("a mesh").elements[&1].kind, C3D6);
}

#[test]
fn refusals() {
    let grid = cube();
    for (from, to, what) in [
        ("LittleEndian", "BigEndian", "big-endian"),
        ("\"UInt32\"", "\"UInt16\"", "is not a header_type"),
        ("UnstructuredGrid\"", "PolyData\"", "a VTK file of type \"PolyData\""),
        ("</Piece>", "</Piece><Piece/>", "several pieces"),
        ("header_type", "compressor=\"vtkLZ4DataCompressor\" header_type", "vtkLZ4DataCompressor"),
        ("9 12", "9 29", "hexahedra of 27 nodes (cell type 29)"),
        ("9 12", "9 99", "cells of type 99"),
        ("9 12", "9 10", "4 points of cell 2 (C3D4)"),
        ("4 12", "4 -1", "ends of cells that rise"),
        ("4 12", "13 12", "ends of cells that rise"),
        ("4 12", "4 1000000000000000000", "1000000000000000000 numbers, and not 12"),
        ("4 12", "4 11", "11 numbers, and no more"),
        ("0 1 2 3 0 1 2 3 4 5 6 7", "0 1 2 3 0 1 2 3 4 5 6 8", "a point from 0 to 7"),
        ("0 1 2 3 0 1 2 3 4 5 6 7", "0 1 2 3 0 1 2 3 4 5 0 7", "element 2 repeats nodes"),
        ("11 12 13", "11 11 13", "node 11 is there twice"),
        ("11 12 13", "-1 12 13", "is not a number of a node"),
        ("gmsh:physical", "element", "-6"),
        ("5 -6", "5 x", "gmsh:physical: \"x\" is not an integer"),
        ("9 12", "9 9", "no solid element (left out: 2 of type quadrilateral)"),
        ("NumberOfPoints=\"8\"", "NumberOfPoints=\"1000000000000000000\"", "Points: expected"),
        ("\"8\"", "\"-8\"", "is not a number of points"),
        ("-1 -1", "nan -1", "is not a number"),
        ("Float64", "Float16", "is not a type of numbers"),
        ("Float64", "Int64", "Float32 or Float64"),
        ("\"types\"", "\"kinds\"", "a DataArray named types"),
        ("</VTKFile>", "", "is it cut short?"),
        ("<Points>", "<Points", "well-formed XML"),
    ] {
        let error = refusal(replaced(&grid, from, to).as_bytes());
        assert!(error.contains(what), "{from} {to}: {error}");
    }
    let twice = replaced(&grid, "gmsh:physical", "element").replace("5 -6", "6 6").replace("9 12", "12 12");
    let twice = twice.replace("0 1 2 3 0 1", "0 1 2 3 4 5 6 7 0 1").replace("4 12\n", "8 16\n");
    assert!(refusal(twice.as_bytes()).contains("element 6 is there twice"), "{}", refusal(twice.as_bytes()));
}

#[test]
fn hostile_headers() {
    let way = |encoding, zlib| Way { encoding, wide: true, zlib };
    let bytes = cube().file(way(Encoding::AppendedRaw, false));
    let place = bytes.windows(2).position(|pair| pair == b" _").expect("data") + 2;
    let mut other = bytes.clone();
    other[place..place + 8].fill(0xff);
    assert!(refusal(&other).contains("bytes of data, as the file has"));
    let text = String::from_utf8(cube().file(way(Encoding::Inline, true))).expect("text");
    let claims = text.replace("=\"8\"", "=\"100000000000000000\"");
    assert!(refusal(claims.as_bytes()).contains("in a file of this size"));
    // A megabyte of zeros for twenty-four coordinates.
    let bomb = zlib(&vec![0; 1 << 20]);
    let header: Vec<u8> = [1, 1 << 20, 0, bomb.len()].into_iter().flat_map(usize::to_le_bytes).collect();
    let begin = text.find("\"Points\"").expect("points");
    let begin = begin + text[begin..].find('>').expect("a tag") + 1;
    let end = begin + text[begin..].find('<').expect("a tag");
    let bombed = format!("{}{}{}", &text[..begin], base64(&[header, bomb]), &text[end..]);
    assert!(refusal(bombed.as_bytes()).contains("and not more"), "{}", refusal(bombed.as_bytes()));
    let attributes = "a=\">\" ".repeat(1000);
    assert!(refusal(format!("<VTKFile {attributes}").as_bytes()).contains("tags of at most"));
    assert!(read("<a>".repeat(200_000).as_bytes()).is_err());
    assert!(refusal(b"<VTKFile>\0").contains("cut short"));
    assert!(refusal(b"\xff").contains("UTF-8"));
}

/// Truncated and corrupted files are read or refused, without panic.
#[test]
fn hostile_files() {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    for way in ways() {
        let bytes = cube().file(way);
        (0..bytes.len()).for_each(|end| drop(read(&bytes[..end])));
        for _ in 0..2_000 {
            let mut other = bytes.clone();
            let place = random() % other.len();
            other[place] = random() as u8;
            drop(read(&other));
        }
    }
}
