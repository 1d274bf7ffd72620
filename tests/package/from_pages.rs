//! Commands of the pages docs/from-*.md and docs/calculix.md, from what a user has to a map: each block in order in an empty folder. Files that
//! other programs write are written here; CalculiX runs where it is.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use rubmap::impeller::mesh::ElementOrder;
use rubmap::impeller::{ImpellerParameters, generate};
use rubmap::package::raw::{RawMatrix, RawPackage};
use rubmap::solid::mesh::SectorMesh;

use crate::from_mesh::{ansys, cartesian, deck, gmsh, impeller, market, nastran, sector_mesh};

/// Largest number of lines of commands from what a user has to a map.
const MOST_LINES: usize = 10;

/// Coarse sector whose map takes seconds.
fn parameters() -> ImpellerParameters {
    ImpellerParameters {
        sectors: 3,
        contact_nodes: 5,
        element_order: ElementOrder::Quadratic,
        mesh: impeller(3).mesh,
        ..ImpellerParameters::default()
    }
}

fn mesh() -> SectorMesh {
    sector_mesh(&parameters())
}

/// Blocks of a page in a language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(page);
    let text = std::fs::read_to_string(path).unwrap();
    let mut blocks: Vec<String> = Vec::new();
    let mut inside = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), inside) {
            (Some(fence), None) => {
                inside = Some(fence == language);
                if fence == language {
                    blocks.push(String::new());
                }
            }
            (Some(_), Some(_)) => inside = None,
            (None, Some(true)) => writeln!(blocks.last_mut().unwrap(), "{line}").unwrap(),
            _ => {}
        }
    }
    blocks
}

