//! Packages from the real CalculiX, where it is installed.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use faer::c64;
use rubmap::dynamics::findings::{SpinAtSpeed, SpinFinding};
use rubmap::dynamics::sector::{SectorModel, Units};
use rubmap::package::calculix::{self, CalculixModel, ImportSummary, Normals};
use rubmap::package::{self, Limits};
use rubmap::solid::element::ElementKind;
use rubmap::solid::load::volumes;
use rubmap::solid::mesh::SectorMesh;

use crate::sample::shared_models;

pub(crate) fn model(folder: &Path, deck: &str, rest: &str) -> CalculixModel {
    CalculixModel {
        deck: folder.join(deck),
        rest: folder.join(rest),
        at_speed: Vec::new(),
        whole_wheel: false,
        sectors: None,
        axis: None,
        low_set: None,
        high_set: None,
        contact_set: "TIP".into(),
        contact_count: None,
        contact_as_listed: false,
        normals: Normals::ContactNodes,
        gyroscopic: false,
        strengths: None,
        units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
        name: "imported".into(),
    }
}

pub(crate) fn put(folder: &Path, name: &str, text: impl AsRef<str>) {
    std::fs::write(folder.join(name), text.as_ref()).expect("written");
}

/// Ring sector of 8-node bricks, skewed so that no face is a plane of symmetry: radii 10 to 20, clamped bore.
struct Ring {
    sectors: usize,
    copies: usize,
}

const CELLS: [usize; 3] = [4, 3, 2];

impl Ring {
    /// Number of the node at a (radial, circumferential, axial) grid position; circumferential positions run on over the copies.
    fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        let around = self.copies * CELLS[1] + usize::from(self.copies < self.sectors);
        1 + i + (CELLS[0] + 1) * (k + (CELLS[2] + 1) * (j % around))
    }

    fn nodes(&self) -> BTreeMap<usize, [f64; 3]> {
        let mut nodes = BTreeMap::new();
        for j in 0..=self.copies * CELLS[1] {
            for i in 0..=CELLS[0] {
                for k in 0..=CELLS[2] {
                    let (r, z) = (10.0 + 2.5 * i as f64, k as f64 + 0.01 * (2.5 * i as f64).powi(2));
                    let angle = TAU / self.sectors as f64 * j as f64 / CELLS[1] as f64 + 0.02 * r + 0.05 * z;
                    nodes.entry(self.node([i, j, k])).or_insert([r * angle.cos(), r * angle.sin(), z]);
                }
            }
        }
        nodes
    }

    /// Nodes of a face without clamped ones, which CalculiX cannot tie.
    fn face(&self, j: usize) -> String {
        let grid = (1..=CELLS[0]).flat_map(|i| (0..=CELLS[2]).map(move |k| [i, j, k]));
        grid.map(|at| format!("{},\n", self.node(at))).collect()
    }

    /// Deck with mesh, material and clamp.
    fn deck(&self) -> String {
        let mut deck = "*NODE, NSET=NALL\n".to_owned();
        for (node, [x, y, z]) in self.nodes() {
            writeln!(deck, "{node}, {x:.12e}, {y:.12e}, {z:.12e}").expect("text");
        }
        deck += "*ELEMENT, TYPE=C3D8, ELSET=EALL\n";
        let mut element = 0;
        for j in 0..self.copies * CELLS[1] {
            for i in 0..CELLS[0] {
                for k in 0..CELLS[2] {
                    element += 1;
                    let corner = |[a, b, c]: [usize; 3]| self.node([i + a, j + b, k + c]).to_string();
                    let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
                    let ids: Vec<_> =
                        [0, 1].iter().flat_map(|&c| corners.map(|[a, b]| corner([a, b, c]))).collect();
                    writeln!(deck, "{element}, {}", ids.join(", ")).expect("text");
                }
            }
        }
        let bore = |j: usize| (0..=CELLS[2]).map(move |k| [0, j, k]);
        let bore: String =
            (0..=self.copies * CELLS[1]).flat_map(bore).map(|at| format!("{},\n", self.node(at))).collect();
        let tip: String =
            (1..=CELLS[0]).rev().map(|i| format!("{},\n", self.node([i, 1, CELLS[2]]))).collect();
        write!(
            deck,
            "*NSET, NSET=BORE\n{bore}*NSET, NSET=LOW\n{}*NSET, NSET=HIGH\n{}*NSET, NSET=TIP\n{tip}\
             *MATERIAL, NAME=M\n*ELASTIC\n114000., .32\n*DENSITY\n4.43e-9\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n\
             *BOUNDARY\nBORE, 1, 3\n",
            self.face(0),
            self.face(CELLS[1]),
        )
        .expect("text");
        deck
    }
}

