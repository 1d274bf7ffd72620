//! Sectors meshed with every kind of element, as a user's deck: read, assembled and reduced to nodal diameters, against CalculiX's own cyclic
//! symmetry and buckling of the same deck.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::process::Command;

use rubmap::from_mesh::{self, MeshSettings};
use rubmap::mesh;
use rubmap::package::raw::RawPackage;
use rubmap::package::to_sector;
use rubmap::solid::element::ElementKind;
use rubmap::solid::rule::MassRule;

use crate::eigen::{dense_eigenvalues, harmonic, hertz, lowest};
use crate::meshes::block;

pub(crate) const SECTORS: usize = 5;
const CELLS: [usize; 3] = [2, 4, 2];
const MODES: usize = 3;

/// Speed of the centrifugal load, rad/s.
pub(crate) const SPEED: f64 = 30_000.0;

/// Sector of a disk with skewed cuts as a deck, cells along r, θ and z, held at its `held`th cylinder of corners; contact nodes along z on the
/// middle one.
pub(crate) fn deck(kind: ElementKind, sectors: usize, held: f64) -> String {
    let turn = TAU / if sectors > 1 { sectors } else { SECTORS } as f64;
    let place = |[r, j, z]: [f64; 3]| {
        let theta = turn * j / CELLS[1] as f64 + 0.1 * r + 0.05 * z;
        let r = 30.0 + 10.0 * r;
        [r * theta.cos(), r * theta.sin(), 2.0 * z + 0.5 * (r / 40.0)]
    };
    let sector = block(kind, CELLS, place);
    let ids = |is: &dyn Fn([f64; 3]) -> bool| -> String {
        let grid = block(kind, CELLS, |at| at);
        let set = grid.nodes.iter().zip(1..).filter(|(at, _)| is(**at));
        set.map(|(_, id): (_, usize)| format!("{id}\n")).collect()
    };
    let mut deck = crate::deck::deck(&sector);
    let middle = CELLS[1] as f64 / 2.0;
    write!(
        deck,
        "*NSET, NSET=BORE\n{}*NSET, NSET=TIP\n{}*BOUNDARY\nBORE, 1, 3\n",
        ids(&|p| p[0] == held),
        ids(&|p| p[0] == 1.0 && p[1] == middle),
    )
    .unwrap();
    if sectors > 1 {
        // A node that is held needs no tie.
        let face = |at: f64| ids(&move |p| p[1] == at && p[0] != held);
        write!(
            deck,
            "*NSET, NSET=LOW\n{}*NSET, NSET=HIGH\n{}*SURFACE, NAME=SHIGH, TYPE=NODE\nHIGH\n\
             *SURFACE, NAME=SLOW, TYPE=NODE\nLOW\n\
             *TIE, NAME=CYC, CYCLIC SYMMETRY, POSITION TOLERANCE=1.E-6\nSHIGH, SLOW\n\
             *CYCLIC SYMMETRY MODEL, N={sectors}, TIE=CYC, NGRAPH=1\n0., 0., 0., 0., 0., 1.\n",
            face(0.0),
            face(CELLS[1] as f64),
        )
        .unwrap();
    }
    deck
}

/// Model of the deck.
pub(crate) fn model(deck: &str, sectors: usize, rule: MassRule) -> RawPackage {
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings {
        sectors: Some(sectors),
        contact_set: Some("tip".into()),
        mass: rule,
        ..MeshSettings::new(SPEED)
    };
    from_mesh::sector(&file, &settings).unwrap().package().unwrap()
}

/// Folder in which CalculiX ran a deck with these steps; `None`, with a printed reason, without it.
pub(crate) fn run(deck: &str, steps: &str) -> Option<tempfile::TempDir> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sector.inp"), format!("{deck}{steps}")).unwrap();
    let run = Command::new("ccx").args(["-i", "sector"]).current_dir(folder.path()).output();
    let output = match run {
        Ok(output) => output,
        Err(error) => {
            eprintln!("skipped: CalculiX (`ccx`, package calculix-ccx) cannot be run: {error}");
            return None;
        }
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    Some(folder)
}

/// Results that CalculiX prints of a deck with these steps; `None`, with a printed reason, without it.
fn calculix(deck: &str, steps: &str) -> Option<String> {
    let folder = run(deck, steps)?;
    Some(std::fs::read_to_string(folder.path().join("sector.dat")).unwrap())
}

