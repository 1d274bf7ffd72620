//! Stiffness at speed against CalculiX's export with initial stresses (docs/calculix.md), entry by entry: one sector of every kind through the
//! public way from a mesh.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;

use faer::Mat;
use rubmap::package::raw::RawPackage;
use rubmap::solid::rule::MassRule;

use crate::eigen::dense;
use crate::mesh_kinds::{SECTORS, SPEED, deck, kinds, model, run};

/// Deck of the free sector: what CalculiX has of the cyclic tie is left out, which would eliminate a face.
fn free(deck: &str) -> &str {
    &deck[..deck.find("*SURFACE").unwrap()]
}

/// Stresses at points under the centrifugal load, as lines of initial conditions; CalculiX prints seven digits.
fn stresses(folder: &Path) -> String {
    let text = std::fs::read_to_string(folder.join("sector.dat")).unwrap();
    let mut lines = String::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.len() == 8 && words.iter().all(|word| word.parse::<f64>().is_ok()) {
            writeln!(lines, "{}", words.join(", ")).unwrap();
        }
    }
    lines
}

/// Stiffness that CalculiX stored, by the rows of the package; those of incompatible modes, at nodes of their own, are left out.
fn stored(folder: &Path, package: &RawPackage) -> Mat<f64> {
    let read = |extension| std::fs::read_to_string(folder.join(format!("sector.{extension}"))).unwrap();
    let rows: HashMap<(u64, u8), usize> =
        package.dofs.iter().enumerate().map(|(row, dof)| ((dof.node, dof.component), row)).collect();
    let place = |line: &str| {
        let (node, component) = line.trim().split_once('.').unwrap();
        rows.get(&(node.parse().unwrap(), component.parse().unwrap())).copied()
    };
    let place: Vec<Option<usize>> = read("dof").lines().map(place).collect();
    assert_eq!(place.iter().flatten().count(), rows.len());
    let mut full = Mat::zeros(rows.len(), rows.len());
    for line in read("sti").lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = |k: usize| place[words[k].parse::<usize>().unwrap() - 1];
        let (Some(row), Some(column)) = (at(0), at(1)) else { continue };
        let value: f64 = words[2].parse().unwrap();
        (full[(row, column)], full[(column, row)]) = (value, value);
    }
    full
}

/// Turn of a package's displacements along x, y, z into its cylindrical components.
fn turn(package: &RawPackage) -> Mat<f64> {
    let angle: HashMap<u64, f64> =
        package.nodes.iter().map(|node| (node.id, node.position[1].atan2(node.position[0]))).collect();
    let dofs = &package.dofs;
    Mat::from_fn(dofs.len(), dofs.len(), |row, column| {
        let (own, of) = (dofs[row], dofs[column]);
        let (sin, cos) = angle[&own.node].sin_cos();
        match (own.node == of.node, own.component, of.component) {
            (true, 1, 1) | (true, 2, 2) => cos,
            (true, 1, 2) => sin,
            (true, 2, 1) => -sin,
            (true, 3, 3) => 1.0,
            _ => 0.0,
        }
    })
}

/// K(Ω) − K(0) with stresses of CalculiX's own cyclic sector, which it prints with seven digits, and its spin softening.
#[test]
fn stiffness_at_speed_of_every_kind_is_calculixs() {
    let load = format!("*DLOAD\nEALL, CENTRIF, {:e}, 0., 0., 0., 0., 0., 1.\n", SPEED * SPEED);
    for kind in kinds() {
        let deck = deck(kind, SECTORS, 0.0);
        let spin = format!("*STEP\n*STATIC\n{load}*EL PRINT, ELSET=EALL\nS\n*END STEP\n");
        let Some(spun) = run(&deck, &spin) else { return };
        let free = free(&deck);
        let export = "*FREQUENCY, SOLVER=MATRIXSTORAGE\n";
        let rest = run(free, &format!("*STEP\n{export}*END STEP\n")).unwrap();
        let steps = format!(
            "*INITIAL CONDITIONS, TYPE=STRESS\n{}*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nNALL, 1, 3\n{load}*END STEP\n\
             *STEP, PERTURBATION\n{export}*BOUNDARY, OP=NEW\nBORE, 1, 3\n*END STEP\n",
            stresses(spun.path())
        );
        let full = run(free, &steps).unwrap();
        let package = model(&deck, SECTORS, MassRule::AsStiffness);
        let theirs = stored(full.path(), &package) - stored(rest.path(), &package);
        let turn = turn(&package);
        let ours = dense(&package.stiffness[2]) - dense(&package.stiffness[0]);
        let ours = turn.transpose() * ours * &turn;
        let off = (&ours - &theirs).norm_max() / theirs.norm_max();
        println!("{kind:?}: {off:.1e}");
        assert!(off < 1e-6, "{kind:?}: {off:e}");
    }
}
