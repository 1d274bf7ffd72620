//! The cyclic faces, the mass and the contact nodes against what rigid motions tell of them.

use nalgebra::{Matrix3, Rotation3, Vector3};
use rubmap::impeller::{ImpellerParameters, Preset, generate};
use rubmap::package::raw::{RawDof, RawMatrix, RawPackage};

use crate::findings::{found, refusal, reordered, turned};

fn wheel(sectors: usize) -> RawPackage {
    let small = Preset::Small.parameters();
    generate(&ImpellerParameters { gyroscopic: false, sectors, ..small }).unwrap()
}

/// Nodes of the high face.
fn high(package: &RawPackage) -> Vec<u64> {
    package.manifest.cyclic.iter().map(|pair| pair[1]).collect()
}

fn without_mesh(mut package: RawPackage) -> RawPackage {
    (package.manifest.mesh, package.elements) = (None, None);
    package
}

/// Folds the part of the high face into the low one, as in a sector cut out of the matrices of the wheel.
fn assembled(package: &mut RawPackage, keeps_high: bool) {
    let sector = 2.0 * std::f64::consts::PI / package.manifest.sectors as f64;
    assert!(package.manifest.frame == rubmap::package::raw::Frame::Cylindrical, "faces in {sector} rad fit");
    let low_of: std::collections::HashMap<u64, u64> =
        package.manifest.cyclic.iter().map(|pair| (pair[1], pair[0])).collect();
    let row_of: std::collections::HashMap<(u64, u8), u32> =
        package.dofs.iter().enumerate().map(|(row, dof)| ((dof.node, dof.component), row as u32)).collect();
    let dofs = package.dofs.clone();
    let fold = |matrix: &mut RawMatrix| {
        let low = |row: u32| {
            let RawDof { node, component } = dofs[row as usize];
            low_of.get(&node).and_then(|low| row_of.get(&(*low, component))).copied()
        };
        let mut folded = Vec::new();
        for &(row, column, value) in &matrix.entries {
            if let (Some(a), Some(b)) = (low(row), low(column)) {
                folded.push((a.max(b), a.min(b), value));
                if !keeps_high {
                    continue;
                }
            }
            folded.push((row, column, value));
        }
        let mut sums = std::collections::BTreeMap::new();
        folded
            .into_iter()
            .for_each(|(row, column, value)| *sums.entry((row, column)).or_insert(0.0) += value);
        matrix.entries = sums.into_iter().map(|((row, column), value)| (row, column, value)).collect();
    };
    fold(&mut package.mass);
    package.stiffness.iter_mut().for_each(fold);
}

/// Both conventions of docs/package.md are sound, for even and odd numbers of sectors; the part of one face in both blocks is not.
#[test]
fn a_face_that_counts_twice_is_refused() {
    for sectors in [3, 7, 10] {
        let good = without_mesh(wheel(sectors));
        assert!(found(&good).warnings().is_empty(), "{:?}", found(&good).warnings());
        let mut moved = good.clone();
        assembled(&mut moved, false);
        assert!(found(&moved).warnings().is_empty(), "{:?}", found(&moved).warnings());
        let mut twice = good;
        assembled(&mut twice, true);
        let refused = refusal(twice);
        assert_eq!(refused.field(), Some("/cyclic"), "{refused}");
        assert!(refused.to_string().contains("in that of the low face already"), "{refused}");
    }
}

#[test]
fn sectors_that_are_not_joined_are_refused() {
    let mut apart = without_mesh(wheel(7));
    let high = high(&apart);
    let dofs = apart.dofs.clone();
    let of_high = |row: u32| high.contains(&dofs[row as usize].node);
    let keep = |matrix: &mut RawMatrix| {
        matrix.entries.retain(|&(row, column, _)| !of_high(row) && !of_high(column));
    };
    apart.stiffness.iter_mut().for_each(keep);
    let refused = refusal(apart);
    assert!(refused.to_string().contains("the sectors are not joined"), "{refused}");
}