/// Frequencies (Hz) per nodal diameter in CalculiX's results.
fn frequencies(text: &str) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    let mut reading = false;
    for line in text.lines() {
        if line.contains("E I G E N V A L U E   O U T P U T") {
            reading = true;
        } else if line.contains("P A R T I C I P A T I O N") || line.contains("E F F E C T I V E") {
            reading = false;
        }
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
        let Some(numbers) = numbers.filter(|numbers| reading && numbers.len() == 6) else { continue };
        let diameter = numbers[0] as usize;
        found.resize(found.len().max(diameter + 1), Vec::new());
        found[diameter].push(numbers[4]);
    }
    found
}

/// Largest relative difference of the lowest frequencies over all nodal diameters.
fn difference(package: &RawPackage, theirs: &[Vec<f64>]) -> f64 {
    assert_eq!(theirs.len(), SECTORS / 2 + 1);
    let mut worst: f64 = 0.0;
    for (i, theirs) in theirs.iter().enumerate() {
        let k = harmonic(package, &package.stiffness[0], i);
        let ours = hertz(&lowest(&k, &harmonic(package, &package.mass, i), MODES).unwrap());
        for (j, ours) in ours.iter().enumerate() {
            worst = worst.max((ours / theirs[2 * j] - 1.0).abs());
        }
    }
    worst
}

/// Kinds that CalculiX has.
pub(crate) fn kinds() -> impl Iterator<Item = ElementKind> {
    let other =
        |kind: &ElementKind| matches!(kind, ElementKind::QM6 | ElementKind::C3D5 | ElementKind::C3D13);
    ElementKind::ALL.into_iter().filter(move |kind| !other(kind))
}

/// CalculiX prints seven digits.
#[test]
fn frequencies_of_every_kind_are_calculixs() {
    let modes = format!(
        "*STEP\n*FREQUENCY\n{}\n*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={}\n*END STEP\n",
        2 * MODES + 6,
        SECTORS / 2
    );
    for kind in kinds() {
        let deck = deck(kind, SECTORS, 0.0);
        let Some(text) = calculix(&deck, &modes) else { return };
        let theirs = frequencies(&text);
        let [rest, consistent] = [MassRule::AsStiffness, MassRule::Consistent]
            .map(|rule| difference(&model(&deck, SECTORS, rule), &theirs));
        println!("{kind:?}: {rest:.1e}, with consistent mass {consistent:.1e}");
        // CalculiX gives the incompatible modes of C3D8I mass, and so frequencies of their own.
        assert!(rest < 1e-6 || kind == ElementKind::C3D8I, "{kind:?}: {rest:e}");
    }
}

/// Least factor on the centrifugal load of one sector alone at which its stiffness vanishes: sign and size of the geometric stiffness.
#[test]
fn buckling_factors_of_every_kind_are_calculixs() {
    let square = SPEED * SPEED;
    // Held at its rim, the sector is pressed outwards and buckles; held at its bore it never does.
    let load = format!("*DLOAD\nEALL, CENTRIF, {square:e}, 0., 0., 0., 0., 0., 1.\n");
    for kind in kinds().filter(|&kind| kind != ElementKind::C3D8I) {
        let deck = deck(kind, 1, CELLS[0] as f64);
        let Some(text) = calculix(&deck, &format!("*STEP\n*BUCKLE\n2\n{load}*END STEP\n")) else { return };
        let theirs = text.lines().filter_map(|line| {
            let numbers: Option<Vec<f64>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
            numbers.filter(|numbers| numbers.len() == 2 && numbers[0] == 1.0).map(|numbers| numbers[1])
        });
        let theirs = theirs.collect::<Vec<f64>>()[0];
        let package = model(&deck, 1, MassRule::AsStiffness);
        // Spin softening is in the matrix at speed; its mass without axial rows is taken out again.
        let z = |row: u32| package.dofs[row as usize].component == 3;
        let mut geometric = package.stiffness[2].clone();
        geometric.entries.extend(package.stiffness[0].entries.iter().map(|&(r, c, v)| (r, c, -v)));
        let in_plane = package.mass.entries.iter().filter(|(r, ..)| !z(*r));
        geometric.entries.extend(in_plane.map(|&(r, c, v)| (r, c, square * v)));
        let factors = dense_eigenvalues(&geometric, &package.stiffness[0]);
        let ours = -1.0 / factors[0];
        println!("{kind:?}: {ours} {theirs}");
        assert!((ours / theirs - 1.0).abs() < 2e-6, "{kind:?}: {ours} {theirs}");
    }
}

