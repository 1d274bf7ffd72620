//! Line along the middle of a strip of faces, between its two long edges.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector3;
use rubmap_solid::frame::distance;
use rubmap_solid::mesh::SectorMesh;

use super::surface::{Face, sides};
use super::way::{Line, shortest};

/// Points of a middle line.
const POINTS: usize = 1001;

/// Largest difference of a node's distances from both edges for it to stand for the middle, in parts of their sum.
const MIDDLE: f64 = 0.15;

/// Largest distance of a node from the straight line between the corners of an end on which it lies, in lengths of that line.
const ON_END: f64 = 0.15;

/// Least cosine of the angle by which a row of nodes turns at a node: 60°.
const STRAIGHT: f64 = 0.5;

/// Largest number of nodes of an end from which rows are tried.
const MOST_ENDS: usize = 12;

/// Largest distance between the corners of a short end, in widths of the strip.
const END: f64 = 3.0;

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

impl Midline {
    /// Whether a place lies on the short end between both edges.
    fn is_on_end(&self, end: usize, at: Vector3<f64>) -> bool {
        let [Some(one), Some(other)] = self.edges.each_ref().map(|edge| edge.get(end)) else { return false };
        let across = other - one;
        let part = ((at - one).dot(&across) / across.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (at - one - across * part).norm() <= ON_END * across.norm()
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

/// Nodes of the longest closed outline of a strip, in order.
fn outline(surface: &[Face], strip: &[usize]) -> Vec<u32> {
    let sides = sides(surface, strip.iter().copied());
    let mut next: BTreeMap<u32, u32> = BTreeMap::new();
    for &face in strip {
        let middles = &surface[face].skin.nodes[surface[face].skin.corners..];
        for (k, [a, b]) in surface[face].edges().enumerate() {
            if sides.get(&[a.min(b), a.max(b)]).is_some_and(|faces| faces.len() == 1) {
                // Blades are thinner than the arcs of their edges are high.
                match middles.get(k) {
                    Some(&middle) => next.extend([(a, middle), (middle, b)]),
                    None => drop(next.insert(a, b)),
                }
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

/// Nodes of a strip along the middle of its thickness, from one end to the other, and whether they lie in the middle: else they are the row
/// of nodes nearest to it.
pub(super) fn along(mesh: &SectorMesh, surface: &[Face], strip: &[usize]) -> (Line, bool) {
    let midline = midline(mesh, surface, strip);
    let nodes: BTreeSet<u32> =
        strip.iter().flat_map(|&face| surface[face].skin.nodes.iter().copied()).collect();
    let mut placed: BTreeMap<u32, Placed> = BTreeMap::new();
    for &node in &nodes {
        let at = Vector3::from(mesh.nodes[node as usize]);
        let Some((along, _)) = nearest(&midline.middle, at) else { continue };
        // Short ends may be skew: between their corners the middle is where both are equally far.
        let end = [0, POINTS - 1].into_iter().find(|&end| midline.is_on_end(end, at));
        let away = |edge: &Vec<Vector3<f64>>| match end {
            Some(corner) => edge.get(corner).map(|corner| (corner - at).norm()),
            None => nearest(edge, at).map(|(_, away)| away),
        };
        let [one, other] = midline.edges.each_ref().map(|edge| away(edge).unwrap_or_default());
        // The corner of a skew end may lie beside a place farther along.
        let reached = end.unwrap_or(along);
        placed.insert(
            node,
            Placed { along, reached, off: (one - other) / (one + other).max(f64::MIN_POSITIVE) },
        );
    }
    let line = |nodes: Vec<u32>| {
        nodes.into_iter().map(|node| (mesh.node_ids[node as usize], mesh.nodes[node as usize])).collect()
    };
    let mut middle: Vec<u32> = nodes
        .iter()
        .copied()
        .filter(|node| placed.get(node).is_some_and(|place| place.off.abs() <= MIDDLE))
        .collect();
    middle.sort_by_key(|node| (placed[node].along, *node));
    let gap = middle.windows(2).map(|pair| placed[&pair[1]].along - placed[&pair[0]].along).max();
    let ends = middle.first().map_or(POINTS, |node| placed[node].along)
        + middle.last().map_or(POINTS, |node| POINTS - 1 - placed[node].along);
    if middle.len() >= 3 && gap.is_some_and(|gap| 2 * gap < POINTS) && 5 * ends < POINTS {
        return (line(middle), true);
    }
    (line(row(mesh, surface, strip, &placed)), false)
}

/// Place of a node in a strip.
struct Placed {
    /// Nearest place on the middle line.
    along: usize,
    /// Nearest place on the middle line; for nodes of a short end, that end of the line.
    reached: usize,
    /// Distance off the middle line, from −1 on one edge to 1 on the other.
    off: f64,
}

/// Row of nodes from end to end of a strip, along the edges of its faces and near the middle.
fn row(mesh: &SectorMesh, surface: &[Face], strip: &[usize], placed: &BTreeMap<u32, Placed>) -> Vec<u32> {
    let mut graph: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &face in strip {
        for [from, to] in surface[face].steps() {
            graph.entry(from).or_default().push(to);
            graph.entry(to).or_default().push(from);
        }
    }
    let length: f64 = placed.len() as f64 * strip.iter().map(|&face| surface[face].area).sum::<f64>().sqrt();
    let place = |node: u32| placed.get(&node).map_or((0, 1.0), |place| (place.reached, place.off));
    // Ways off the middle are longer, and ways from row to row longer than any along one.
    let cost = |a: u32, b: u32| {
        let (off_a, off_b) = (place(a).1, place(b).1);
        let step = distance(mesh.nodes[a as usize], mesh.nodes[b as usize]);
        step * (1.0 + 20.0 * (off_a.abs() + off_b.abs())) + length * (off_a - off_b).abs()
    };
    let at_end = |reach: &dyn Fn(usize) -> usize| {
        let mut nodes: Vec<u32> =
            graph.keys().copied().filter(|&node| reach(place(node).0) < POINTS / 20).collect();
        nodes.sort_by(|&a, &b| place(a).1.abs().total_cmp(&place(b).1.abs()).then(a.cmp(&b)));
        nodes.truncate(MOST_ENDS);
        nodes
    };
    let (starts, ends) = (at_end(&|along| along), at_end(&|along| POINTS - 1 - along));
    let mut best: Option<(f64, Vec<u32>)> = None;
    for (&from, &to) in starts.iter().flat_map(|from| ends.iter().map(move |to| (from, to))) {
        let Some(way) = shortest(&graph, from, to, cost) else { continue };
        let missing = (place(from).0 + POINTS - 1 - place(to).0) as f64 / POINTS as f64;
        let total = length * missing + way.windows(2).map(|pair| cost(pair[0], pair[1])).sum::<f64>();
        if best.as_ref().is_none_or(|(least, _)| total < *least) {
            best = Some((total, way));
        }
    }
    let mut way = best.map(|(_, way)| way).unwrap_or_default();
    // Where ends are skew the middle line ends before the row does.
    let at = |node: u32| Vector3::from(mesh.nodes[node as usize]);
    for _ in 0..2 {
        way.reverse();
        while let [.., before, last] = way[..] {
            let on = (at(last) - at(before)).normalize();
            let goes_on = |node: &u32| {
                let step = at(*node) - at(last);
                !way.contains(node)
                    && step.dot(&on) > STRAIGHT * step.norm()
                    && (place(*node).1 - place(last).1).abs() <= MIDDLE
            };
            let Some(&next) = graph.get(&last).and_then(|next| next.iter().find(|node| goes_on(node))) else {
                break;
            };
            way.push(next);
        }
    }
    way
}

/// Nearest point of a line, as its place in the line, and its distance.
fn nearest(line: &[Vector3<f64>], at: Vector3<f64>) -> Option<(usize, f64)> {
    let away = line.iter().map(|point| (point - at).norm()).enumerate();
    away.min_by(|a, b| a.1.total_cmp(&b.1))
}
