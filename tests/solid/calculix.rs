//! Stress of every element against CalculiX, at the elements' own points and at nodes: of prescribed displacements, of a static
//! load, and of vibration modes.

use std::fmt::Write as _;
use std::process::Command;

use faer::{Mat, c64};
use nalgebra::Vector3;
use rubmap::solid::element::ElementKind;
use rubmap::solid::mesh::{Element, SectorMesh};
use rubmap::solid::stress::{NodalStress, point_stress};

use crate::crooked::{crooked, noise};
use crate::deck::deck;
use crate::meshes::block;

/// Relative precision of CalculiX's output: it prints displacements and stresses at points with seven digits. In a mode, stress
/// comes from differences of displacements that are some hundredth of them.
const PRINTED: [f64; 2] = [5e-7, 5e-5];

/// Precision of CalculiX's table of extrapolation, whose coefficients have four digits, the largest 2.549 (C3D8, C3D20R) and 2.37499 (C3D20).
const ITS_TABLE: f64 = 5e-5;

/// Set of displacements and stresses that CalculiX printed.
#[derive(Default)]
struct Answer {
    /// Displacements x, y, z by node.
    displacements: Vec<[f64; 3]>,
    /// Stresses xx, yy, zz, xy, yz, zx at the points of each element.
    points: Vec<Vec<[f64; 6]>>,
    /// Stresses xx, yy, zz, xy, yz, zx at each node.
    nodes: Vec<[f64; 6]>,
}

/// Runs CalculiX on a deck; `None`, with a printed reason, without it.
pub(crate) fn run(deck: &str) -> Option<tempfile::TempDir> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("block.inp"), deck).unwrap();
    match Command::new("ccx").args(["-i", "block"]).current_dir(folder.path()).output() {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
            Some(folder)
        }
        Err(error) => {
            eprintln!("skipped: CalculiX (`ccx`, package calculix-ccx) cannot be run: {error}");
            None
        }
    }
}

/// Runs `steps` on the mesh, each of which prints U and S of everything; `None`, with a printed reason, without CalculiX.
fn calculix(mesh: &SectorMesh, steps: &str) -> Option<Vec<Answer>> {
    let folder = run(&format!("{}{steps}\n", deck(mesh)))?;
    let read = |extension| {
        std::fs::read_to_string(folder.path().join(format!("block.{extension}"))).unwrap_or_default()
    };
    let (dat, frd) = (read("dat"), read("frd"));
    assert!(!dat.is_empty(), "CalculiX printed nothing");
    Some(parse(mesh, &dat, &frd))
}

fn parse(mesh: &SectorMesh, dat: &str, frd: &str) -> Vec<Answer> {
    let mut answers: Vec<Answer> = Vec::new();
    let mut block = "";
    for line in dat.lines() {
        if line.contains("displacements (vx,vy,vz)") {
            block = "displacements";
            answers.push(Answer {
                displacements: vec![[0.0; 3]; mesh.nodes.len()],
                points: vec![Vec::new(); mesh.elements.len()],
                nodes: vec![[f64::NAN; 6]; mesh.nodes.len()],
            });
        } else if line.contains("stresses (elem, integ.pnt.") {
            block = "stresses";
        } else if line.contains("E I G E N V A L U E") || line.contains("P A R T I C I P A T I O N") {
            block = "";
        }
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        match (block, &numbers[..], answers.last_mut()) {
            ("displacements", &[node, x, y, z], Some(answer)) => {
                answer.displacements[node as usize - 1] = [x, y, z];
            }
            ("stresses", &[element, _, xx, yy, zz, xy, xz, yz], Some(answer)) => {
                answer.points[element as usize - 1].push([xx, yy, zz, xy, yz, xz]);
            }
            _ => {}
        }
    }
    let mut step = 0;
    let mut in_stress = false;
    for line in frd.lines() {
        if line.starts_with(" -4") {
            in_stress = line.contains("STRESS");
        } else if line.starts_with(" -3") && std::mem::take(&mut in_stress) {
            step += 1;
        } else if in_stress && line.starts_with(" -1") {
            let node: usize = line[3..13].trim().parse().unwrap();
            let value = |k: usize| line[13 + 12 * k..25 + 12 * k].trim().parse::<f64>().unwrap();
            answers[step].nodes[node - 1] = std::array::from_fn(value);
        }
    }
    assert_eq!(step, answers.len(), "stress of each step in both files");
    answers
}

const PRINT: &str = "*NODE PRINT, NSET=NALL\nU\n*EL PRINT, ELSET=EALL\nS\n*EL FILE\nS\n*END STEP\n";

