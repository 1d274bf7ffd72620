//! Impeller A (`shared/models`): a mesh that does not come from our own mesher, against the independent frequencies of
//! its README, on the same 20-node elements.

use std::io::Read;
use std::path::PathBuf;

use rubmap::dynamics::sector::Units;
use rubmap::impeller::Material;
use rubmap::impeller::mesh::{Elements, HexMesh, SectorMesh};

use crate::eigen::{harmonic, hertz, lowest};
use crate::packed::packed;

const SECTORS: usize = 10;
const BORE: f64 = 13.0;

/// Frequencies at rest, by CalculiX's own cyclic symmetry analysis: f1, f2, f3 of nodal diameters 0, 2, 5, Hz.
const AT_REST: [(usize, [f64; 3]); 3] = [
    (0, [2250.532, 3882.676, 4357.521]),
    (2, [2249.385, 3762.181, 5224.063]),
    (5, [2283.033, 4698.776, 4792.489]),
];
/// Frequencies at 5000 rad/s, from the package's matrices (`K_σ` on the same mesh of 20-node elements), Hz.
const AT_SPEED: [(usize, [f64; 3]); 3] = [
    (0, [2469.048, 4030.349, 4381.930]),
    (2, [2475.196, 3967.971, 5326.236]),
    (5, [2517.201, 4970.430, 5098.990]),
];

/// Text of the deck; `None`, with a printed reason, without it: it lives beside the repository, not in it.
fn deck() -> Option<String> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/models");
    let folders = [
        std::env::var_os("RUBMAP_MODELS").map(PathBuf::from),
        Some(beside),
        Some("/work/shared/models".into()),
    ];
    let file = folders.into_iter().flatten().map(|f| f.join("impeller-a.inp.gz")).find(|f| f.exists());
    let Some(file) = file else {
        eprintln!("skipped: impeller-a.inp.gz not found; set RUBMAP_MODELS to its folder");
        return None;
    };
    let mut text = String::new();
    flate2::read::GzDecoder::new(std::fs::File::open(file).unwrap()).read_to_string(&mut text).unwrap();
    Some(text)
}

/// Node positions by id and the elements' twenty node ids, which count from 1.
fn parse(deck: &str) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let mut nodes = vec![[f64::NAN; 3]];
    let mut numbers: Vec<usize> = Vec::new();
    let mut keyword = "";
    for line in deck.lines() {
        if line.starts_with('*') {
            keyword = line.split(',').next().unwrap();
            continue;
        }
        let fields = line.split(',').map(str::trim).filter(|f| !f.is_empty());
        match keyword {
            "*NODE" => {
                let v: Vec<f64> = fields.map(|f| f.parse().unwrap()).collect();
                let id = v[0] as usize;
                nodes.resize(nodes.len().max(id + 1), [f64::NAN; 3]);
                nodes[id] = [v[1], v[2], v[3]];
            }
            "*ELEMENT" => numbers.extend(fields.map(|f| f.parse::<usize>().unwrap())),
            _ => {}
        }
    }
    (nodes, numbers.chunks(21).map(|c| c[1..].to_vec()).collect())
}

/// Sector of the deck's elements; bore clamped, faces paired by position.
fn sector(deck: &str) -> SectorMesh {
    let (positions, elements) = parse(deck);
    let nodes = positions[1..].to_vec();
    let elements = elements.iter().map(|ids| std::array::from_fn(|a| ids[a] - 1)).collect();
    let near = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|d| (a[d] - b[d]).abs() < 1e-5);
    let (s, c) = (2.0 * std::f64::consts::PI / SECTORS as f64).sin_cos();
    let mut cyclic = Vec::new();
    for (low, &[x, y, z]) in nodes.iter().enumerate() {
        let turned = [c * x - s * y, s * x + c * y, z];
        if let Some(high) = nodes.iter().position(|x| near(x, &turned)) {
            cyclic.push((low, high));
        }
    }
    let clamped = nodes.iter().map(|x| [x[0].hypot(x[1]) < BORE + 0.02; 3]).collect();
    let mesh = HexMesh { nodes, elements: Elements::Quadratic(elements) };
    SectorMesh { sectors: SECTORS, mesh, clamped, cyclic, contact: Vec::new() }
}

/// Frequencies of impeller A: at rest seven digits of CalculiX; at speed seven of another assembly of `K_σ` on CalculiX's `K_e` and M.
#[test]
fn frequencies_of_impeller_a() {
    let Some(deck) = deck() else { return };
    let units = Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() };
    let package = packed("impeller-a", &sector(&deck), &Material::default(), &units, 5000.0);
    for (speed, table) in [(0, AT_REST), (2, AT_SPEED)] {
        for (i, expected) in table {
            let mass = harmonic(&package, &package.mass, i);
            let stiffness = harmonic(&package, &package.stiffness[speed], i);
            for (ours, theirs) in hertz(&lowest(&stiffness, &mass, 3).unwrap()).into_iter().zip(expected) {
                let name = format!("nodal diameter {i}, speed {speed}: {ours:.4} Hz, expected {theirs}");
                assert!((ours / theirs - 1.0).abs() < 1e-6, "{name}");
            }
        }
    }
}
