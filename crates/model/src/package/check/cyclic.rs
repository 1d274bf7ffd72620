//! Checks of the cyclic faces: one partner for each node, at the position where the turn by 2π/N puts it, with the same free components.

use std::f64::consts::TAU;

use super::layout::{NONE, components};
use super::slits::{self, Slit};
use super::tables::NodeIndex;
use crate::package::error::{ManifestProblem, PackageError, TurnFit};
use crate::package::raw::{Frame, Manifest, RawPackage};
use rubmap_solid::frame::{AxisFrame, Basis, distance};
use rubmap_solid::place::{on_axis, tolerance};

/// Largest angle (rad) of a clamped direction from its image under the turn: an axis direction of few digits.
const DIRECTION_TOLERANCE: f64 = 1e-6;

/// Relation of the nodes of a sector to its neighbours.
pub(super) struct Neighbours {
    /// High node of each low node, or [`NONE`].
    pub(super) high_of: Vec<u32>,
    /// Low node of each high node, or [`NONE`].
    pub(super) low_of: Vec<u32>,
    /// Free nodes on the axis, which all sectors share.
    pub(super) on_axis: Vec<u32>,
}

/// Checks the cyclic faces and the nodes on the axis.
pub(super) fn check(
    package: &RawPackage,
    frame: &AxisFrame,
    index: &NodeIndex,
    rows_of_node: &[[u32; 3]],
) -> Result<Neighbours, PackageError> {
    let (high_of, low_of) = partners(&package.manifest, package.nodes.len(), index)?;
    let tolerance = tolerance(package.nodes.iter().map(|node| node.position));
    check_places(package, frame, tolerance, index)?;
    check_dofs(package, frame, tolerance, rows_of_node, index)?;
    check_all_paired(package, frame, tolerance, rows_of_node, |node| {
        let node = index[&node] as usize;
        high_of[node] != NONE || low_of[node] != NONE
    })?;
    let on_axis = check_axis(package, frame, tolerance, rows_of_node)?;
    Ok(Neighbours { high_of, low_of, on_axis })
}

/// Partners `(high_of, low_of)` as `sector.json` states them.
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

/// Compares every high node with its low node turned by +2π/N. For pairs that fit neither turn, the worst pair of the better-fitting turn
/// is reported.
fn check_places(
    package: &RawPackage,
    frame: &AxisFrame,
    tolerance: f64,
    index: &NodeIndex,
) -> Result<(), PackageError> {
    let sectors = package.manifest.sectors;
    let alpha = TAU / sectors as f64;
    let worst = |turn: f64| {
        let pairs = package.manifest.cyclic.iter().enumerate().map(|(k, &[low, high])| {
            let place = |id| package.nodes[index[&id] as usize].position;
            (distance(frame.turn_point(place(low), turn), place(high)), k, low, high)
        });
        pairs.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let Some(forward) = worst(alpha).filter(|(distance, ..)| *distance > tolerance) else {
        return Ok(());
    };
    let backward = worst(-alpha).filter(|backward| backward.0 < forward.0);
    let (fit, (distance, k, low, high)) = match backward {
        Some((distance, ..)) if distance <= tolerance => (TurnFit::Reversed, forward),
        Some(backward) => (TurnFit::NearerReversed, backward),
        None => (TurnFit::Forward, forward),
    };
    let problem = ManifestProblem::PairNotTurned { low, high, distance, tolerance, sectors, fit };
    Err(PackageError::manifest(format!("/cyclic/{k}"), problem))
}

/// Refuses free nodes that need a pair and have none.
fn check_all_paired(
    package: &RawPackage,
    frame: &AxisFrame,
    tolerance: f64,
    rows_of_node: &[[u32; 3]],
    paired: impl Fn(u64) -> bool,
) -> Result<(), PackageError> {
    let free = package.nodes.iter().zip(rows_of_node).filter(|(_, rows)| **rows != [NONE; 3]);
    let free = free.map(|(node, _)| (node.id, node.position)).collect();
    let sectors = package.manifest.sectors;
    match slits::find(free, paired, frame, sectors, tolerance) {
        None => Ok(()),
        Some(Slit { low, high }) => {
            Err(PackageError::manifest("/cyclic", ManifestProblem::PairMissing { low, high, sectors }))
        }
    }
}

/// Finds the free nodes on the axis, and refuses those whose free components the turn by one sector does not map onto each other.
fn check_axis(
    package: &RawPackage,
    frame: &AxisFrame,
    tolerance: f64,
    rows_of_node: &[[u32; 3]],
) -> Result<Vec<u32>, PackageError> {
    let sectors = package.manifest.sectors;
    let mut found = Vec::new();
    for (index, (node, rows)) in package.nodes.iter().zip(rows_of_node).enumerate() {
        if *rows == [NONE; 3] || !on_axis(node.position, frame, sectors, tolerance) {
            continue;
        }
        let free = rows.map(|row| row != NONE);
        let along = |component: usize| match package.manifest.frame {
            Frame::Cartesian => frame.direction()[component].abs(),
            Frame::Cylindrical => [0.0, 0.0, 1.0][component],
        };
        let oblique = |component: usize| along(component).min(1.0 - along(component)) > DIRECTION_TOLERANCE;
        let across = (0..3).filter(|&component| free[component] && along(component) < 0.5).count();
        if free != [true; 3] && ((0..3).any(|c| free[c] && oblique(c)) || (across == 1 && sectors > 2)) {
            let problem = ManifestProblem::AxisClampNotCyclic { node: node.id, components: components(rows) };
            return Err(PackageError::manifest("/dofs", problem));
        }
        found.push(index as u32);
    }
    Ok(found)
}

fn check_dofs(
    package: &RawPackage,
    frame: &AxisFrame,
    tolerance: f64,
    rows_of_node: &[[u32; 3]],
    index: &NodeIndex,
) -> Result<(), PackageError> {
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
        let at = package.nodes[index[&low] as usize].position;
        if on_axis(at, frame, package.manifest.sectors, tolerance) && present(rows(low)).contains(&true) {
            return wrong(ManifestProblem::PairOnAxis { low, high });
        }
    }
    Ok(())
}

/// Whether the turn maps the free global directions onto each other: no part of it couples free with clamped ones.
fn maps_onto_itself(turned: &Basis, free: [bool; 3]) -> bool {
    (0..3).all(|i| (0..3).all(|j| !free[i] || free[j] || turned[(i, j)].abs() <= DIRECTION_TOLERANCE))
}
