//! Sector that fields are shown on, and its repetition to the whole wheel.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::{Mat, MatRef, c64};
use nalgebra::Matrix3;

use super::excluded::Excluded;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::stress::NodalStress;
use rubmap_wheel::dynamics::nodes::SectorNode;

/// Part of the wheel that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Whole wheel; nodes of the faces between sectors count once.
    Wheel,
    /// Single sector, by its index, with both its faces.
    Sector(usize),
}

/// Nodes and elements of a sector.
#[derive(Debug)]
pub struct FieldSector {
    sectors: usize,
    frame: AxisFrame,
    nodes: Vec<SectorNode>,
    mesh: Option<SectorMesh>,
    stress: Option<NodalStress>,
    excluded: Option<Excluded>,
    /// Low node that goes with each node of the high face; the node itself elsewhere.
    low: Vec<u32>,
}

impl FieldSector {
    /// Sector of a wheel of `sectors` sectors, from the nodes of a package and its mesh, if it has one, in the same order; `None` if the
    /// axis has no direction.
    pub fn new(
        sectors: usize,
        axis: ([f64; 3], [f64; 3]),
        nodes: Vec<SectorNode>,
        mesh: Option<SectorMesh>,
    ) -> Option<Self> {
        let frame = AxisFrame::new(axis.0, axis.1)?;
        let mut low: Vec<u32> = (0..nodes.len() as u32).collect();
        for &(from, to) in mesh.iter().flat_map(|mesh| &mesh.cyclic) {
            low[to as usize] = from;
        }
        Some(Self { sectors, frame, nodes, mesh, stress: None, excluded: None, low })
    }

    /// Adds the stress operator, where there is a mesh. Stress is not valid within a radius of contact nodes, by default their mean
    /// distance.
    #[must_use]
    pub fn with_stress(mut self, excluded_radius: Option<f64>) -> Self {
        self.stress = self.mesh.as_ref().map(NodalStress::new);
        self.excluded =
            self.mesh.is_some().then(|| Excluded::new(&self.nodes, self.turn(1), excluded_radius));
        self
    }

    /// Number of sectors N.
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Nodes of the sector, in the order of the package.
    pub fn nodes(&self) -> &[SectorNode] {
        &self.nodes
    }

    /// Elements of the sector, if the package has them.
    pub fn mesh(&self) -> Option<&SectorMesh> {
        self.mesh.as_ref()
    }

    /// Whether fields on this sector have stress.
    pub fn has_stress(&self) -> bool {
        self.stress.is_some()
    }

    /// Nodes without valid stress, if fields have stress.
    pub fn excluded(&self) -> Option<&Excluded> {
        self.excluded.as_ref()
    }

    /// Sectors of a part.
    pub fn sectors_of(&self, part: Part) -> Range<usize> {
        match part {
            Part::Wheel => 0..self.sectors,
            Part::Sector(sector) => sector..sector + 1,
        }
    }

    /// Position of a node of a sector, in the user's coordinates.
    pub fn position(&self, sector: usize, place: u32) -> [f64; 3] {
        self.frame.turn_point(self.nodes[place as usize].position, self.turn(sector))
    }

    /// Number of a node among the contact nodes, from 1 in the order of the package; 0 for all others.
    pub fn contact(&self, place: u32) -> u32 {
        self.nodes[place as usize].contact.map_or(0, |contact| contact + 1)
    }

    /// Directions r, θ, z at a node of a sector, in the user's coordinates.
    pub(super) fn directions(&self, sector: usize, place: u32) -> Matrix3<f64> {
        self.frame.cylindrical(self.nodes[place as usize].coordinates[1] + self.turn(sector))
    }

    /// Angle by which a sector is turned from the first, rad.
    pub(super) fn turn(&self, sector: usize) -> f64 {
        TAU * sector as f64 / self.sectors as f64
    }

    /// Whether a node lies on the high face, where the next sector begins.
    pub(super) fn is_high(&self, place: u32) -> bool {
        self.nodes[place as usize].on_high_face || self.low(place) != place
    }

    /// Low node that goes with a node of the high face; any other node itself.
    pub(super) fn low(&self, place: u32) -> u32 {
        self.low[place as usize]
    }

    /// Phase e^{jiα} of nodal diameter i from one sector to the next.
    pub(super) fn phase(&self, harmonic: usize) -> c64 {
        let (sin, cos) = self.turn(harmonic).sin_cos();
        c64::new(cos, sin)
    }

    /// Displacement (r, θ, z) at every node, `3·nodes × columns`, from columns over the own DOF at a nodal diameter.
    pub(super) fn at_nodes(&self, harmonic: usize, own: MatRef<'_, c64>) -> Mat<c64> {
        let mut at = Mat::zeros(3 * self.nodes.len(), own.ncols());
        for (place, node) in self.nodes.iter().enumerate() {
            let turn = if node.on_high_face { self.phase(harmonic) } else { c64::new(1.0, 0.0) };
            for dof in node.dofs.iter().flatten() {
                for column in 0..own.ncols() {
                    let value = turn * own[(dof.dof, column)];
                    for (component, &share) in dof.components.iter().enumerate() {
                        at[(3 * place + component, column)] += value * share;
                    }
                }
            }
        }
        at
    }

    /// Cylindrical stress at every node, `6·nodes × columns`, from the displacement of [`Self::at_nodes`]; NaN at nodes without stress.
    /// None without [`Self::with_stress`].
    pub(super) fn stress(&self, harmonic: usize, at_nodes: MatRef<'_, c64>) -> Option<Mat<c64>> {
        let operator = self.stress.as_ref()?;
        let phase = self.phase(harmonic);
        let found = operator.apply(phase, at_nodes);
        let nan = c64::new(f64::NAN, f64::NAN);
        let mut at = Mat::from_fn(6 * self.nodes.len(), at_nodes.ncols(), |_, _| nan);
        for (number, &place) in operator.places().iter().enumerate() {
            for component in 0..6 {
                for column in 0..at.ncols() {
                    at[(6 * place as usize + component, column)] = found[(6 * number + component, column)];
                }
            }
        }
        for place in (0..self.nodes.len()).filter(|&place| self.low[place] as usize != place) {
            for component in 0..6 {
                for column in 0..at.ncols() {
                    let low = at[(6 * self.low[place] as usize + component, column)];
                    at[(6 * place + component, column)] = phase * low;
                }
            }
        }
        Some(at)
    }
}
