//! Sensors at any node: shapes and responses against the explicitly assembled wheel, faces, names of the same place.

use faer::c64;
use nalgebra::{Complex, DMatrix, DVector};
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::{Sensor, SweepRequest};
use rubmap::analysis::run::{ModelFacts, ReducedSector, place_sensors, prepare, resolve_sweep, run_speed};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap::dynamics::kept_rows::KeptRows;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::nodes::{NodeDof, SectorNode};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::SectorModel;
use rubmap::package::{Limits, read_nodes, to_sector, write};
use serde_json::{Value, json};
use std::f64::consts::TAU;

use crate::fixtures::{TOP_SPEED, WheelRecipe, assembled_wheel, small_impeller, wheel};

/// Nodes of a test wheel, all of them, by the number of their first DOF over three.
pub(crate) fn nodes_of(sector: &SectorModel) -> Vec<SectorNode> {
    let node = |node: usize| SectorNode {
        id: node as u64,
        position: [node as f64, 0.0, 0.0],
        coordinates: [node as f64, 0.0, 0.0],
        dofs: std::array::from_fn(|k| {
            let components = std::array::from_fn(|component| if component == k { 1.0 } else { 0.0 });
            Some(NodeDof { dof: 3 * node + k, components })
        }),
        on_high_face: false,
        contact: None,
    };
    (0..sector.own_dofs() / 3).map(node).collect()
}

/// Makes a reduction that is read at `nodes`.
fn read_at(sector: &SectorModel, modes: u32, nodes: &[SectorNode]) -> ReducedSector {
    let kept = KeptRows::new(&NoCheckpoints, nodes);
    let reduced = prepare(sector, modes, None, &kept, &Unwatched).unwrap();
    ReducedSector { nodes: kept.of(&reduced.wheel), ..reduced }
}

/// Shapes at all nodes of all sectors, with every mode kept, solve the eigenproblem of the assembled wheel.
#[test]
fn shapes_at_every_node_are_those_of_the_assembled_wheel() {
    for (sectors, stiffening) in [(1, true), (2, false), (5, true), (6, true)] {
        let sector = wheel(WheelRecipe { sectors, stiffening, ..Default::default() });
        let nodes = nodes_of(&sector);
        let reduced = read_at(&sector, 1000, &nodes);
        let mass = assembled_wheel(&sector.mass, sectors).map(|x| Complex::new(x, 0.0));
        let given: Vec<_> = sector.stiffness.iter().map(|k| assembled_wheel(k, sectors)).collect();
        for share in [0.0, 0.6, 1.0] {
            // The fixture's K is linear in Ω².
            let stiffness = match stiffening {
                true => &given[0] + (&given[2] - &given[0]) * f64::powi(share, 2),
                false => given[0].clone(),
            }
            .map(|x| Complex::new(x, 0.0));
            let effects = RotationEffects::stiffening(stiffening);
            let modal = ModalWheel::at(&reduced.wheel, share * TOP_SPEED, effects).unwrap();
            let modal = reduced.nodes.join(modal, &reduced.wheel, stiffening).unwrap();
            let below = reduced.wheel.contact_dofs();
            for harmonic in &modal.harmonics {
                assert_eq!(harmonic.contact.nrows(), below + sector.own_dofs());
                let alpha = TAU * harmonic.harmonic as f64 / sectors as f64;
                for (m, omega) in harmonic.omega.iter().enumerate() {
                    let shape = DVector::from_fn(sectors * sector.own_dofs(), |row, _| {
                        let (s, dof) = (row / sector.own_dofs(), row % sector.own_dofs());
                        let c64 { re, im } = harmonic.contact[(below + dof, m)];
                        Complex::new(re, im) * Complex::from_polar(1.0, alpha * s as f64)
                    });
                    let elastic = &stiffness * &shape;
                    let residual = (&elastic - (&mass * &shape) * Complex::from(omega * omega)).norm();
                    assert!(residual < 1e-8 * elastic.norm(), "{sectors} sectors: {residual}");
                    let modal_mass = shape.dotc(&(&mass * &shape)).re;
                    assert!((modal_mass / sectors as f64 - 1.0).abs() < 1e-8, "{modal_mass}");
                }
            }
        }
    }
}

