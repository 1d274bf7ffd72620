//! Static part of sweeps, the wheel under its centrifugal load, against CalculiX: a sector with cyclic symmetry, `*DLOAD` with `CENTRIF`.

use nalgebra::{Matrix3, Vector3};
use rubmap::analysis::stress::StressMaker;
use rubmap::analysis::tip_growth::TipGrowth;
use rubmap::impeller::impeller_sector;
use rubmap::package::{self, Limits};
use rubmap::solid::frame::AxisFrame;

use crate::calculix::{calculix, twenty_node_impeller};
use crate::packed::packed;

/// Relative precision with which CalculiX prints displacements, and stress at nodes after extrapolation by a table of four digits.
const PRINTED: [f64; 2] = [1e-6, 1e-4];

/// Static part of stress by the stored matrices at rest, as CalculiX's linear step has them. At nodes of the faces between sectors
/// CalculiX averages over the elements of its sector alone; we do over those of the next, too, as `tests/solid` has it of whole wheels.
#[test]
fn the_static_part_of_stress_is_that_of_calculix() {
    let p = twenty_node_impeller();
    let sector = impeller_sector(&p).unwrap();
    let speed = p.top_speed_rad_s;
    let Some(theirs) = calculix(&sector, &p.material, speed) else { return };
    let file = tempfile::NamedTempFile::new().unwrap();
    package::write(&packed("impeller", &sector, &p.material, &p.units, speed), &file).unwrap();
    let limits = Limits::default();
    let mesh = package::read_mesh(file.path(), &limits).unwrap().unwrap();
    let nodes = package::read_nodes(file.path(), &limits).unwrap();
    let maker = StressMaker::new(&mesh, &nodes);
    let imported = package::read(file.path(), &limits).unwrap();
    let fixed = maker.fixed(&imported.sector, &|_, _| true).unwrap();

    // CalculiX's number of a node is that of the generator.
    let near = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let theirs_of = |node: usize| {
        sector.mesh.nodes.iter().position(|at| near(at, &mesh.nodes[node])).expect("the same nodes")
    };
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1).unwrap();
    let directions = |node: usize| frame.cylindrical(frame.coordinates(mesh.nodes[node])[1]);
    let own = fixed.displacement(0.0, false);
    assert!(own.iter().all(|u| *u == 0.0), "nothing at rest");
    let own = fixed.displacement(speed, false);
    let largest = theirs.displacements.iter().map(|u| Vector3::from(*u).norm()).fold(0.0, f64::max);
    let mut displacement = 0.0f64;
    for (index, node) in nodes.iter().enumerate().filter(|(_, node)| !node.on_high_face) {
        let mut ours = Vector3::zeros();
        for dof in node.dofs.iter().flatten() {
            ours += Vector3::from(dof.components) * own[dof.dof];
        }
        let off =
            directions(index).transpose() * ours - Vector3::from(theirs.displacements[theirs_of(index)]);
        displacement = displacement.max(off.norm() / largest);
    }

    // Tips grow by what their nodes move along their normals.
    let contact = &imported.sector.contact;
    for (node, growth) in contact.iter().zip(TipGrowth::of(&fixed, contact).at(speed, false)) {
        let index = nodes.iter().position(|own| own.id == node.id).expect("a node of the mesh");
        let moved = directions(index) * Vector3::from(theirs.displacements[theirs_of(index)]);
        let expected = moved.dot(&Vector3::from(node.normal));
        assert!((growth - expected).abs() / largest < PRINTED[0], "{growth} {expected}");
    }

    let shares = fixed.stress.span.at(speed, false);
    let places = maker.operator().places();
    let on_face =
        |node: usize| mesh.cyclic.iter().any(|&(low, high)| node == low as usize || node == high as usize);
    let compared: Vec<usize> = (0..places.len()).filter(|&place| !on_face(places[place] as usize)).collect();
    assert!(2 * compared.len() > places.len());
    let largest =
        theirs.nodal_stresses.iter().flatten().filter(|s| s.is_finite()).fold(0.0f64, |m, s| m.max(s.abs()));
    let mut stress = 0.0f64;
    for place in compared {
        let node = places[place] as usize;
        let [rr, tt, zz, rt, tz, zr]: [f64; 6] = std::array::from_fn(|component| {
            let from = shares.len() * (6 * place + component);
            shares.iter().zip(&fixed.stress.stress[from..]).map(|(share, stress)| share * stress).sum()
        });
        let turn = directions(node);
        let ours = turn.transpose() * Matrix3::new(rr, rt, zr, rt, tt, tz, zr, tz, zz) * turn;
        let at = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
        for (at, theirs) in at.into_iter().zip(theirs.nodal_stresses[theirs_of(node)]) {
            stress = stress.max((ours[at] - theirs).abs() / largest);
        }
    }
    println!("displacement {displacement:.1e}, nodal stress {stress:.1e} of {largest:.1}");
    assert!(displacement < PRINTED[0] && stress < PRINTED[1]);
}
