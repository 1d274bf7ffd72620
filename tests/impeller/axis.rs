//! Wheels without a bore: nodes on the axis belong to all sectors. Held against the whole wheel as one sector, in which they are nodes like
//! others, and against closed forms of the solid plate.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::fmt::Write as _;

use faer::{Mat, c64};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap::dynamics::kept_rows::KeptRows;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::nodes::SectorNode;
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce, static_response};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::SectorModel;
use rubmap::from_mesh::{self, MeshSettings};
use rubmap::mesh;
use rubmap::package::raw::{Frame, RawMatrix, RawPackage};
use rubmap::package::{Limits, look_at, read_mesh, read_nodes, to_sector, write};
use rubmap::solid::element::ElementKind;
use rubmap::solid::mesh::SectorMesh;
use rubmap::solid::skin::skin;
use rubmap::solid::stress::NodalStress;

use crate::eigen::dense;
use crate::meshes::block;

/// Speed of the last stiffness matrix, rad/s.
const SPEED: f64 = 20_000.0;
/// Cells of a sector along r, θ and z.
const CELLS: [usize; 3] = [2, 2, 2];
/// Outer radius.
const RADIUS: f64 = 30.0;

/// Solid disk with skewed cuts, `sectors` of its parts in one mesh: hexahedra that meet the axis are wedges, tetrahedra that lie on it are
/// left out.
fn disk(kind: ElementKind, parts: usize, sectors: usize) -> SectorMesh {
    let [radial, around, _] = CELLS;
    let place = |[r, j, z]: [f64; 3]| {
        let radius = RADIUS * r / radial as f64;
        let theta = TAU * j / (around * parts) as f64 + 0.1 * r + 0.05 * z;
        [radius * theta.cos(), radius * theta.sin(), 2.0 * z * (1.0 - 0.2 * r / radial as f64)]
    };
    merged(block(kind, [CELLS[0], around * sectors, CELLS[2]], place))
}

/// Mesh with one node at each place: hexahedra at the axis get repeated nodes, and tetrahedra that would are left out; edges of these that
/// meet the axis are straight.
fn merged(mut mesh: SectorMesh) -> SectorMesh {
    const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    for element in mesh.elements.iter().filter(|element| element.kind == ElementKind::C3D10) {
        for (k, ends) in (4..).zip(EDGES) {
            let [a, b] = ends.map(|end| mesh.nodes[element.nodes[end] as usize]);
            if a[0].hypot(a[1]).min(b[0].hypot(b[1])) < 1e-9 {
                mesh.nodes[element.nodes[k] as usize] = std::array::from_fn(|d| 0.5 * (a[d] + b[d]));
            }
        }
    }
    let mut first_at: HashMap<[i64; 3], u32> = HashMap::new();
    let one: Vec<u32> =
        (0..).zip(&mesh.nodes).map(|(node, at)| *first_at.entry(key(*at)).or_insert(node)).collect();
    for element in &mut mesh.elements {
        element.nodes.iter_mut().for_each(|node| *node = one[*node as usize]);
    }
    mesh.elements.retain(|element| {
        let corners = element.kind.corners();
        let distinct: HashSet<u32> = element.nodes[..corners].iter().copied().collect();
        corners == 8 || distinct.len() == corners
    });
    mesh
}

/// Whether a point lies on the circle by which the disk is held.
fn is_held(at: [f64; 3]) -> bool {
    (at[0].hypot(at[1]) - 0.5 * RADIUS).abs() < 1e-6 && at[2] == 0.0
}

