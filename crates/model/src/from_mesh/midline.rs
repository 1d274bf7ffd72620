//! Line along the middle of a strip of faces, between its two long edges.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector3;
use rubmap_solid::mesh::SectorMesh;

use super::surface::{Face, sides};

/// Nodes along a line, in order, with their positions.
pub(super) type Line = Vec<(u64, [f64; 3])>;

/// Points of a middle line.
const POINTS: usize = 1001;

/// Largest difference of a node's distances from both edges for it to stand for the middle, in parts of their sum.
const MIDDLE: f64 = 0.5;

/// Largest distance between the corners of a short end, in widths of the strip.
const END: f64 = 2.5;

/// Middle line of a strip, and both of its long edges at the same parts of their lengths.
#[derive(Debug)]
pub(super) struct Midline {
    middle: Vec<Vector3<f64>>,
    edges: [Vec<Vector3<f64>>; 2],
}

impl Midline {
    /// Length of the line.
    pub(super) fn length(&self) -> f64 {
        self.middle.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }
}

/// Middle line of a strip of faces; empty for faces without an outline.
pub(super) fn midline(mesh: &SectorMesh, surface: &[Face], strip: &[usize]) -> Midline {
    let outline = outline(surface, strip);
    let places: Vec<Vector3<f64>> = outline.iter().map(|&node| mesh.nodes[node as usize].into()).collect();
    let around: f64 = (0..places.len()).map(|k| (places[(k + 1) % places.len()] - places[k]).norm()).sum();
    let area: f64 = strip.iter().map(|&face| surface[face].area).sum();
    let Some([first, second]) = long_edges(&places, 2.0 * area / around) else {
        return Midline { middle: Vec::new(), edges: [Vec::new(), Vec::new()] };
    };
    let edges = [first, second].map(|edge| evenly(&edge));
    let middle = edges[0].iter().zip(&edges[1]).map(|(a, b)| (a + b) * 0.5).collect();
    Midline { middle, edges }
}

/// Corners of the longest closed outline of a strip, in order.
fn outline(surface: &[Face], strip: &[usize]) -> Vec<u32> {
    let sides = sides(surface, strip.iter().copied());
    let mut next: BTreeMap<u32, u32> = BTreeMap::new();
    for &face in strip {
        for [a, b] in surface[face].edges() {
            if sides.get(&[a.min(b), a.max(b)]).is_some_and(|faces| faces.len() == 1) {
                next.insert(a, b);
            }
        }
    }
    let mut longest = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut walk = vec![start];
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            if to == start {
                break;
            }
            walk.push(to);
            at = to;
        }
        if walk.len() > longest.len() {
            longest = walk;
        }
    }
    longest
}

/// Long edges of the closed outline of a strip of about this width, both from the same end: the outline without its two short ends.
fn long_edges(outline: &[Vector3<f64>], width: f64) -> Option<[Vec<Vector3<f64>>; 2]> {
    let count = outline.len();
    let away = |a: usize, b: usize| (outline[a] - outline[b]).norm();
    let farthest = |from: usize| (0..count).max_by(|&a, &b| away(a, from).total_cmp(&away(b, from)));
    if count < 4 {
        return None;
    }
    let [one, other] = {
        let a = farthest(farthest(0)?)?;
        [a, farthest(a)?]
    };
    let [one, other] = [one, other].map(|end| ends(outline, end, width));
    let walk = |from: usize, to: usize| -> Vec<Vector3<f64>> {
        let steps = (to + count - from) % count;
        (0..=steps).map(|k| outline[(from + k) % count]).collect()
    };
    let first = walk(one[1], other[0]);
    let mut second = walk(other[1], one[0]);
    second.reverse();
    Some([first, second])
}

