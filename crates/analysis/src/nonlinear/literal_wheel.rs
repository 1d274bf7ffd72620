//! Whole wheels of finite elements under Green–Lagrange strain, integrated in time without any reduction: what blades that bend far are held
//! against. Reduction, condensation and steps are checked by them; elements, which are the same, by CalculiX. Nothing rotates but the forces.
//!
//! Central differences with the consistent mass, M ü = f − ∂V/∂u, with steps that resolve the fastest mode of the mesh. Contact is that of the wheel
//! in space: the distance of a displaced tip from a circular casing, forces along its gradient that keep it outside.

use std::f64::consts::TAU;

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, MatMut};
use nalgebra::{DMatrix, Vector3};

use super::sector::HeldSector;
use super::wheel_tests::Wheel;
use rubmap_model::impeller::{CantileverParameters, ImpellerParameters, cantilever, generate};
use rubmap_numerics::sparse_cholesky::{SparseCholesky, SymbolicFactor};
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::integrals::mass;
use rubmap_solid::rule::MassRule;
use rubmap_wheel::dynamics::bending::{Bending, BladeBending, EnergyForm};
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap_wheel::dynamics::schemes::Scheme;

/// Revolutions of a run.
const REVOLUTIONS: usize = 2;

/// Instants of a revolution at which histories are compared.
const SAMPLES: usize = 100;

/// Scene: a force at one engine order on the first contact node, and a casing if there is a clearance.
#[derive(Clone)]
struct Scene {
    speed_rad_s: f64,
    force: EngineOrderExcitation,
    clearance: Option<f64>,
}

impl Scene {
    fn new(speed_rad_s: f64, order: u32, amplitude: f64, clearance: Option<f64>) -> Self {
        let directions = vec![Direction { node: 0, components: [0.0, 1.0, 0.0] }];
        let force =
            EngineOrderExcitation { order, directions, amplitude, phase_rad: 0.3, ramp_revolutions: 1.0 };
        Self { speed_rad_s, force, clearance }
    }

    fn casing(&self, nodes: usize) -> Option<Casing> {
        let casing = |clearance| Casing {
            clearance: vec![clearance; nodes],
            restriction: None,
            ramp_revolutions: 1.0,
        };
        self.clearance.map(casing)
    }
}

/// Displacements of node, component and sector at every instant.
type Histories = Vec<Vec<f64>>;

/// Difference of histories over the largest displacement of the second.
fn difference(found: &Histories, expected: &Histories) -> f64 {
    let size = expected.iter().flatten().fold(0.0f64, |most, u| most.max(u.abs()));
    let squares = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).powi(2));
    let count = expected.iter().map(Vec::len).sum::<usize>();
    (squares.sum::<f64>() / count as f64).sqrt() / size
}

/// Histories of all contact nodes in a reduced wheel, linear without a blade.
fn reduced(wheel: &Wheel, scene: &Scene, blade: Option<&BladeBending>) -> Histories {
    let of = &wheel.reduced.wheel;
    let mut modal = ModalWheel::at(of, scene.speed_rad_s, RotationEffects::stiffening(false)).unwrap();
    let bending = blade.map(|blade| {
        let first = blade.join(&mut modal, of, false).unwrap();
        Bending { blade, first, stiffens: true }
    });
    let row = |sector: usize, node: usize, k: usize| {
        let mut components = [0.0; 3];
        components[k] = 1.0;
        SensorRow { direction: Direction { node, components }, sector }
    };
    let sensors: Vec<SensorRow> = (0..of.sectors)
        .flat_map(|s| (0..of.contact.len()).flat_map(move |node| (0..3).map(move |k| row(s, node, k))))
        .collect();
    let run = Simulation {
        wheel: &modal,
        contact_nodes: &of.contact,
        damping: None,
        casing: scene.casing(of.contact.len()).as_ref(),
        effects: Effects { bending, excitation: std::slice::from_ref(&scene.force), ..Effects::default() },
        initial: &[],
        sensors: &sensors,
        scheme: Scheme::ExactModal,
        steps_per_revolution: 8000,
        samples_per_revolution: SAMPLES,
        revolutions: REVOLUTIONS,
        window_revolutions: REVOLUTIONS,
        repeats: None,
        detail: None,
        states: None,
    }
    .run(&|_| true);
    assert_eq!(run.statistics.contact_impulse > 0.0, scene.clearance.is_some());
    let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
    history.displacement.clone()
}