/// Model of a mesh of `sectors` sectors, held at a circle in the middle of its back, contact nodes along z at the rim.
fn model(mesh: &SectorMesh, parts: usize, sectors: usize) -> RawPackage {
    let used: HashSet<u32> = mesh.elements.iter().flat_map(|element| element.nodes.iter().copied()).collect();
    let rim = |at: [f64; 3]| {
        let theta = TAU / (2 * parts) as f64 + 0.1 * CELLS[0] as f64 + 0.05 * at[2] / (2.0 * 0.8);
        (at[0] - RADIUS * theta.cos()).hypot(at[1] - RADIUS * theta.sin()) < 1e-6
    };
    let set = |is: &dyn Fn([f64; 3]) -> bool| -> String {
        let nodes =
            (0..mesh.nodes.len()).filter(|&node| used.contains(&(node as u32)) && is(mesh.nodes[node]));
        nodes.map(|node| format!("{}\n", mesh.node_ids[node])).collect()
    };
    let mut deck = crate::deck::deck(mesh);
    write!(deck, "*NSET, NSET=HELD\n{}*NSET, NSET=TIP\n{}*BOUNDARY\nHELD, 1, 3\n", set(&is_held), set(&rim))
        .unwrap();
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings {
        sectors: Some(sectors),
        contact_set: Some("TIP".into()),
        contact_nodes: 3,
        ..MeshSettings::new(SPEED)
    };
    from_mesh::sector(&file, &settings).unwrap().package().unwrap()
}

/// Sector and whole wheel of the same mesh.
struct Pair {
    sectors: usize,
    sector: RawPackage,
    whole: RawPackage,
}

fn pair(kind: ElementKind, sectors: usize) -> Pair {
    let sector = model(&disk(kind, sectors, 1), sectors, sectors);
    let mut whole = model(&disk(kind, sectors, sectors), sectors, 1);
    // Contact nodes of the other sectors, with the normals of the first.
    let places = by_place(&whole);
    for s in 1..sectors {
        for contact in sector.manifest.contact.clone() {
            let at = sector.nodes.iter().find(|node| node.id == contact.node).unwrap().position;
            let node = whole.nodes[places[&key(turned(at, s, sectors))]].id;
            whole.manifest.contact.push(rubmap::package::raw::ManifestContact { node, ..contact });
        }
    }
    Pair { sectors, sector, whole }
}

fn turned([x, y, z]: [f64; 3], s: usize, sectors: usize) -> [f64; 3] {
    let (sin, cos) = (TAU * s as f64 / sectors as f64).sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}

fn key(at: [f64; 3]) -> [i64; 3] {
    at.map(|x| (x * 1e5).round() as i64)
}

fn by_place(package: &RawPackage) -> HashMap<[i64; 3], usize> {
    package.nodes.iter().enumerate().map(|(index, node)| (key(node.position), index)).collect()
}

fn nodes(package: &RawPackage) -> Vec<SectorNode> {
    let file = tempfile::NamedTempFile::new().unwrap();
    write(package, file.as_file()).unwrap();
    read_nodes(file.path(), &Limits::default()).unwrap()
}

fn whole_basis(sector: &SectorModel) -> ReducedWheel {
    reduce(sector, &ReductionOptions::new(10_000), &NoCheckpoints, &|_, _| true).unwrap()
}

