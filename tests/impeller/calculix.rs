//! Our impeller against CalculiX (`ccx`, Debian's `calculix-ccx`) on the same mesh: frequencies per nodal diameter at
//! rest, displacements and stresses of the centrifugal load.
//!
//! C3D20 is our 20-node element; C3D8I is another incompatible-mode formulation than ours, equal on parallelepipeds
//! only. CalculiX prints seven digits of a frequency or displacement and seven of a stress.

use std::fmt::Write as _;
use std::process::Command;

use rubmap::impeller::mesh::{ElementOrder, Elements, SectorMesh};
use rubmap::impeller::{
    ImpellerParameters, MeshDensities, SectorMatrices, Splitter, impeller_sector, to_package,
};

use crate::eigen::{harmonic, hertz, lowest};

const MODES: usize = 4;

/// What CalculiX printed.
struct Answer {
    /// Frequencies (Hz) per nodal diameter.
    frequencies: Vec<Vec<f64>>,
    /// Nodal displacements in x, y, z.
    displacements: Vec<[f64; 3]>,
    /// Per element and Gauss point: xx, yy, zz, xy, xz, yz.
    stresses: Vec<Vec<[f64; 6]>>,
}

fn ids(deck: &mut String, ids: impl Iterator<Item = usize>) {
    for id in ids {
        writeln!(deck, "{}", id + 1).unwrap();
    }
}

/// A static step with the centrifugal load at `speed`, then a cyclic frequency analysis without pre-stress.
fn deck(sector: &SectorMesh, p: &ImpellerParameters, speed: f64) -> String {
    let mut deck = String::from("*NODE, NSET=NALL\n");
    for (n, [x, y, z]) in sector.mesh.nodes.iter().enumerate() {
        writeln!(deck, "{}, {x:.14e}, {y:.14e}, {z:.14e}", n + 1).unwrap();
    }
    let kind = match sector.mesh.elements {
        Elements::Linear(_) => "C3D8I",
        Elements::Quadratic(_) => "C3D20",
    };
    writeln!(deck, "*ELEMENT, TYPE={kind}, ELSET=EALL").unwrap();
    for e in 0..sector.mesh.elements.len() {
        // At most sixteen numbers a line.
        let numbers: Vec<String> = std::iter::once(e + 1)
            .chain(sector.mesh.elements.nodes_of(e).iter().map(|n| n + 1))
            .map(|number| number.to_string())
            .collect();
        let lines: Vec<String> = numbers.chunks(11).map(|line| line.join(", ")).collect();
        writeln!(deck, "{}", lines.join(",\n")).unwrap();
    }
    let free = |node: usize| sector.clamped[node] == [false; 3];
    deck.push_str("*NSET, NSET=BORE\n");
    ids(&mut deck, (0..sector.mesh.nodes.len()).filter(|&node| !free(node)));
    deck.push_str("*NSET, NSET=LOW\n");
    ids(&mut deck, sector.cyclic.iter().map(|&(low, _)| low).filter(|&low| free(low)));
    deck.push_str("*NSET, NSET=HIGH\n");
    ids(&mut deck, sector.cyclic.iter().map(|&(_, high)| high).filter(|&high| free(high)));
    let m = &p.material;
    write!(
        deck,
        "*MATERIAL, NAME=M
*ELASTIC
{:e}, {:e}
*DENSITY
{:e}
*SOLID SECTION, ELSET=EALL, MATERIAL=M
*BOUNDARY
BORE, 1, 3
*SURFACE, NAME=SHIGH, TYPE=NODE
HIGH
*SURFACE, NAME=SLOW, TYPE=NODE
LOW
*TIE, NAME=CYC, CYCLIC SYMMETRY, POSITION TOLERANCE=1.E-6
SHIGH, SLOW
*CYCLIC SYMMETRY MODEL, N={sectors}, TIE=CYC, NGRAPH=1
0., 0., 0., 0., 0., 1.
*STEP
*STATIC
*DLOAD
EALL, CENTRIF, {square:e}, 0., 0., 0., 0., 0., 1.
*NODE PRINT, NSET=NALL
U
*EL PRINT, ELSET=EALL
S
*END STEP
*STEP
*FREQUENCY
{MODES}
*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={last}
*END STEP
",
        m.youngs_modulus,
        m.poissons_ratio,
        m.density,
        sectors = p.sectors,
        square = speed * speed,
        last = p.sectors / 2,
    )
    .unwrap();
    deck
}

/// Runs the deck; none, with a printed reason, without CalculiX.
fn calculix(deck: &str, sector: &SectorMesh) -> Option<Answer> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sector.inp"), deck).unwrap();
    let run = Command::new("ccx").args(["-i", "sector"]).current_dir(folder.path()).output();
    let output = match run {
        Ok(output) => output,
        Err(error) => {
            eprintln!("skipped: CalculiX (`ccx`, package calculix-ccx) cannot be run: {error}");
            return None;
        }
    };
    let text = std::fs::read_to_string(folder.path().join("sector.dat")).unwrap_or_default();
    assert!(
        output.status.success() && !text.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
    Some(parse(&text, sector))
}