const EXPORT: &str = "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*END STEP\n";

fn tie(sectors: usize) -> String {
    format!(
        "*SURFACE, NAME=SH, TYPE=NODE\nHIGH\n*SURFACE, NAME=SL, TYPE=NODE\nLOW\n*TIE, NAME=T1, CYCLIC SYMMETRY\nSH, SL\n\
         *CYCLIC SYMMETRY MODEL, N={sectors}, TIE=T1, NGRAPH=1\n0., 0., 0., 0., 0., 1.\n"
    )
}

fn centrifugal(square: f64) -> String {
    format!("*DLOAD\nEALL, CENTRIF, {square:.9e}, 0., 0., 0., 0., 0., 1.\n")
}

fn have_ccx() -> bool {
    let found = Command::new("ccx").arg("-v").output().is_ok();
    if !found {
        println!("skipped: no ccx on PATH (Debian: calculix-ccx)");
    }
    found
}

fn ccx(folder: &Path, job: &str, deck: &str) {
    put(folder, &format!("{job}.inp"), deck);
    let run =
        Command::new("ccx").arg(job).current_dir(folder).env("OMP_NUM_THREADS", "1").output().expect("runs");
    let log = String::from_utf8_lossy(&run.stdout);
    assert!(log.contains("Job finished"), "{job}:\n{log}");
}

/// Stresses of `*EL PRINT` as data lines of `*INITIAL CONDITIONS, TYPE=STRESS`, times `factor`.
fn stresses(folder: &Path, job: &str, factor: f64) -> String {
    let text = std::fs::read_to_string(folder.join(format!("{job}.dat"))).expect("readable");
    let mut lines = String::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [element, point, values @ ..] = &words[..]
            && values.len() == 6
            && let Ok(values) = values.iter().map(|word| word.parse::<f64>()).collect::<Result<Vec<_>, _>>()
        {
            let scaled: Vec<String> = values.iter().map(|value| format!("{:.8e}", factor * value)).collect();
            writeln!(lines, "{element}, {point}, {}", scaled.join(", ")).expect("text");
        }
    }
    lines
}

/// Exports matrices at speed as docs/calculix.md has it: stresses of the cyclic sector as initial stresses, held in place, then exported.
fn export_at_speed(folder: &Path, job: &str, mesh: &str, stress: &str, load: &str) {
    ccx(
        folder,
        job,
        &format!(
            "{mesh}*INITIAL CONDITIONS, TYPE=STRESS\n{stress}*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nNALL, 1, 3\n{load}\
             *END STEP\n*STEP, PERTURBATION\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*BOUNDARY, OP=NEW\nBORE, 1, 3\n*END STEP\n"
        ),
    );
}

/// Natural frequencies of one nodal diameter in Hz, ascending, from the real form of the harmonic matrices.
fn frequencies(sector: &SectorModel, nodal_diameter: usize, speed: usize) -> Vec<f64> {
    let phase = c64::cis(TAU * nodal_diameter as f64 / sector.sectors as f64);
    let n = sector.own_dofs();
    let harmonic = |matrix: &rubmap::dynamics::sector::CyclicMatrix| {
        let (own, next) = (matrix.own.to_dense(), matrix.next.to_dense());
        nalgebra::DMatrix::from_fn(2 * n, 2 * n, |i, j| {
            let (a, b) = (i % n, j % n);
            let re = own[(a, b)] + phase.re * (next[(a, b)] + next[(b, a)]);
            let im = phase.im * (next[(a, b)] - next[(b, a)]);
            match (i < n, j < n) {
                (true, true) | (false, false) => re,
                (true, false) => -im,
                (false, true) => im,
            }
        })
    };
    let lower = harmonic(&sector.mass).cholesky().expect("a positive mass").l();
    let half = lower.solve_lower_triangular(&harmonic(&sector.stiffness[speed])).expect("regular");
    let standard = lower.solve_lower_triangular(&half.transpose()).expect("regular");
    let mut values: Vec<f64> =
        ((&standard + standard.transpose()) * 0.5).symmetric_eigen().eigenvalues.as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    // The real form has every value twice.
    values.iter().step_by(2).map(|value| value.max(0.0).sqrt() / TAU).collect()
}

