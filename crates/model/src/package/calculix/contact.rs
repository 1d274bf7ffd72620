//! Contact nodes: in order from leading to trailing edge, and their normals in the meridional plane.
//!
//! The casing is a surface of revolution, so its normal has no circumferential part: with the tip's meridional curve
//! (r(s), z(s)) and its tangent t, the normal is t turned by a right angle, to the side away from the sector's nodes.

use std::path::Path;

use nalgebra::Vector3;

use super::error::{CalculixError, LineProblem, ModelProblem, NoOrder};
use super::model::Normals;
use super::text::{self, TextLines};
use rubmap_solid::frame::{AxisFrame, distance};

/// Contact node in the making.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// Number of the node.
    pub node: u64,
    /// Position (r, θ, z) about the axis.
    pub position: [f64; 3],
    /// Outward unit normal (r, θ, z).
    pub normal: [f64; 3],
}

/// Largest distance of a contact node from a given meridional curve, in lengths of the tip.
const OFF_CURVE: f64 = 0.1;

/// Least difference of the radii of the two ends, as a part of the tip's length, that identifies the leading edge.
const SAME_RADIUS: f64 = 1e-2;

/// Nodes of one line in order from the end at the smaller radius.
pub(super) fn in_chord_order(
    nodes: &[(u64, [f64; 3])],
    frame: &AxisFrame,
) -> Result<Vec<(u64, [f64; 3])>, ModelProblem> {
    let wrong = |reason| Err(ModelProblem::ContactOrder { reason });
    let centre: [f64; 3] =
        std::array::from_fn(|k| nodes.iter().map(|node| node.1[k]).sum::<f64>() / nodes.len() as f64);
    let farthest = |from: [f64; 3]| {
        let away = |a: &&(u64, [f64; 3])| distance(a.1, from);
        nodes.iter().max_by(|a, b| away(a).total_cmp(&away(b)).then(b.0.cmp(&a.0))).copied()
    };
    let Some(one_end) = farthest(centre) else { return Ok(Vec::new()) };
    let Some(other_end) = farthest(one_end.1).filter(|_| nodes.len() > 1) else { return Ok(nodes.to_vec()) };
    let radius = |node: (u64, [f64; 3])| frame.coordinates(node.1)[0];
    let difference = radius(other_end) - radius(one_end);
    if difference.abs() < SAME_RADIUS * distance(one_end.1, other_end.1) {
        return wrong(NoOrder::SameRadius);
    }
    let (start, end) = if difference > 0.0 { (one_end, other_end) } else { (other_end, one_end) };
    let chain = nearest_neighbours(nodes, start);
    if chain.last().map(|node| node.0) != Some(end.0) {
        return wrong(NoOrder::NoLine);
    }
    Ok(chain)
}

/// Nodes from `start` on, each followed by the nearest of those that are left.
pub(crate) fn nearest_neighbours(nodes: &[(u64, [f64; 3])], start: (u64, [f64; 3])) -> Vec<(u64, [f64; 3])> {
    let mut left: Vec<_> = nodes.iter().copied().filter(|node| node.0 != start.0).collect();
    let mut chain = vec![start];
    let mut last = start;
    while let Some(k) = (0..left.len()).min_by(|&a, &b| {
        let away = |k: usize| distance(left[k].1, last.1);
        away(a).total_cmp(&away(b)).then(left[a].0.cmp(&left[b].0))
    }) {
        last = left.swap_remove(k);
        chain.push(last);
    }
    chain
}

/// Selection of `count` of the nodes, as evenly spaced along the line as its nodes allow; all if there are fewer.
pub(crate) fn spread(nodes: Vec<(u64, [f64; 3])>, count: usize) -> Vec<(u64, [f64; 3])> {
    if count >= nodes.len() || count == 0 {
        return nodes;
    }
    let lengths = arc_lengths(nodes.iter().map(|node| node.1));
    let total = lengths[lengths.len() - 1];
    let mut chosen = Vec::with_capacity(count);
    let mut first = 0;
    for k in 0..count {
        let target = if count == 1 { 0.5 * total } else { total * k as f64 / (count - 1) as f64 };
        // Leave a node for each of those to come.
        let last = nodes.len() - (count - k);
        let off = |at: &usize| (lengths[*at] - target).abs();
        let best = (first..=last).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(first);
        chosen.push(nodes[best]);
        first = best + 1;
    }
    chosen
}

fn arc_lengths(positions: impl Iterator<Item = [f64; 3]>) -> Vec<f64> {
    let mut total = 0.0;
    let mut last: Option<[f64; 3]> = None;
    positions
        .map(|position| {
            total += last.replace(position).map_or(0.0, |before| distance(before, position));
            total
        })
        .collect()
}

