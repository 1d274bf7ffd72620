//! View of a surface: its direction, and how large its displacement is drawn.

use std::f64::consts::{PI, TAU};

use rubmap_analysis::result::FieldSurface;

/// Direction from which a surface is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceView {
    /// Front view, along the axis, which points to the viewer.
    Front,
    /// Rear view, along the axis, which points away from the viewer.
    Rear,
    /// Side view, across the axis. A sector is turned into the meridional plane: radius over axial coordinate, the largest angle in front.
    Meridional,
}

/// Share of the largest radius at which the largest displacement is drawn.
pub(super) const LARGEST_SHARE: f64 = 0.05;

/// View of one surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    view: SurfaceView,
    /// Angle of the middle of a sector; none for a wheel.
    sector: Option<f64>,
}

impl Camera {
    pub(super) fn new(view: SurfaceView, nodes: &[[f64; 3]]) -> Self {
        Self { view, sector: middle(nodes) }
    }

    /// Projects a position: to the right, up, and towards the viewer. Keeps the sense of rotation.
    pub(super) fn project(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match (self.view, self.sector) {
            (SurfaceView::Front, _) => [x, y, z],
            (SurfaceView::Rear, _) => [-x, y, -z],
            (SurfaceView::Meridional, None) => [z, y, -x],
            (SurfaceView::Meridional, Some(middle)) => {
                let (radius, angle) = (f64::hypot(x, y), y.atan2(x) - middle);
                [z, radius, radius * (angle - TAU * (angle / TAU).round())]
            }
        }
    }

    /// Words for the view.
    pub(super) fn words(self) -> &'static str {
        match (self.view, self.sector) {
            (SurfaceView::Front, _) => "seen along the axis, which points to the viewer",
            (SurfaceView::Rear, _) => "seen along the axis, which points away from the viewer",
            (SurfaceView::Meridional, None) => "seen across the axis",
            (SurfaceView::Meridional, Some(_)) => {
                "turned into the meridional plane, seen against the sense of the angle"
            }
        }
    }

    /// Axis titles, without unit.
    pub(super) fn axes(self) -> [&'static str; 2] {
        match (self.view, self.sector) {
            (SurfaceView::Front, _) => ["x", "y"],
            (SurfaceView::Rear, _) => ["−x", "y"],
            (SurfaceView::Meridional, None) => ["axial coordinate z", "y"],
            (SurfaceView::Meridional, Some(_)) => ["axial coordinate z", "radius r"],
        }
    }
}

/// Middle of the angles of nodes; none without a gap of half a turn between them, as on a wheel.
fn middle(nodes: &[[f64; 3]]) -> Option<f64> {
    let radius = largest_radius(nodes);
    let off_axis = nodes.iter().filter(|[x, y, _]| f64::hypot(*x, *y) > 1e-9 * radius);
    let mut angles: Vec<f64> =
        off_axis.map(|[x, y, _]| y.atan2(*x)).filter(|angle| angle.is_finite()).collect();
    angles.sort_by(f64::total_cmp);
    let (first, last) = (*angles.first()?, *angles.last()?);
    let between = angles.windows(2).map(|pair| (pair[1] - pair[0], pair[1]));
    let (gap, start) = between.fold((first + TAU - last, first), |a, b| if b.0 > a.0 { b } else { a });
    (gap > PI).then_some(start + 0.5 * (TAU - gap))
}

/// Largest distance of a node from the axis.
pub(super) fn largest_radius(nodes: &[[f64; 3]]) -> f64 {
    let radii = nodes.iter().map(|[x, y, _]| f64::hypot(*x, *y));
    radii.filter(|radius| radius.is_finite()).fold(0.0, f64::max)
}

/// Magnification of the displacement, to two digits; 0 where nothing moves.
pub(super) fn stretch(surface: &FieldSurface) -> f64 {
    let moved = surface.displacement.iter().map(|[x, y, z]| x.hypot(*y).hypot(*z));
    let largest = moved.filter(|moved| moved.is_finite()).fold(0.0, f64::max);
    let wanted = LARGEST_SHARE * largest_radius(&surface.nodes) / largest;
    if !(wanted.is_finite() && wanted > 0.0) {
        return 0.0;
    }
    // Parsing 2.3e2 gives the number that is shown.
    format!("{wanted:.1e}").parse().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(from: f64, to: f64) -> Vec<[f64; 3]> {
        (0..=20).map(|i| from + (to - from) * f64::from(i) / 20.0).map(|a| [a.cos(), a.sin(), 0.0]).collect()
    }

    #[test]
    fn a_sector_is_told_from_a_wheel() {
        for (from, to, expected) in [(-0.3, 0.3, 0.0), (2.9, 3.5, 3.2), (0.0, 2.0, 1.0)] {
            let found = middle(&ring(from, to)).unwrap();
            assert!((found - expected).sin().abs() < 1e-12 && (found - expected).cos() > 0.0, "{found}");
        }
        assert_eq!(middle(&ring(0.0, 1.9 * PI)), None);
        assert_eq!(middle(&[]), None);
    }

    #[test]
    fn every_view_keeps_the_sense_of_rotation() {
        let at = [1.0f64, 2.0, 3.0];
        let sector = ring(1.0, 1.2);
        for view in [SurfaceView::Front, SurfaceView::Rear, SurfaceView::Meridional] {
            for nodes in [&sector[..], &[]] {
                let camera = Camera::new(view, nodes);
                let column = |axis: usize| {
                    let mut moved = at;
                    moved[axis] += 1e-6;
                    let (a, b) = (camera.project(at), camera.project(moved));
                    [0, 1, 2].map(|i| (b[i] - a[i]) / 1e-6)
                };
                let [a, b, c] = [column(0), column(1), column(2)];
                let determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
                    + c[0] * (a[1] * b[2] - a[2] * b[1]);
                assert!((determinant - 1.0).abs() < 1e-4, "{view:?} {determinant}");
            }
        }
    }
}