/// Frequencies of a cyclic `*FREQUENCY` by nodal diameter, from lines `NODAL DIAMETER, MODE NO, …, CYCLES/TIME, …`, where every mode comes twice.
fn cyclic_frequencies(folder: &Path, job: &str) -> BTreeMap<usize, Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(format!("{job}.dat"))).expect("readable");
    let mut found: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [diameter, mode, _, _, hertz, _] = words[..]
            && let (Ok(diameter), Ok(mode), Ok(hertz)) =
                (diameter.parse(), mode.parse::<usize>(), hertz.parse())
            && mode % 2 == 1
        {
            found.entry(diameter).or_default().push(hertz);
        }
    }
    found
}

/// Imports a model of CalculiX, by way of a file.
fn imported(model: &CalculixModel) -> (SectorModel, ImportSummary, SectorMesh) {
    let (package, summary) = calculix::import(model).expect("imported");
    let file = tempfile::NamedTempFile::new().expect("a file");
    package::write(&package, file.as_file()).expect("written");
    let read = package::read(file.path(), &Limits::default()).expect("a good package");
    let mesh = read.mesh.unwrap_or_else(|| panic!("no mesh: {:?}", summary.no_mesh));
    assert_eq!(package::read_mesh(file.path(), &Limits::default()).expect("read before"), Some(mesh.clone()));
    (read.sector, summary, mesh)
}

/// Asserts that a mesh is that of one sector of a [`Ring`].
fn assert_ring(mesh: &SectorMesh) {
    assert_eq!(mesh.elements.len(), CELLS.iter().product::<usize>());
    assert_eq!((mesh.sets.len(), &*mesh.sets[0].name), (1, "EALL"));
    assert_eq!(mesh.cyclic.len(), (CELLS[0] + 1) * (CELLS[2] + 1), "with the clamped pairs at the bore");
    // Radii 10 and 20, height 2, straight chords; the skew bends what lies between the nodes.
    let turn = TAU / mesh.sectors as f64 / CELLS[1] as f64;
    let exact = CELLS[1] as f64 * 0.5 * turn.sin() * (400.0 - 100.0) * 2.0;
    let volume: f64 = volumes(mesh).iter().sum();
    assert!((volume / exact - 1.0).abs() < 1e-3, "{volume} {exact}");
}

#[test]
fn a_sector_exported_by_calculix_has_the_frequencies_of_its_cyclic_analysis() {
    if !have_ccx() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let ring = Ring { sectors: 6, copies: 1 };
    let (mesh, tied) = (ring.deck(), tie(6));
    put(folder, "deck.inp", format!("{mesh}{tied}"));
    ccx(folder, "rest", &format!("{mesh}{EXPORT}"));
    ccx(
        folder,
        "cyclic",
        &format!(
            "{mesh}{tied}*STEP\n*FREQUENCY\n8\n*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX=3\n*END STEP\n"
        ),
    );
    let (sector, summary, elements) = imported(&model(folder, "deck.inp", "rest"));
    assert_ring(&elements);
    assert_eq!((sector.sectors, summary.contact.len()), (6, CELLS[0]));
    let reference = cyclic_frequencies(folder, "cyclic");
    assert_eq!(reference.len(), 4);
    let mut worst: f64 = 0.0;
    for (diameter, expected) in reference {
        let found = frequencies(&sector, diameter, 0);
        assert!(expected.len() >= 4);
        for (found, expected) in found.iter().zip(expected) {
            worst = worst.max((found / expected - 1.0).abs());
        }
    }
    println!("largest difference from CalculiX's own cyclic symmetry: {worst:.1e}");
    // CalculiX prints seven digits.
    assert!(worst < 1e-6, "{worst:.1e}");
    // The tip is z = 2 + 0.01 (r − 10)² on the side of larger z.
    for point in &summary.contact {
        let slope = 0.02 * (point.position[0] - 10.0);
        let length = slope.hypot(1.0);
        let off = (point.normal[0] + slope / length).abs().max((point.normal[2] - 1.0 / length).abs());
        assert!(off < 2e-3, "{point:?}");
    }
    let radii: Vec<f64> = summary.contact.iter().map(|point| point.position[0]).collect();
    assert!(radii.is_sorted(), "from leading to trailing edge: {radii:?}");
    // An export with the tie active has eliminated one face.
    ccx(folder, "tied", &format!("{mesh}{tied}{EXPORT}"));
    let refused =
        calculix::import(&model(folder, "deck.inp", "tied")).expect_err("one face has no DOF").to_string();
    assert!(refused.contains("the cyclic tie was active when the matrices were exported"), "{refused}");
}