/// Compares our stresses of CalculiX's displacements with CalculiX's stresses; returns the largest differences at points and at
/// nodes, relative to the largest stress component.
fn differences(mesh: &SectorMesh, answer: &Answer) -> [f64; 2] {
    let largest = answer.points.iter().flatten().flatten().fold(0.0, |most: f64, s| most.max(s.abs()));
    let at_points = |(element, expected): (&Element, &Vec<[f64; 6]>)| {
        let u: Vec<Vector3<f64>> =
            element.nodes.iter().map(|&node| answer.displacements[node as usize].into()).collect();
        let found = point_stress(mesh, element, &u);
        assert_eq!(found.len(), expected.len(), "integration points");
        let off = found.iter().zip(expected).flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
        off.fold(0.0, f64::max)
    };
    let points = mesh.elements.iter().zip(&answer.points).map(at_points).fold(0.0, f64::max);
    // At θ = 0 of an axis far away, cylindrical components are those of x, y, z to one part in 1e9.
    let far = SectorMesh { axis: ([-1e12, 0.0, 0.0], [0.0, 0.0, 1.0]), ..mesh.clone() };
    let operator = NodalStress::new(&far);
    let u =
        Mat::from_fn(3 * mesh.nodes.len(), 1, |row, _| c64::new(answer.displacements[row / 3][row % 3], 0.0));
    let found = operator.apply(c64::new(1.0, 0.0), u.as_ref());
    let mut nodes: f64 = 0.0;
    for (place, &node) in operator.places().iter().enumerate() {
        for (k, expected) in answer.nodes[node as usize].into_iter().enumerate() {
            nodes = nodes.max((found[(6 * place + k, 0)].re - expected).abs());
        }
    }
    [points / largest, nodes / largest]
}

/// Whether CalculiX has the element.
pub(crate) fn its_own(kind: ElementKind) -> bool {
    !matches!(kind, ElementKind::QM6 | ElementKind::C3D5 | ElementKind::C3D13)
}

/// Displacements of crooked elements in which every node is moved anyhow, so that no balance of forces makes anything small.
#[test]
fn any_displacement_of_crooked_elements() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| its_own(*kind)) {
        let mesh = block(kind, [2, 2, 2], |at| crooked(at, 0.1));
        let mut steps = String::from("*STEP\n*STATIC\n*BOUNDARY\n");
        for (id, at) in mesh.node_ids.iter().zip(&mesh.nodes) {
            for k in 1..=3 {
                writeln!(steps, "{id}, {k}, {k}, {:.14e}", 1e-3 * noise(*at, f64::from(k) + 7.0)).unwrap();
            }
        }
        let Some(answers) = calculix(&mesh, &(steps + PRINT)) else { return };
        let [points, nodes] = differences(&mesh, &answers[0]);
        println!("{kind:?}: points {points:.1e}, nodes {nodes:.1e}");
        assert!(points < PRINTED[0], "{kind:?}: {points:e}");
        // CalculiX's node values of a C3D6 alternate around its triangles.
        assert!(nodes < ITS_TABLE || kind == ElementKind::C3D6, "{kind:?}: {nodes:e}");
    }
}

/// Crooked beam held at one end, in a spin and in its lowest modes: differences per step.
fn beam(kind: ElementKind, cells: [usize; 3], modes: usize) -> Option<Vec<[f64; 2]>> {
    let mesh = block(kind, cells, |at| crooked(at, 0.08).map(|x| 10.0 * x));
    let held = mesh.nodes.iter().zip(&mesh.node_ids).filter(|(at, _)| at[0] < 1.0);
    let held: String = held.map(|(_, id)| format!("{id}, 1, 3\n")).collect();
    let spin = "*STEP\n*STATIC\n*DLOAD\nEALL, CENTRIF, 1.E6, 0., 0., 0., 0., 0., 1.\n";
    let steps = format!("*BOUNDARY\n{held}{spin}{PRINT}*STEP\n*FREQUENCY\n{modes}\n{PRINT}");
    let answers = calculix(&mesh, &steps)?;
    assert_eq!(answers.len(), 1 + modes);
    Some(answers.iter().map(|answer| differences(&mesh, answer)).collect())
}

#[test]
fn a_static_load_and_vibration_modes() {
    let with_modes = |kind: &ElementKind| its_own(*kind) && *kind != ElementKind::C3D8I;
    for kind in ElementKind::ALL.into_iter().filter(with_modes) {
        let Some(steps) = beam(kind, [5, 2, 2], 4) else { return };
        for (step, [points, nodes]) in steps.into_iter().enumerate() {
            println!("{kind:?}, {step}: points {points:.1e}, nodes {nodes:.1e}");
            assert!(points < PRINTED[1], "{kind:?}, {step}: {points:e}");
            assert!(
                nodes < PRINTED[1] + ITS_TABLE || kind == ElementKind::C3D6,
                "{kind:?}, {step}: {nodes:e}"
            );
        }
    }
}

/// Incompatible modes: CalculiX gives those of C3D8I mass, so in vibration they do not follow the corners statically, as ours do.
/// The effect on stress falls with the square of the element's size over the wave's length.
#[test]
fn incompatible_modes_follow_statically() {
    let Some(short) = beam(ElementKind::C3D8I, [12, 1, 1], 1) else { return };
    let Some(long) = beam(ElementKind::C3D8I, [24, 1, 1], 1) else { return };
    assert!(short[0][0] < PRINTED[1] && long[0][0] < PRINTED[1], "{short:?} {long:?}");
    assert!(long[1][0] < 1e-3 && long[1][0] < 0.35 * short[1][0], "{short:?} {long:?}");
}
