//! Chains of sharp edges: from node to node where three or more edges meet, or one ends, and closed loops.

use std::collections::{BTreeMap, BTreeSet};

/// Chains of a graph of neighbours, as nodes in order; a closed chain ends with its first node.
pub(super) fn chains(graph: &BTreeMap<u32, Vec<u32>>) -> Vec<Vec<u32>> {
    let passes = |node: &u32| graph[node].len() == 2;
    let mut walked = BTreeSet::new();
    let mut found = Vec::new();
    // Loops without a meeting begin anywhere, after all others.
    let (inner, meetings): (Vec<u32>, Vec<u32>) = graph.keys().partition(|node| passes(node));
    for start in meetings.into_iter().chain(inner) {
        for &first in &graph[&start] {
            let mut chain = vec![start];
            let (mut from, mut to) = (start, first);
            while walked.insert([from.min(to), from.max(to)]) {
                chain.push(to);
                if to == start || !passes(&to) {
                    break;
                }
                let next = graph[&to].iter().copied().find(|&next| next != from);
                (from, to) = (to, next.unwrap_or(from));
            }
            if chain.len() > 1 {
                found.push(chain);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Graph of edges.
    fn graph(edges: &[[u32; 2]]) -> BTreeMap<u32, Vec<u32>> {
        let mut graph: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &[a, b] in edges {
            graph.entry(a).or_default().push(b);
            graph.entry(b).or_default().push(a);
        }
        graph
    }

    #[test]
    fn chains_end_where_others_meet_and_loops_close() {
        // A path through a meeting of three, of which one ends, and a loop apart.
        let found = chains(&graph(&[[0, 1], [1, 2], [2, 3], [2, 4], [4, 5], [7, 8], [8, 9], [9, 7]]));
        assert_eq!(found, [vec![0, 1, 2], vec![2, 3], vec![2, 4, 5], vec![7, 8, 9, 7]]);
        // A loop that hangs on a meeting.
        assert_eq!(chains(&graph(&[[0, 1], [1, 2], [2, 0], [0, 3]])), [vec![0, 1, 2, 0], vec![0, 3]]);
    }
}
