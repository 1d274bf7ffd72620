//! Reduced stress compared with the sector without reduction: forced response at a nodal diameter, and the centrifugal load.

use std::sync::Mutex;

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};
use rubmap_model::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap_model::package::{Limits, read, read_mesh, read_nodes, write};
use rubmap_solid::load::centrifugal;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::modal_wheel::{ModalWheel, natural_frequencies};
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::reduction::{BasisRows, Checkpoints, ReducedWheel};
use rubmap_wheel::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap_wheel::dynamics::states::{HarmonicStates, WheelStates};

use super::make::{StressMaker, lower};
use super::measure::{Stress, ellipse, form};
use super::reduced::{HarmonicStress, ReducedStress};
use super::search::{Course, stress_of};
use crate::model::ModelFacts;
use crate::monitor::Unwatched;
use crate::prepare::prepare;

const SECTORS: usize = 7;

struct Impeller {
    sector: SectorModel,
    mesh: SectorMesh,
    nodes: Vec<SectorNode>,
}

fn impeller() -> Impeller {
    let mesh = MeshDensities {
        between_contact_nodes: 2,
        blade_height: 5,
        blade_thickness: 1,
        half_passage: 1,
        disk: 1,
    };
    let parameters = ImpellerParameters { sectors: SECTORS, contact_nodes: 5, mesh, ..Default::default() };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("impeller.zip");
    write(&generate(&parameters).unwrap(), std::fs::File::create(&path).unwrap()).unwrap();
    let limits = Limits::default();
    let sector = read(&path, &limits).unwrap().sector;
    let mesh = read_mesh(&path, &limits).unwrap().expect("the generator writes its elements");
    let nodes = read_nodes(&path, &limits).unwrap();
    Impeller { sector, mesh, nodes }
}

/// Store that keeps whole bases in memory.
#[derive(Default)]
struct Bases(Mutex<Vec<Vec<Vec<f64>>>>);

impl Checkpoints for Bases {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        let whole = (0..rows.dofs()).map(|dof| rows.row(dof).collect()).collect();
        self.0.lock().unwrap().push(whole);
    }
}

impl Impeller {
    fn reduced(&self, modes: u32) -> (ReducedWheel, ReducedStress) {
        let bases = Bases::default();
        let reduced = prepare(&self.sector, modes, None, &bases, &Unwatched).unwrap();
        let bases = bases.0.into_inner().unwrap();
        let wheel = std::sync::Arc::unwrap_or_clone(reduced.wheel);
        let maker = StressMaker::new(&self.mesh, &self.nodes);
        let fixed = maker.fixed(&self.sector, &|_, _| true).unwrap().stress;
        let spacing = ModelFacts::of(&self.sector).contact_spacing.unwrap();
        let made: Vec<HarmonicStress> = wheel
            .harmonics
            .iter()
            .map(|reduced| {
                let Ok(made) = maker.harmonic(reduced, self.sector.own_dofs(), &mut |harmonic, dof| {
                    Ok::<_, std::convert::Infallible>(bases[harmonic][dof].clone())
                });
                made
            })
            .collect();
        let load = |harmonic: usize, kept: &[usize]| {
            let made: &HarmonicStress = &made[harmonic];
            HarmonicStress::gather(made.unknowns(), kept.len(), |slot, numbers| {
                numbers.iter_mut().zip(made.of_place(kept[slot])).for_each(|(into, number)| *into = number);
                Ok::<_, std::convert::Infallible>(())
            })
        };
        let Ok(stress) =
            ReducedStress::load(&self.mesh, maker.operator(), &wheel, 2.0 * spacing, fixed, load);
        (wheel, stress)
    }

    /// Cyclic matrix Ŷ(i) of a nodal diameter, dense.
    fn dense(&self, matrix: &CyclicMatrix, harmonic: usize) -> Mat<c64> {
        let angle = std::f64::consts::TAU * harmonic as f64 / SECTORS as f64;
        let phase = c64::new(angle.cos(), angle.sin());
        let mut dense = Mat::<c64>::zeros(self.sector.own_dofs(), self.sector.own_dofs());
        for entry in matrix.own.triplet_iter() {
            dense[(entry.row, entry.col)] += c64::new(*entry.val, 0.0);
        }
        for entry in matrix.next.triplet_iter() {
            dense[(entry.row, entry.col)] += phase * *entry.val;
            dense[(entry.col, entry.row)] += phase.conj() * *entry.val;
        }
        dense
    }

