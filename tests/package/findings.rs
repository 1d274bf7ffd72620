//! Findings of rigid motions in the matrices: rows in another order or frame, few digits, stiffness of other speeds.

use std::collections::HashMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix3, Rotation3, Unit, Vector3};
use rubmap::dynamics::findings::{Findings, SpinAtSpeed, SpinFinding};
use rubmap::dynamics::sector::{CyclicMatrix, SectorModel, Units};
use rubmap::impeller::{ImpellerParameters, MeshDensities, Preset, generate};
use rubmap::package::raw::{Frame, RawDof, RawMatrix, RawPackage};
use rubmap::package::{self, Limits, PackageError};

use crate::sample::shared_models;

fn wheel() -> RawPackage {
    let small = Preset::Small.parameters();
    generate(&ImpellerParameters { gyroscopic: false, ..small }).unwrap()
}

pub(crate) fn found(package: &RawPackage) -> Findings {
    package::look_at(package.clone()).unwrap()
}

/// Every matrix in the axes that `basis` gives each node.
pub(crate) fn turned(package: &mut RawPackage, basis: impl Fn(u64) -> Matrix3<f64>) {
    let dofs = package.dofs.clone();
    let mut rows: HashMap<u64, [Option<usize>; 3]> = HashMap::new();
    for (row, dof) in dofs.iter().enumerate() {
        rows.entry(dof.node).or_default()[usize::from(dof.component) - 1] = Some(row);
    }
    let turn = |matrix: &mut RawMatrix, mirror: f64| {
        let mut blocks: HashMap<(u64, u64), Matrix3<f64>> = HashMap::new();
        for &(row, column, value) in &matrix.entries {
            let (a, b) = (dofs[row as usize], dofs[column as usize]);
            let (i, j) = (usize::from(a.component) - 1, usize::from(b.component) - 1);
            blocks.entry((a.node, b.node)).or_default()[(i, j)] += value;
            if row != column {
                blocks.entry((b.node, a.node)).or_default()[(j, i)] += mirror * value;
            }
        }
        matrix.entries.clear();
        for ((a, b), block) in blocks {
            let block = basis(a) * block * basis(b).transpose();
            for (i, row) in rows[&a].iter().enumerate() {
                for (j, column) in rows[&b].iter().enumerate() {
                    if let (Some(row), Some(column)) = (row, column)
                        && row >= column
                    {
                        matrix.entries.push((*row as u32, *column as u32, block[(i, j)]));
                    }
                }
            }
        }
    };
    turn(&mut package.mass, 1.0);
    package.stiffness.iter_mut().for_each(|matrix| turn(matrix, 1.0));
    package.gyroscopic.iter_mut().for_each(|matrix| turn(matrix, -1.0));
    package.elements = None;
    package.manifest.mesh = None;
}

/// Matrix rows moved to where `order` has their DOF, the table as it was.
pub(crate) fn reordered(package: &mut RawPackage, order: &[RawDof]) {
    let place: HashMap<(u64, u8), u32> =
        order.iter().enumerate().map(|(row, dof)| ((dof.node, dof.component), row as u32)).collect();
    let rows: Vec<u32> = package.dofs.iter().map(|dof| place[&(dof.node, dof.component)]).collect();
    for matrix in std::iter::once(&mut package.mass).chain(&mut package.stiffness) {
        for (row, column, _) in &mut matrix.entries {
            let [a, b] = [*row, *column].map(|old| rows[old as usize]);
            (*row, *column) = (a.max(b), a.min(b));
        }
    }
    package.elements = None;
    package.manifest.mesh = None;
}

pub(crate) fn refusal(package: RawPackage) -> PackageError {
    package::to_sector(package).map(drop).unwrap_err()
}