#[test]
fn a_high_face_in_another_frame_sign_or_order_is_refused() {
    let good = without_mesh(wheel(7));
    let faces = high(&good);
    let at: std::collections::HashMap<u64, Vector3<f64>> =
        good.nodes.iter().map(|node| (node.id, Vector3::from(node.position))).collect();
    let of_high = |turn: &dyn Fn(u64) -> Matrix3<f64>| {
        let mut package = good.clone();
        turned(&mut package, |node| if faces.contains(&node) { turn(node) } else { Matrix3::identity() });
        refusal(package).to_string()
    };
    let to_cartesian = |node: u64| {
        let at = at[&node];
        Rotation3::from_axis_angle(&Vector3::z_axis(), at.y.atan2(at.x)).into_inner()
    };
    let refused = of_high(&to_cartesian);
    assert!(refused.contains("nodes on the high face alone are cartesian"), "{refused}");
    let refused = of_high(&|_| -Matrix3::identity());
    assert!(refused.contains("the rows of the high face have the other sign"), "{refused}");
    let refused = of_high(&|_| Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0)));
    assert!(refused.contains("component 2 of the nodes on the high face"), "{refused}");

    let mut package = good.clone();
    let mut nodes: Vec<u64> = good.dofs.iter().map(|dof| dof.node).collect();
    nodes.dedup();
    let mut listed: Vec<u64> = nodes.iter().copied().filter(|node| faces.contains(node)).collect();
    let order: Vec<RawDof> = nodes
        .iter()
        .map(|node| if faces.contains(node) { listed.pop().unwrap() } else { *node })
        .flat_map(|node| (1..=3).map(move |component| RawDof { node, component }))
        .collect();
    reordered(&mut package, &order);
    let refused = refusal(package).to_string();
    assert!(refused.contains("the nodes of the high face are in the order"), "{refused}");
}

#[test]
fn numbers_that_no_model_has_are_refused() {
    let good = without_mesh(wheel(7));
    let with = |change: &dyn Fn(&mut RawPackage)| {
        let mut package = good.clone();
        change(&mut package);
        refusal(package).to_string()
    };
    let scaled = |by: f64| {
        move |package: &mut RawPackage| {
            package
                .stiffness
                .iter_mut()
                .flat_map(|matrix| &mut matrix.entries)
                .for_each(|entry| entry.2 *= by);
        }
    };
    assert!(with(&scaled(0.0)).contains("all entries are zero"));
    assert!(with(&scaled(1e300)).contains("choose other units"));
    assert!(with(&scaled(1e-300)).contains("choose other units"));
    assert!(with(&scaled(-1.0)).contains("check the sign of the matrix"));
    assert!(with(&|package| package.manifest.speeds_rad_s[1] = 1e-300).contains("is too near to 0.0 rad/s"));
    let slow = with(&|package| package.manifest.speeds_rad_s = vec![0.0, 1e-9, 2e-9]);
    assert!(slow.contains("rad/s are accepted"), "{slow}");
}

#[test]
fn mass_of_another_frame_and_odd_contact_nodes_are_told() {
    let good = without_mesh(wheel(7));
    let warned = |change: &dyn Fn(&mut RawPackage)| {
        let mut package = good.clone();
        change(&mut package);
        found(&package).warnings().join("; ")
    };
    let axial = |package: &mut RawPackage| {
        let dofs = package.dofs.clone();
        let is_axial = |row: u32| dofs[row as usize].component == 3;
        let entries = package.mass.entries.iter_mut();
        entries.filter(|entry| is_axial(entry.0) && is_axial(entry.1)).for_each(|entry| entry.2 *= 2.0);
    };
    assert!(warned(&axial).contains("not the same in all directions"), "{}", warned(&axial));
    let contact = |package: &RawPackage| package.manifest.contact.len();
    assert!(contact(&good) >= 4);
    let flipped = warned(&|package| {
        package.manifest.contact[1].normal = package.manifest.contact[1].normal.map(|x| -x)
    });
    assert!(flipped.contains("contact normals turn over"), "{flipped}");
    let around = warned(&|package| {
        package.manifest.contact.iter_mut().for_each(|contact| contact.normal = [0.0, 1.0, 0.0]);
    });
    assert!(around.contains("contact normals run around the axis"), "{around}");
    let shuffled = warned(&|package| package.manifest.contact.swap(0, 2));
    assert!(shuffled.contains("doubles back"), "{shuffled}");
}
