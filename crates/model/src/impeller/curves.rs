//! Meridional and camber curves of an impeller.

use super::parameters::ImpellerParameters;

/// Quarter ellipse in the (r, z) plane that leaves (r0, 0) axially and arrives at (r1, z1) radially.
#[derive(Debug, Clone)]
pub(super) struct TurningCurve {
    start_radius: f64,
    end: [f64; 2],
    /// Arc length up to parameter φ = π/2 · index / (len − 1).
    lengths: Vec<f64>,
}

impl TurningCurve {
    /// Number of intervals of the arc-length table: chords of a quarter ellipse then miss 1e-8 of the arc.
    const INTERVALS: usize = 4096;

    pub(super) fn new(start_radius: f64, end: [f64; 2]) -> Self {
        let mut curve = Self { start_radius, end, lengths: vec![0.0] };
        let mut last = curve.at_parameter(0.0);
        let mut length = 0.0;
        for index in 1..=Self::INTERVALS {
            let point = curve.at_parameter(Self::parameter(index as f64));
            length += (point[0] - last[0]).hypot(point[1] - last[1]);
            curve.lengths.push(length);
            last = point;
        }
        curve
    }

    fn parameter(index: f64) -> f64 {
        std::f64::consts::FRAC_PI_2 * index / Self::INTERVALS as f64
    }

    /// Point r = r1 − (r1 − r0) cos φ, z = z1 sin φ at parameter φ.
    fn at_parameter(&self, phi: f64) -> [f64; 2] {
        [self.end[0] - (self.end[0] - self.start_radius) * phi.cos(), self.end[1] * phi.sin()]
    }

    /// Parameter φ at the fraction `s` of the arc length.
    fn phi(&self, s: f64) -> f64 {
        let target = s * self.length();
        let upper = self.lengths.partition_point(|&l| l < target).clamp(1, Self::INTERVALS);
        let (a, b) = (self.lengths[upper - 1], self.lengths[upper]);
        Self::parameter((upper - 1) as f64 + (target - a) / (b - a))
    }

    /// Arc length of the whole curve.
    pub(super) fn length(&self) -> f64 {
        self.lengths[Self::INTERVALS]
    }

    /// Point (r, z) at the fraction `s` of the arc length.
    pub(super) fn point(&self, s: f64) -> [f64; 2] {
        self.at_parameter(self.phi(s))
    }

    /// Unit tangent (r, z) at the fraction `s` of the arc length, in the direction of the flow.
    pub(super) fn tangent(&self, s: f64) -> [f64; 2] {
        let (sin, cos) = self.phi(s).sin_cos();
        let t = [(self.end[0] - self.start_radius) * sin, self.end[1] * cos];
        let norm = t[0].hypot(t[1]);
        t.map(|c| c / norm)
    }

    /// Unit normal (r, z) away from the hub: +r at the leading edge, −z at the trailing edge.
    pub(super) fn outward_normal(&self, s: f64) -> [f64; 2] {
        let [r, z] = self.tangent(s);
        [z, -r]
    }
}

/// Camber of a blade: θ(s) quadratic in the fraction s of the arc length, the same from hub to tip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camber {
    wrap: f64,
    end_slope: f64,
}

impl Camber {
    /// Camber that wraps by `wrap_deg` and ends at the backsweep angle β: r |dθ/dm| = tan β at the trailing edge, with the mean of the arc
    /// lengths of hub and shroud for m.
    pub(super) fn new(parameters: &ImpellerParameters, hub: &TurningCurve, shroud: &TurningCurve) -> Self {
        let mean = 0.5 * (hub.length() + shroud.length());
        let backsweep = parameters.backsweep_deg.to_radians().tan();
        Self {
            wrap: parameters.wrap_deg.to_radians(),
            end_slope: backsweep * mean / parameters.outlet_radius,
        }
    }

    /// Angle θ at the fraction s: 0 at the leading edge, −wrap at the trailing edge.
    pub(super) fn angle(&self, s: f64) -> f64 {
        -(self.wrap * s + (self.end_slope - self.wrap) * s * (s - 1.0))
    }

    /// Slope dθ/ds.
    pub(super) fn slope(&self, s: f64) -> f64 {
        -(self.wrap + (self.end_slope - self.wrap) * (2.0 * s - 1.0))
    }
}