/// Natural frequencies of all waves, ascending: twice those that travel either way.
fn frequencies(wheel: &ReducedWheel, speed: f64) -> Vec<f64> {
    let modal = ModalWheel::at(wheel, speed, RotationEffects::stiffening(true)).unwrap();
    let all = modal.harmonics.into_iter().flat_map(|harmonic| {
        let count = if harmonic.single { 1 } else { 2 };
        harmonic.omega.into_iter().flat_map(move |omega| std::iter::repeat_n(omega, count))
    });
    let mut all: Vec<f64> = all.collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Kinds and numbers of sectors.
const WHEELS: [(ElementKind, usize); 5] = [
    (ElementKind::C3D8I, 2),
    (ElementKind::C3D8I, 3),
    (ElementKind::C3D8I, 8),
    (ElementKind::C3D10, 5),
    (ElementKind::C3D20, 3),
];

/// Frequencies at rest and at speed are those of the whole wheel, for few and many sectors, odd and even.
#[test]
fn frequencies_are_those_of_the_whole_wheel() {
    for (kind, sectors) in WHEELS {
        let pair = pair(kind, sectors);
        let findings = look_at(pair.sector.clone()).unwrap();
        assert!(findings.warnings().is_empty(), "{kind:?} {sectors}: {:?}", findings.warnings());
        assert!(findings.spin.iter().all(|at| at.finding.residual().is_some_and(|residual| residual < 1e-6)));
        let sector = to_sector(pair.sector).unwrap();
        assert_eq!(sector.axis.len(), if kind == ElementKind::C3D8I { 3 } else { 5 });
        let whole = to_sector(pair.whole).unwrap();
        assert!(whole.axis.is_empty());
        let [reduced, whole] = [&sector, &whole].map(whole_basis);
        for speed in [0.0, 0.5 * SPEED, SPEED] {
            let (ours, theirs) = (frequencies(&reduced, speed), frequencies(&whole, speed));
            assert_eq!(ours.len(), theirs.len(), "{kind:?} {sectors}");
            for (ours, theirs) in ours.iter().zip(&theirs).take(40) {
                assert!((ours / theirs - 1.0).abs() < 1e-9, "{kind:?} {sectors} {speed}: {ours} {theirs}");
            }
        }
    }
}

/// Node of the whole wheel for each node of a sector's `s`th copy.
fn copies(pair: &Pair, s: usize) -> Vec<usize> {
    let places = by_place(&pair.whole);
    pair.sector.nodes.iter().map(|node| places[&key(turned(node.position, s, pair.sectors))]).collect()
}

/// Shapes at all nodes of all sectors, those on the axis and on the high face among them, solve the eigenproblem of the whole wheel and have
/// its stress; cuts that meet at the axis are no part of the skin.
#[test]
fn shapes_solve_the_eigenproblem_of_the_whole_wheel() {
    for (kind, sectors) in [(ElementKind::C3D8I, 5), (ElementKind::C3D10, 2), (ElementKind::C3D20, 4)] {
        let pair = pair(kind, sectors);
        let [of_sector, of_whole] = [&pair.sector, &pair.whole].map(nodes);
        let copies: Vec<Vec<usize>> = (0..sectors).map(|s| copies(&pair, s)).collect();
        let [mesh, whole_mesh] = [&pair.sector, &pair.whole].map(mesh_of);
        let [sector, whole] = [pair.sector, pair.whole].map(|package| to_sector(package).unwrap());
        assert_eq!(skin(&mesh).free().count() * sectors, skin(&whole_mesh).faces.len());
        let kept = KeptRows::new(&NoCheckpoints, &of_sector);
        let reduced = reduce(&sector, &ReductionOptions::new(10_000), &kept, &|_, _| true).unwrap();
        let rows = kept.of(&reduced);
        let modal = ModalWheel::at(&reduced, SPEED, RotationEffects::stiffening(true)).unwrap();
        let modal = rows.join(modal, &reduced, true).unwrap();
        let times = |matrix: &rubmap::dynamics::sector::CyclicMatrix, x: &[c64]| {
            let mut y = vec![c64::ZERO; x.len()];
            for entry in matrix.own.triplet_iter() {
                y[entry.row] += x[entry.col] * *entry.val;
            }
            y
        };
        for harmonic in &modal.harmonics {
            for (mode, omega) in harmonic.omega.iter().enumerate().take(6) {
                let mut shape = vec![c64::ZERO; whole.own_dofs()];
                let mut on_axis: f64 = 0.0;
                for (s, copies) in copies.iter().enumerate() {
                    for (k, (node, &copy)) in of_sector.iter().zip(copies).enumerate() {
                        // Nodes of the high face have the rows of the low one, which move as those of the next sector.
                        let s = s + usize::from(node.on_high_face);
                        let turn = TAU * (harmonic.harmonic * s) as f64 / sectors as f64;
                        let mut u: [c64; 3] = std::array::from_fn(|d| {
                            let row = 3 * (sector.contact.len() + k) + d;
                            harmonic.contact[(row, mode)] * c64::new(turn.cos(), turn.sin())
                        });
                        if node.coordinates[0] < 1e-6 {
                            on_axis = u.iter().fold(on_axis, |most, u| most.max(u.norm()));
                            let (sin, cos) = (TAU * s as f64 / sectors as f64).sin_cos();
                            u = [u[0] * cos - u[1] * sin, u[0] * sin + u[1] * cos, u[2]];
                        }
                        for (dof, u) in of_whole[copy].dofs.iter().zip(u) {
                            if let Some(dof) = dof {
                                shape[dof.dof] = u;
                            }
                        }
                    }
                }
                let wanted = (harmonic.harmonic, mode);
                check_stress(&[&mesh, &whole_mesh], &copies, &of_whole, wanted, &modal, &shape);
                let (k, m) = (times(&whole.stiffness[2], &shape), times(&whole.mass, &shape));
                let norm = |x: &[c64]| x.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt();
                let left: Vec<c64> = k.iter().zip(&m).map(|(k, m)| k - m * (omega * omega)).collect();
                let residual = norm(&left) / norm(&k);
                assert!(residual < 1e-7, "{kind:?} {sectors} {} {mode}: {residual:e}", harmonic.harmonic);
                assert!(
                    (on_axis > 0.0) == (harmonic.harmonic < 2),
                    "{kind:?} {sectors} {}",
                    harmonic.harmonic
                );
            }
        }
    }
}

fn mesh_of(package: &RawPackage) -> SectorMesh {
    let file = tempfile::NamedTempFile::new().unwrap();
    write(package, file.as_file()).unwrap();
    read_mesh(file.path(), &Limits::default()).unwrap().unwrap()
}

/// Asserts that the stress of a mode of the sector is that of the whole wheel's `shape` at all nodes of the second sector.
fn check_stress(
    [sector, whole]: &[&SectorMesh; 2],
    copies: &[Vec<usize>],
    of_whole: &[SectorNode],
    (index, mode): (usize, usize),
    modal: &ModalWheel,
    shape: &[c64],
) {
    let harmonic = &modal.harmonics[index];
    let phase = c64::cis(TAU * harmonic.harmonic as f64 / sector.sectors as f64);
    let below = harmonic.contact.nrows() - 3 * sector.nodes.len();
    let own = Mat::from_fn(3 * sector.nodes.len(), 1, |row, _| harmonic.contact[(below + row, mode)]);
    let all = Mat::from_fn(3 * whole.nodes.len(), 1, |row, _| {
        of_whole[row / 3].dofs[row % 3].map_or(c64::ZERO, |dof| shape[dof.dof])
    });
    let [of_sector, of_wheel] = [sector, whole].map(|mesh| NodalStress::new(mesh));
    let (found, expected) = (of_sector.apply(phase, own.as_ref()), of_wheel.apply(c64::ONE, all.as_ref()));
    for (k, &node) in of_sector.places().iter().enumerate() {
        let copy = copies[1][node as usize] as u32;
        let place = of_wheel.places().iter().position(|&place| place == copy).unwrap();
        let tensor = |stress: &Mat<c64>, at: usize| -> [c64; 6] {
            std::array::from_fn(|component| stress[(6 * at + component, 0)])
        };
        let (mut ours, theirs) = (tensor(&found, k).map(|value| value * phase), tensor(&expected, place));
        if sector.nodes[node as usize][0].hypot(sector.nodes[node as usize][1]) < 1e-6 {
            // Components along the axes of the second sector; the whole wheel has those of the first.
            let (sin, cos) = (TAU / sector.sectors as f64).sin_cos();
            let [rr, tt, zz, rt, tz, zr] = ours;
            ours = [
                rr * cos * cos + tt * sin * sin - rt * (2.0 * sin * cos),
                rr * sin * sin + tt * cos * cos + rt * (2.0 * sin * cos),
                zz,
                (rr - tt) * (sin * cos) + rt * (cos * cos - sin * sin),
                zr * sin + tz * cos,
                zr * cos - tz * sin,
            ];
        }
        for (a, b) in ours.into_iter().zip(theirs) {
            assert!(
                (a - b).norm() < 1e-9 * expected.norm_max(),
                "{index} {mode} {node}: {ours:?} {theirs:?}"
            );
        }
    }
}

/// Responses to a load that is the same in all sectors: forces on the axis add up along it and balance across it.
#[test]
fn static_responses_are_those_of_the_whole_wheel() {
    let pair = pair(ElementKind::C3D20, 5);
    let [of_sector, of_whole] = [&pair.sector, &pair.whole].map(nodes);
    let copies: Vec<Vec<usize>> = (0..5).map(|s| copies(&pair, s)).collect();
    let [sector, whole] = [pair.sector, pair.whole].map(|package| to_sector(package).unwrap());
    let mut loads = [vec![0.0; sector.own_dofs()], vec![0.0; whole.own_dofs()]];
    for (k, node) in of_sector.iter().enumerate().filter(|(_, node)| !node.on_high_face) {
        for (d, dof) in node.dofs.iter().enumerate() {
            let Some(dof) = dof else { continue };
            let force = ((7 * k + 3 * d) % 11) as f64 - 4.0;
            loads[0][dof.dof] = force;
            for copies in &copies {
                let at = of_whole[copies[k]].dofs[d].unwrap().dof;
                // Five equal forces across the axis, each turned by a fifth, are none.
                if node.coordinates[0] > 1e-6 || d == 2 {
                    loads[1][at] += force;
                }
            }
        }
    }
    let ours = static_response(&sector, &loads[0], &|_, _| true).unwrap().solutions;
    let theirs = static_response(&whole, &loads[1], &|_, _| true).unwrap().solutions;
    let largest = (0..theirs.nrows()).map(|row| theirs[(row, 2)].abs()).fold(0.0, f64::max);
    for (k, node) in of_sector.iter().enumerate() {
        for (d, dof) in node.dofs.iter().enumerate() {
            let (Some(dof), Some(at)) = (dof, of_whole[copies[3][k]].dofs[d]) else { continue };
            for speed in 0..3 {
                let difference = (ours[(dof.dof, speed)] - theirs[(at.dof, speed)]).abs();
                assert!(difference < 1e-9 * largest, "node {} {d} {speed}: {difference:e}", node.id);
            }
        }
    }
}

/// Contact under Coriolis forces: tips of all sectors against a lobed casing move as those of the whole wheel do.
#[test]
fn contact_is_that_of_the_whole_wheel() {
    let pair = pair(ElementKind::C3D8I, 5);
    let tips = pair.sector.manifest.contact.len();
    let [sector, whole] = [pair.sector, pair.whole].map(|package| to_sector(package).unwrap());
    let run = |model: &SectorModel| {
        let reduced = whole_basis(model);
        let modal =
            ModalWheel::at(&reduced, SPEED, RotationEffects { stiffening: true, coriolis: true }).unwrap();
        let lobes = Lobes { count: 2, amplitude: 0.03, width_rad: 0.5, phase_rad: 0.1 };
        let casing = Casing {
            clearance: vec![0.02; reduced.contact.len()],
            restriction: Some(lobes.into()),
            ramp_revolutions: 0.1,
        };
        let sensors: Vec<SensorRow> = (0..5 * tips)
            .map(|tip| {
                let (node, sector) = if model.sectors == 1 { (tip, 0) } else { (tip % tips, tip / tips) };
                SensorRow { direction: Direction { node, components: [0.6, 0.0, 0.8] }, sector }
            })
            .collect();
        let steps = 2_000;
        let run = Simulation {
            wheel: &modal,
            contact_nodes: &reduced.contact,
            damping: None,
            casing: Some(&casing),
            effects: Effects::default(),
            initial: &[],
            scheme: Scheme::ExactModal,
            sensors: &sensors,
            steps_per_revolution: steps,
            samples_per_revolution: steps,
            revolutions: 1,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true);
        let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
        assert!(run.statistics.contact_steps > 50, "{}", run.statistics.contact_steps);
        assert!(run.energy.residual() < 1e-9, "{:e}", run.energy.residual());
        history.displacement
    };
    let (ours, theirs) = (run(&sector), run(&whole));
    let largest = theirs.iter().flatten().fold(0.0, |most: f64, u| most.max(u.abs()));
    for (ours, theirs) in ours.iter().zip(&theirs) {
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).abs() < 1e-7 * largest, "{a} {b} {largest}");
        }
    }
}