/// Adds the normals; `sector` are the positions of all nodes, which tell inside from outside.
pub(crate) fn with_normals(
    nodes: &[(u64, [f64; 3])],
    normals: &Normals,
    frame: &AxisFrame,
    sector: &[[f64; 3]],
) -> Result<Vec<ContactPoint>, CalculixError> {
    let points: Vec<(u64, [f64; 3])> =
        nodes.iter().map(|(node, at)| (*node, frame.coordinates(*at))).collect();
    let meridional: Vec<[f64; 2]> = points.iter().map(|(_, [r, _, z])| [*r, *z]).collect();
    let curve = match normals {
        Normals::Table(path) => return from_table(path, &points, frame),
        Normals::Meridian(path) => {
            let curve = read_rows::<2>(path, "a point of the curve: r, z")?;
            if curve.len() < 3 {
                return Err(ModelProblem::ContactOrder { reason: NoOrder::ShortCurve }.into());
            }
            let length: f64 = meridional.windows(2).map(|pair| apart(pair[0], pair[1])).sum();
            for (point, at) in points.iter().zip(&meridional) {
                let distance = distance_to(&curve, *at);
                if distance > OFF_CURVE * length {
                    return Err(ModelProblem::OffCurve { node: point.0, distance }.into());
                }
            }
            curve
        }
        Normals::ContactNodes => {
            if points.len() < 3 {
                return Err(ModelProblem::ContactOrder { reason: NoOrder::FewNodes }.into());
            }
            meridional.clone()
        }
    };
    let mut found: Vec<[f64; 2]> = meridional
        .iter()
        .map(|at| {
            let [r, z] = tangent(&curve, *at);
            let length = r.hypot(z);
            [z / length, -r / length]
        })
        .collect();
    let coordinates = sector.iter().map(|at| frame.coordinates(*at));
    let sum = coordinates.fold([0.0; 2], |sum, [r, _, z]| [sum[0] + r, sum[1] + z]);
    let inside = sum.map(|x| x / sector.len() as f64);
    let outward: f64 = (meridional.iter().zip(&found))
        .map(|(at, n)| n[0] * (at[0] - inside[0]) + n[1] * (at[1] - inside[1]))
        .sum();
    if outward < 0.0 {
        found.iter_mut().flatten().for_each(|x| *x = -*x);
    }
    let point = |((node, position), n): (&(u64, [f64; 3]), &[f64; 2])| ContactPoint {
        node: *node,
        position: *position,
        normal: [n[0], 0.0, n[1]],
    };
    Ok(points.iter().zip(&found).map(point).collect())
}

/// Tangent, of any length, at the point of the curve nearest to `at`: that of the parabola over arc length through the three nearest points
/// of the curve.
fn tangent(curve: &[[f64; 2]], at: [f64; 2]) -> [f64; 2] {
    let away = |k: &usize| apart(curve[*k], at);
    let nearest = (0..curve.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0);
    let middle = nearest.clamp(1, curve.len() - 2);
    let [a, b, c] = [curve[middle - 1], curve[middle], curve[middle + 1]];
    let (before, after) = (apart(a, b).max(f64::MIN_POSITIVE), apart(b, c).max(f64::MIN_POSITIVE));
    let slope = |from: f64, to: f64, length: f64| (to - from) / length;
    let [first, second] = [0, 1].map(|k| {
        let (left, right) = (slope(a[k], b[k], before), slope(b[k], c[k], after));
        let bend = (right - left) / (before + after);
        (left + bend * before, bend)
    });
    // Arc length of `at` from b, along the tangent there.
    let norm = first.0.hypot(second.0).max(f64::MIN_POSITIVE);
    let along = ((at[0] - b[0]) * first.0 + (at[1] - b[1]) * second.0) / norm;
    let s = along.clamp(-before, after);
    [first.0 + 2.0 * first.1 * s, second.0 + 2.0 * second.1 * s]
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Distance of a point from a polyline.
fn distance_to(curve: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let from_piece = |pair: &[[f64; 2]]| {
        let [a, b] = [pair[0], pair[1]];
        let d = [b[0] - a[0], b[1] - a[1]];
        let length = d[0] * d[0] + d[1] * d[1];
        let t = ((at[0] - a[0]) * d[0] + (at[1] - a[1]) * d[1]) / length.max(f64::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        apart([a[0] + t * d[0], a[1] + t * d[1]], at)
    };
    curve.windows(2).map(from_piece).fold(f64::INFINITY, f64::min)
}

/// Normals from rows `node, nx, ny, nz` of Cartesian normals of any length.
fn from_table(
    path: &Path,
    points: &[(u64, [f64; 3])],
    frame: &AxisFrame,
) -> Result<Vec<ContactPoint>, CalculixError> {
    let rows = read_rows::<4>(path, "a normal: node, nx, ny, nz")?;
    let mut contact = Vec::new();
    for &(node, position) in points {
        let row = rows.iter().find(|row| row[0] == node as f64);
        let normal = row.and_then(|[_, x, y, z]| {
            let length = x.hypot(*y).hypot(*z);
            (length > 0.0).then(|| [x / length, y / length, z / length])
        });
        let Some(normal) = normal else {
            return Err(ModelProblem::NoNormal { node, file: path.to_owned() }.into());
        };
        let normal = (frame.cylindrical(position[1]) * Vector3::from(normal)).into();
        contact.push(ContactPoint { node, position, normal });
    }
    Ok(contact)
}

/// Reads rows of comma-separated numbers; a first line without numbers is a header.
fn read_rows<const N: usize>(path: &Path, expected: &'static str) -> Result<Vec<[f64; N]>, CalculixError> {
    let mut lines = TextLines::open(path)?;
    let mut rows = Vec::new();
    let mut first = true;
    while let Some(line) = lines.next()? {
        if line.trim().is_empty() {
            continue;
        }
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        let numbers: Result<Vec<f64>, _> = words.iter().map(|word| text::real(word, expected)).collect();
        match numbers.map(<[f64; N]>::try_from) {
            Ok(Ok(row)) => rows.push(row),
            Err(_) if first => {}
            Ok(Err(_)) => return Err(lines.fault(LineProblem::Words { expected })),
            Err(problem) => return Err(lines.fault(problem)),
        }
        first = false;
    }
    Ok(rows)
}
