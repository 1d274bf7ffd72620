//! Shape of one impeller sector on the grid of its mesh.
//!
//! Points are addressed by half-indices (see [`super::blocks`]): along the flow, across the sector in θ, outwards. The
//! sector consists of lanes, one per blade: a blade with half a passage on either side. Without a splitter the lane is
//! the sector; with one the sector has two lanes of half its width, the main blade's first, so that the splitter
//! stands in the middle between two main blades. All of it follows the camber angle: the cyclic faces are wrapped
//! surfaces in the middle of a passage.

use std::f64::consts::PI;

use super::curves::{Camber, TurningCurve};
use super::error::ImpellerError;
use super::parameters::ImpellerParameters;

/// Curves of one impeller and the counts of its mesh.
pub(super) struct Geometry<'a> {
    pub(super) parameters: &'a ImpellerParameters,
    hub: TurningCurve,
    pub(super) shroud: TurningCurve,
    camber: Camber,
    /// Lanes of the sector: that of the main blade, then that of the splitter if there is one.
    pub(super) lanes: Vec<Lane>,
    /// Half the angle of a lane, rad.
    half_lane: f64,
    /// Number of elements along the flow.
    pub(super) stations: usize,
    /// Station at which the inner curve turns from the bore to the back face.
    pub(super) corner: usize,
}

/// Share of one blade in the sector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lane {
    /// Angle of the blade's camber from the middle of the sector.
    centre: f64,
    /// Station at which the blade begins.
    pub(super) start: usize,
}

impl<'a> Geometry<'a> {
    /// Geometry of parameters that are within their ranges, whose inner curve turns at the station where that of `pattern` does.
    pub(super) fn like(p: &'a ImpellerParameters, pattern: &ImpellerParameters) -> Self {
        Self { corner: Geometry::new(pattern).corner, ..Self::new(p) }
    }

    fn new(p: &'a ImpellerParameters) -> Self {
        let hub = TurningCurve::new(p.inlet_hub_radius, [p.outlet_radius, p.axial_length]);
        let shroud =
            TurningCurve::new(p.inlet_tip_radius, [p.outlet_radius, p.axial_length - p.outlet_blade_height]);
        let camber = Camber::new(p, &hub, &shroud);
        let half_pitch = PI / p.sectors as f64;
        let (lanes, half_lane) = match p.splitter_start() {
            None => (vec![Lane { centre: 0.0, start: 0 }], half_pitch),
            Some(start) => {
                let quarter = 0.5 * half_pitch;
                (vec![Lane { centre: -quarter, start: 0 }, Lane { centre: quarter, start }], quarter)
            }
        };
        let stations = p.elements_along_blade();
        let mut geometry = Self { parameters: p, hub, shroud, camber, lanes, half_lane, stations, corner: 1 };
        geometry.corner = geometry.corner_station();
        geometry
    }

    /// Station whose hub point lies closest to the 45° line from the corner of bore and back face.
    fn corner_station(&self) -> usize {
        let off_diagonal = |station: usize| {
            let [r, z] = self.hub.point(self.fraction(2 * station));
            ((r - self.parameters.bore_radius) - (self.back_face() - z)).abs()
        };
        (1..self.stations).min_by(|&a, &b| off_diagonal(a).total_cmp(&off_diagonal(b))).unwrap_or(1)
    }

    fn back_face(&self) -> f64 {
        self.parameters.axial_length + self.parameters.rim_thickness
    }

    /// Fraction of the arc lengths of hub and shroud at a half-index along the flow.
    pub(super) fn fraction(&self, along: usize) -> f64 {
        along as f64 / (2 * self.stations) as f64
    }

    /// Point (r, z) of the inner curve: up the bore, then out along the back face.
    fn inner(&self, along: usize) -> [f64; 2] {
        let (bore, back) = (self.parameters.bore_radius, self.back_face());
        let corner = 2 * self.corner;
        if along <= corner {
            [bore, back * along as f64 / corner as f64]
        } else {
            let x = (along - corner) as f64 / (2 * self.stations - corner) as f64;
            [bore + x * (self.parameters.outlet_radius - bore), back]
        }
    }

    /// Point (r, z) of the blade at a height between hub (0) and tip (1).
    fn blade_point(&self, s: f64, height: f64) -> [f64; 2] {
        lerp(self.hub.point(s), self.shroud.point(s), height)
    }

    /// Half the angle that a blade covers: t/2 in θ, with t normal to the camber surface, (t/2r) √(1 + tan² β).
    fn half_blade_angle(&self, s: f64, height: f64) -> f64 {
        let p = self.parameters;
        let thickness = p.root_thickness + height * (p.tip_thickness - p.root_thickness);
        let [r, _] = self.blade_point(s, height);
        let speed = |curve: &TurningCurve| curve.tangent(s).map(|t| t * curve.length());
        let dm = lerp(speed(&self.hub), speed(&self.shroud), height);
        let tan_beta = r * self.camber.slope(s) / dm[0].hypot(dm[1]);
        0.5 * thickness / r * 1.0_f64.hypot(tan_beta)
    }