#[test]
fn rows_in_another_order_are_refused_with_that_order() {
    let good = wheel();
    let mut nodes: Vec<u64> = good.dofs.iter().map(|dof| dof.node).collect();
    nodes.dedup();
    let by_node = |nodes: &[u64]| -> Vec<RawDof> {
        nodes.iter().flat_map(|&node| (1..=3).map(move |component| RawDof { node, component })).collect()
    };
    nodes.reverse();
    let mut by_component = good.dofs.clone();
    by_component.sort_by_key(|dof| dof.component);
    for (order, says) in
        [(by_node(&nodes), "the DOF table, reversed"), (by_component, "all components 1 first")]
    {
        let mut package = good.clone();
        reordered(&mut package, &order);
        let refused = refusal(package);
        assert_eq!(refused.field(), Some("/dofs"), "{refused}");
        assert!(refused.to_string().contains(says), "{refused}");
    }
}

/// Order of rows that is none of the known ones: accepted, for it may be something else than a solid, and reported.
#[test]
fn rows_that_no_reading_balances_are_told() {
    let mut package = wheel();
    assert!(found(&package).warnings().is_empty());
    let mut nodes: Vec<u64> = package.dofs.iter().map(|dof| dof.node).collect();
    nodes.dedup();
    nodes.sort_by_key(|&node| (7 * node) % 101);
    let order: Vec<RawDof> =
        nodes.iter().flat_map(|&node| (1..=3).map(move |component| RawDof { node, component })).collect();
    reordered(&mut package, &order);
    let findings = found(&package);
    assert!(findings.warnings()[0].contains("rigid motions of the sector"), "{findings:?}");
}

#[test]
fn components_in_another_frame_are_refused_with_that_frame() {
    let good = wheel();
    assert_eq!(good.manifest.frame, Frame::Cylindrical);
    let axis = Unit::new_normalize(Vector3::from(good.manifest.axis.direction));
    let at: HashMap<u64, Vector3<f64>> =
        good.nodes.iter().map(|node| (node.id, Vector3::from(node.position))).collect();
    // About z: cylindrical components are Cartesian ones turned by −θ.
    let to_cartesian = |node: u64| {
        let at = at[&node];
        Rotation3::from_axis_angle(&axis, at.y.atan2(at.x)).into_inner()
    };
    let faces: Vec<u64> = good.manifest.cyclic.iter().flatten().copied().collect();
    let cartesian = |only: &dyn Fn(u64) -> bool| {
        let mut package = good.clone();
        turned(&mut package, |node| if only(node) { to_cartesian(node) } else { Matrix3::identity() });
        for contact in &mut package.manifest.contact {
            contact.normal = (to_cartesian(contact.node) * Vector3::from(contact.normal)).into();
        }
        package.manifest.frame = Frame::Cartesian;
        package
    };
    let sound = cartesian(&|_| true);
    assert!(matches!(found(&sound).spin[1].finding, SpinFinding::Undeformed { residual } if residual < 1e-6));

    let says = |package: RawPackage, field: &str, words: &str| {
        let refused = refusal(package);
        assert_eq!(refused.field(), Some(field), "{refused}");
        assert!(refused.to_string().contains(words), "{refused}");
    };
    let mut called = sound.clone();
    called.manifest.frame = Frame::Cylindrical;
    says(called, "/frame", "say \"frame\": \"cartesian\"");
    let mut called = good.clone();
    (called.manifest.frame, called.manifest.mesh, called.elements) = (Frame::Cartesian, None, None);
    says(called, "/frame", "say \"frame\": \"cylindrical\"");
    says(
        cartesian(&|node| !faces.contains(&node)),
        "/frame",
        "nodes on the cyclic faces alone are cylindrical",
    );
    let mut high = sound;
    let back = Rotation3::from_axis_angle(&axis, -TAU / high.manifest.sectors as f64).into_inner();
    let of_high: Vec<u64> = high.manifest.cyclic.iter().map(|pair| pair[1]).collect();
    turned(&mut high, |node| if of_high.contains(&node) { back } else { Matrix3::identity() });
    says(high, "/frame", "along axes turned with the sector");
}

