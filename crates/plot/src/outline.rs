//! Area that a cloud of nodes covers: packages have nodes and no elements.
//!
//! Neighbouring nodes are joined by Delaunay's triangles (Bowyer, Computer J. 24, 1981); triangles whose circle is larger than the mesh is
//! coarse span a gap and are left out (an α-shape: Edelsbrunner, Kirkpatrick, Seidel, IEEE Trans. Inf. Theory 29, 1983).

use std::collections::{BTreeMap, BTreeSet};

type Point = (f64, f64);

/// Number of points beyond which the cloud is thinned: the outline is still as fine as the eye can see.
const MOST: usize = 1500;

/// Radius of the largest circle about a triangle, relative to the distance of nodes where they are sparse.
const LARGEST_CIRCLE: f64 = 1.25;

/// Triangles that cover the cloud, and the edges at which they end; none unless three points span an area.
pub(super) fn outline(points: &[Point]) -> (Vec<[Point; 3]>, Vec<[Point; 2]>) {
    let points = thinned(points);
    let triangles = delaunay(&points);
    let Some(limit) = spacing(&points, &triangles).map(|spacing| LARGEST_CIRCLE * spacing) else {
        return (Vec::new(), Vec::new());
    };
    let mut uses: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    let mut kept = Vec::new();
    for &corners in &triangles {
        let places = corners.map(|corner| points[corner]);
        if circle(places).is_some_and(|(_, square)| square.sqrt() <= limit) {
            kept.push(places);
            for edge in edges(corners) {
                *uses.entry(edge).or_default() += 1;
            }
        }
    }
    let ends = uses.into_iter().filter(|(_, count)| *count == 1);
    (kept, ends.map(|((a, b), _)| [points[a], points[b]]).collect())
}

/// Thins points to one in each cell of a grid, with cells so large that at most [`MOST`] points are left.
fn thinned(points: &[Point]) -> Vec<Point> {
    let ends = |value: fn(&Point) -> f64| {
        let values = points.iter().map(value);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)))
    };
    let (x, y) = (ends(|point| point.0), ends(|point| point.1));
    let extent = f64::max(x.1 - x.0, y.1 - y.0);
    if !(extent.is_finite() && extent > 0.0) {
        return points.first().copied().into_iter().collect();
    }
    let mut parts = 1000.0;
    loop {
        let cell = |point: &Point| {
            ((parts * (point.0 - x.0) / extent) as i64, (parts * (point.1 - y.0) / extent) as i64)
        };
        let mut taken = BTreeSet::new();
        let kept: Vec<Point> = points.iter().filter(|point| taken.insert(cell(point))).copied().collect();
        if kept.len() <= MOST {
            return kept;
        }
        parts *= 0.8;
    }
}

/// Distance of neighbours where they are sparse: 95 % of the points have their shortest edge below it.
fn spacing(points: &[Point], triangles: &[[usize; 3]]) -> Option<f64> {
    let mut shortest = vec![f64::INFINITY; points.len()];
    for (a, b) in triangles.iter().flat_map(|corners| edges(*corners)) {
        let length = f64::hypot(points[a].0 - points[b].0, points[a].1 - points[b].1);
        for end in [a, b] {
            shortest[end] = shortest[end].min(length);
        }
    }
    shortest.retain(|length| length.is_finite());
    shortest.sort_by(f64::total_cmp);
    shortest.get((0.95 * shortest.len() as f64) as usize).copied()
}

fn edges([a, b, c]: [usize; 3]) -> [(usize, usize); 3] {
    [(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b)))
}

/// Centre and squared radius of the circle through three points; none if they lie on a line.
fn circle([a, b, c]: [Point; 3]) -> Option<(Point, f64)> {
    let (b, c) = ((b.0 - a.0, b.1 - a.1), (c.0 - a.0, c.1 - a.1));
    let twice = 2.0 * (b.0 * c.1 - b.1 * c.0);
    let (bb, cc) = (b.0 * b.0 + b.1 * b.1, c.0 * c.0 + c.1 * c.1);
    let centre = ((c.1 * bb - b.1 * cc) / twice, (b.0 * cc - c.0 * bb) / twice);
    let square = centre.0 * centre.0 + centre.1 * centre.1;
    square.is_finite().then_some(((a.0 + centre.0, a.1 + centre.1), square))
}

