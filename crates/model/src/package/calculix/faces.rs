//! Cyclic faces: the nodes of each, and their pairs.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use super::deck::Deck;
use super::error::{ModelProblem, NoCopy};
use super::matrices::DofList;
use super::model::CalculixModel;
use super::sets::set;
use crate::package::by_place::{Nearest, NodeGrid};
use crate::package::check::slits::{self, Slit};
use crate::package::raw::RawDof;
use rubmap_solid::frame::AxisFrame;

/// Nodes of the low and of the high face. The high face is empty for a whole wheel; both are empty for a single blade whose faces are not
/// named: one sector has no neighbour.
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

/// Pairs of low and high nodes, and whether the faces were given the other way round. For faces that fit neither way, the problem of the
/// way that fits better.
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
    let turned = |low: &[u64], high: &[u64]| -> Result<Vec<[u64; 2]>, Unfit> {
        let places = NodeGrid::new(high.iter().map(|node| (*node, positions[node])).collect(), tolerance);
        let to = |node: &u64| frame.turn_point(positions[node], alpha);
        let found: Vec<Option<u64>> = low.iter().map(|node| places.near(to(node))).collect();
        let Some(first) = found.iter().position(Option::is_none) else {
            return Ok(low.iter().copied().zip(found.into_iter().flatten()).map(<[u64; 2]>::from).collect());
        };
        let without = found.iter().filter(|high| high.is_none()).count();
        let node = low[first];
        let Nearest { node: nearest, distance } = places.nearest_of_all(to(&node));
        Err(Unfit { without, first: NoCopy { node, sectors, tolerance, nearest, distance } })
    };
    let forward = match turned(low, high) {
        Ok(pairs) => return Ok((pairs, false)),
        Err(forward) => forward,
    };
    let backward = match turned(high, low) {
        Ok(pairs) => return Ok((pairs, true)),
        Err(backward) => backward,
    };
    let order = backward.without.cmp(&forward.without);
    let swapped = order.then(backward.first.distance.total_cmp(&forward.first.distance)).is_lt();
    let copy = if swapped { backward.first } else { forward.first };
    Err(ModelProblem::NoPartner { copy, swapped })
}

/// Mismatch of the faces in one order.
struct Unfit {
    /// Number of nodes without a partner.
    without: usize,
    /// First node without a partner.
    first: NoCopy,
}

/// Refuses free nodes of `dofs` that need a pair and are in none of `pairs`: faces without their mid-edge nodes, or with holes.
pub(super) fn check_all_paired(
    dofs: &[RawDof],
    pairs: &[[u64; 2]],
    positions: &HashMap<u64, [f64; 3]>,
    frame: &AxisFrame,
    sectors: usize,
    tolerance: f64,
) -> Result<(), ModelProblem> {
    let paired: HashSet<u64> = pairs.iter().flatten().copied().collect();
    let mut seen = HashSet::new();
    let free = dofs.iter().map(|dof| dof.node).filter(|node| seen.insert(*node));
    let free = free.map(|node| (node, positions[&node])).collect();
    match slits::find(free, |node| paired.contains(&node), frame, sectors, tolerance) {
        None => Ok(()),
        Some(Slit { low, high }) => Err(ModelProblem::PairMissing { low, high, sectors }),
    }
}

/// Requires that either both nodes of a pair have DOF, or none.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes on each of two radial planes 2π/7 apart, as high as `top` on the second.
    fn planes(top: f64) -> HashMap<u64, [f64; 3]> {
        let at = |r: f64, theta: f64, z: f64| [r * theta.cos(), r * theta.sin(), z];
        let alpha = TAU / 7.0;
        HashMap::from([
            (1, at(40.0, 0.2, 0.0)),
            (2, at(50.0, 0.2, 0.0)),
            (3, at(50.0, 0.2, 5.0)),
            (11, at(40.0, 0.2 + alpha, 0.0)),
            (12, at(50.0, 0.2 + alpha, 0.0)),
            (13, at(50.0, 0.2 + alpha, top)),
        ])
    }

    fn paired(low: &[u64], high: &[u64], top: f64) -> Result<(Vec<[u64; 2]>, bool), ModelProblem> {
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        pair(low, high, &planes(top), &frame, 7, 1e-3)
    }

    #[test]
    fn faces_pair_in_either_order() {
        let (low, high) = ([1, 2, 3], [12, 13, 11]);
        assert_eq!(paired(&low, &high, 5.0).unwrap(), (vec![[1, 11], [2, 12], [3, 13]], false));
        assert_eq!(paired(&high, &low, 5.0).unwrap(), (vec![[1, 11], [2, 12], [3, 13]], true));
    }

    #[test]
    fn a_node_without_partner_is_reported_for_the_turn_that_fits_better() {
        let (low, high) = ([1, 2, 3], [12, 13, 11]);
        for (first, second, exchanged) in [(low, high, false), (high, low, true)] {
            let Err(ModelProblem::NoPartner { copy, swapped }) = paired(&first, &second, 5.1) else {
                panic!("node 3 has no partner");
            };
            assert_eq!((copy.node, copy.nearest, swapped), (3, 13, exchanged));
            assert!((copy.distance - 0.1).abs() < 1e-9, "{}", copy.distance);
        }
    }

    /// Node near the axis, which a turn in the wrong direction misses by little.
    #[test]
    fn a_node_near_the_axis_does_not_decide_which_turn_fits_better() {
        let mut places = planes(5.1);
        places.insert(4, [0.01, 0.0, 0.0]);
        places.insert(14, [0.01 * (TAU / 7.0).cos(), 0.01 * (TAU / 7.0).sin(), 0.0]);
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        let found = pair(&[4, 1, 2, 3], &[14, 11, 12, 13], &places, &frame, 7, 1e-3);
        let Err(ModelProblem::NoPartner { copy, swapped: false }) = found else {
            panic!("three of the four nodes fit the turn from low to high");
        };
        assert_eq!((copy.node, copy.nearest), (3, 13));
    }

    #[test]
    fn faces_without_some_of_their_nodes_leave_a_slit() {
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        let dofs: Vec<RawDof> = planes(5.0).into_keys().map(|node| RawDof { node, component: 1 }).collect();
        let check = |pairs: &[[u64; 2]]| check_all_paired(&dofs, pairs, &planes(5.0), &frame, 7, 1e-3);
        assert!(check(&[[1, 11], [2, 12], [3, 13]]).is_ok());
        let slit = check(&[[1, 11], [2, 12]]).unwrap_err();
        assert!(matches!(slit, ModelProblem::PairMissing { low: 3, high: 13, sectors: 7 }), "{slit}");
    }
}