/// Shares of stiffening and softening: K(Ω) of other speeds, and with other shares of what belongs in it, against the shares that were put in.
#[test]
fn shares_of_stiffening_and_softening_are_told() {
    let good = wheel();
    for SpinAtSpeed { finding, .. } in found(&good).spin {
        assert!(matches!(finding, SpinFinding::Undeformed { residual } if residual < 1e-6), "{finding}");
    }
    let shares = |package: &RawPackage| match found(package).spin[..] {
        [SpinAtSpeed { finding: SpinFinding::Shares { stiffening: a, softening: b, .. }, .. }, last] => {
            (a, b, last.finding.to_string())
        }
        ref other => panic!("{other:?}"),
    };
    let near = |(a, b, _): &(f64, f64, String), c: f64, d: f64| (a - c).abs() < 1e-4 && (b - d).abs() < 1e-4;

    let mut rpm = good.clone();
    rpm.manifest.speeds_rad_s.iter_mut().for_each(|speed| *speed *= 60.0 / TAU);
    let factor = (TAU / 60.0).powi(2);
    let said = shares(&rpm);
    assert!(near(&said, factor, factor) && said.2.contains("in rpm, and belong in rad/s"), "{said:?}");

    // In single precision too, where the identity row by row is hidden by round-off.
    for matrix in &mut rpm.stiffness {
        matrix.entries.iter_mut().for_each(|entry| entry.2 = f64::from(entry.2 as f32));
    }
    let said = shares(&rpm);
    assert!((said.0 / factor - 1.0).abs() < 0.05 && said.2.contains("in rpm"), "{said:?}");

    let softened = |times: f64| {
        let mut package = good.clone();
        let in_plane: HashMap<(u32, u32), f64> = (good.mass.entries.iter())
            .filter(|(row, column, _)| {
                [row, column].iter().all(|row| good.dofs[**row as usize].component != 3)
            })
            .map(|&(row, column, value)| ((row, column), value))
            .collect();
        for (matrix, speed) in package.stiffness.iter_mut().zip(&good.manifest.speeds_rad_s) {
            for (row, column, value) in &mut matrix.entries {
                *value -= times * speed * speed * in_plane.get(&(*row, *column)).copied().unwrap_or(0.0);
            }
        }
        shares(&package)
    };
    let said = softened(-1.0);
    assert!(near(&said, 1.0, 0.0) && said.2.contains("WITHOUT spin softening"), "{said:?}");
    let said = softened(1.0);
    assert!(near(&said, 1.0, 2.0) && said.2.contains("TWICE"), "{said:?}");

    let mut still = good.clone();
    still.stiffness = vec![good.stiffness[0].clone(); 3];
    let said = shares(&still);
    assert!(near(&said, 0.0, 0.0) && said.2.contains("that at rest"), "{said:?}");

    // The same model with time counted in ms: mm, N, ms, and N·ms²/mm = 1e6 t.
    let mut milliseconds = good.clone();
    milliseconds.mass.entries.iter_mut().for_each(|entry| entry.2 *= 1e6);
    milliseconds.manifest.units =
        Units { length: "mm".into(), force: "N".into(), time: "ms".into(), mass: "N·ms²/mm".into() };
    milliseconds.manifest.mesh = None;
    milliseconds.elements = None;
    for SpinAtSpeed { finding, .. } in found(&milliseconds).spin {
        assert!(matches!(finding, SpinFinding::Undeformed { residual } if residual < 1e-6), "{finding}");
    }
}

