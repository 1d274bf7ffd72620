//! Ways through a graph of nodes.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Nodes along a line, in order, with their positions.
pub(super) type Line = Vec<(u64, [f64; 3])>;

/// Cheapest way through a graph of nodes (Dijkstra); none if there is no way.
pub(super) fn shortest(
    graph: &BTreeMap<u32, Vec<u32>>,
    from: u32,
    to: u32,
    cost: impl Fn(u32, u32) -> f64,
) -> Option<Vec<u32>> {
    // Bits of numbers that are not negative are in their order.
    let mut open = BinaryHeap::from([Reverse((0_u64, from))]);
    let mut reached: BTreeMap<u32, (f64, u32)> = BTreeMap::from([(from, (0.0, from))]);
    while let Some(Reverse((bits, node))) = open.pop() {
        let so_far = f64::from_bits(bits);
        if node == to {
            break;
        }
        if reached.get(&node).is_some_and(|&(best, _)| best < so_far) {
            continue;
        }
        for &next in graph.get(&node).into_iter().flatten() {
            let way = so_far + cost(node, next);
            if reached.get(&next).is_none_or(|&(best, _)| way < best) {
                reached.insert(next, (way, node));
                open.push(Reverse((way.to_bits(), next)));
            }
        }
    }
    let mut way = vec![to];
    while way.last() != Some(&from) {
        way.push(reached.get(way.last()?)?.1);
    }
    way.reverse();
    Some(way)
}