/// Delaunay's triangles, as indices: points are inserted one by one, and triangles whose circle holds the new point make way for new ones
/// around it.
fn delaunay(points: &[Point]) -> Vec<[usize; 3]> {
    let count = points.len();
    let farthest = |value: fn(&Point) -> f64| points.iter().map(value).fold(0.0, |m: f64, v| m.max(v.abs()));
    let reach = 50.0 * (1.0 + farthest(|point| point.0) + farthest(|point| point.1));
    // Regular meshes have four points on a circle everywhere; shifts too small to see avoid this.
    let moved = |(index, point): (usize, &Point)| {
        let off = |step: u64| (index as u64).wrapping_mul(step) % 1009;
        (
            point.0 + 1e-9 * reach * off(7919) as f64 / 1009.0,
            point.1 + 1e-9 * reach * off(104_729) as f64 / 1009.0,
        )
    };
    let mut places: Vec<Point> = points.iter().enumerate().map(moved).collect();
    places.extend([(-reach, -reach), (reach, -reach), (0.0, reach)]);
    let about = |places: &[Point], corners: [usize; 3]| {
        circle(corners.map(|corner| places[corner])).map(|circle| (corners, circle))
    };
    let mut triangles: Vec<_> = about(&places, [count, count + 1, count + 2]).into_iter().collect();
    for index in 0..count {
        let (x, y) = places[index];
        let mut hole: BTreeMap<(usize, usize), u32> = BTreeMap::new();
        triangles.retain(|(corners, (centre, square))| {
            let inside = (x - centre.0).powi(2) + (y - centre.1).powi(2) < *square;
            if inside {
                for edge in edges(*corners) {
                    *hole.entry(edge).or_default() += 1;
                }
            }
            !inside
        });
        let rim = hole.into_iter().filter(|(_, uses)| *uses == 1);
        triangles.extend(rim.filter_map(|((a, b), _)| about(&places, [a, b, index])));
    }
    let all = triangles.into_iter().map(|(corners, _)| corners);
    all.filter(|corners| corners.iter().all(|corner| *corner < count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area([a, b, c]: &[Point; 3]) -> f64 {
        0.5 * ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).abs()
    }

    /// L-shaped cloud of 30 × 30 with a square of 20 × 20 cut out: its area and its circumference.
    #[test]
    fn a_cloud_with_a_corner_missing_keeps_it_missing() {
        let all = (0..=30).flat_map(|i| (0..=30).map(move |j| (f64::from(i), f64::from(j))));
        let cloud: Vec<Point> = all.filter(|(x, y)| *x <= 10.0 || *y <= 10.0).collect();
        let (triangles, edges) = outline(&cloud);
        let covered: f64 = triangles.iter().map(area).sum();
        assert!((covered - 500.0).abs() < 1.0, "{covered}");
        let length: f64 = edges.iter().map(|[a, b]| f64::hypot(a.0 - b.0, a.1 - b.1)).sum();
        assert!((length - 120.0).abs() < 2.0, "{length}");
    }

    #[test]
    fn what_has_no_area_has_no_outline() {
        for cloud in [&[][..], &[(1.0, 2.0)], &[(1.0, 2.0), (3.0, 4.0)], &[(0.0, 0.0); 9]] {
            assert_eq!(outline(cloud), (Vec::new(), Vec::new()));
        }
        let (triangles, _) = outline(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
        assert!(triangles.iter().map(area).sum::<f64>() < 1e-3);
    }

    #[test]
    fn large_clouds_are_thinned() {
        let cloud: Vec<Point> = (0..200_000).map(|i| (f64::from(i % 500), f64::from(i / 500))).collect();
        let (triangles, edges) = outline(&cloud);
        assert!(triangles.len() < 2 * MOST && !edges.is_empty());
    }
}
