//! Closed forms on bodies that come as a user's deck, through the public way from a mesh: spinning disk, rod and beam, and annular plate.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use rubmap::analysis::stress::StressMaker;
use rubmap::from_mesh::{self, MeshSettings};
use rubmap::mesh;
use rubmap::package::raw::{RawMatrix, RawPackage};
use rubmap::package::{self, Limits};
use rubmap::solid::element::ElementKind::{self, C3D8I, C3D10, C3D15, C3D20, C3D20R};
use rubmap::solid::material::Material;

use crate::beam::TABLE as BEAM;
use crate::eigen::{harmonic, lowest, lowest_real};
use crate::meshes::{block, steel};
use crate::plate::TABLE as PLATE;

/// Material without Poisson's effect, for bodies that are lines in theory.
fn thread() -> Material {
    Material { poissons_ratio: 0.0, ..steel() }
}

/// Body of `cells` cubes whose corner (0, y, z) is held and whose contact line is the row of nodes along z at the other end, in the middle.
struct Body {
    kind: ElementKind,
    cells: [usize; 3],
    sectors: usize,
    material: Material,
    /// Materials of the first cells along the first direction, instead of the body's.
    hub: Option<Material>,
    top_speed: f64,
}

impl Body {
    fn package(&self, place: impl Fn([f64; 3]) -> [f64; 3]) -> RawPackage {
        let [nx, ny, _] = self.cells;
        let body = block(self.kind, self.cells, place);
        let grid = block(self.kind, self.cells, |at| at);
        let ids = |is: &dyn Fn([f64; 3]) -> bool| -> String {
            let set = grid.nodes.iter().zip(1..).filter(|(at, _)| is(**at));
            set.map(|(_, id): (_, usize)| format!("{id}\n")).collect()
        };
        let mut deck = crate::deck::deck(&body);
        write!(
            deck,
            "*NSET, NSET=ROOT\n{}*NSET, NSET=TIP\n{}*BOUNDARY\nROOT, 1, 3\n",
            ids(&|at| at[0] == 0.0),
            ids(&|at| at[0] == nx as f64 && at[1] == 0.5 * ny as f64),
        )
        .unwrap();
        let mut materials = BTreeMap::from([("EALL".to_owned(), self.material.clone())]);
        if let Some(hub) = &self.hub {
            let inner = |nodes: &[u32]| nodes.iter().all(|&node| grid.nodes[node as usize][0] <= 1.0);
            let hubs = body.elements.iter().filter(|element| inner(&element.nodes));
            deck += "*ELSET, ELSET=HUB\n";
            hubs.for_each(|element| writeln!(deck, "{}", element.id).unwrap());
            let rest = body.elements.iter().filter(|element| !inner(&element.nodes));
            deck += "*ELSET, ELSET=DISK\n";
            rest.for_each(|element| writeln!(deck, "{}", element.id).unwrap());
            materials = [("HUB".to_owned(), hub.clone()), ("DISK".to_owned(), self.material.clone())].into();
        }
        let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
        let settings = MeshSettings {
            sectors: Some(self.sectors),
            contact_set: Some("TIP".into()),
            materials,
            ..MeshSettings::new(self.top_speed)
        };
        from_mesh::sector(&file, &settings).unwrap().package().unwrap()
    }
}

/// Radial displacements under the centrifugal load of the top speed, with the radii of their nodes.
fn growth(package: &RawPackage) -> Vec<[f64; 2]> {
    let file = tempfile::NamedTempFile::new().unwrap();
    package::write(package, &file).unwrap();
    let limits = Limits::default();
    let mesh = package::read_mesh(file.path(), &limits).unwrap().unwrap();
    let nodes = package::read_nodes(file.path(), &limits).unwrap();
    let imported = package::read(file.path(), &limits).unwrap();
    let fixed = StressMaker::new(&mesh, &nodes).fixed(&imported.sector, &|_, _| true).unwrap();
    let moved = fixed.displacement(package.manifest.speeds_rad_s[2], false);
    let of = |(node, [x, y, _]): (usize, &[f64; 3])| {
        let radial = nodes[node].dofs.iter().flatten().map(|dof| dof.components[0] * moved[dof.dof]);
        [x.hypot(*y), radial.sum()]
    };
    mesh.nodes.iter().enumerate().filter(|(node, _)| !nodes[*node].on_high_face).map(of).collect()
}

/// Stiffness at a part of the top speed: quadratic in the speed, as its matrices are.
fn at(package: &RawPackage, part: f64) -> RawMatrix {
    let weighted = |matrix: &RawMatrix, by: f64| -> Vec<(u32, u32, f64)> {
        matrix.entries.iter().map(|&(row, column, value)| (row, column, by * value)).collect()
    };
    let [rest, _, top] = &package.stiffness[..] else { panic!("three speeds") };
    let mut sums: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for (row, column, value) in
        weighted(rest, 1.0 - part * part).into_iter().chain(weighted(top, part * part))
    {
        *sums.entry((row, column)).or_default() += value;
    }
    RawMatrix { size: rest.size, entries: sums.into_iter().map(|((r, c), v)| (r, c, v)).collect() }
}

