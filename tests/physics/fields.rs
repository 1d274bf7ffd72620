//! Fields of the whole wheel: modes against the explicitly assembled wheel, deflection shapes in closed form.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Mutex;

use faer::{Mat, MatRef, c64};
use nalgebra::DVector;
use rubmap::analysis::fields::{
    Field, FieldSector, ModeRequest, Motion, Part, Points, deflection_shape, instants, mode_field,
};
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::run::{ReducedSector, prepare};
use rubmap::dynamics::modal_wheel::natural_frequencies;
use rubmap::dynamics::reduction::{BasisRows, Checkpoints};
use rubmap::dynamics::sector::SectorModel;
use rubmap::dynamics::states::{HarmonicStates, WheelStates};

use crate::fixtures::{Numbers, TOP_SPEED, WheelRecipe, assembled_wheel, wheel};
use crate::node_sensors::nodes_of;

/// Checkpoints that keep whole bases, by nodal diameter.
#[derive(Default)]
struct Bases(Mutex<BTreeMap<usize, Mat<c64>>>);

impl Checkpoints for Bases {
    fn load(&self, _: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _: &str, _: Vec<u8>) {}

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        let mut basis = Mat::zeros(rows.dofs(), rows.unknowns());
        for dof in 0..rows.dofs() {
            let row: Vec<f64> = rows.row(dof).collect();
            for (unknown, value) in row.chunks_exact(2).enumerate() {
                basis[(dof, unknown)] = c64::new(value[0], value[1]);
            }
        }
        self.0.lock().unwrap().insert(rows.harmonic(), basis);
    }
}

impl Bases {
    fn product(&self, harmonic: usize, columns: MatRef<'_, c64>) -> std::io::Result<Mat<c64>> {
        Ok(&self.0.lock().unwrap()[&harmonic] * columns)
    }
}

/// Wheel reduced with all of its modes.
fn whole(sectors: usize) -> (SectorModel, ReducedSector, Bases, FieldSector) {
    let sector = wheel(WheelRecipe { sectors, ..Default::default() });
    let bases = Bases::default();
    let reduced = prepare(&sector, 1000, None, &bases, &Unwatched).unwrap();
    let axis = ([0.0; 3], [0.0, 0.0, 1.0]);
    let of = FieldSector::new(sectors, axis, nodes_of(&sector), None).unwrap();
    (sector, reduced, bases, of)
}

/// Displacements of all DOF of the wheel in (r, θ, z): its nodes stand at θ = 0 of their sectors.
fn turned_back(field: &Field, of: &FieldSector, frame: usize) -> DVector<f64> {
    let places = Points::all(of, Part::Wheel).places().to_vec();
    let all = (0..of.sectors()).flat_map(|sector| {
        let (sin, cos) = (TAU * sector as f64 / of.sectors() as f64).sin_cos();
        let moved = field.displacement(of, sector, &places, &field.frames[frame].weights);
        moved.into_iter().flat_map(move |[x, y, z]| [x * cos + y * sin, y * cos - x * sin, z])
    });
    DVector::from_vec(all.collect())
}

/// Mode shapes with every mode kept: at any phase, standing or travelling, they are eigenvectors of the assembled wheel.
#[test]
fn mode_shapes_solve_the_assembled_wheel() {
    for sectors in [1, 2, 5, 6] {
        let (sector, reduced, bases, of) = whole(sectors);
        let mass = assembled_wheel(&sector.mass, sectors);
        let given: Vec<_> = sector.stiffness.iter().map(|k| assembled_wheel(k, sectors)).collect();
        // The fixture's K is linear in Ω².
        let stiffness = &given[0] + (&given[2] - &given[0]) * 0.36;
        for harmonic in &reduced.wheel.harmonics {
            let omega = natural_frequencies(harmonic, 0.6 * TOP_SPEED, true).unwrap();
            let single = harmonic.harmonic == 0 || 2 * harmonic.harmonic == sectors;
            for (mode, omega) in omega.iter().enumerate().step_by(5) {
                for motion in [Motion::Standing, Motion::Travelling] {
                    let asked = ModeRequest {
                        speed_rad_s: 0.6 * TOP_SPEED,
                        stiffening: true,
                        nodal_diameter: harmonic.harmonic,
                        modes: usize::MAX,
                        mode: mode + 1,
                        motion,
                        phase: 0.4,
                        frames: 3,
                    };
                    let mut product = |i: usize, columns: MatRef<'_, c64>| bases.product(i, columns);
                    let field = mode_field(&reduced.wheel, &of, &asked, &mut product);
                    if single && motion == Motion::Travelling {
                        assert!(field.unwrap_err().to_string().starts_with("motion: "));
                        continue;
                    }
                    let field = field.unwrap();
                    for frame in 0..3 {
                        let u = turned_back(&field, &of, frame);
                        let elastic = &stiffness * &u;
                        let residual = (&elastic - &mass * &u * (omega * omega)).norm();
                        assert!(u.norm() > 1e-3 && residual < 1e-8 * elastic.norm(), "{sectors}: {residual}");
                    }
                    let places = Points::all(&of, Part::Wheel).places().to_vec();
                    let largest = (0..sectors)
                        .flat_map(|sector| field.amplitude(&of, sector, &places, &field.frames[0]))
                        .fold(0.0f64, f64::max);
                    assert!((largest - 1.0).abs() < 1e-12, "{largest}");
                }
            }
        }
    }
}