/// Package in Cartesian components without the rows that `is_held` names by their node's position and component.
fn cartesian(package: &RawPackage, is_held: impl Fn([f64; 3], u8) -> bool) -> RawPackage {
    let position: HashMap<u64, [f64; 3]> =
        package.nodes.iter().map(|node| (node.id, node.position)).collect();
    let row_of: HashMap<(u64, u8), usize> =
        package.dofs.iter().enumerate().map(|(row, dof)| ((dof.node, dof.component), row)).collect();
    let kept: Vec<_> =
        package.dofs.iter().copied().filter(|dof| !is_held(position[&dof.node], dof.component)).collect();
    // Row of each Cartesian displacement: what it is of r, θ and z there.
    let turn = Mat::from_fn(package.dofs.len(), kept.len(), |row, column| {
        let (own, dof) = (package.dofs[row], kept[column]);
        let [x, y, _] = position[&dof.node];
        let (sin, cos) = y.atan2(x).sin_cos();
        let basis = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let same = own.node == dof.node && row_of[&(own.node, own.component)] == row;
        if same { basis[usize::from(own.component) - 1][usize::from(dof.component) - 1] } else { 0.0 }
    });
    let turned = |matrix: &RawMatrix| {
        let dense = turn.transpose() * dense(matrix) * &turn;
        let lower = (0..kept.len()).flat_map(|column| (column..kept.len()).map(move |row| (row, column)));
        let entries = lower.map(|(row, column)| (row as u32, column as u32, dense[(row, column)]));
        RawMatrix { size: kept.len(), entries: entries.filter(|entry| entry.2 != 0.0).collect() }
    };
    let mut cartesian = package.clone();
    cartesian.mass = turned(&package.mass);
    cartesian.stiffness = package.stiffness.iter().map(turned).collect();
    cartesian.gyroscopic = None;
    cartesian.manifest.gyroscopic = None;
    cartesian.manifest.frame = Frame::Cartesian;
    for contact in &mut cartesian.manifest.contact {
        let [x, y, _] = position[&contact.node];
        let (sin, cos) = y.atan2(x).sin_cos();
        let [r, t, z] = contact.normal;
        contact.normal = [r * cos - t * sin, r * sin + t * cos, z];
    }
    cartesian.dofs = kept;
    cartesian
}