/// Rotating disk of constant thickness with a free bore (Timoshenko and Goodier, art. 32): growth of bore and rim in plane stress. Its hub is
/// a million times softer and only keeps it in place.
#[test]
fn bore_and_rim_of_a_spinning_disk_grow_as_in_plane_stress() {
    let (bore, rim, speed) = (30.0, 100.0, 2000.0);
    let steel = steel();
    let hub = Material {
        youngs_modulus: 1e-6 * steel.youngs_modulus,
        density: 1e-5 * steel.density,
        ..steel.clone()
    };
    let nu = steel.poissons_ratio;
    let exact = |r: f64| {
        let (a2, b2) = (bore * bore, rim * rim);
        steel.density * speed * speed * (3.0 + nu) * (1.0 - nu) / (8.0 * steel.youngs_modulus)
            * ((a2 + b2) * r + (1.0 + nu) / (1.0 - nu) * a2 * b2 / r - (1.0 + nu) / (3.0 + nu) * r.powi(3))
    };
    for (kind, within) in [(C3D8I, 1e-2), (C3D10, 1e-3), (C3D15, 1e-3), (C3D20, 5e-4), (C3D20R, 5e-4)] {
        let cells = [9, 4, 2];
        let body = Body {
            kind,
            cells,
            sectors: 12,
            material: steel.clone(),
            hub: Some(hub.clone()),
            top_speed: speed,
        };
        let package = body.package(|[x, y, z]| {
            let r = if x < 1.0 { 20.0 + 10.0 * x } else { bore + (rim - bore) * (x - 1.0) / 8.0 };
            let theta = TAU / 12.0 * (y / 4.0 - 0.5);
            [r * theta.cos(), r * theta.sin(), z - 1.0]
        });
        let mut worst = [0.0_f64; 2];
        for [radius, moved] in growth(&package) {
            for (k, at) in [bore, rim].into_iter().enumerate() {
                if (radius / at - 1.0).abs() < 1e-9 {
                    worst[k] = worst[k].max((moved / exact(at) - 1.0).abs());
                }
            }
        }
        println!("{kind:?}: bore {:.1e}, rim {:.1e}", worst[0], worst[1]);
        assert!(worst.iter().all(|&off| off > 0.0 && off < within), "{kind:?}: {worst:?}");
    }
}

/// Square bar along r from the axis.
fn bar(kind: ElementKind, cells: [usize; 3], slenderness: f64, top_speed: f64) -> RawPackage {
    let body = Body { kind, cells, sectors: 1, material: thread(), hub: None, top_speed };
    let [nx, ny, nz] = cells.map(|n| n as f64);
    body.package(|[x, y, z]| [slenderness * x / nx, y / ny - 0.5, z / nz - 0.5])
}

/// Rotating rod held on the axis: elongation ρΩ²L³/3E of its end, and axial frequencies, whose geometric stiffness of the pull ρΩ²(L² − x²)/2
/// and spin softening make ω² = k²E/ρ + Ω²(k²L²/3 + 1/4 − 1) to first order in Ω², with kL = (2n − 1)π/2.
#[test]
fn a_spinning_rod_lengthens_and_vibrates_along_itself() {
    let length = 20.0;
    let thread = thread();
    let wave = (thread.youngs_modulus / thread.density).sqrt();
    // The next order is this squared.
    let speed = 1e-3 * wave / length;
    for (kind, within) in [(C3D8I, 1e-2), (C3D10, 1e-4), (C3D15, 1e-4), (C3D20, 1e-4), (C3D20R, 1e-4)] {
        let package = bar(kind, [16, 2, 2], length, speed);
        let exact = thread.density * speed.powi(2) * length.powi(3) / (3.0 * thread.youngs_modulus);
        let ends = growth(&package);
        let [_, end] = ends.iter().find(|at| (at[0] / length - 1.0).abs() < 1e-9).unwrap();
        let elongation = end / exact - 1.0;
        // Motion along x alone is what uniform sections do.
        let along: HashMap<u64, [f64; 2]> = package
            .nodes
            .iter()
            .map(|node| {
                let [x, y, _] = node.position;
                (node.id, [x / x.hypot(y), -y / x.hypot(y)])
            })
            .collect();
        let mut place: BTreeMap<u64, u32> = BTreeMap::new();
        for dof in &package.dofs {
            let next = place.len() as u32;
            place.entry(dof.node).or_insert(next);
        }
        let only_along = |matrix: &RawMatrix| -> RawMatrix {
            let mut sums: BTreeMap<(u32, u32), f64> = BTreeMap::new();
            let weight = |row: u32| {
                let dof = package.dofs[row as usize];
                (place[&dof.node], along[&dof.node].get(usize::from(dof.component) - 1).copied())
            };
            for &(row, column, value) in &matrix.entries {
                let ((a, Some(by)), (b, Some(times))) = (weight(row), weight(column)) else { continue };
                // One triangle: entries within a node count for both.
                let twice = if a == b && row != column { 2.0 } else { 1.0 };
                *sums.entry((a.max(b), a.min(b))).or_default() += twice * by * times * value;
            }
            let entries = sums.into_iter().map(|((r, c), v)| (r, c, v)).collect();
            RawMatrix { size: place.len(), entries }
        };
        let mass = only_along(&package.mass);
        let squares = |part: f64| lowest_real(&only_along(&at(&package, part)), &mass, 2).unwrap();
        let (rest, spun) = (squares(0.0), squares(1.0));
        let mut worst = [elongation.abs(), 0.0, 0.0];
        for n in 0..2 {
            let kl = (2 * n + 1) as f64 * PI / 2.0;
            worst[1] = worst[1].max((rest[n].sqrt() / (kl * wave / length) - 1.0).abs());
            let shift = (spun[n] - rest[n]) / speed.powi(2);
            worst[2] = worst[2].max((shift / (kl * kl / 3.0 - 0.75) - 1.0).abs());
        }
        println!(
            "{kind:?}: elongation {:.1e}, frequencies {:.1e}, their shift {:.1e}",
            worst[0], worst[1], worst[2]
        );
        assert!(worst[0] < 1e-5 && worst[1] < within && worst[2] < within, "{kind:?}: {worst:?}");
    }
}

