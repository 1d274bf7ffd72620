//! The two cyclic faces: which nodes they are, and which node belongs to which.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use super::deck::Deck;
use super::error::{ModelProblem, NoCopy};
use super::matrices::DofList;
use super::model::CalculixModel;
use super::sets::set;
use crate::package::by_place::Places;
use rubmap_solid::frame::AxisFrame;

/// Nodes of the low and of the high face; the latter empty for a whole wheel, both for a single blade whose faces
/// nothing names: one sector has no neighbour.
pub(super) fn faces(
    model: &CalculixModel,
    deck: &Deck,
    sectors: usize,
) -> Result<(Vec<u64>, Vec<u64>), ModelProblem> {
    let tied = deck.tied_faces();
    if sectors == 1 && tied.is_none() && model.low_set.is_none() && model.high_set.is_none() {
        return Ok((Vec::new(), Vec::new()));
    }
    let face = |name: &Option<String>, tied: Option<&[u64]>, face, option| match (name, tied) {
        (Some(name), _) => set(deck, name).map(<[u64]>::to_vec),
        (None, Some(nodes)) => Ok(nodes.to_vec()),
        (None, None) => Err(ModelProblem::FaceUnknown { face, option }),
    };
    let high = || face(&model.high_set, tied.map(|tied| tied[1]), "high", "--high-set");
    let low = face(&model.low_set, tied.map(|tied| tied[0]), "low", "--low-set")?;
    Ok((low, if model.whole_wheel { Vec::new() } else { high()? }))
}

/// Pairs of low and high nodes, and whether the faces were given the other way round.
pub(super) fn pair(
    low: &[u64],
    high: &[u64],
    positions: &HashMap<u64, [f64; 3]>,
    frame: &AxisFrame,
    sectors: usize,
    tolerance: f64,
) -> Result<(Vec<[u64; 2]>, bool), ModelProblem> {
    if low.len() != high.len() {
        return Err(ModelProblem::FaceSizes { low: low.len(), high: high.len() });
    }
    let alpha = TAU / sectors as f64;
    let turned = |low: &[u64], high: &[u64]| -> Result<Vec<[u64; 2]>, ModelProblem> {
        let places = Places::new(high.iter().map(|node| (*node, positions[node])).collect(), tolerance);
        let partner = |&node: &u64| match places.at(frame.turn_point(positions[&node], alpha)) {
            Ok(high) => Ok([node, high]),
            Err(near) => {
                let (nearest, distance) = (near.node, near.distance);
                Err(ModelProblem::NoPartner(NoCopy { node, sectors, tolerance, nearest, distance }))
            }
        };
        low.iter().map(partner).collect()
    };
    match turned(low, high) {
        Ok(pairs) => Ok((pairs, false)),
        Err(problem) => turned(high, low).map(|pairs| (pairs, true)).map_err(|_| problem),
    }
}

/// Both nodes of a pair must have DOF, or none.
pub(super) fn check_ties(pairs: &[[u64; 2]], dofs: &DofList) -> Result<(), ModelProblem> {
    let free: HashSet<u64> = dofs.dofs.iter().map(|dof| dof.node).collect();
    for &[low, high] in pairs {
        let dof_file = dofs.path.clone();
        match (free.contains(&low), free.contains(&high)) {
            (true, false) => {
                return Err(ModelProblem::TieActive { node: high, face: "high", partner: low, dof_file });
            }
            (false, true) => {
                return Err(ModelProblem::TieActive { node: low, face: "low", partner: high, dof_file });
            }
            _ => {}
        }
    }
    Ok(())
}
