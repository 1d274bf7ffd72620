//! Meshes in the files of other programs.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

use anyhow::Context;
use rubmap_mesh::MeshFormat;
use rubmap_model::from_mesh::{MeshSettings, sector};
use rubmap_model::package::raw::Axis;
use rubmap_model::package::to_sector;
use rubmap_solid::material::Material;
use rubmap_wheel::dynamics::modal_wheel::natural_frequencies;
use rubmap_wheel::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap_wheel::dynamics::sector::Units;

use super::blade::relative;
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "beam-in-every-format",
    covers: &[
        Subject::Mesh(MeshFormat::Inp),
        Subject::Mesh(MeshFormat::Gmsh),
        Subject::Mesh(MeshFormat::Nastran),
        Subject::Mesh(MeshFormat::Ansys),
        Subject::Mesh(MeshFormat::Vtu),
    ],
    claim: "A mesh of 20-node hexahedra is the same body in every format, in millimetres as in metres.",
    reference: "closed form: cantilever of Euler and Bernoulli, 2πf = 1.87510²√(EI/ρAL⁴), bent about either axis of its section",
    quantity: "largest relative error of both frequencies in hertz, five formats in mm, t, N and in m, kg, N",
    check: Check::Computed(Computed {
        error: beam_in_every_format,
        wrong: "Young's modulus",
        limit: 2e-3,
        reason: "shear, rotary inertia and the mesh: a beam thirty and twenty times as long as it is thick",
    }),
}];

/// Edges of a hexahedron, each between two corners, in the orders in which programs number their middles.
type Edges = [[usize; 2]; 12];

/// Order of Abaqus, Ansys and VTK: around the bottom, around the top, upwards.
const UPWARDS_LAST: Edges =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Order of Nastran: around the bottom, upwards, around the top.
const TOP_LAST: Edges =
    [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 6], [6, 7], [7, 4]];

/// Order of Gmsh: by the lower corner, then by the other.
const BY_CORNER: Edges =
    [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]];

/// Corners of a hexahedron in half elements from its first one, in the order of all programs.
const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];

/// Length along x, width along y and depth along z of the beam, in millimetres, and the distance of its root from the axis.
const SIZE: [f64; 3] = [120.0, 4.0, 6.0];
const ROOT: f64 = 10.0;
const ELEMENTS: usize = 16;

/// Nodes and elements of the beam in an order of edges.
struct Beam {
    nodes: BTreeMap<u64, [f64; 3]>,
    elements: Vec<[u64; 20]>,
}

impl Beam {
    fn new(edges: &Edges, unit: f64) -> Self {
        let mut nodes = BTreeMap::new();
        // Numbers by half elements: nine places in each section.
        let mut node = |half: [usize; 3]| {
            let id = (9 * half[0] + 3 * half[1] + half[2] + 1) as u64;
            let [x, y, z] = half.map(|k| k as f64);
            let along = ROOT + x / (2 * ELEMENTS) as f64 * SIZE[0];
            nodes.insert(
                id,
                [along * unit, (y / 2.0 - 0.5) * SIZE[1] * unit, (z / 2.0 - 0.5) * SIZE[2] * unit],
            );
            id
        };
        let mut element = |k: usize| {
            let mut at = |offset: [usize; 3]| node([2 * k + offset[0], offset[1], offset[2]]);
            std::array::from_fn(|place| match place.checked_sub(8) {
                None => at(CORNERS[place]),
                Some(edge) => {
                    let [a, b] = edges[edge].map(|corner| CORNERS[corner]);
                    at([0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2))
                }
            })
        };
        let elements = (0..ELEMENTS).map(&mut element).collect();
        Self { nodes, elements }
    }

    fn inp(&self) -> String {
        let mut text = "*NODE\n".to_owned();
        for (id, [x, y, z]) in &self.nodes {
            let _ = writeln!(text, "{id}, {x:e}, {y:e}, {z:e}");
        }
        text += "*ELEMENT, TYPE=C3D20, ELSET=ALL\n";
        for (k, nodes) in self.elements.iter().enumerate() {
            let [first, rest] = [&nodes[..10], &nodes[10..]].map(|part| joined(part, ", "));
            let _ = writeln!(text, "{}, {first},\n{rest}", k + 1);
        }
        text
    }

    fn gmsh(&self) -> String {
        let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", self.nodes.len());
        for (id, [x, y, z]) in &self.nodes {
            let _ = writeln!(text, "{id} {x:e} {y:e} {z:e}");
        }
        let _ = writeln!(text, "$EndNodes\n$Elements\n{}", self.elements.len());
        for (k, nodes) in self.elements.iter().enumerate() {
            let _ = writeln!(text, "{} 17 2 1 1 {}", k + 1, joined(nodes, " "));
        }
        text + "$EndElements\n"
    }

    fn nastran(&self) -> String {
        let mut text = "BEGIN BULK\nMAT1,1,1.,,0.,1.\nPSOLID,1,1\n".to_owned();
        for (id, [x, y, z]) in &self.nodes {
            let _ = writeln!(text, "GRID*,{id},,{x:.10E},{y:.10E}\n*,{z:.10E}");
        }
        for (k, nodes) in self.elements.iter().enumerate() {
            let [a, b, c] = [&nodes[..6], &nodes[6..14], &nodes[14..]].map(|part| joined(part, ","));
            let _ = writeln!(text, "CHEXA,{},1,{a}\n,{b}\n,{c}", k + 1);
        }
        text + "ENDDATA\n"
    }