fn parse(text: &str, sector: &SectorMesh) -> Answer {
    let mut answer = Answer {
        frequencies: Vec::new(),
        displacements: vec![[f64::NAN; 3]; sector.mesh.nodes.len()],
        stresses: vec![Vec::new(); sector.mesh.elements.len()],
    };
    let mut block = "";
    for line in text.lines() {
        if line.contains("E I G E N V A L U E") {
            block = "frequencies";
        } else if line.contains("P A R T I C I P A T I O N") || line.contains("E F F E C T I V E") {
            block = "";
        } else if line.contains("displacements (vx,vy,vz)") {
            block = "displacements";
        } else if line.contains("stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)") {
            block = "stresses";
        }
        let values: Option<Vec<f64>> = line.split_whitespace().map(|field| field.parse().ok()).collect();
        let Some(v) = values.filter(|v| !v.is_empty()) else { continue };
        match block {
            // Nodal diameter, mode, eigenvalue, rad/time, cycles/time, imaginary part.
            "frequencies" => {
                let diameter = v[0] as usize;
                answer.frequencies.resize(answer.frequencies.len().max(diameter + 1), Vec::new());
                answer.frequencies[diameter].push(v[4]);
            }
            "displacements" => answer.displacements[v[0] as usize - 1] = [v[1], v[2], v[3]],
            "stresses" => answer.stresses[v[0] as usize - 1].push(std::array::from_fn(|c| v[2 + c])),
            _ => {}
        }
    }
    answer
}

/// Largest differences from CalculiX: relative for frequencies, in parts of the largest for the others.
#[derive(Debug)]
struct Differences {
    frequency: f64,
    displacement: f64,
    stress: f64,
}

fn differences(element_order: ElementOrder) -> Option<Differences> {
    let p = ImpellerParameters {
        sectors: 7,
        contact_nodes: 5,
        element_order,
        splitter: Some(Splitter::default()),
        mesh: MeshDensities {
            between_contact_nodes: 1,
            blade_height: 2,
            blade_thickness: 1,
            half_passage: 1,
            disk: 2,
        },
        ..ImpellerParameters::default()
    };
    let sector = impeller_sector(&p).unwrap();
    let speed = p.top_speed_rad_s;
    let theirs = calculix(&deck(&sector, &p, speed), &sector)?;

    let package = to_package("impeller", &sector, &p.material, &p.units, speed).unwrap();
    let mut frequency = 0.0_f64;
    assert_eq!(theirs.frequencies.len(), p.sectors / 2 + 1);
    for (i, theirs) in theirs.frequencies.iter().enumerate() {
        let k = harmonic(&package, &package.stiffness[0], i);
        let ours = hertz(&lowest(&k, &harmonic(&package, &package.mass, i), MODES).unwrap());
        println!("{element_order:?}, nodal diameter {i}: {ours:.3?}, CalculiX {theirs:.3?}");
        // CalculiX counts the cosine and the sine mode of a pair.
        let pair = if i == 0 { 1 } else { 2 };
        for (j, theirs) in theirs.iter().enumerate() {
            frequency = frequency.max((ours[j / pair] / theirs - 1.0).abs());
        }
    }

    let prestress = SectorMatrices::assemble(&sector, &p.material).unwrap().prestress;
    let square = speed * speed;
    let length = |u: &[f64; 3]| u.iter().map(|u| u * u).sum::<f64>().sqrt();
    let largest = theirs.displacements.iter().map(length).fold(0.0, f64::max);
    let mut displacement = 0.0_f64;
    for (node, theirs) in theirs.displacements.iter().enumerate() {
        let (s, c) = sector.mesh.angle(node).sin_cos();
        let [r, t, z] = prestress.displacements[node].map(|u| u * square);
        let ours = [c * r - s * t, s * r + c * t, z];
        let off: [f64; 3] = std::array::from_fn(|d| ours[d] - theirs[d]);
        displacement = displacement.max(length(&off) / largest);
    }
    let components = || theirs.stresses.iter().flatten().flatten();
    let largest = components().fold(0.0_f64, |m, s| m.max(s.abs()));
    let mut stress = 0.0_f64;
    for (ours, theirs) in prestress.stresses.iter().zip(&theirs.stresses) {
        assert_eq!(ours.len(), theirs.len());
        for (ours, theirs) in ours.iter().zip(theirs) {
            for (component, theirs) in [0, 1, 2, 3, 5, 4].into_iter().zip(theirs) {
                stress = stress.max((ours[component] * square - theirs).abs() / largest);
            }
        }
    }
    Some(Differences { frequency, displacement, stress })
}

/// The same element, so only the printed digits differ.
#[test]
fn twenty_node_impeller_agrees_with_calculix() {
    let Some(d) = differences(ElementOrder::Quadratic) else { return };
    println!("{d:?}");
    assert!(d.frequency < 1e-6 && d.displacement < 1e-6 && d.stress < 1e-6, "{d:?}");
}

/// Two formulations of the same idea on a coarse, distorted mesh.
#[test]
fn eight_node_impeller_is_close_to_calculix() {
    let Some(d) = differences(ElementOrder::Linear) else { return };
    println!("{d:?}");
    assert!(d.frequency < 0.01 && d.displacement < 0.01 && d.stress < 0.1, "{d:?}");
}