    /// Displacement (r, θ, z) at all nodes from the own DOF.
    fn at_nodes(&self, own: &Mat<c64>) -> Mat<c64> {
        let mut shapes = Mat::zeros(3 * self.nodes.len(), own.ncols());
        for (index, node) in self.nodes.iter().enumerate().filter(|(_, node)| !node.on_high_face) {
            for dof in node.dofs.iter().flatten() {
                for component in 0..3 {
                    for column in 0..own.ncols() {
                        shapes[(3 * index + component, column)] +=
                            own[(dof.dof, column)] * dof.components[component];
                    }
                }
            }
        }
        shapes
    }
}

fn at(stress: &Mat<c64>, place: usize) -> [Stress; 2] {
    [
        std::array::from_fn(|component| stress[(6 * place + component, 0)].re),
        std::array::from_fn(|component| stress[(6 * place + component, 0)].im),
    ]
}

/// Force at the first contact node of every blade, one nodal diameter around, below the first resonance: the stress away from the contact
/// nodes converges to that of the whole sector, more slowly than displacement.
#[test]
fn stress_of_a_forced_response_converges_with_the_modes_kept() {
    let impeller = impeller();
    let harmonic = 2;
    let (stiffness, mass) = (
        impeller.dense(&impeller.sector.stiffness[0], harmonic),
        impeller.dense(&impeller.sector.mass, harmonic),
    );
    let dofs = impeller.sector.own_dofs();
    let mut force = Mat::<c64>::zeros(dofs, 1);
    for (&dof, part) in impeller.sector.contact[0].dofs.iter().zip([0.6, 0.0, 0.8]) {
        force[(dof, 0)] = c64::new(part, 0.0);
    }
    let first = {
        let (wheel, _) = impeller.reduced(6);
        natural_frequencies(&wheel.harmonics[harmonic], 0.0, true).unwrap()[0]
    };
    let nu = 0.7 * first;
    let pencil = |k: &Mat<c64>, m: &Mat<c64>| {
        Mat::from_fn(k.nrows(), k.ncols(), |i, j| k[(i, j)] - m[(i, j)] * (nu * nu))
    };
    let full = pencil(&stiffness, &mass).partial_piv_lu().solve(&force);
    let operator = super::make::StressMaker::new(&impeller.mesh, &impeller.nodes);
    let angle = std::f64::consts::TAU * harmonic as f64 / SECTORS as f64;
    let phase = c64::new(angle.cos(), angle.sin());
    let expected = operator.operator().apply(phase, impeller.at_nodes(&full).as_ref());
    println!("{dofs} DOF; modes a speed, error of displacement, error of stress, largest von Mises stress");
    let mut errors = Vec::new();
    for modes in [2, 4, 8, 16, 32, 1000] {
        let (wheel, stress) = impeller.reduced(modes);
        let reduced = &wheel.harmonics[harmonic];
        let k = reduced.stiffness.at(0.0, true);
        let unit = Mat::from_fn(k.nrows(), 1, |row, _| {
            c64::new(if row < 3 { [0.6, 0.0, 0.8][row] } else { 0.0 }, 0.0)
        });
        let q = pencil(&k, &reduced.mass).partial_piv_lu().solve(&unit);
        let tip = (0..3).map(|row| (q[(row, 0)] - full[(impeller.sector.contact[0].dofs[row], 0)]).norm());
        let size = (0..3).map(|row| q[(row, 0)].norm()).fold(0.0, f64::max);
        let displacement = tip.fold(0.0, f64::max) / size;
        let energy = lower(reduced).unwrap().adjoint() * &q;
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for (kept, place) in stress.places.iter().enumerate() {
            let id = |&node: &u32| impeller.mesh.node_ids[node as usize] == place.node;
            let all = operator.operator().places().iter().position(id).unwrap();
            let found = stress.harmonics[harmonic].matrix(kept) * &energy;
            let [re, im] = at(&expected, all);
            let difference = |k: usize, part: &Stress, of: fn(c64) -> f64| of(found[(k, 0)]) - part[k];
            let a: Stress = std::array::from_fn(|k| difference(k, &re, |value| value.re));
            let b: Stress = std::array::from_fn(|k| difference(k, &im, |value| value.im));
            worst = worst.max((form(&a, &a) + form(&b, &b)).sqrt());
            largest = largest.max(ellipse(&re, &im));
        }
        println!("{modes:5} {displacement:9.1e} {:9.1e} {largest:9.3e}", worst / largest);
        errors.push((displacement, worst / largest));
        if modes == 1000 {
            // A wave that travels: every blade sees all phases.
            let states = WheelStates {
                revolutions: (0..720).map(|t| f64::from(t) / 720.0).collect(),
                harmonics: vec![HarmonicStates {
                    harmonic,
                    coordinates: Mat::from_fn(q.nrows(), 720, |row, t| {
                        let angle = std::f64::consts::TAU * t as f64 / 720.0;
                        q[(row, 0)] * c64::new(angle.cos(), angle.sin())
                    }),
                }],
            };
            let modal = ModalWheel { speed_rad_s: 0.0, sectors: SECTORS, repeats: 1, harmonics: Vec::new() };
            let course =
                Course { harmonics: &wheel.harmonics, wheel: &modal, states: &states, stiffening: true };
            let found = stress_of(&stress, &course, |_| None).unwrap().unwrap();
            println!("followed {} of {}", found.followed_nodes, stress.places());
            assert!((found.largest.von_mises - largest).abs() < 1e-4 * largest);
            // A zero mean at every place: alternating up to the same, as far as the sign follows.
            assert!(found.cycles[0].alternating <= largest * (1.0 + 1e-6));
        }
    }
    let (first, last) = (errors[1], errors[errors.len() - 1]);
    assert!(errors.windows(2).all(|pair| pair[1].1 < 1.05 * pair[0].1), "{errors:?}");
    assert!(first.1 > first.0 && errors[4].1 < 0.1, "{errors:?}");
    // Single precision of the operator, and what the basis drops as dependent.
    assert!(last.1 < 1e-4, "{errors:?}");
}