    fn ansys(&self) -> String {
        let mut text = "/PREP7\nET,1,186\nKEYOPT,1,2,1\nNBLOCK,6,SOLID,999,999\n(3i9,6e21.13e3)\n".to_owned();
        for (id, [x, y, z]) in &self.nodes {
            let _ = writeln!(text, "{id:9}{:9}{:9}{x:21.13e}{y:21.13e}{z:21.13e}", 0, 0);
        }
        text += "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,99,99\n(19i9)\n";
        for (k, nodes) in self.elements.iter().enumerate() {
            for number in [1, 1, 1, 1, 0, 0, 0, 0, 20, 0, k + 1] {
                let _ = write!(text, "{number:9}");
            }
            for (place, node) in nodes.iter().enumerate() {
                let _ = write!(text, "{}{node:9}", if place == 8 { "\n" } else { "" });
            }
            text.push('\n');
        }
        text + "       -1\n"
    }

    fn vtu(&self) -> String {
        // Points count from 0 in the order of the file.
        let places: BTreeMap<u64, u64> = self.nodes.keys().copied().zip(0..).collect();
        let points: Vec<f64> = self.nodes.values().flatten().copied().collect();
        let cells: Vec<u64> = self.elements.iter().flatten().map(|id| places[id]).collect();
        let ends: Vec<usize> = (1..=self.elements.len()).map(|k| 20 * k).collect();
        let array = |kind: &str, name: &str, components: usize, numbers: String| {
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">\n{numbers}\n</DataArray>\n"
            )
        };
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n\
             </Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
            self.nodes.len(),
            self.elements.len(),
            array("Float64", "Points", 3, joined(&points, " ")),
            array("Int64", "connectivity", 1, joined(&cells, " ")),
            array("Int64", "offsets", 1, joined(&ends, " ")),
            array("UInt8", "types", 1, joined(&vec![25; self.elements.len()], " ")),
        )
    }
}

/// Text of the beam in a format.
type Writer = fn(&Beam) -> String;

fn joined<T: ToString>(numbers: &[T], between: &str) -> String {
    numbers.iter().map(T::to_string).collect::<Vec<_>>().join(between)
}

/// Bending frequencies in hertz of the beam in a file: the lowest two.
fn frequencies(text: &str, units: Units, material: &Material) -> anyhow::Result<[f64; 2]> {
    let file = rubmap_mesh::read(text.as_bytes(), &|name| Err(format!("no file {name}")))?;
    // Numbers are those of the file, and VTK has none: nodes are found by their places.
    let near = |x: f64, y: f64, z: f64| {
        let off = |at: &[f64; 3]| (at[0] / x - 1.0).abs() + (at[1] / y - 1.0).abs() + (at[2] / z - 1.0).abs();
        file.nodes.iter().find(|(_, at)| off(at) < 1e-9).map(|(&id, _)| id)
    };
    let unit = if units.length == "m" { 1e-3 } else { 1.0 };
    let [width, depth] = [0.5 * SIZE[1] * unit, 0.5 * SIZE[2] * unit];
    let corner = |x: f64, y: f64, z: f64| {
        near(x * unit, y * width, z * depth).ok_or_else(|| anyhow::anyhow!("the beam has lost a corner"))
    };
    let root = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let clamp_at = root.into_iter().map(|(y, z)| corner(ROOT, y, z)).collect::<Result<_, _>>()?;
    let tip = ROOT + SIZE[0];
    let settings = MeshSettings {
        units,
        sectors: Some(1),
        axis: Some(Axis { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] }),
        materials: [("*".to_owned(), material.clone())].into(),
        clamp_at,
        contact_between: Some([corner(tip, -1.0, -1.0)?, corner(tip, -1.0, 1.0)?]),
        ..MeshSettings::new(100.0)
    };
    let model = to_sector(sector(&file, &settings)?.package().with_context(|| file.format.name())?)?;
    let wheel = reduce(&model, &ReductionOptions::new(8), &NoCheckpoints, &|_, _| true)?;
    let found = natural_frequencies(&wheel.harmonics[0], 0.0, false)?;
    Ok([found[0], found[1]].map(|omega| omega / TAU))
}

fn beam_in_every_format(wrong: f64) -> anyhow::Result<f64> {
    let steel = Material {
        youngs_modulus: wrong * 2e5,
        poissons_ratio: 0.0,
        density: 8e-9,
        yield_strength: None,
        ultimate_strength: None,
        fatigue_strength: None,
    };
    let in_si = Material { youngs_modulus: wrong * 2e11, density: 8e3, ..steel.clone() };
    let named = |length: &str, mass: &str| Units {
        length: length.into(),
        force: "N".into(),
        time: "s".into(),
        mass: mass.into(),
    };
    // First root of cos x cosh x = −1, and EI/ρA = E h²/12ρ in m⁴/s².
    let exact = |thickness: f64| {
        1.875_104_1f64.powi(2) / TAU * (2e11f64 / 8e3 / 12.0).sqrt() * 1e-3 * thickness
            / (1e-3 * SIZE[0]).powi(2)
    };
    let exact = [exact(SIZE[1]), exact(SIZE[2])];
    let formats: [(&Edges, Writer); 5] = [
        (&UPWARDS_LAST, Beam::inp),
        (&BY_CORNER, Beam::gmsh),
        (&TOP_LAST, Beam::nastran),
        (&UPWARDS_LAST, Beam::ansys),
        (&UPWARDS_LAST, Beam::vtu),
    ];
    let mut most = 0.0f64;
    for (edges, written) in formats {
        let in_mm = frequencies(&written(&Beam::new(edges, 1.0)), named("mm", "t"), &steel)?;
        let in_m = frequencies(&written(&Beam::new(edges, 1e-3)), named("m", "kg"), &in_si)?;
        most = most.max(relative(in_mm.into_iter().zip(exact).chain(in_m.into_iter().zip(exact))));
    }
    Ok(most)
}