/// Nodes on the axis that are clamped along it, or across it: the frequencies of the whole wheel, whichever way the axis points.
#[test]
fn nodes_on_the_axis_may_be_clamped_in_part() {
    for held in [&[3_u8][..], &[1, 2]] {
        for sectors in [2, 5] {
            let pair = pair(ElementKind::C3D8I, sectors);
            let is_held = |[x, y, _]: [f64; 3], component: u8| x.hypot(y) < 1e-6 && held.contains(&component);
            let [mut sector, whole] = [&pair.sector, &pair.whole].map(|package| cartesian(package, is_held));
            let found = |package| frequencies(&whole_basis(&to_sector(package).unwrap()), SPEED);
            let expected = found(whole);
            let forward = found(sector.clone());
            sector.manifest.axis.direction = [0.0, 0.0, -1.0];
            sector.manifest.cyclic.iter_mut().for_each(|pair| pair.reverse());
            let reversed = found(sector);
            for ours in [forward, reversed] {
                assert_eq!(ours.len(), expected.len());
                for (ours, theirs) in ours.iter().zip(&expected).take(40) {
                    assert!((ours / theirs - 1.0).abs() < 1e-9, "{held:?} {sectors}: {ours} {theirs}");
                }
            }
        }
    }
}

/// Solid plate held at its rim: λ² of ω = λ² √(D/ρh)/a² for nodal diameters 0 to 3 without nodal circle and 0 with one, of thin plates
/// (A. W. Leissa, Vibration of Plates, NASA SP-160, Table 2.1).
const CLAMPED_PLATE: [(usize, usize, f64); 5] =
    [(0, 0, 10.2158), (1, 0, 21.26), (2, 0, 34.88), (3, 0, 51.04), (0, 1, 39.771)];