/// Structured rings, whose faces fit about many axes and by many turns, are recognised, also where half a turn carries each face onto the
/// other, and pass the checks of a package.
#[test]
fn rings_of_any_number_of_sectors_are_recognised() {
    for sectors in [2, 3, 4, 9] {
        for kind in [ElementKind::C3D8I, ElementKind::C3D20, ElementKind::C3D10] {
            let deck = deck(kind, sectors, 0.0);
            let bare = &deck[..deck.find("*NSET, NSET=LOW").unwrap()];
            let file = mesh::read(bare.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
            let settings = MeshSettings { contact_set: Some("tip".into()), ..MeshSettings::new(SPEED) };
            let sector = from_mesh::sector(&file, &settings).unwrap();
            assert_eq!((sector.found.sectors, sector.found.axis[1]), (sectors, [0.0, 0.0, 1.0]), "{kind:?}");
            to_sector(sector.package().unwrap())
                .unwrap_or_else(|error| panic!("{kind:?}, {sectors}: {error}"));
        }
    }
}

/// Sector of a commercial solver, whose reduced 20-node elements have another mass than CalculiX's and ours: within 1 % in all nodal diameters,
/// axis along y, units m, kg, s, N.
#[test]
fn cyclic_frequencies_are_those_of_a_commercial_solver() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/references/ansys-cyclic-sector.json");
    let Ok(text) = std::fs::read_to_string(path) else {
        eprintln!("skipped: {path} is not here");
        return;
    };
    let reference: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut deck = String::from("*NODE\n");
    for (id, at) in reference["nodes"].as_object().unwrap() {
        writeln!(deck, "{id}, {}, {}, {}", at[0], at[1], at[2]).unwrap();
    }
    deck += "*ELEMENT, TYPE=C3D20R, ELSET=EALL\n";
    for (k, element) in reference["elements"].as_array().unwrap().iter().enumerate() {
        let nodes: Vec<String> = element.as_array().unwrap().iter().map(ToString::to_string).collect();
        writeln!(deck, "{}, {},\n{}", k + 1, nodes[..10].join(", "), nodes[10..].join(", ")).unwrap();
    }
    let material = &reference["material"];
    let constant = |name: &str| material[name].as_f64().unwrap();
    write!(
        deck,
        "*MATERIAL, NAME=M\n*ELASTIC\n{:e}, {:e}\n*DENSITY\n{:e}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*BOUNDARY\n",
        constant("youngs_modulus"),
        constant("poissons_ratio"),
        constant("density")
    )
    .unwrap();
    for node in reference["fixed_nodes"].as_array().unwrap() {
        writeln!(deck, "{node}, 1, 3").unwrap();
    }
    // Nodes along the axis in the middle of the inner face.
    deck += "*NSET, NSET=TIP\n18, 1, 17\n";
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings { contact_set: Some("TIP".into()), ..MeshSettings::new(SPEED) };
    let sector = from_mesh::sector(&file, &settings).unwrap();
    assert_eq!((sector.found.sectors, sector.found.axis[1]), (8, [0.0, 1.0, 0.0]));
    let package = sector.package().unwrap();
    let mut worst: f64 = 0.0;
    for (diameter, theirs) in reference["frequencies_hz"].as_object().unwrap() {
        let i: usize = diameter.parse().unwrap();
        let theirs: Vec<f64> = theirs.as_array().unwrap().iter().map(|f| f.as_f64().unwrap()).collect();
        // Standing waves come in pairs, but for nodal diameters 0 and N/2.
        let step = if i == 0 || 2 * i == 8 { 1 } else { 2 };
        let theirs: Vec<f64> = theirs.into_iter().step_by(step).collect();
        let k = harmonic(&package, &package.stiffness[0], i);
        let ours = hertz(&lowest(&k, &harmonic(&package, &package.mass, i), theirs.len()).unwrap());
        println!("nodal diameter {i}: {ours:.0?}, theirs {theirs:.0?}");
        worst = ours.iter().zip(&theirs).map(|(a, b)| (a / b - 1.0).abs()).fold(worst, f64::max);
    }
    println!("largest difference {worst:.2e}");
    assert!(worst < 0.01, "{worst:e}");
}

/// Contact lines around the axis have no meridional curve and no normals.
#[test]
fn a_contact_line_around_the_axis_is_refused() {
    let grid = block(ElementKind::C3D8I, CELLS, |at| at);
    let rim =
        grid.nodes.iter().zip(1..).filter(|([r, j, z], _)| *r == 2.0 && *z == 0.0 && *j > 0.0 && *j < 4.0);
    let rim: String = rim.map(|(_, id): (_, usize)| format!("{id}\n")).collect();
    let text = format!("{}*NSET, NSET=RIM\n{rim}", deck(ElementKind::C3D8I, SECTORS, 0.0));
    let file = mesh::read(text.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings { contact_set: Some("RIM".into()), ..MeshSettings::new(SPEED) };
    let message = from_mesh::sector(&file, &settings).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("the contact line runs around the axis"), "{message}");
}
