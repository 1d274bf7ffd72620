//! The structured, conforming mesh of one impeller sector.
//!
//! Three directions: stations along the flow (equal arc lengths of hub and shroud, so contact nodes are evenly
//! spaced), columns in θ, and layers outwards. The disk's layers run straight from the inner curve (up the bore,
//! then out along the back face) to the hub curve; the blade's layers run straight from hub to shroud curve, on
//! the middle columns. All of it follows the camber angle, so the cyclic faces are wrapped surfaces half a pitch
//! to either side of the blade.

use std::f64::consts::PI;

use super::curves::{Camber, TurningCurve};
use super::error::ImpellerError;
use super::mesh::{Elements, Grid, HexMesh, SectorMesh, TipNode, cell};
use super::parameters::{ImpellerParameters, at_least};

/// Meshes one sector of the impeller.
///
/// # Errors
/// [`ImpellerError::Parameter`] for a field out of range, [`ImpellerError::Jacobian`] for an element turned inside out.
pub fn impeller_sector(parameters: &ImpellerParameters) -> Result<SectorMesh, ImpellerError> {
    parameters.validate()?;
    at_least(
        "mesh.between_contact_nodes",
        parameters.elements_along_blade(),
        2,
        "times `contact_nodes` - 1 must be at least 2",
    )?;
    let geometry = Geometry::new(parameters);
    geometry.check_passage()?;
    let sector = geometry.mesh();
    sector.mesh.check_jacobians()?;
    Ok(sector)
}

/// The curves of one impeller and the counts of its mesh.
struct Geometry<'a> {
    parameters: &'a ImpellerParameters,
    hub: TurningCurve,
    shroud: TurningCurve,
    camber: Camber,
    /// Elements along the blade.
    stations: usize,
    /// Elements across the sector.
    columns: usize,
    /// Station at which the inner curve turns from the bore to the back face.
    corner: usize,
}

impl<'a> Geometry<'a> {
    fn new(p: &'a ImpellerParameters) -> Self {
        let hub = TurningCurve::new(p.inlet_hub_radius, [p.outlet_radius, p.axial_length]);
        let shroud =
            TurningCurve::new(p.inlet_tip_radius, [p.outlet_radius, p.axial_length - p.outlet_blade_height]);
        let camber = Camber::new(p, &hub, &shroud);
        let stations = p.elements_along_blade();
        let columns = p.mesh.blade_thickness + 2 * p.mesh.half_passage;
        let mut geometry = Self { parameters: p, hub, shroud, camber, stations, columns, corner: 1 };
        geometry.corner = geometry.corner_station();
        geometry
    }

    /// The station whose hub point lies closest to the 45° line from the corner of bore and back face.
    fn corner_station(&self) -> usize {
        let off_diagonal = |station: usize| {
            let [r, z] = self.hub.point(self.fraction(station));
            ((r - self.parameters.bore_radius) - (self.back_face() - z)).abs()
        };
        (1..self.stations).min_by(|&a, &b| off_diagonal(a).total_cmp(&off_diagonal(b))).unwrap_or(1)
    }

    fn back_face(&self) -> f64 {
        self.parameters.axial_length + self.parameters.rim_thickness
    }

    fn fraction(&self, station: usize) -> f64 {
        station as f64 / self.stations as f64
    }

    /// Point (r, z) of the inner curve.
    fn inner(&self, station: usize) -> [f64; 2] {
        let (bore, back) = (self.parameters.bore_radius, self.back_face());
        if station <= self.corner {
            [bore, back * station as f64 / self.corner as f64]
        } else {
            let x = (station - self.corner) as f64 / (self.stations - self.corner) as f64;
            [bore + x * (self.parameters.outlet_radius - bore), back]
        }
    }

    /// Point (r, z) of the blade at a height between hub (0) and tip (1).
    fn blade_point(&self, s: f64, height: f64) -> [f64; 2] {
        lerp(self.hub.point(s), self.shroud.point(s), height)
    }

    /// Half the angle the blade covers: t/2 in θ, with t normal to the camber surface, (t/2r) √(1 + tan² β).
    fn half_blade_angle(&self, s: f64, height: f64) -> f64 {
        let p = self.parameters;
        let thickness = p.root_thickness + height * (p.tip_thickness - p.root_thickness);
        let [r, _] = self.blade_point(s, height);
        let speed = |curve: &TurningCurve| curve.tangent(s).map(|t| t * curve.length());
        let dm = lerp(speed(&self.hub), speed(&self.shroud), height);
        let tan_beta = r * self.camber.slope(s) / dm[0].hypot(dm[1]);
        0.5 * thickness / r * 1.0_f64.hypot(tan_beta)
    }

    /// The blade must leave room for the passage at every station, at its root and at its tip.
    fn check_passage(&self) -> Result<(), ImpellerError> {
        let p = self.parameters;
        let half_pitch = PI / p.sectors as f64;
        let ends = [(0.0, "root_thickness", p.root_thickness), (1.0, "tip_thickness", p.tip_thickness)];
        for (height, field, thickness) in ends {
            let half_blade = |station: usize| self.half_blade_angle(self.fraction(station), height);
            let widest = (0..=self.stations).map(half_blade).fold(0.0, f64::max);
            if widest > 0.9 * half_pitch {
                let requirement = "leaves less than a tenth of the pitch as passage";
                return Err(ImpellerError::Parameter { field, value: thickness.to_string(), requirement });
            }
        }
        Ok(())
    }