/// Deflection shapes of a motion with engine orders 0, 2 and 3: the shape of one at a phase is that part alone at the angle, and the
/// mean the constant.
#[test]
fn deflection_shapes_take_one_engine_order_out_of_many() {
    let (_, reduced, bases, of) = whole(5);
    let mut numbers = Numbers::new(7);
    let mut random = || c64::new(numbers.next() - 0.5, numbers.next() - 0.5);
    let (samples, revolutions) = (16, 2);
    let at: Vec<f64> = (1..=samples * revolutions).map(|m| 3.0 + m as f64 / samples as f64).collect();
    let orders = [0, 2, 3];
    // The parts are, per nodal diameter, unknown and order, what turns forwards and what turns backwards.
    let parts: Vec<Vec<[[c64; 2]; 3]>> = reduced
        .wheel
        .harmonics
        .iter()
        .map(|of| (0..of.mass.nrows()).map(|_| orders.map(|_| [random(), random()])).collect())
        .collect();
    let value = |parts: &[[c64; 2]; 3], which: &[usize], revolution: f64| {
        let one = |&k: &usize| {
            let angle = TAU * f64::from(orders[k]) * revolution;
            let turn = c64::new(angle.cos(), angle.sin());
            parts[k][0] * turn + parts[k][1] * turn.conj()
        };
        which.iter().map(one).fold(c64::new(0.0, 0.0), |sum, x| sum + x)
    };
    let states = |which: &[usize], at: &[f64]| WheelStates {
        revolutions: at.to_vec(),
        harmonics: parts
            .iter()
            .enumerate()
            .map(|(harmonic, parts)| HarmonicStates {
                harmonic,
                coordinates: Mat::from_fn(parts.len(), at.len(), |row, m| value(&parts[row], which, at[m])),
            })
            .collect(),
    };
    let mut product = |i: usize, columns: MatRef<'_, c64>| bases.product(i, columns);
    let all = states(&[0, 1, 2], &at);
    for (k, order) in orders.into_iter().enumerate() {
        let phase = 0.7;
        let shape = deflection_shape(&all, &of, order, (phase, 1), &mut product).unwrap();
        // This is the revolution where φ = Eθ.
        let revolution = if order == 0 { 0.0 } else { phase / (TAU * f64::from(order)) };
        let alone = instants(&states(&[k], &[revolution]), &of, &[0], &mut product).unwrap();
        let (found, expected) = (turned_back(&shape, &of, 0), turned_back(&alone, &of, 0));
        assert!((&found - &expected).norm() < 1e-12 * expected.norm(), "engine order {order}");
    }
    let nothing = deflection_shape(&all, &of, 5, (0.0, 1), &mut product).unwrap();
    let something = deflection_shape(&all, &of, 2, (0.0, 1), &mut product).unwrap();
    assert!(turned_back(&nothing, &of, 0).norm() < 1e-12 * turned_back(&something, &of, 0).norm());
    let error = deflection_shape(&all, &of, 8, (0.0, 1), &mut product).unwrap_err();
    assert!(error.to_string().contains("0 to 7"), "{error}");
    let error = instants(&all, &of, &[32], &mut product).unwrap_err();
    assert!(error.to_string().contains("0 to 31"), "{error}");
}