/// Amplitudes at `dofs` of sector 0 of the assembled wheel that engine order `order` drives along radius at the first contact node,
/// every mode damped alike: by all of its modes.
fn forced_amplitudes(
    sector: &SectorModel,
    (order, amplitude): (u32, f64),
    damping: f64,
    speed: f64,
    dofs: &[usize],
) -> Vec<f64> {
    let (sectors, size) = (sector.sectors, sector.own_dofs());
    let mass = assembled_wheel(&sector.mass, sectors);
    let lower = mass.cholesky().unwrap().l();
    let half = lower.solve_lower_triangular(&assembled_wheel(&sector.stiffness[0], sectors)).unwrap();
    let standard: DMatrix<f64> = lower.solve_lower_triangular(&half.transpose()).unwrap();
    let eigen = ((&standard + standard.transpose()) * 0.5).symmetric_eigen();
    let shapes = lower.transpose().solve_upper_triangular(&eigen.eigenvectors).unwrap();
    let nu = f64::from(order) * speed;
    let mut response = vec![Complex::new(0.0, 0.0); dofs.len()];
    for (m, lambda) in eigen.eigenvalues.iter().enumerate() {
        let omega = lambda.sqrt();
        let force: Complex<f64> = (0..sectors)
            .map(|s| {
                let phase = TAU * f64::from(order) * s as f64 / sectors as f64;
                Complex::from_polar(amplitude, phase) * shapes[(s * size + sector.contact[0].dofs[0], m)]
            })
            .sum();
        let gain = force / Complex::new(lambda - nu * nu, 2.0 * damping * omega * nu);
        for (response, &dof) in response.iter_mut().zip(dofs) {
            *response += gain * shapes[(dof, m)];
        }
    }
    response.iter().map(|u| u.norm()).collect()
}

fn resolved(
    sector: &SectorModel,
    nodes: &[SectorNode],
    change: Value,
) -> rubmap::analysis::resolved::ResolvedSweep {
    let mut request = json!({
        "model": "test wheel", "modes_per_speed": 6, "speeds": {"values": [TOP_SPEED], "unit": "rad_s"},
        "integration": {"revolutions": 10, "window_revolutions": 4}, "max_engine_order": 12
    });
    request.as_object_mut().unwrap().extend(change.as_object().unwrap().clone());
    let mut request: SweepRequest = serde_json::from_value(request).unwrap();
    place_sensors(&mut request.sensors, nodes).unwrap();
    resolve_sweep(request, &ModelFacts::of(sector)).unwrap()
}

/// Forced responses inside the sector: without contact a wheel driven at one engine order answers as the assembled one does,
/// at every node within the error of the reduction, which goes with the modes kept.
#[test]
fn forced_responses_inside_the_sector_converge_to_the_assembled_wheel() {
    let recipe = WheelRecipe { sectors: 5, nodes: 20, stiffening: false, ..Default::default() };
    let sector = wheel(recipe);
    let nodes = nodes_of(&sector);
    // Two nodes of the low face, three inside.
    let read = [0, 1, 5, 9, 13];
    let dofs: Vec<usize> = read.iter().flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2]).collect();
    let component = ["radial", "tangential", "axial"];
    let sensors: Vec<Value> =
        dofs.iter().map(|dof| json!({"node": dof / 3, "component": component[dof % 3]})).collect();
    for order in [2, 4] {
        let expected = forced_amplitudes(&sector, (order, 1.0), 0.05, 0.4 * TOP_SPEED, &dofs);
        let largest = expected.iter().copied().fold(0.0, f64::max);
        let error = |modes: u32| {
            let reduced = read_at(&sector, modes, &nodes);
            let force =
                json!({"order": order, "contact_nodes": [0], "component": "radial", "amplitude": 1.0});
            let request = resolved(
                &sector,
                &nodes,
                json!({
                    "scene": {"damping": {"modal_ratio": 0.05}, "engine_order_excitation": [force]},
                    "speeds": {"values": [0.4 * TOP_SPEED], "unit": "rad_s"}, "sensors": sensors,
                    "integration": {"scheme": "exact_modal", "steps_per_revolution": 4800, "revolutions": 40,
                                    "window_revolutions": 1},
                }),
            );
            let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
            let spectra = result.spectra.unwrap_or_else(|| panic!("{:?}", result.point.message));
            let found = spectra.sensors.iter().map(|sensor| sensor.amplitude[order as usize]);
            found.zip(&expected).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max)
        };
        let errors = [3, 8, 1000].map(error);
        // Three and eight of 51 internal modes are kept; with all of them the error left is the step's, over which the force is steady.
        let falls = errors[0] < 0.06 && errors[1] < 0.5 * errors[0];
        assert!(falls && errors[2] < 1e-5, "order {order}: {errors:?}");
    }
}