/// Solution K(Ω) u = Ω² f of the whole sector at speeds between those of the matrices.
#[test]
fn static_stress_between_the_given_speeds_is_that_of_a_solution_there() {
    let impeller = impeller();
    let sector = &impeller.sector;
    let maker = StressMaker::new(&impeller.mesh, &impeller.nodes);
    let fixed = maker.fixed(sector, &|_, _| true).unwrap().stress;
    let mut load = Mat::<c64>::zeros(sector.own_dofs(), 1);
    for (node, force) in impeller.nodes.iter().zip(centrifugal(&impeller.mesh)) {
        for dof in node.dofs.iter().flatten().filter(|_| !node.on_high_face) {
            load[(dof.dof, 0)] += c64::new((0..3).map(|k| dof.components[k] * force[k]).sum(), 0.0);
        }
    }
    let top = sector.speeds_rad_s[2];
    for (share, tolerance) in [(0.0, 1e-12), (0.2, 3e-5), (0.5, 1e-7), (0.75, 3e-5), (0.9, 3e-5), (1.0, 1e-7)]
    {
        let speed = share * top;
        let x: Vec<f64> = sector.speeds_rad_s.iter().map(|given| given * given).collect();
        let weight = |i: usize| {
            let others = (0..3).filter(|&j| j != i);
            others.map(|j| (speed * speed - x[j]) / (x[i] - x[j])).product::<f64>()
        };
        let mut stiffness = Mat::<c64>::zeros(sector.own_dofs(), sector.own_dofs());
        for (i, matrix) in sector.stiffness.iter().enumerate() {
            stiffness += impeller.dense(matrix, 0) * faer::Scale(c64::new(weight(i), 0.0));
        }
        let exact = stiffness.partial_piv_lu().solve(&load);
        let exact = maker.operator().apply(c64::new(1.0, 0.0), impeller.at_nodes(&exact).as_ref());
        let shares = fixed.span.at(speed, true);
        let (mut worst, mut largest) = (0.0f64, f64::MIN_POSITIVE);
        for row in 0..exact.nrows() {
            let found: f64 = (0..3).map(|k| fixed.stress[3 * row + k] * shares[k]).sum();
            worst = worst.max((found - exact[(row, 0)].re * speed * speed).abs());
            largest = largest.max((exact[(row, 0)].re * speed * speed).abs());
        }
        println!("{share} of the top speed: {:.1e}", worst / largest);
        assert!(worst <= tolerance * largest, "{share}: {}", worst / largest);
    }
}
