//! Every contact node of every sector closes in the same step and stays closed.
//!
//! Contact solvers that close one node at a time, or iterate, stall on hundreds of nodes that push each other; a solver
//! that reserves room for a few active nodes overruns; penalties ring. Guaranteed: all close together and without
//! penetration, in a few candidate sets; the damped wheel comes to rest on the static solution, whatever the scheme.

use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::casing::Lobes;

use crate::fixtures::WheelRecipe;
use crate::oracle::gauss_seidel;
use crate::scenes::{PENETRATION, Scene, assert_sound, history};
use crate::support::LIBRARY_SCHEMES;

const CLEARANCE: f64 = 0.3;
const RESTRICTION: f64 = 0.35;

/// Scene of one lobe so wide that it is a ring, growing over a revolution.
fn ring(recipe: WheelRecipe) -> Scene {
    let mut scene = Scene::new(recipe);
    let casing = scene.casing.as_mut().unwrap();
    casing.restriction =
        Some(Lobes { count: 1, amplitude: RESTRICTION, width_rad: 1e6, phase_rad: 0.0 }.into());
    casing.ramp_revolutions = 1.0;
    scene.damping_ratio = 0.3;
    scene.revolutions = 16;
    scene.sensors = [0, recipe.sectors / 2]
        .iter()
        .flat_map(|&s| (0..recipe.contact_nodes).map(move |k| (s, k)))
        .map(|(s, k)| scene.normal(k, s))
        .collect();
    scene
}

/// Normal displacements at rest, the same in every sector: 0 ≤ λ ⊥ c − p + Wλ ≥ 0 with the static flexibility of nodal
/// diameter 0.
fn at_rest(scene: &Scene) -> DVector<f64> {
    let umbrella = &scene.wheel.harmonics[0];
    let nodes = scene.contact.len();
    let shape = Mat::<f64>::from_fn(nodes, umbrella.omega.len(), |k, m| {
        let normal: c64 = (0..3).map(|d| umbrella.contact[(3 * k + d, m)] * scene.contact[k].normal[d]).sum();
        normal.re / umbrella.omega[m]
    });
    let w = &shape * shape.transpose();
    let w = DMatrix::from_fn(nodes, nodes, |i, j| w[(i, j)]);
    let mut lambda = DVector::zeros(nodes);
    gauss_seidel(&w, &DVector::from_element(nodes, CLEARANCE - RESTRICTION), &mut lambda);
    -(w * lambda)
}

#[test]
fn all_close_in_one_step_and_come_to_rest_on_the_static_solution() {
    // 30 nodes, and 320: more than the solver reserves room for.
    for (sectors, contact_nodes) in [(10, 3), (64, 5)] {
        let scene = ring(WheelRecipe { sectors, contact_nodes, ..Default::default() });
        let rest = at_rest(&scene);
        for scheme in LIBRARY_SCHEMES {
            let context = format!("{sectors} sectors, {scheme:?}");
            let mut scene = scene.clone();
            let steps = scene.steps(scheme, 1.3);
            // Gaps are checked after every step.
            scene.samples = steps;
            let run = scene.run(scheme, steps);
            assert_sound(&run, PENETRATION, &context);
            let displacement = &history(&run).displacement;
            let casing = scene.casing.as_ref().unwrap();
            let gap = |sample: usize, line: &[f64]| {
                CLEARANCE - RESTRICTION * casing.growth((sample + 1) as f64 / steps as f64) - line[sample]
            };
            let closes = |line: &Vec<f64>| (0..line.len()).find(|&q| gap(q, line) < 1e-11).unwrap();
            let first: Vec<_> = displacement.iter().map(closes).collect();
            assert!(first.iter().all(|&q| q == first[0]), "{context}: {first:?}");
            for (place, line) in displacement.iter().enumerate() {
                let (found, expected) = (line[line.len() - 1], rest[place % contact_nodes]);
                // The ring is a lobe after all: 1e-11 lower at its far side.
                assert!((found - expected).abs() < 1e-10 * RESTRICTION, "{context}: {found} {expected}");
            }
            let pivots = run.statistics.pivots;
            assert!(10 * pivots.candidates < 11 * pivots.problems, "{context}: {pivots:?}");
        }
    }
}