/// Rows of a contact node, with a boundary without mass and lasting contact: a node of the basis, static part included, reads
/// what the contact node reads that it is.
#[test]
fn rows_of_a_contact_node_read_what_it_reads() {
    let sector = wheel(WheelRecipe { sectors: 6, ..Default::default() });
    // The contact node is numbered as any other node.
    let mut nodes = nodes_of(&sector);
    nodes.retain(|node| node.dofs[0].is_some_and(|dof| dof.dof == sector.contact[1].dofs[0]));
    let reduced = read_at(&sector, 6, &nodes);
    let modal = ModalWheel::at(&reduced.wheel, TOP_SPEED, RotationEffects::stiffening(true)).unwrap();
    let modal = reduced.nodes.join(modal, &reduced.wheel, true).unwrap();
    let restriction = Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.0 };
    let casing =
        Casing { clearance: vec![0.25; 3], restriction: Some(restriction.into()), ramp_revolutions: 1.0 };
    let damping = ModalDamping { modal_ratio: 0.05, family_ratios: Vec::new(), ranks: Vec::new() };
    let components = [0.3, -1.0, 0.5];
    let sensor = |node| SensorRow { direction: Direction { node, components }, sector: 2 };
    for scheme in [Scheme::MasslessBoundary { kept_modes: 4 }, Scheme::ExactModal] {
        let steps = scheme.smallest_stable_steps(&modal, &reduced.wheel.contact) as usize;
        let run = Simulation {
            wheel: &modal,
            contact_nodes: &reduced.wheel.contact,
            damping: Some(&damping),
            casing: Some(&casing),
            effects: Effects::default(),
            initial: &[],
            sensors: &[sensor(1), sensor(3)],
            scheme,
            steps_per_revolution: (2 * steps).next_multiple_of(512),
            samples_per_revolution: 512,
            revolutions: 2,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true);
        let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
        assert!(run.statistics.contact_share() > 0.0, "{scheme:?} touches");
        let largest = history.displacement[0].iter().fold(0.0f64, |m, u| m.max(u.abs()));
        let pairs = history.displacement[0].iter().zip(&history.displacement[1]);
        assert!(largest > 0.0 && pairs.clone().all(|(a, b)| (a - b).abs() < 1e-12 * largest), "{scheme:?}");
    }
}

