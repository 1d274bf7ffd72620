//! Noise of matrices that were written with few digits.
//!
//! Round-off of the entries makes forces against rigid motions, where there should be none. In a mode of a blade each element moves nearly
//! rigidly, most of all at the tip, so the same forces, times the amplitudes of such a mode, change the square of its frequency by about
//! (w·F)/(w·M w), summed over nodes as independent errors are.

use rubmap_solid::frame::distance;
use rubmap_wheel::dynamics::findings::DigitNoise;

use super::rigid::{Balance, Body, MOTIONS, forces};
use crate::package::check::layout::Layout;
use crate::package::raw::{RawMatrix, RawPackage};
use crate::package::units;

/// Factor from independent errors to the estimate: equal entries are rounded alike. Wheels with blades of 0.3 to 3 mm
/// (`tests/package/findings.rs`) then change by 0.05 to 6 times the estimate.
const SAFETY: f64 = 4.0;

/// Entries whose digits are counted.
const LOOKED_AT: usize = 1000;

/// Relative forces below this are those of ten digits and more.
const ALL_DIGITS: f64 = 1e-10;

/// Noise of the stiffness matrix at rest, from the nodes that it leaves in balance; none where all digits are there.
pub(super) fn find(
    body: &Body,
    balance: &Balance,
    package: &RawPackage,
    layout: &Layout,
) -> Option<DigitNoise> {
    if balance.residual <= ALL_DIGITS {
        return None;
    }
    let motions = body.motions(&body.stated);
    let inertia = forces(&package.mass, &motions);
    let shape = amplitudes(package, layout, body.size);
    let square = |motion: usize| {
        let (mut work, mut kinetic) = (0.0, 0.0);
        for node in (0..balance.nodes.len()).filter(|&node| balance.nodes[node]) {
            let amplitude = shape[node];
            for row in body.stated.rows_of_node[node].map(|row| row as usize) {
                let moved = amplitude * amplitude * motions[row][motion];
                work += (moved * balance.forces[row][motion]).powi(2);
                kinetic += moved * inertia[row][motion];
            }
        }
        SAFETY * work.sqrt() / kinetic
    };
    let largest = (0..MOTIONS).map(square).filter(|square| square.is_finite()).fold(0.0, f64::max);
    let seconds = units::seconds(&package.manifest.units);
    Some(DigitNoise {
        residual: balance.residual,
        square_rad2_s2: largest / (seconds * seconds),
        has_all_digits: has_all_digits(&package.stiffness[0]),
    })
}

/// Whether fewer than half of the entries are numbers of at most ten digits or of single precision.
fn has_all_digits(stiffness: &RawMatrix) -> bool {
    let values = stiffness.entries.iter().map(|entry| entry.2).filter(|value| *value != 0.0);
    let step = stiffness.entries.len().div_ceil(LOOKED_AT).max(1);
    let looked_at: Vec<f64> = values.step_by(step).collect();
    let is_short = |value: &&f64| {
        let decimal = format!("{value:.9e}").parse().is_ok_and(|rounded: f64| rounded == **value);
        decimal || f64::from(**value as f32) == **value
    };
    2 * looked_at.iter().filter(is_short).count() < looked_at.len()
}

/// Amplitude of each node in a mode of the blade: from 1 at the contact nodes down to 0 at half the length of their line away from them.
fn amplitudes(package: &RawPackage, layout: &Layout, size: f64) -> Vec<f64> {
    let contact: Vec<[f64; 3]> =
        layout.contact.iter().map(|&node| package.nodes[node as usize].position).collect();
    let length: f64 = contact.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let reach = 0.5 * if length > 0.0 { length } else { size };
    let amplitude = |position: [f64; 3]| {
        let nearest = contact.iter().map(|&at| distance(at, position)).fold(f64::INFINITY, f64::min);
        (1.0 - nearest / reach).max(0.0)
    };
    package.nodes.iter().map(|node| amplitude(node.position)).collect()
}
