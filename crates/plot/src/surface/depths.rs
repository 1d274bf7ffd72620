//! Depth buffer (z-buffer): the surface nearest to the viewer, pixel by pixel.

/// Corner of a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    /// Position in pixels: to the right, down, and towards the viewer.
    pub(super) place: [f64; 3],
    pub(super) value: f64,
    /// Weight of `value`: 1 where it is known, 0 where nothing is claimed; at 0 the value has no meaning.
    pub(super) claim: f64,
    /// Light: 1 where the surface faces the viewer, 0 where it is seen edge on.
    pub(super) light: f64,
}

/// Side of a surface that is seen in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// No surface: the background is seen.
    Nothing,
    /// Outer side.
    Outside,
    /// Inner side, where the surface is open.
    Inside,
}

/// Surface seen in a pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragment {
    /// Depth in pixels, larger towards the viewer.
    pub(super) depth: f32,
    /// Value of the surface; NaN where nothing is claimed.
    pub(super) value: f32,
    pub(super) light: f32,
    pub(super) side: Side,
}

const EMPTY: Fragment =
    Fragment { depth: f32::NEG_INFINITY, value: f32::NAN, light: 0.0, side: Side::Nothing };

/// Share of the area of a triangle that rounding may cost at its edge: pixels on an edge belong to both of its triangles.
const EDGE: f64 = 1e-9;

/// Nearest surface in every pixel.
#[derive(Debug)]
pub(super) struct Depths {
    pub(super) width: usize,
    pub(super) height: usize,
    fragments: Vec<Fragment>,
}

impl Depths {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self { width, height, fragments: vec![EMPTY; width * height] }
    }

    pub(super) fn at(&self, column: usize, line: usize) -> &Fragment {
        &self.fragments[line * self.width + column]
    }

    /// Fragments of all pixels, line by line.
    pub(super) fn fragments(&self) -> &[Fragment] {
        &self.fragments
    }

    /// Draws a triangle where nothing is nearer. Depth, light and value are linear between the corners, which is exact for parallel rays;
    /// values end half-way to corners of which nothing is claimed.
    pub(super) fn triangle(&mut self, corners: &[Corner; 3]) {
        let [a, b, c] = corners.map(|corner| corner.place);
        let twice = cross(a, b, c[0], c[1]);
        if !twice.is_finite() || twice == 0.0 {
            return;
        }
        // In the image y points down: anticlockwise seen from outside is clockwise there.
        let side = if twice < 0.0 { Side::Outside } else { Side::Inside };
        let (columns, lines) = (span([a[0], b[0], c[0]], self.width), span([a[1], b[1], c[1]], self.height));
        for line in lines {
            let y = line as f64 + 0.5;
            for column in columns.clone() {
                let x = column as f64 + 0.5;
                let weights = [cross(b, c, x, y), cross(c, a, x, y), cross(a, b, x, y)].map(|w| w / twice);
                if weights.iter().any(|weight| *weight < -EDGE) {
                    continue;
                }
                let mixed = |values: [f64; 3]| (0..3).map(|i| weights[i] * values[i]).sum::<f64>();
                let depth = mixed([a[2], b[2], c[2]]) as f32;
                let pixel = &mut self.fragments[line * self.width + column];
                if depth > pixel.depth {
                    let light = mixed(corners.map(|corner| corner.light)) as f32;
                    let value = value(corners, &weights).map_or(f32::NAN, |value| value as f32);
                    *pixel = Fragment { depth, value, light, side };
                }
            }
        }
    }

    /// Whether no surface hides a position, given in pixels as corners are: it may lie behind by `tolerance`, or at the rim of the visible
    /// surface.
    pub(super) fn shows(&self, [x, y, depth]: [f64; 3], tolerance: f64) -> bool {
        let near = |value: f64, count: usize| {
            let middle = value.floor();
            span([middle - 1.0, middle, middle + 2.0], count)
        };
        let (columns, lines) = (near(x, self.width), near(y, self.height));
        let around = lines.flat_map(|line| columns.clone().map(move |column| (column, line)));
        let farthest = around.map(|(column, line)| self.at(column, line).depth).fold(f32::INFINITY, f32::min);
        depth + tolerance >= f64::from(farthest)
    }
}