/// Both corners of the short end of an outline near its far point, in the order of the outline: the far point itself, and the sharpest corner
/// about a width away.
fn ends(outline: &[Vector3<f64>], far: usize, width: f64) -> [usize; 2] {
    let count = outline.len();
    let turn = |k: usize| {
        let (before, after) = (outline[(k + count - 1) % count], outline[(k + 1) % count]);
        let [a, b] =
            [outline[k] - before, after - outline[k]].map(|v| v.try_normalize(0.0).unwrap_or_default());
        1.0 - a.dot(&b)
    };
    let near = |step: usize| {
        let walk = (1..count / 2).map(move |k| (far + k * step) % count);
        walk.take_while(|&k| (outline[k] - outline[far]).norm() <= END * width)
    };
    let sharpest = |step| near(step).max_by(|&a, &b| turn(a).total_cmp(&turn(b)));
    let turn_of = |corner: Option<usize>| corner.map_or(-1.0, turn);
    let (after, before) = (sharpest(1), sharpest(count - 1));
    match (turn_of(before) > turn_of(after), before, after) {
        (true, Some(before), _) => [before, far],
        (false, _, Some(after)) => [far, after],
        _ => [far, far],
    }
}

/// Points at even parts of the length of a polyline.
fn evenly(line: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let lengths: Vec<f64> = std::iter::once(0.0)
        .chain(line.windows(2).scan(0.0, |sum, pair| {
            *sum += (pair[1] - pair[0]).norm();
            Some(*sum)
        }))
        .collect();
    let total = lengths.last().copied().unwrap_or(0.0);
    let at = |k: usize| {
        let along = total * k as f64 / (POINTS - 1) as f64;
        let piece = lengths.partition_point(|&length| length < along).clamp(1, line.len().max(2) - 1);
        let (Some(&from), Some(&to)) = (line.get(piece - 1), line.get(piece)) else {
            return line.first().copied().unwrap_or_default();
        };
        let step = lengths[piece] - lengths[piece - 1];
        from + (to - from) * if step > 0.0 { (along - lengths[piece - 1]) / step } else { 0.0 }
    };
    (0..POINTS).map(at).collect()
}

/// Nodes of a strip along the middle of its thickness, from one end to the other. Where the mesh has no nodes in the middle, they are those
/// of one edge.
pub(super) fn along(mesh: &SectorMesh, surface: &[Face], strip: &[usize]) -> Line {
    let midline = midline(mesh, surface, strip);
    let nodes: BTreeSet<u32> =
        strip.iter().flat_map(|&face| surface[face].skin.nodes.iter().copied()).collect();
    let mut placed: Vec<(usize, f64, u32)> = Vec::with_capacity(nodes.len());
    for &node in &nodes {
        let at = Vector3::from(mesh.nodes[node as usize]);
        let Some((k, _)) = nearest(&midline.middle, at) else { continue };
        let [one, other] = [0, 1].map(|edge| nearest(&midline.edges[edge], at).map_or(0.0, |(_, away)| away));
        placed.push((k, (one - other) / (one + other).max(f64::MIN_POSITIVE), node));
    }
    placed.sort_by_key(|&(k, _, node)| (k, node));
    let middle: Vec<_> = placed.iter().copied().filter(|(_, off, _)| off.abs() <= MIDDLE).collect();
    let edge: Vec<_> = placed.iter().copied().filter(|(_, off, _)| *off < -MIDDLE).collect();
    let chosen = if middle.len() >= 3 { middle } else { edge };
    let line = |node: u32| (mesh.node_ids[node as usize], mesh.nodes[node as usize]);
    thinned(&chosen).into_iter().map(line).collect()
}

/// Nearest point of a line, as its place in the line, and its distance.
fn nearest(line: &[Vector3<f64>], at: Vector3<f64>) -> Option<(usize, f64)> {
    let away = line.iter().map(|point| (point - at).norm()).enumerate();
    away.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// One node of each place along the line: of those that lie beside each other the one nearest to the middle.
fn thinned(placed: &[(usize, f64, u32)]) -> Vec<u32> {
    let mut chosen: Vec<(usize, f64, u32)> = Vec::new();
    for &(k, off, node) in placed {
        match chosen.last_mut() {
            Some(last) if k - last.0 <= 1 => {
                if off.abs() < last.1.abs() {
                    *last = (k, off, node);
                }
            }
            _ => chosen.push((k, off, node)),
        }
    }
    chosen.into_iter().map(|(.., node)| node).collect()
}
