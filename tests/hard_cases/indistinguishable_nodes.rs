//! Two contact nodes in the same place, and a basis that cannot tell nodes apart: the contact operator W, and the
//! residual flexibility F of a boundary without mass, are singular.
//!
//! A Cholesky factor breaks down, or divides by round-off: forces of 1e16 that cancel, energy out of nothing. An
//! iterative solver never ends. Guaranteed: the sum of the forces is that of one node, motion and impulse are those of the
//! wheel without the double, the gap closes to 1e-9 of its size (the ridge that keeps forces finite leaves 1e-10).

use rubmap::dynamics::schemes::Scheme;

use crate::fixtures::WheelRecipe;
use crate::scenes::{PENETRATION, Scene, assert_sound, difference, history, largest};
use crate::support::LIBRARY_SCHEMES;

/// Share of a gap of about one that the ridge may leave.
const RIDGE: f64 = 1e-9;

#[test]
fn a_node_given_twice_changes_nothing() {
    let single = Scene::new(WheelRecipe { sectors: 7, contact_nodes: 3, ..Default::default() });
    for nodes in [[0, 0, 1, 2], [0, 1, 2, 1]] {
        for scheme in LIBRARY_SCHEMES {
            let context = format!("{nodes:?} {scheme:?}");
            let double = single.with_nodes(&nodes);
            let steps = single.steps(scheme, 1.3);
            assert_eq!(double.steps(scheme, 1.3), steps, "{context}");
            let (one, two) = (single.run(scheme, steps), double.run(scheme, steps));
            assert_sound(&one, PENETRATION, &context);
            assert_sound(&two, RIDGE, &context);
            let moved = difference(&history(&one).displacement[0], &history(&two).displacement[0]);
            let impulse = two.statistics.contact_impulse / one.statistics.contact_impulse - 1.0;
            assert!(one.statistics.contact_share() > 0.05);
            assert!(moved < 1e-8, "{context}: {moved:e}");
            assert!(impulse.abs() < 1e-8, "{context}: {impulse:e}");
        }
    }
}

/// The second of two coincident nodes has a little more clearance and never touches.
#[test]
fn the_farther_of_two_coincident_nodes_is_never_loaded() {
    let single = Scene::new(WheelRecipe { sectors: 7, contact_nodes: 2, ..Default::default() });
    for scheme in LIBRARY_SCHEMES {
        for farther in [1e-3, 1e-9] {
            let mut double = single.with_nodes(&[0, 0, 1]);
            double.casing.as_mut().unwrap().clearance[1] += farther;
            let steps = single.steps(scheme, 1.3);
            let (one, two) = (single.run(scheme, steps), double.run(scheme, steps));
            assert_sound(&two, RIDGE, &format!("{scheme:?}"));
            let moved = difference(&history(&one).displacement[0], &history(&two).displacement[0]);
            assert!(moved < 1e-8, "{scheme:?} {farther:e}: {moved:e}");
        }
    }
}

/// Basis that cannot tell nodes apart: one to three modes per nodal diameter for four nodes of a blade; W lacks that much rank.
#[test]
fn a_basis_that_cannot_tell_nodes_apart() {
    for modes in [1, 2, 3] {
        let scene =
            Scene::new(WheelRecipe { sectors: 5, contact_nodes: 4, ..Default::default() }).truncated(modes);
        for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
            let context = format!("{modes} modes, {scheme:?}");
            let run = scene.run(scheme, scene.steps(scheme, 1.3));
            assert_sound(&run, RIDGE, &context);
            assert!(run.statistics.contact_steps > 0, "{context}");
            // A few times what the lobes reach into the blade.
            assert!(largest(&history(&run).displacement[0]) < 3.0, "{context}");
        }
    }
}