/// Displacement in contact, at the same place by other names, at the seam of two sectors, and along a direction.
#[test]
fn the_same_displacement_by_other_names() {
    let package = small_impeller(6);
    let file = tempfile::NamedTempFile::new().unwrap();
    write(&package, &file).unwrap();
    let nodes = read_nodes(file.path(), &Limits::default()).unwrap();
    let sector = to_sector(package.clone()).unwrap();
    assert_eq!(nodes.len(), package.nodes.len());
    let free: std::collections::BTreeSet<usize> =
        nodes.iter().flat_map(|node| node.dofs.iter().flatten()).map(|dof| dof.dof).collect();
    assert_eq!(free, (0..sector.own_dofs()).collect());
    for (node, contact) in nodes.iter().filter(|node| node.contact.is_some()).zip(&sector.contact) {
        let own = &sector.contact[node.contact.unwrap() as usize];
        assert_eq!(node.dofs.map(|dof| dof.unwrap().dof), own.dofs);
        assert!(sector.contact.iter().any(|node| node.id == contact.id));
    }

    let is_free = |id: u64| nodes.iter().any(|node| node.id == id && node.is_free());
    let &[low, high] = package.manifest.cyclic.iter().find(|pair| is_free(pair[0])).unwrap();
    let inner = nodes.iter().find(|node| node.is_free() && !node.on_high_face && node.contact.is_none());
    let inner = inner.unwrap();
    let point = inner.position.map(|x| x * (1.0 + 1e-9));
    let tip = sector.contact[2].id;
    let sensors = json!([
        {"contact_node": 2, "sector": 1, "component": "normal"},
        {"node": tip, "sector": 1, "component": "normal"},
        {"node": high, "sector": 1, "component": "radial"},
        {"node": low, "sector": 2, "component": "radial"},
        {"node": high, "sector": 5, "component": "axial"},
        {"node": low, "sector": 0, "component": "axial"},
        {"node": inner.id, "component": "radial"},
        {"nearest": point, "component": "radial"},
        {"node": inner.id, "component": "tangential"},
        {"node": inner.id, "component": "axial"},
        {"node": inner.id, "direction": [2.0, -3.0, 6.0]},
        {"node": high, "component": "radial"},
        {"node": high, "component": "tangential"},
        {"node": high, "component": "axial"},
        {"gauge": {"nodes": [inner.id, high]}},
        {"gauge": {"nodes": [tip, low]}, "sector": 3},
        {"gauge": {"nodes": [low, tip]}, "sector": 3},
    ]);
    let length = (sector.contact[0].position[0]) * 1e-3;
    let request = resolved(
        &sector,
        &nodes,
        json!({
            "sensors": sensors,
            "speeds": {"values": [2000.0], "unit": "rad_s"},
            "scene": {
                "damping": {"modal_ratio": 0.02},
                "casing": {"clearance": {"leading": length, "trailing": length},
                           "lobes": {"count": 1, "amplitude": 1.5 * length, "width_rad": 0.5}},
                "contact": {}
            }
        }),
    );
    let wanted: Vec<SectorNode> =
        nodes.iter().filter(|node| request.sensor_nodes().contains(&node.id)).copied().collect();
    let reduced = read_at(&sector, 6, &wanted);
    let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
    assert!(result.point.contact_share > 0.0, "{:?}", result.point);
    let responses = &result.point.responses;
    let spectra = result.spectra.unwrap().sensors;
    for (one, other) in [(0, 1), (2, 3), (4, 5), (6, 7)] {
        assert!(responses[one].rms > 0.0);
        assert_eq!(responses[one].rms.to_bits(), responses[other].rms.to_bits(), "sensors {one} and {other}");
        assert_eq!(spectra[one].amplitude, spectra[other].amplitude);
        assert_eq!(spectra[one].nodal_diameters, spectra[other].nodal_diameters);
    }
    let mean = |sensor: usize| responses[sensor].mean;
    let combined = (2.0 * mean(6) - 3.0 * mean(8) + 6.0 * mean(9)) / 7.0;
    let scale = [6, 8, 9].iter().fold(0.0f64, |m, &sensor| m.max(mean(sensor).abs()));
    assert!((mean(10) - combined).abs() < 1e-12 * scale, "{} {combined}", mean(10));

    // A gauge across the seam: the fibre between both nodes, in Cartesian components.
    let place = |id: u64| nodes.iter().find(|node| node.id == id).unwrap().position;
    let (a, b) = (place(inner.id), place(high));
    let apart: [f64; 3] = std::array::from_fn(|d| b[d] - a[d]);
    let gauge = apart.iter().map(|d| d * d).sum::<f64>().sqrt();
    let cartesian = |at: [f64; 3], [r, t, z]: [usize; 3]| {
        let (sin, cos) = at[1].atan2(at[0]).sin_cos();
        [mean(r) * cos - mean(t) * sin, mean(r) * sin + mean(t) * cos, mean(z)]
    };
    let (from, to) = (cartesian(a, [6, 8, 9]), cartesian(b, [11, 12, 13]));
    let strain = (0..3).map(|d| (to[d] - from[d]) * apart[d]).sum::<f64>() / gauge.powi(2);
    assert!(strain != 0.0 && (mean(14) - strain).abs() < 1e-10 * scale / gauge, "{} {strain}", mean(14));
    // It does not matter from which end it is read, and a contact node is as good as any.
    assert!(mean(15) != 0.0 && (mean(15) - mean(16)).abs() < 1e-12 * mean(15).abs());
    assert_eq!(responses[7].sensor, Sensor { node: Some(inner.id), nearest: None, ..responses[6].sensor });

    // A sensor whose rows nobody read ends the speed with a reason.
    let unread = ReducedSector { nodes: Default::default(), ..reduced };
    let point = run_speed(&unread, &request, 0, None, &Unwatched).unwrap().point;
    assert!(point.message.unwrap().contains("was not read at node"));
}