/// Twice the area of the triangle from `a` over `b` to a point.
fn cross(a: [f64; 3], b: [f64; 3], x: f64, y: f64) -> f64 {
    (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
}

/// Interpolated value of the corners that claim one; none where their weight is less than half.
fn value(corners: &[Corner; 3], weights: &[f64; 3]) -> Option<f64> {
    let claims = corners.iter().zip(weights).map(|(corner, weight)| (corner.value, weight * corner.claim));
    let claims = claims.filter(|(_, claim)| *claim > 0.0);
    let (sum, claim) =
        claims.fold((0.0, 0.0), |(sum, all), (value, claim)| (sum + value * claim, all + claim));
    (claim >= 0.5).then(|| sum / claim)
}

/// Range of pixels, of `count`, whose middles may lie within some positions.
fn span(places: [f64; 3], count: usize) -> std::ops::Range<usize> {
    let (low, high) =
        places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
    // A cast limits positions outside to the ends.
    (low.floor() as usize).min(count)..(high.ceil() as usize).min(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn corner(place: [f64; 3], value: f64) -> Corner {
        Corner { place, value, claim: 1.0, light: 1.0 }
    }

    /// Draws a square between two diagonal corners at a depth that is linear in x.
    fn square(depths: &mut Depths, from: f64, to: f64, depth: impl Fn(f64) -> f64, value: f64) {
        let at = |x: f64, y: f64| corner([x, y, depth(x)], value);
        depths.triangle(&[at(from, from), at(from, to), at(to, to)]);
        depths.triangle(&[at(from, from), at(to, to), at(to, from)]);
    }

    /// Plane z = x − 50 that pierces z = 0 at x = 50: left of it the one is seen, right of it the other.
    #[test]
    fn of_two_squares_the_nearer_is_seen_pixel_by_pixel() {
        for order in [false, true] {
            let mut depths = Depths::new(100, 100);
            let level = |depths: &mut Depths| square(depths, 10.0, 90.0, |_| 0.0, 1.0);
            if order {
                level(&mut depths);
            }
            square(&mut depths, 20.0, 80.0, |x| x - 50.0, 2.0);
            if !order {
                level(&mut depths);
            }
            for (index, fragment) in depths.fragments().iter().enumerate() {
                let (x, y) = ((index % 100) as f64 + 0.5, (index / 100) as f64 + 0.5);
                let within = |from: f64, to: f64| x > from && x < to && y > from && y < to;
                let (depth, value) = match () {
                    () if within(20.0, 80.0) && x > 50.0 => (x - 50.0, 2.0),
                    () if within(10.0, 90.0) => (0.0, 1.0),
                    () => (f64::NEG_INFINITY, f64::NAN),
                };
                assert!(
                    f64::from(fragment.depth) == depth || (f64::from(fragment.depth) - depth).abs() < 1e-5
                );
                assert!(
                    (f64::from(fragment.value) - value).abs() < 1e-6
                        || value.is_nan() && fragment.value.is_nan()
                );
            }
        }
    }

    #[test]
    fn the_side_follows_from_the_winding() {
        let corners = [[0.0, 0.0, 0.0], [0.0, 9.0, 0.0], [9.0, 0.0, 0.0]].map(|place| corner(place, 1.0));
        let seen = |corners: [Corner; 3]| {
            let mut depths = Depths::new(9, 9);
            depths.triangle(&corners);
            depths.at(1, 1).side
        };
        // Down and then up to the right is anticlockwise, as seen.
        assert_eq!(seen(corners), Side::Outside);
        assert_eq!(seen([corners[0], corners[2], corners[1]]), Side::Inside);
    }

    /// Silhouette and depth of a sphere: πr² pixels, and √(r² − x² − y²) in the middle of each.
    #[test]
    fn a_sphere_covers_its_disk() {
        let (radius, steps) = (80.0, 200);
        let mut depths = Depths::new(200, 200);
        let at = |i: usize, j: usize| {
            let (polar, around) = (PI * i as f64 / steps as f64, TAU * j as f64 / steps as f64);
            let place = [polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()];
            corner([100.0 + radius * place[0], 100.0 + radius * place[1], radius * place[2]], place[2])
        };
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            depths.triangle(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            depths.triangle(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        let covered = depths.fragments().iter().filter(|fragment| fragment.side != Side::Nothing).count();
        let disk = PI * radius * radius;
        assert!((covered as f64 / disk - 1.0).abs() < 2e-3, "{covered} {disk}");
        for (x, y) in [(100, 100), (140, 100), (60, 130)] {
            let (dx, dy) = (x as f64 + 0.5 - 100.0, y as f64 + 0.5 - 100.0);
            let expected = (radius * radius - dx * dx - dy * dy).sqrt();
            let found = depths.at(x, y);
            assert!((f64::from(found.depth) - expected).abs() < 0.05, "{found:?} {expected}");
            assert!((f64::from(found.value) - expected / radius).abs() < 1e-3);
        }
        assert!(depths.shows([100.0, 100.0, radius], 0.1) && !depths.shows([100.0, 100.0, -radius], 0.1));
    }

    #[test]
    fn around_a_corner_without_value_nothing_is_claimed() {
        let mut corners =
            [[0.0, 0.0, 0.0], [0.0, 90.0, 0.0], [90.0, 0.0, 0.0]].map(|place| corner(place, 3.0));
        corners[0].claim = 0.0;
        let mut depths = Depths::new(90, 90);
        depths.triangle(&corners);
        assert!(depths.at(2, 2).value.is_nan());
        assert!((depths.at(80, 2).value - 3.0).abs() < 1e-6 && (depths.at(2, 80).value - 3.0).abs() < 1e-6);
    }

    #[test]
    fn what_has_no_area_or_no_place_is_not_drawn() {
        let mut depths = Depths::new(9, 9);
        for places in [
            [[1.0, 1.0, 0.0], [5.0, 5.0, 0.0], [8.0, 8.0, 0.0]],
            [[1.0, 1.0, 0.0], [f64::NAN, 5.0, 0.0], [8.0, 0.0, 0.0]],
            [[-50.0, 1.0, 0.0], [-40.0, 5.0, 0.0], [-30.0, 0.0, 0.0]],
            [[1e300, 1e300, 0.0], [-1e300, 1e300, 0.0], [0.0, -1e300, 0.0]],
        ] {
            depths.triangle(&places.map(|place| corner(place, 1.0)));
        }
        assert!(depths.fragments().iter().all(|fragment| fragment.side == Side::Nothing));
    }
}
