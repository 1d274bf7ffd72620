//! Slits between sectors: free nodes without a cyclic pair one turn from each other.

use super::super::by_place::NodeGrid;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::place::on_axis;
use std::f64::consts::TAU;

/// Two free nodes one sector apart that are not a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slit {
    /// Node on the low side.
    pub(crate) low: u64,
    /// Free node where the turn by +2π/N takes the low one.
    pub(crate) high: u64,
}

/// First free node without a pair that the turn by ±2π/N takes to another free node; `None` if all pairs are there, and for a single sector.
/// Nodes on the axis need none. `free` has the id and position of every node with a row of the matrices, `paired` says whether a node is in
/// a pair, and `tolerance` is the distance within which two places are one.
///
/// Time grows linearly with the number of nodes.
pub(crate) fn find(
    free: Vec<(u64, [f64; 3])>,
    paired: impl Fn(u64) -> bool,
    frame: &AxisFrame,
    sectors: usize,
    tolerance: f64,
) -> Option<Slit> {
    if sectors == 1 {
        return None;
    }
    let needs_pair = |&(node, at): &(u64, [f64; 3])| !paired(node) && !on_axis(at, frame, sectors, tolerance);
    let alone: Vec<(u64, [f64; 3])> = free.iter().copied().filter(needs_pair).collect();
    let places = NodeGrid::new(free, tolerance);
    let alpha = TAU / sectors as f64;
    alone.into_iter().find_map(|(node, position)| {
        let other = |turn| places.near(frame.turn_point(position, turn)).filter(|other| *other != node);
        let above = other(alpha).map(|high| Slit { low: node, high });
        above.or_else(|| other(-alpha).map(|low| Slit { low, high: node }))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of a block between the angles 0 and 2π/N about z, with a node on the axis in the last place.
    fn corners(sectors: usize) -> Vec<(u64, [f64; 3])> {
        let at = |id, r: f64, theta: f64, z| (id, [r * theta.cos(), r * theta.sin(), z]);
        let alpha = TAU / sectors as f64;
        vec![
            at(1, 1.0, 0.0, 0.0),
            at(2, 2.0, 0.0, 1.0),
            at(3, 1.0, alpha, 0.0),
            at(4, 2.0, alpha, 1.0),
            at(5, 1.5, 0.4 * alpha, 0.5),
            at(6, 0.0, 0.0, 0.3),
        ]
    }

    fn found(nodes: Vec<(u64, [f64; 3])>, sectors: usize, pairs: &[[u64; 2]]) -> Option<Slit> {
        let frame = AxisFrame::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
        find(nodes, |node| pairs.as_flattened().contains(&node), &frame, sectors, 1e-5)
    }

    #[test]
    fn a_missing_pair_names_both_nodes_for_odd_and_even_sectors() {
        for sectors in [2, 3, 10, 23] {
            let nodes = || corners(sectors)[..5].to_vec();
            assert_eq!(found(nodes(), sectors, &[[1, 3], [2, 4]]), None);
            assert_eq!(found(nodes(), sectors, &[[1, 3]]), Some(Slit { low: 2, high: 4 }));
            let mut other_order = nodes();
            other_order.reverse();
            let slit = found(other_order, sectors, &[[1, 3]]);
            // Half a turn either way is one turn, so two sectors do not tell low from high.
            let expected = if sectors == 2 { Slit { low: 4, high: 2 } } else { Slit { low: 2, high: 4 } };
            assert_eq!(slit, Some(expected));
        }
    }

    #[test]
    fn a_clamped_side_and_one_sector_have_no_slit() {
        let mut clamped = corners(10)[..5].to_vec();
        clamped.remove(3);
        assert_eq!(found(clamped, 10, &[[1, 3]]), None);
        assert_eq!(found(corners(10), 1, &[]), None);
    }

    #[test]
    fn nodes_on_the_axis_need_no_pair() {
        assert_eq!(found(corners(7), 7, &[[1, 3], [2, 4]]), None);
    }
}