    /// Angle of a disk column from the camber: evenly spread on the inner curve, gathered under the blade at the
    /// hub.
    fn disk_angle(&self, station: usize, column: usize, depth: f64) -> f64 {
        let half_pitch = PI / self.parameters.sectors as f64;
        let even = half_pitch * (2.0 * column as f64 / self.columns as f64 - 1.0);
        let half_blade = self.half_blade_angle(self.fraction(station), 0.0);
        let passage = self.parameters.mesh.half_passage;
        let blade = self.parameters.mesh.blade_thickness;
        let gathered = if column <= passage {
            -half_pitch + (half_pitch - half_blade) * column as f64 / passage as f64
        } else if column >= passage + blade {
            let from_face = (self.columns - column) as f64 / passage as f64;
            half_pitch - (half_pitch - half_blade) * from_face
        } else {
            half_blade * (2.0 * (column - passage) as f64 / blade as f64 - 1.0)
        };
        (1.0 - depth) * even + depth * gathered
    }

    fn mesh(&self) -> SectorMesh {
        let p = self.parameters;
        let m = &p.mesh;
        let (columns, stations, layers) = (self.columns, self.stations, m.disk);
        let disk = Grid { size: [columns + 1, stations + 1, layers + 1], first: 0 };
        let blade = Grid { size: [m.blade_thickness + 1, stations + 1, m.blade_height], first: disk.len() };
        // The blade's lowest layer of nodes is the hub's surface.
        let blade_node = |j: usize, i: usize, k: usize| match k {
            0 => disk.node(j + m.half_passage, i, layers),
            _ => blade.node(j, i, k - 1),
        };

        let pitch = 2.0 * PI / p.sectors as f64;
        let mut mesh = HexMesh::default();
        for k in 0..=layers {
            let depth = k as f64 / layers as f64;
            for i in 0..=stations {
                let s = self.fraction(i);
                let [r, z] = lerp(self.inner(i), self.hub.point(s), depth);
                for j in 0..columns {
                    let theta = self.camber.angle(s) + self.disk_angle(i, j, depth);
                    mesh.nodes.push(cartesian(r, theta, z));
                }
                // The high face is the low face turned, from the same numbers.
                let low = self.camber.angle(s) + self.disk_angle(i, 0, depth);
                mesh.nodes.push(cartesian(r, low + pitch, z));
            }
        }
        for k in 1..=m.blade_height {
            let height = k as f64 / m.blade_height as f64;
            for i in 0..=stations {
                let s = self.fraction(i);
                let [r, z] = self.blade_point(s, height);
                let half = self.half_blade_angle(s, height);
                for j in 0..=m.blade_thickness {
                    let offset = half * (2.0 * j as f64 / m.blade_thickness as f64 - 1.0);
                    mesh.nodes.push(cartesian(r, self.camber.angle(s) + offset, z));
                }
            }
        }

        // (θ, along the flow, outwards) is right-handed.
        let mut elements = Vec::new();
        let mut add_block = |size: [usize; 3], node: &dyn Fn(usize, usize, usize) -> usize| {
            for k in 0..size[2] {
                for i in 0..size[1] {
                    for j in 0..size[0] {
                        elements.push(cell(node, j, i, k));
                    }
                }
            }
        };
        add_block([columns, stations, layers], &|j, i, k| disk.node(j, i, k));
        add_block([m.blade_thickness, stations, m.blade_height], &blade_node);

        mesh.elements = Elements::Linear(elements);

        let mut clamped = vec![[false; 3]; mesh.nodes.len()];
        for i in 0..=self.corner {
            for j in 0..=columns {
                clamped[disk.node(j, i, 0)] = [true; 3];
            }
        }
        let faces = (0..=layers).flat_map(|k| (0..=stations).map(move |i| (i, k)));
        let cyclic = faces.map(|(i, k)| (disk.node(0, i, k), disk.node(columns, i, k))).collect();
        let contact = (0..p.contact_nodes)
            .map(|c| {
                let station = c * m.between_contact_nodes;
                let [n_r, n_z] = self.shroud.outward_normal(self.fraction(station));
                TipNode {
                    node: blade_node(m.blade_thickness / 2, station, m.blade_height),
                    normal: [n_r, 0.0, n_z],
                }
            })
            .collect();
        SectorMesh { sectors: p.sectors, mesh, clamped, cyclic, contact }
    }
}

fn lerp(a: [f64; 2], b: [f64; 2], x: f64) -> [f64; 2] {
    [a[0] + x * (b[0] - a[0]), a[1] + x * (b[1] - a[1])]
}

fn cartesian(r: f64, theta: f64, z: f64) -> [f64; 3] {
    [r * theta.cos(), r * theta.sin(), z]
}