#[test]
fn a_solid_plate_has_the_frequencies_of_the_closed_form() {
    const SECTORS: usize = 8;
    let (radius, thickness) = (100.0, 1.0);
    let place = |[r, j, z]: [f64; 3]| {
        let theta = TAU * j / (2 * SECTORS) as f64;
        [radius * r / 40.0 * theta.cos(), radius * r / 40.0 * theta.sin(), thickness * z]
    };
    let mesh = block(ElementKind::C3D20R, [40, 2, 1], place);
    let set = |is: &dyn Fn(f64, f64, f64) -> bool| -> String {
        let nodes =
            mesh.node_ids.iter().zip(&mesh.nodes).filter(|(_, at)| {
                is(at[0].hypot(at[1]), at[1].atan2(at[0]) - TAU / (2 * SECTORS) as f64, at[2])
            });
        nodes.map(|(id, _)| format!("{id}\n")).collect()
    };
    let mut deck = crate::deck::deck(&merged(mesh.clone()));
    let on_top = |r: f64, theta: f64, z: f64| r > 15.0 && r < 85.0 && theta.abs() < 1e-9 && z == thickness;
    let (held, tip) = (set(&|r, _, _| r > radius - 1e-6), set(&on_top));
    write!(deck, "*NSET, NSET=HELD\n{held}*NSET, NSET=TIP\n{tip}*BOUNDARY\nHELD, 1, 3\n").unwrap();
    let file = mesh::read(deck.as_bytes(), &|_| Err("no file".to_owned())).unwrap();
    let settings = MeshSettings { contact_set: Some("TIP".into()), ..MeshSettings::new(1.0) };
    let sector = to_sector(from_mesh::sector(&file, &settings).unwrap().package().unwrap()).unwrap();
    assert_eq!(sector.sectors, SECTORS);
    let reduced = reduce(&sector, &ReductionOptions::new(12), &NoCheckpoints, &|_, _| true).unwrap();
    let steel = &mesh.sets[0].material;
    let rigidity = steel.youngs_modulus * thickness.powi(3) / (12.0 * (1.0 - steel.poissons_ratio.powi(2)));
    let unit = (rigidity / (steel.density * thickness)).sqrt() / radius.powi(2);
    for (diameter, circles, expected) in CLAMPED_PLATE {
        let at_rest =
            reduced.comparison.iter().find(|c| c.harmonic == diameter && c.speed_rad_s == 0.0).unwrap();
        let found = at_rest.full[circles] / unit;
        println!("nodal diameter {diameter}, circles {circles}: {found:.3} {expected}");
        assert!((found / expected - 1.0).abs() < 5e-3, "{diameter} {circles}: {found} {expected}");
    }
}