/// Frequencies of nodal diameter 0, Hz, by dense matrices.
fn frequencies(sector: &SectorModel) -> Vec<f64> {
    let dense = |matrix: &CyclicMatrix| {
        let (own, next) = (matrix.own.to_dense(), matrix.next.to_dense());
        let n = sector.own_dofs();
        DMatrix::from_fn(n, n, |i, j| own[(i, j)] + next[(i, j)] + next[(j, i)])
    };
    let lower = dense(&sector.mass).cholesky().unwrap().l();
    let half = lower.solve_lower_triangular(&dense(&sector.stiffness[0])).unwrap();
    let standard = lower.solve_lower_triangular(&half.transpose()).unwrap();
    let mut values: Vec<f64> =
        ((&standard + standard.transpose()) * 0.5).symmetric_eigen().eigenvalues.as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    values.iter().map(|value| value.max(0.0).sqrt() / TAU).collect()
}

/// Few digits: entries rounded to single precision and to fewer digits. The reported change of the lowest frequencies is about the true one, by
/// dense matrices.
#[test]
fn few_digits_are_told_with_what_they_cost() {
    let mesh = MeshDensities {
        between_contact_nodes: 1,
        blade_height: 4,
        blade_thickness: 1,
        half_passage: 1,
        disk: 1,
    };
    let of = |thickness: f64| {
        let p = ImpellerParameters {
            tip_thickness: thickness,
            root_thickness: 1.5 * thickness,
            ..Default::default()
        };
        generate(&ImpellerParameters { contact_nodes: 4, mesh, gyroscopic: false, ..p }).unwrap()
    };
    type Round = fn(f64) -> f64;
    let cases: [(&str, Round); 4] = [
        ("float32", |x| f64::from(x as f32)),
        ("8 digits", |x| format!("{x:.7e}").parse().unwrap()),
        ("7 digits", |x| format!("{x:.6e}").parse().unwrap()),
        ("6 digits", |x| format!("{x:.5e}").parse().unwrap()),
    ];
    let mut ratios = Vec::new();
    for thickness in [0.3, 1.0, 3.0] {
        let good = of(thickness);
        assert!(found(&good).digits.is_none());
        let exact = frequencies(&package::to_sector(good.clone()).unwrap());
        for (name, round) in cases {
            let mut package = good.clone();
            for matrix in std::iter::once(&mut package.mass).chain(&mut package.stiffness) {
                matrix.entries.iter_mut().for_each(|entry| entry.2 = round(entry.2));
            }
            let findings = found(&package);
            let digits = findings.digits.expect("few digits");
            let rounded = frequencies(&package::to_sector(package).unwrap());
            let changes: Vec<f64> = (0..3).map(|mode| (rounded[mode] / exact[mode] - 1.0).abs()).collect();
            let said = digits.change_of(exact[0]);
            println!("{thickness} mm, {name}: {digits:?} {:?}", findings.spin);
            println!("  {:.0} Hz, changes {changes:?}, said {said:.1e}", exact[0]);
            if said < 0.1 {
                ratios.push(changes.iter().copied().fold(0.0, f64::max) / said);
            }
        }
    }
    println!("true/said {ratios:?}");
    assert!(ratios.len() >= 6 && ratios.iter().all(|ratio| (0.05..=6.5).contains(ratio)), "{ratios:?}");
}

#[test]
fn shared_models_are_sound() {
    let Some(models) = shared_models() else {
        println!("skipped: no shared models beside the project (set RUBMAP_SHARED)");
        return;
    };
    for name in ["impeller-a.zip", "impeller-a-cartesian.zip"] {
        let findings = package::read(&models.join(name), &Limits::default()).unwrap().findings;
        println!("{name}: {findings:?}");
        assert!(findings.warnings().is_empty());
        for SpinAtSpeed { finding, .. } in findings.spin {
            assert!(matches!(finding, SpinFinding::Undeformed { residual } if residual < 1e-3), "{finding}");
        }
    }
    let deformed = package::read(&models.join("impeller-a-nlgeom.zip"), &Limits::default()).unwrap().findings;
    assert!(deformed.spin.iter().all(|at| matches!(at.finding, SpinFinding::Other { .. })), "{deformed:?}");
}