    /// Height between hub (0) and tip (1) of a layer of the blade.
    fn height(&self, up: usize) -> f64 {
        up as f64 / (2 * self.parameters.mesh.blade_height) as f64
    }

    /// Checks that every blade leaves room for the passage, at every station and height.
    pub(super) fn check_passage(&self) -> Result<(), ImpellerError> {
        let p = self.parameters;
        for up in 0..=2 * p.mesh.blade_height {
            for lane in &self.lanes {
                let half_blade = |along: usize| self.half_blade_angle(self.fraction(along), self.height(up));
                let widest = (2 * lane.start..=2 * self.stations).map(half_blade).fold(0.0, f64::max);
                if widest > 0.9 * self.half_lane {
                    let (field, thickness) = match up {
                        0 => ("root_thickness", p.root_thickness),
                        _ => ("tip_thickness", p.tip_thickness),
                    };
                    let requirement = "leaves less than a tenth of the passage open: use thinner or fewer blades, \
                                       a larger hub, or less wrap or backsweep";
                    return Err(ImpellerError::Parameter {
                        field,
                        value: thickness.to_string(),
                        requirement,
                    });
                }
            }
        }
        Ok(())
    }

    /// Half the angle of a lane's gathered columns at the hub: that of the blade, and upstream of a splitter a smooth transition to it from
    /// evenly spread columns at the inlet.
    fn half_gathered(&self, lane: &Lane, along: usize) -> f64 {
        let start = 2 * lane.start;
        if along >= start {
            return self.half_blade_angle(self.fraction(along), 0.0);
        }
        let m = &self.parameters.mesh;
        let even =
            self.half_lane * m.blade_thickness as f64 / (m.blade_thickness + 2 * m.half_passage) as f64;
        let blade = self.half_blade_angle(self.fraction(start), 0.0);
        even + (blade - even) * along as f64 / start as f64
    }

    /// Angle of a disk column from the middle of the sector's camber: evenly spread on the inner curve (depth 0),
    /// gathered under the blades at the hub (depth 1).
    fn disk_angle(&self, along: usize, across: usize, depth: f64) -> f64 {
        let m = &self.parameters.mesh;
        let (passage, blade) = (2 * m.half_passage, 2 * m.blade_thickness);
        let columns = blade + 2 * passage;
        let index = (across / columns).min(self.lanes.len() - 1);
        let lane = &self.lanes[index];
        let across = across - index * columns;
        let even = self.half_lane * (2.0 * across as f64 / columns as f64 - 1.0);
        let half_blade = self.half_gathered(lane, along);
        let gathered = if across <= passage {
            -self.half_lane + (self.half_lane - half_blade) * across as f64 / passage as f64
        } else if across >= passage + blade {
            let from_face = (columns - across) as f64 / passage as f64;
            self.half_lane - (self.half_lane - half_blade) * from_face
        } else {
            half_blade * (2.0 * (across - passage) as f64 / blade as f64 - 1.0)
        };
        lane.centre + ((1.0 - depth) * even + depth * gathered)
    }

    /// Position of a point of the disk, `up` from the inner curve to the hub.
    pub(super) fn disk_point(&self, across: usize, along: usize, up: usize) -> [f64; 3] {
        let p = self.parameters;
        let s = self.fraction(along);
        let depth = up as f64 / (2 * p.mesh.disk) as f64;
        let [r, z] = lerp(self.inner(along), self.hub.point(s), depth);
        let theta = |across: usize| self.camber.angle(s) + self.disk_angle(along, across, depth);
        if across == 2 * p.columns() {
            // The high face is the low face turned, from the same numbers.
            cartesian(r, theta(0) + 2.0 * PI / p.sectors as f64, z)
        } else {
            cartesian(r, theta(across), z)
        }
    }

    /// Position of a point of a lane's blade, `up` from hub to tip.
    pub(super) fn lane_point(&self, lane: &Lane, across: usize, along: usize, up: usize) -> [f64; 3] {
        let s = self.fraction(along);
        let height = self.height(up);
        let [r, z] = self.blade_point(s, height);
        let half = self.half_blade_angle(s, height);
        let blade = 2 * self.parameters.mesh.blade_thickness;
        let offset = half * (2.0 * across as f64 / blade as f64 - 1.0);
        cartesian(r, self.camber.angle(s) + (lane.centre + offset), z)
    }
}

fn lerp(a: [f64; 2], b: [f64; 2], x: f64) -> [f64; 2] {
    [a[0] + x * (b[0] - a[0]), a[1] + x * (b[1] - a[1])]
}

fn cartesian(r: f64, theta: f64, z: f64) -> [f64; 3] {
    [r * theta.cos(), r * theta.sin(), z]
}
