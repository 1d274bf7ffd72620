//! Impeller A (`shared/models`): CalculiX's mesh of 20-node hexahedra, each cut into m³ of our 8-node ones,
//! against the independent frequencies of its README. Nothing here comes from our own mesher.

use std::io::Read;
use std::path::PathBuf;

use rubmap::dynamics::sector::Units;
use rubmap::impeller::mesh::{Elements, HexMesh, SectorMesh};
use rubmap::impeller::{Material, to_package};

use crate::eigen::{harmonic, hertz, lowest};

const SECTORS: usize = 10;
const BORE: f64 = 13.0;

/// At rest, by CalculiX's own cyclic symmetry analysis: f1, f2, f3 of nodal diameters 0, 2, 5.
const AT_REST: [(usize, [f64; 3]); 3] = [
    (0, [2250.532, 3882.676, 4357.521]),
    (2, [2249.385, 3762.181, 5224.063]),
    (5, [2283.033, 4698.776, 4792.489]),
];
/// At 5000 rad/s, from the package's matrices (`K_σ` on the same mesh of 20-node elements).
const AT_SPEED: [(usize, [f64; 3]); 3] = [
    (0, [2469.048, 4030.349, 4381.930]),
    (2, [2475.196, 3967.971, 5326.236]),
    (5, [2517.201, 4970.430, 5098.990]),
];

/// The deck, or none with a printed reason: it lives beside the repository, not in it.
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

/// Node positions by id and the elements' twenty node ids.
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

/// The serendipity functions of the 20-node hexahedron.
fn shape20(xi: [f64; 3]) -> [f64; 20] {
    let corner =
        [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]];
    let edges =
        [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)];
    let mut n = [0.0; 20];
    for (a, c) in corner.iter().enumerate() {
        let s: [f64; 3] = std::array::from_fn(|d| f64::from(c[d]) * xi[d]);
        n[a] = 0.125 * (1.0 + s[0]) * (1.0 + s[1]) * (1.0 + s[2]) * (s[0] + s[1] + s[2] - 2.0);
    }
    for (e, &(p, q)) in edges.iter().enumerate() {
        n[8 + e] = (0..3)
            .map(|d| {
                let m = 0.5 * f64::from(corner[p][d] + corner[q][d]);
                if m == 0.0 { 1.0 - xi[d] * xi[d] } else { 0.5 * (1.0 + m * xi[d]) }
            })
            .product();
    }
    n
}

/// Every 20-node element cut into m³ hexahedra on its own curved map; bore clamped, faces paired by position.
fn sector(deck: &str, m: usize) -> SectorMesh {
    let (positions, elements) = parse(deck);
    let near = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|d| (a[d] - b[d]).abs() < 1e-5);
    let mut mesh = HexMesh::default();
    let mut cut = Vec::new();
    for element in &elements {
        let mut local = Vec::new();
        for k in 0..=m {
            for j in 0..=m {
                for i in 0..=m {
                    let n = shape20([i, j, k].map(|c| 2.0 * c as f64 / m as f64 - 1.0));
                    let x: [f64; 3] = std::array::from_fn(|d| {
                        element.iter().zip(n).map(|(&id, n)| n * positions[id][d]).sum()
                    });
                    let known = mesh.nodes.iter().position(|y| near(&x, y));
                    local.push(known.unwrap_or_else(|| {
                        mesh.nodes.push(x);
                        mesh.nodes.len() - 1
                    }));
                }
            }
        }
        let at = |i: usize, j: usize, k: usize| local[i + (m + 1) * (j + (m + 1) * k)];
        for k in 0..m {
            for j in 0..m {
                for i in 0..m {
                    let face =
                        |k: usize| [at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k)];
                    let (a, b) = (face(k), face(k + 1));
                    cut.push([a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
                }
            }
        }
    }
    mesh.elements = Elements::Linear(cut);
    let (s, c) = (2.0 * std::f64::consts::PI / SECTORS as f64).sin_cos();
    let mut cyclic = Vec::new();
    for (low, &[x, y, z]) in mesh.nodes.iter().enumerate() {
        let turned = [c * x - s * y, s * x + c * y, z];
        if let Some(high) = mesh.nodes.iter().position(|x| near(x, &turned)) {
            cyclic.push((low, high));
        }
    }
    // Points between the deck's nodes leave the circle by the quadratic map's own error.
    let clamped = mesh.nodes.iter().map(|x| [x[0].hypot(x[1]) < BORE + 0.02; 3]).collect();
    SectorMesh { sectors: SECTORS, mesh, clamped, cyclic, contact: Vec::new() }
}

/// 1456 elements for 182: other elements on the same geometry, so agreement within the meshes' own errors.
/// Measured: at rest −1.7 to +0.3 %, at 5000 rad/s −1.5 to +0.4 %; what the speed adds to ω² agrees to 2.3 % in
/// the first family and 10 % in the others (families 2 and 3 of nodal diameter 5 are close and veer).
#[test]
fn frequencies_of_impeller_a() {
    let Some(deck) = deck() else { return };
    let units = Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() };
    let sector = sector(&deck, 2);
    let package = to_package("impeller-a", &sector, &Material::default(), &units, 5000.0).unwrap();
    for ((i, rest), (_, speed)) in AT_REST.into_iter().zip(AT_SPEED) {
        let mass = harmonic(&package, &package.mass, i);
        let [f0, f2] = [0, 2].map(|s| {
            let stiffness = harmonic(&package, &package.stiffness[s], i);
            hertz(&lowest(&stiffness, &mass, 3).unwrap())
        });
        for j in 0..3 {
            let name = format!("nodal diameter {i}, family {}: {:.1} Hz, {:.1} Hz", j + 1, f0[j], f2[j]);
            assert!((f0[j] / rest[j] - 1.0).abs() < 0.02, "{name}");
            assert!((f2[j] / speed[j] - 1.0).abs() < 0.02, "{name}");
            let rise = (f2[j].powi(2) - f0[j].powi(2)) / (speed[j].powi(2) - rest[j].powi(2));
            assert!((rise - 1.0).abs() < if j == 0 { 0.03 } else { 0.12 }, "{name}: {rise:.3}");
        }
    }
}