/// Runs a page's commands in a folder with these files, and looks at the map.
fn run(page: &str, files: &[(&str, String)]) {
    let commands = blocks(page, "sh");
    let to_map = commands.join("");
    let to_map = &to_map[..to_map.find("rubmap demo").expect("a page ends with a map")];
    assert!(to_map.lines().count() < MOST_LINES, "{page}: {to_map}");
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let program = Path::new(env!("CARGO_BIN_EXE_rubmap")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let calculix = Command::new("ccx").arg("-v").output().is_ok();
    for block in &commands {
        if !calculix && block.contains("ccx ") {
            eprintln!("skipped from here: CalculiX (`ccx`, package calculix-ccx) cannot be run");
            break;
        }
        let output = Command::new("sh")
            .args(["-euc", block])
            .current_dir(folder.path())
            .env("PATH", &path)
            .output()
            .unwrap();
        let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert!(
            output.status.success(),
            "{page}:\n{block}\n{}{}",
            said(&output.stdout),
            said(&output.stderr)
        );
    }
    let map = std::fs::read_to_string(folder.path().join("rubmap-demo/interaction-map.svg")).unwrap();
    assert!(map.contains("<svg"), "{page}: {map}");
}

#[test]
fn from_gmsh_to_a_map() {
    run("from-gmsh.md", &[("sector.msh", gmsh(&mesh()))]);
}

/// Calls `line` with the nodes, components and value of each entry of a matrix.
fn each(package: &RawPackage, matrix: &RawMatrix, mut line: impl FnMut([u64; 2], [u8; 2], f64)) {
    for &(row, column, value) in &matrix.entries {
        let [row, column] = [row, column].map(|at| package.dofs[at as usize]);
        line([row.node, column.node], [row.component, column.component], value);
    }
}

/// Input file as Abaqus/CAE writes it, with one instance of one part.
fn abaqus_job(mesh: &SectorMesh) -> String {
    let deck = deck(mesh);
    let (body, material) = deck.split_once("*MATERIAL").unwrap();
    let (material, section) = material.split_once("*SOLID SECTION").unwrap();
    format!(
        "*Heading\n** Job name: Job-1 Model name: Model-1\n*Preprint, echo=NO, model=NO\n*Part, name=Sector\n{body}\
         *Solid Section{section}*End Part\n*Assembly, name=Assembly\n*Instance, name=Sector-1, part=Sector\n\
         *End Instance\n*End Assembly\n*MATERIAL{material}"
    )
}

/// Matrix as Abaqus generates it as matrix input.
fn abaqus_matrix(package: &RawPackage, matrix: &RawMatrix) -> String {
    let mut text = "** assembled by Job-1\n*MATRIX, NAME=GENERATED, TYPE=SYMMETRIC\n".to_owned();
    each(package, matrix, |[a, b], [i, j], value| writeln!(text, "{a},{i}, {b},{j}, {value:.15e}").unwrap());
    text
}

#[test]
fn from_abaqus_to_a_map() {
    let package = cartesian(generate(&parameters()).unwrap());
    run(
        "from-abaqus.md",
        &[
            ("Job-1.inp", abaqus_job(&mesh())),
            ("Job-1_MASS1.mtx", abaqus_matrix(&package, &package.mass)),
            ("Job-1_STIF1.mtx", abaqus_matrix(&package, &package.stiffness[0])),
        ],
    );
}

/// Young's modulus, Poisson's ratio and density of the sector.
fn constants() -> [f64; 3] {
    let material = parameters().material;
    [material.youngs_modulus, material.poissons_ratio, material.density]
}

/// Matrix as HBMAT of Ansys writes it in text form, lower triangle by columns.
fn boeing(matrix: &RawMatrix) -> String {
    let mut entries = matrix.entries.clone();
    entries.sort_by_key(|&(row, column, _)| (column, row));
    let mut text = format!(
        "Matrix from Ansys\n{0} {1} {2} {2} 0\nRSA {3} {3} {2} 0\n(1I14)          (1I14)          (1E25.15)\n",
        matrix.size + 1 + 2 * entries.len(),
        matrix.size + 1,
        entries.len(),
        matrix.size,
    );
    let mut first = 0;
    for column in 0..=matrix.size as u32 {
        first += entries[first..].iter().take_while(|entry| entry.1 < column).count();
        writeln!(text, "{:>14}", first + 1).unwrap();
    }
    entries.iter().for_each(|(row, ..)| writeln!(text, "{:>14}", row + 1).unwrap());
    entries.iter().for_each(|(.., value)| writeln!(text, "{:>25}", format!("{value:.15E}")).unwrap());
    text
}

#[test]
fn from_ansys_to_a_map() {
    let package = cartesian(generate(&parameters()).unwrap());
    let [e, nu, rho] = constants();
    let archive = format!("{}MP,EX,1,{e:?}\nMP,NUXY,1,{nu:?}\nMP,DENS,1,{rho:?}\n", ansys(&mesh()));
    run(
        "from-ansys.md",
        &[
            ("sector.cdb", archive),
            ("m.txt", boeing(&package.mass)),
            ("k.txt", boeing(&package.stiffness[0])),
            ("k.mapping", market(&package, &package.mass).1),
        ],
    );
}

/// Matrix on the punch file of Nastran, long fields, both names in one file.
fn punch(package: &RawPackage, name: &str, matrix: &RawMatrix) -> String {
    let mut columns: std::collections::BTreeMap<(u64, u8), String> = std::collections::BTreeMap::new();
    each(package, matrix, |[a, b], [i, j], value| {
        let value = format!("{value:.9e}").replace('e', "D");
        writeln!(columns.entry((b, j)).or_default(), "{:<8}{a:>16}{i:>16}{value:>16}", "*").unwrap();
    });
    let mut text = format!("DMIG    {name:<8}{:>8}{:>8}{:>8}{:>8}\n", 0, 6, 2, 0);
    for ((node, component), lines) in columns {
        write!(text, "DMIG*   {name:<16}{node:>16}{component:>16}\n{lines}").unwrap();
    }
    text
}

#[test]
fn from_nastran_to_a_map() {
    let package = cartesian(generate(&parameters()).unwrap());
    let [e, nu, rho] = constants();
    let material = format!("MAT1,1,{e:?},,{nu:?},{rho:.3e}\nPSOLID,1,1\nENDDATA\n");
    run(
        "from-nastran.md",
        &[
            ("sector.bdf", nastran(&mesh()).replace("ENDDATA\n", &material)),
            (
                "sector.pch",
                punch(&package, "KAAX", &package.stiffness[0]) + &punch(&package, "MAAX", &package.mass),
            ),
        ],
    );
}

/// Deck of a mesh with the sets of the page: cyclic faces without clamped nodes, the tip and the bore.
fn calculix_mesh() -> String {
    let package = generate(&parameters()).unwrap();
    let mesh = mesh();
    let mut text = deck(&mesh)
        .replace("*NODE\n", "*NODE, NSET=NALL\n")
        .replace("ELSET=WHEEL", "ELSET=EALL")
        .replace("NAME=M\n", "NAME=TI64\n")
        .replace("MATERIAL=M\n", "MATERIAL=TI64\n");
    let free: std::collections::BTreeSet<u64> = package.dofs.iter().map(|dof| dof.node).collect();
    let pairs = &package.manifest.cyclic;
    let sets: [(&str, Vec<u64>); 4] = [
        ("LOW", pairs.iter().map(|pair| pair[0]).collect()),
        ("HIGH", pairs.iter().map(|pair| pair[1]).collect()),
        ("TIP", package.manifest.contact.iter().map(|contact| contact.node).collect()),
        ("BORE", mesh.node_ids.iter().copied().filter(|node| !free.contains(node)).collect()),
    ];
    for (name, nodes) in sets {
        let lines: String = nodes.iter().map(|node| format!("{node}\n")).collect();
        write!(text, "*NSET, NSET={name}\n{lines}").unwrap();
    }
    text + "*BOUNDARY\nBORE, 1, 3\n"
}

/// The page's decks name their files in their first line.
#[test]
fn from_calculix_to_a_map() {
    let mesh = calculix_mesh();
    let decks = blocks("calculix.md", "text").into_iter().map(|text| {
        let name = text.lines().next().unwrap().strip_prefix("** ").expect("a deck begins with its name");
        (name.to_owned(), text.replace("N=10", "N=3"))
    });
    let decks: Vec<(String, String)> = decks.collect();
    let mut files: Vec<(&str, String)> =
        decks.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    files.push(("deck.inp", mesh.clone()));
    files.push(("mesh.inp", mesh));
    run("calculix.md", &files);
}