/// Rotating cantilever: flap frequencies of the table (Wright, Smith, Thresher and Wang), and lag² = flap² − Ω².
#[test]
fn a_spinning_cantilever_meets_the_table() {
    let slenderness = 100.0_f64;
    let thread = thread();
    let unit = (thread.youngs_modulus / thread.density / 12.0).sqrt() / slenderness.powi(2);
    let fastest = BEAM.last().unwrap().0;
    for (kind, within) in [(C3D8I, 1e-3), (C3D10, 1e-3), (C3D20, 1e-3), (C3D20R, 1e-3)] {
        let package = bar(kind, [48, 2, 2], slenderness, fastest * unit);
        let mut worst = [0.0_f64; 2];
        for (eta, exact) in BEAM {
            let values = lowest_real(&at(&package, eta / fastest), &package.mass, 4).unwrap();
            let f: Vec<f64> = values.iter().map(|value| value.sqrt() / unit).collect();
            for (k, exact) in exact.into_iter().enumerate() {
                let [lag, flap] = [f[2 * k], f[2 * k + 1]];
                worst[0] = worst[0].max((flap / exact - 1.0).abs());
                worst[1] = worst[1].max(((lag * lag + eta * eta).sqrt() / flap - 1.0).abs());
            }
        }
        println!("{kind:?}: flap {:.1e}, lag {:.1e}", worst[0], worst[1]);
        assert!(worst[0] < within && worst[1] < 1e-4, "{kind:?}: {worst:?}");
    }
}

/// Annular plate held at its bore: frequencies of nodal diameters 0 to 4 of the table.
#[test]
fn an_annular_plate_meets_the_table() {
    let (ratio, rows) = PLATE[1];
    let (rim, thickness) = (100.0_f64, 1.0);
    let steel = steel();
    let unit = thickness / rim.powi(2)
        * (steel.youngs_modulus / steel.density / (12.0 * (1.0 - steel.poissons_ratio.powi(2)))).sqrt();
    for (kind, within) in [(C3D8I, 0.01), (C3D20, 0.004), (C3D20R, 0.004)] {
        let (cells, sectors) = ([24, 2, 2], 48);
        let body = Body { kind, cells, sectors, material: steel.clone(), hub: None, top_speed: 1.0 };
        let package = body.package(|[x, y, z]| {
            let r = rim * (ratio + (1.0 - ratio) * x / 24.0);
            let theta = TAU / 48.0 * (y / 2.0 - 0.5);
            [r * theta.cos(), r * theta.sin(), thickness * (0.5 * z - 0.5)]
        });
        let mut worst: f64 = 0.0;
        for (i, exact) in rows.iter().enumerate() {
            let k = harmonic(&package, &package.stiffness[0], i);
            let values = lowest(&k, &harmonic(&package, &package.mass, i), 2).unwrap();
            for (value, exact) in values.into_iter().zip(exact) {
                worst = worst.max((value.sqrt() / unit / exact - 1.0).abs());
            }
        }
        println!("{kind:?}: {worst:.1e}");
        assert!(worst < within, "{kind:?}: {worst:e}");
    }
}