#[test]
fn a_whole_wheel_gives_the_sector_it_is_made_of() {
    if !have_ccx() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for (name, copies) in [("sector", 1), ("wheel", 5)] {
        let mesh = Ring { sectors: 5, copies }.deck();
        put(folder, &format!("{name}-mesh.inp"), &mesh);
        ccx(folder, name, &format!("{mesh}{EXPORT}"));
    }
    let faces = |model: CalculixModel| CalculixModel {
        sectors: Some(5),
        low_set: Some("LOW".into()),
        high_set: Some("HIGH".into()),
        ..model
    };
    let (sector, _, mesh) = imported(&faces(model(folder, "sector-mesh.inp", "sector")));
    let cut = CalculixModel { whole_wheel: true, ..faces(model(folder, "wheel-mesh.inp", "wheel")) };
    let (from_wheel, summary, of_wheel) = imported(&cut);
    assert_ring(&mesh);
    assert_ring(&of_wheel);
    assert!(summary.sectors_differ.is_some_and(|difference| difference < 1e-9), "{summary:?}");
    assert_eq!(from_wheel.contact.len(), sector.contact.len());
    let mut worst: f64 = 0.0;
    for diameter in 0..=2 {
        let [a, b] = [&sector, &from_wheel].map(|sector| frequencies(sector, diameter, 0));
        assert_eq!(a.len(), b.len());
        worst = a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs()).fold(worst, f64::max);
    }
    println!("largest difference of the two routes, all modes: {worst:.1e}");
    // Coordinates have 13 digits, entries 14.
    assert!(worst < 1e-9, "{worst:.1e}");
    let wrong = CalculixModel { low_set: Some("TIP".into()), ..cut.clone() };
    let refused = calculix::import(&wrong).expect_err("no cut").to_string();
    assert!(refused.contains("does not cut the wheel into sectors"), "{refused}");
    let wrong = CalculixModel { sectors: Some(7), ..cut };
    let refused = calculix::import(&wrong).expect_err("no cut").to_string();
    assert!(refused.contains("make the wheel by copying one meshed sector"), "{refused}");
}

/// Deck of the mesh, and jobs `rest`, `half` and `full` made by the recipe of docs/calculix.md.
fn spun(folder: &Path, mesh: &str, tied: &str, top_speed: f64) -> CalculixModel {
    put(folder, "deck.inp", format!("{mesh}{tied}"));
    ccx(folder, "rest", &format!("{mesh}{EXPORT}"));
    let load = |factor: f64| centrifugal(factor * top_speed * top_speed);
    ccx(
        folder,
        "spin",
        &format!("{mesh}{tied}*STEP\n*STATIC\n{}*EL PRINT, ELSET=EALL\nS\n*END STEP\n", load(1.0)),
    );
    for (job, factor) in [("half", 0.25), ("full", 1.0)] {
        export_at_speed(folder, job, mesh, &stresses(folder, "spin", factor), &load(factor));
    }
    CalculixModel {
        at_speed: vec![(0.5 * top_speed, folder.join("half")), (top_speed, folder.join("full"))],
        ..model(folder, "deck.inp", "rest")
    }
}

