//! The cyclic faces: one partner each, at the place the turn by 2π/N puts it, with the same free components.

use std::f64::consts::TAU;

use super::layout::{NONE, components};
use super::tables::NodeIndex;
use crate::package::error::{ManifestProblem, PackageError};
use crate::package::raw::{Frame, Manifest, RawPackage};
use rubmap_solid::frame::{AxisFrame, Basis, distance};

/// Distance between a high node and its turned low node, relative to the diagonal of the sector's bounding box.
/// Six printed digits stay below it; neighbouring nodes of any usable mesh are far above.
const PLACE_TOLERANCE: f64 = 1e-5;

/// A clamped direction may be this far (rad) from the one it should be: an axis direction of few digits.
const DIRECTION_TOLERANCE: f64 = 1e-6;

/// `(high_of, low_of)`: partners by node, or [`NONE`].
pub(super) fn check(
    package: &RawPackage,
    frame: &AxisFrame,
    index: &NodeIndex,
    rows_of_node: &[[u32; 3]],
) -> Result<(Vec<u32>, Vec<u32>), PackageError> {
    let (high_of, low_of) = partners(&package.manifest, package.nodes.len(), index)?;
    check_places(package, frame, &high_of, index)?;
    check_dofs(package, frame, rows_of_node, index)?;
    Ok((high_of, low_of))
}

/// `(high_of, low_of)` as `sector.json` states them.
pub(crate) fn partners(
    manifest: &Manifest,
    nodes: usize,
    index: &NodeIndex,
) -> Result<(Vec<u32>, Vec<u32>), PackageError> {
    let mut high_of = vec![NONE; nodes];
    let mut low_of = vec![NONE; nodes];
    for (k, &[low_id, high_id]) in manifest.cyclic.iter().enumerate() {
        let wrong = |end: &str, problem| Err(PackageError::manifest(format!("/cyclic/{k}{end}"), problem));
        let Some(&low) = index.get(&low_id) else {
            return wrong("/0", ManifestProblem::UnknownNode { node: low_id });
        };
        let Some(&high) = index.get(&high_id) else {
            return wrong("/1", ManifestProblem::UnknownNode { node: high_id });
        };
        if low == high {
            return wrong("", ManifestProblem::PairedWithItself { node: low_id });
        }
        for (end, node, id) in [("/0", low, low_id), ("/1", high, high_id)] {
            let role = match (high_of[node as usize], low_of[node as usize]) {
                (NONE, NONE) => continue,
                (NONE, _) => "a high node",
                _ => "a low node",
            };
            return wrong(end, ManifestProblem::FaceNodeRepeated { node: id, role });
        }
        high_of[low as usize] = high;
        low_of[high as usize] = low;
    }
    Ok((high_of, low_of))
}

fn check_places(
    package: &RawPackage,
    frame: &AxisFrame,
    high_of: &[u32],
    index: &NodeIndex,
) -> Result<(), PackageError> {
    let sectors = package.manifest.sectors;
    let alpha = TAU / sectors as f64;
    let tolerance = PLACE_TOLERANCE * diagonal(package);
    let pairs = || {
        package.manifest.cyclic.iter().enumerate().map(|(k, &[low, high])| {
            let place = |id| package.nodes[index[&id] as usize].position;
            (k, low, high, place(low), place(high))
        })
    };
    let off = |turn: f64, low, high| distance(frame.turn_point(low, turn), high);
    let worst = pairs()
        .map(|(k, low, high, from, to)| (off(alpha, from, to), k, low, high))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((distance, k, low, high)) = worst.filter(|(distance, ..)| *distance > tolerance) else {
        return Ok(());
    };
    debug_assert!(high_of.iter().any(|high| *high != NONE));
    let reversed = pairs().all(|(.., from, to)| off(-alpha, from, to) <= tolerance);
    let problem = ManifestProblem::PairNotTurned { low, high, distance, tolerance, sectors, reversed };
    Err(PackageError::manifest(format!("/cyclic/{k}"), problem))
}

fn check_dofs(
    package: &RawPackage,
    frame: &AxisFrame,
    rows_of_node: &[[u32; 3]],
    index: &NodeIndex,
) -> Result<(), PackageError> {
    let on_axis = PLACE_TOLERANCE * diagonal(package);
    let turned = frame.turned_global(TAU / package.manifest.sectors as f64);
    for (k, &[low, high]) in package.manifest.cyclic.iter().enumerate() {
        let rows = |id| &rows_of_node[index[&id] as usize];
        let present = |rows: &[u32; 3]| rows.map(|row| row != NONE);
        let wrong = |problem| Err(PackageError::manifest(format!("/cyclic/{k}"), problem));
        if present(rows(low)) != present(rows(high)) {
            let (low_components, high_components) = (components(rows(low)), components(rows(high)));
            return wrong(ManifestProblem::PairDofsDiffer { low, high, low_components, high_components });
        }
        if package.manifest.frame == Frame::Cartesian && !maps_onto_itself(&turned, present(rows(low))) {
            return wrong(ManifestProblem::PairClampNotCyclic {
                low,
                high,
                sectors: package.manifest.sectors,
            });
        }
        // With one sector the high face is the low face, on the axis as elsewhere.
        let [r, ..] = frame.coordinates(package.nodes[index[&low] as usize].position);
        if r <= on_axis && present(rows(low)).contains(&true) && package.manifest.sectors > 1 {
            return wrong(ManifestProblem::PairOnAxis { low, high });
        }
    }
    Ok(())
}

/// Whether the turn maps the free global directions onto each other: no part of it couples free with clamped ones.
fn maps_onto_itself(turned: &Basis, free: [bool; 3]) -> bool {
    (0..3).all(|i| (0..3).all(|j| !free[i] || free[j] || turned[(i, j)].abs() <= DIRECTION_TOLERANCE))
}

/// Diagonal of the bounding box of all nodes.
fn diagonal(package: &RawPackage) -> f64 {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for node in &package.nodes {
        for k in 0..3 {
            low[k] = low[k].min(node.position[k]);
            high[k] = high[k].max(node.position[k]);
        }
    }
    distance(low, high)
}