/// Place of a component of a node's displacement: own DOF, whether it is the next sector's, and its direction in space.
type Place = (usize, bool, Vector3<f64>);

/// Unknown of a place in a sector.
fn unknown(sectors: usize, own: usize, sector: usize, (dof, next, _): &Place) -> usize {
    (sector + usize::from(*next)) % sectors * own + dof
}

/// Solution M⁻¹f in place.
type MassSolution<'a> = &'a dyn Fn(&mut [f64]);

/// Finite elements of a whole wheel; unknowns are the own DOF of one sector after the other.
struct Literal<'a> {
    wheel: &'a Wheel,
    sector: HeldSector,
    own: usize,
    places: Vec<Vec<Place>>,
    mass: SparseColMat<usize, f64>,
    symbolic: SymbolicFactor,
}

impl<'a> Literal<'a> {
    fn new(wheel: &'a Wheel) -> Self {
        let (mesh, sectors) = (&wheel.mesh, wheel.reduced.wheel.sectors);
        let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1).unwrap();
        let places: Vec<Vec<Place>> = (wheel.nodes.iter())
            .map(|node| {
                let unit = frame.cylindrical(node.coordinates[1]);
                let place = |dof: &rubmap_wheel::dynamics::nodes::NodeDof| {
                    (dof.dof, node.on_high_face, unit.tr_mul(&Vector3::from(dof.components)))
                };
                node.dofs.iter().flatten().map(place).collect()
            })
            .collect();
        let own = places.iter().flatten().map(|&(dof, ..)| dof + 1).max().unwrap();
        let at = |sector: usize, place: &Place| unknown(sectors, own, sector, place);
        let mut triplets = Vec::new();
        for element in &mesh.elements {
            let density = mesh.sets[element.set as usize].material.density;
            let m: DMatrix<f64> = mass(element.kind, &mesh.positions(element), density, MassRule::Consistent);
            for sector in 0..sectors {
                for (a, &row) in element.nodes.iter().enumerate() {
                    for (b, &column) in element.nodes.iter().enumerate() {
                        for row in &places[row as usize] {
                            for column in &places[column as usize] {
                                let value = m[(a, b)] * row.2.dot(&column.2);
                                triplets.push(Triplet::new(at(sector, row), at(sector, column), value));
                            }
                        }
                    }
                }
            }
        }
        let size = sectors * own;
        let mass = SparseColMat::try_new_from_triplets(size, size, &triplets).unwrap();
        let symbolic = SymbolicFactor::new(mass.symbolic(), &(0..size).collect::<Vec<_>>());
        Self { wheel, sector: HeldSector::new(mesh, &wheel.nodes).unwrap(), own, places, mass, symbolic }
    }

    fn size(&self) -> usize {
        self.sectors() * self.own
    }

    fn sectors(&self) -> usize {
        self.wheel.reduced.wheel.sectors
    }

    fn at(&self, sector: usize, place: &Place) -> usize {
        unknown(self.sectors(), self.own, sector, place)
    }

    /// Forces −∂V/∂u on all unknowns.
    fn forces(&self, u: &[f64], force: &mut [f64]) {
        force.fill(0.0);
        for sector in 0..self.sectors() {
            let moved = |of: &Vec<Place>| {
                of.iter().map(|place| place.2 * u[self.at(sector, place)]).sum::<Vector3<f64>>()
            };
            let field: Vec<Vector3<f64>> = self.places.iter().map(moved).collect();
            for (nodes, element) in &self.sector.elements {
                let on_nodes = element.force(&element.values(&HeldSector::at(nodes, &field), &[]));
                for (&node, f) in nodes.iter().zip(&on_nodes) {
                    for place in &self.places[node as usize] {
                        force[self.at(sector, place)] -= place.2.dot(f);
                    }
                }
            }
        }
    }

    /// Unknowns of the displacement of a contact node of a sector along r, θ, z.
    fn contact(&self, sector: usize, contact: usize) -> [usize; 3] {
        let node = self.wheel.nodes.iter().position(|node| node.contact == Some(contact as u32)).unwrap();
        std::array::from_fn(|k| {
            let dof = self.wheel.nodes[node].dofs[k].expect("contact nodes are free along r, θ and z");
            assert!((dof.components[k] - 1.0).abs() < 1e-12);
            sector * self.own + dof.dof
        })
    }

    /// Largest angular frequency of the linear mesh, by the power method.
    fn largest_frequency(&self, factor: &SparseCholesky<'_, f64>) -> f64 {
        let size = self.size();
        let tiny = 1e-9;
        let mut u: Vec<f64> = (0..size).map(|k| tiny * (k as f64 * 12.9898).sin()).collect();
        let mut squared = 0.0;
        for _ in 0..60 {
            let mut a = vec![0.0; size];
            self.forces(&u, &mut a);
            factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut a, size, 1));
            let norm = |of: &[f64]| of.iter().map(|u| u * u).sum::<f64>().sqrt();
            squared = norm(&a) / norm(&u);
            let scale = tiny / norm(&a);
            u = a.iter().map(|a| a * scale).collect();
        }
        squared.sqrt()
    }

    /// Histories of all contact nodes.
    fn run(&self, scene: &Scene) -> Histories {
        let size = self.size();
        let factor = SparseCholesky::new(&self.symbolic, &self.mass).unwrap();
        let solve = |x: &mut [f64]| {
            factor.solve_in_place(MatMut::from_column_major_slice_mut(x, size, 1));
        };
        let nodes = &self.wheel.reduced.wheel.contact;
        let contact: Vec<[usize; 3]> = (0..self.sectors())
            .flat_map(|s| (0..nodes.len()).map(move |node| (s, node)))
            .map(|(s, node)| self.contact(s, node))
            .collect();
        // At most half the stable step of the linear mesh.
        let per_sample =
            (TAU / scene.speed_rad_s / SAMPLES as f64 * self.largest_frequency(&factor)).ceil() as usize;
        let steps = per_sample * SAMPLES;
        let h = TAU / (scene.speed_rad_s * steps as f64);

        let casing = scene.casing(nodes.len());
        // A force grows as a restriction does.
        let grown = Casing {
            clearance: Vec::new(),
            restriction: None,
            ramp_revolutions: scene.force.ramp_revolutions,
        };
        let (mut u, mut d, mut force) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        let mut histories = vec![Vec::new(); 3 * contact.len()];
        for step in 0..REVOLUTIONS * steps {
            let revolutions = step as f64 / steps as f64;
            self.forces(&u, &mut force);
            for sector in 0..self.sectors() {
                let place = sector as f64 / self.sectors() as f64;
                let phase =
                    TAU * f64::from(scene.force.order) * (place + revolutions) + scene.force.phase_rad;
                let pushed = contact[sector * nodes.len()][1];
                force[pushed] += scene.force.amplitude * grown.growth(revolutions) * phase.cos();
            }
            solve(&mut force);
            for ((u, d), a) in u.iter_mut().zip(&mut d).zip(&force) {
                *d += h * h * a;
                *u += *d;
            }
            if let Some(casing) = &casing {
                self.push_outside(&contact, casing, (&solve, h), [&mut u, &mut d]);
            }
            if (step + 1) % per_sample == 0 {
                let read = contact.iter().flatten().map(|&at| u[at]);
                histories.iter_mut().zip(read).for_each(|(line, u)| line.push(u));
            }
        }
        histories
    }

    /// Moves the tips that have passed the casing back to it, by forces of one step that only push.
    fn push_outside(
        &self,
        contact: &[[usize; 3]],
        casing: &Casing,
        (solve, h): (MassSolution<'_>, f64),
        [u, d]: [&mut Vec<f64>; 2],
    ) {
        let nodes = &self.wheel.reduced.wheel.contact;
        // Distance to the casing along the normal of the node, and its gradient.
        let gap = |tip: usize, u: &[f64]| {
            let (node, [r, t, z]) = (&nodes[tip % nodes.len()], contact[tip].map(|at| u[at]));
            let [along_r, _, along_z] = node.normal;
            let radius = (node.position[0] + r).hypot(t);
            let gradient = [along_r * (node.position[0] + r) / radius, along_r * t / radius, along_z];
            (
                casing.clearance[tip % nodes.len()] - along_r * (radius - node.position[0]) - along_z * z,
                gradient,
            )
        };
        let found: Vec<_> = (0..contact.len()).map(|tip| gap(tip, u)).collect();
        let mut active: Vec<usize> = (0..contact.len()).filter(|&tip| found[tip].0 < 0.0).collect();
        let moved: Vec<(usize, Vec<f64>)> = (active.iter())
            .map(|&tip| {
                let mut load = vec![0.0; self.size()];
                contact[tip].iter().zip(found[tip].1).for_each(|(&at, n)| load[at] = -h * h * n);
                solve(&mut load);
                (tip, load)
            })
            .collect();
        let by = |tip: usize| &moved.iter().find(|(of, _)| *of == tip).unwrap().1;
        while !active.is_empty() {
            let w = |i: usize, j: usize| -> f64 {
                let load = by(active[j]);
                -contact[active[i]].iter().zip(found[active[i]].1).map(|(&at, n)| n * load[at]).sum::<f64>()
            };
            let matrix: Mat<f64> = Mat::from_fn(active.len(), active.len(), w);
            let right: Mat<f64> = Mat::from_fn(active.len(), 1, |i, _| -found[active[i]].0);
            let lambda = matrix.partial_piv_lu().solve(&right);
            let pushing: Vec<usize> = (0..active.len()).filter(|&i| lambda[(i, 0)] > 0.0).collect();
            if pushing.len() == active.len() {
                for (i, &tip) in active.iter().enumerate() {
                    for ((u, d), load) in u.iter_mut().zip(d.iter_mut()).zip(by(tip)) {
                        *u += lambda[(i, 0)] * load;
                        *d += lambda[(i, 0)] * load;
                    }
                }
                return;
            }
            active = pushing.into_iter().map(|i| active[i]).collect();
        }
    }
}