#[test]
fn initial_stresses_give_the_stiffness_of_the_undeformed_geometry() {
    if !have_ccx() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let (mesh, tied) = (Ring { sectors: 6, copies: 1 }.deck(), tie(6));
    let model = spun(folder, &mesh, &tied, 10_000.0);
    let spin = |model: &CalculixModel| package::look_at(calculix::import(model).unwrap().0).unwrap().spin;
    let found = spin(&model);
    println!("{found:?}");
    for SpinAtSpeed { finding, .. } in &found {
        // Stresses are printed with seven digits.
        assert!(matches!(finding, SpinFinding::Undeformed { residual } if *residual < 1e-5), "{finding:?}");
    }
    let finding = |job: &str| {
        let at_speed = vec![(5000.0, folder.join("half")), (10_000.0, folder.join(job))];
        spin(&CalculixModel { at_speed, ..model.clone() })[1].finding
    };
    export_at_speed(folder, "no-load", &mesh, &stresses(folder, "spin", 1.0), "");
    let shares = |job: &str| match finding(job) {
        SpinFinding::Shares { stiffening, softening, .. } => [stiffening, softening],
        other => panic!("{other:?}"),
    };
    let near =
        |found: [f64; 2], is: [f64; 2]| found.iter().zip(is).all(|(found, is)| (found - is).abs() < 1e-4);
    assert!(near(shares("no-load"), [1.0, 0.0]), "{:?}", finding("no-load"));
    export_at_speed(folder, "twice", &mesh, &stresses(folder, "spin", 2.0), &centrifugal(1e8));
    assert!(near(shares("twice"), [2.0, 1.0]), "{:?}", finding("twice"));
    ccx(
        folder,
        "tangent",
        &format!(
            "{mesh}*STEP, NLGEOM\n*STATIC\n{}*END STEP\n*STEP, PERTURBATION\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*END STEP\n",
            centrifugal(1e8)
        ),
    );
    assert!(matches!(finding("tangent"), SpinFinding::Other { residual } if residual > 0.1));
}

#[test]
fn impeller_a_by_the_same_recipe_is_the_shared_package() {
    let (Some(models), true) = (shared_models(), have_ccx()) else {
        println!("skipped: needs ccx and the shared models (set RUBMAP_SHARED)");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let mut deck = String::new();
    let file = std::fs::File::open(models.join("impeller-a.inp.gz")).expect("there");
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(file), &mut deck).expect("text");
    let (mesh, tied) = deck.split_at(deck.find("*SURFACE").expect("the tie"));
    let (sector, _, mesh) = imported(&spun(folder, mesh, tied, 5000.0));
    let path: PathBuf = models.join("impeller-a-cartesian.zip");
    let shared = package::read(&path, &Limits::default()).expect("a good package").sector;
    // CalculiX orders DOF as the package does: by node, own ones first but for the high face.
    assert_eq!(sector.own_dofs(), shared.own_dofs());
    assert_eq!((mesh.elements.len(), mesh.elements[0].kind), (182, ElementKind::C3D20));
    let rows = |sector: &SectorModel| sector.contact.iter().map(|contact| contact.dofs).collect::<Vec<_>>();
    assert_eq!(rows(&sector), rows(&shared));
    let [k0, k2] =
        [0, 2].map(|speed| (sector.stiffness[speed].own.to_dense(), shared.stiffness[speed].own.to_dense()));
    let added = &k2.1 - &k0.1;
    let off = (&k2.0 - &k0.0 - &added).norm_l2() / added.norm_l2();
    println!(
        "K(Ω1) − K(0): {off:.1e} from that of the package, at rest {:.1e}",
        (&k0.0 - &k0.1).norm_max() / k0.1.norm_max()
    );
    // Stresses have seven digits.
    assert!(off < 1e-6, "{off:.1e}");
    // The package's normals are those of the shroud curve; ours of the ten nodes alone.
    for (a, b) in sector.contact.iter().zip(&shared.contact) {
        let cosine: f64 = (0..3).map(|k| a.normal[k] * b.normal[k]).sum();
        assert!(cosine > 1f64.to_radians().cos(), "{a:?} {b:?}");
    }
}