/// Differences of a linear wheel and of wheels with these blades from the literal one.
fn differences(wheel: &Wheel, scene: &Scene, blades: &[BladeBending]) -> (f64, Vec<f64>) {
    let expected = Literal::new(wheel).run(scene);
    let linear = difference(&reduced(wheel, scene, None), &expected);
    let of = |blade: &BladeBending| difference(&reduced(wheel, scene, Some(blade)), &expected);
    let found: Vec<f64> = blades.iter().map(of).collect();
    let largest = expected.iter().flatten().fold(0.0f64, |most, u| most.max(u.abs()));
    println!("largest {largest:.3}: linear {linear:.2e}, blades {found:?}");
    (linear, found)
}

fn one_blade() -> Wheel {
    let parameters: CantileverParameters = serde_json::from_value(serde_json::json!({
        "root_radius": 40.0, "length": 40.0, "width": 2.0, "depth": 10.0, "elements": [4, 1, 1],
        "element_order": "quadratic", "top_speed_rad_s": 1000.0,
    }))
    .unwrap();
    Wheel::of(&cantilever(&parameters).unwrap(), 20)
}

fn three_blades() -> Wheel {
    let parameters: ImpellerParameters = serde_json::from_value(serde_json::json!({
        "sectors": 3, "contact_nodes": 3, "element_order": "quadratic", "root_thickness": 4.0, "tip_thickness": 3.0,
        "mesh": {"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 1},
    }))
    .unwrap();
    Wheel::of(&generate(&parameters).unwrap(), 20)
}

#[test]
fn one_blade_moves_as_its_finite_elements() {
    let wheel = one_blade();
    let modal = ModalWheel::at(&wheel.reduced.wheel, 1000.0, RotationEffects::stiffening(false)).unwrap();
    let speed = modal.harmonics[0].omega[0] / 2.8;
    // First bent to a quarter of its length without a casing, then pressed to a casing from which the tip draws back.
    for (amplitude, clearance) in [(40.0, None), (25.0, Some(-0.005))] {
        let scene = Scene::new(speed, 3, amplitude, clearance);
        let still = BladeBending { inertia: EnergyForm::zero(1), ..wheel.blade(1) };
        let (linear, found) = differences(&wheel, &scene, &[wheel.blade(1), wheel.blade(4), still]);
        let [one, four, still] = found[..] else { panic!("three blades") };
        assert!(linear > 0.01 && one < 1e-3 && four < 1e-3, "{clearance:?}: {linear} {one} {four}");
        assert!(still > 5.0 * one, "{clearance:?}: without inertia {still}, with it {one}");
    }
}

#[test]
fn three_blades_move_as_their_finite_elements() {
    let wheel = three_blades();
    let modal = ModalWheel::at(&wheel.reduced.wheel, 1000.0, RotationEffects::stiffening(false)).unwrap();
    let speed = modal.harmonics[1].omega[0] / 2.1;
    for (amplitude, clearance) in [(600.0, None), (600.0, Some(0.1))] {
        let scene = Scene::new(speed, 2, amplitude, clearance);
        let (linear, found) = differences(&wheel, &scene, &[2, 4, 6].map(|count| wheel.blade(count)));
        assert!(linear > 5e-3 && found[2] < 0.2 * linear, "{clearance:?}: {linear} {found:?}");
        assert!(found.is_sorted_by(|few, many| few > many), "{clearance:?}: {found:?}");
    }
}
