//! Measured validity: the largest motions of some speeds, recovered at all nodes of a sector and relaxed.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use nalgebra::Vector3;

use super::relax::{NotRelaxed, Relaxation, Relaxed};
use super::sector::HeldSector;
use crate::fields::BasisProduct;
use crate::monitor::Monitor;
use rubmap_solid::frame::AxisFrame;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::sector::ContactNode;
use rubmap_wheel::dynamics::states::WheelStates;

/// Phase of a job whose validity is measured, in words.
pub(crate) const PHASE: &str = "measuring the validity of linear theory";

/// Motion of the wheel at the instant at which a contact node is farthest from its place.
#[derive(Debug, Clone)]
pub struct LargestMotion {
    /// Index of the speed in the request.
    pub(crate) index: u32,
    /// Sector of the contact node.
    pub(crate) sector: usize,
    /// Displacement of the contact node.
    pub(crate) displacement: f64,
    /// Coordinates of the reduction by nodal diameter.
    pub(super) coordinates: Vec<(usize, Vec<c64>)>,
    /// Clearance of every contact node, if there is a casing.
    pub(super) clearance: Option<Vec<f64>>,
}

/// Largest motion of a speed with what linear theory neglects in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredMotion {
    /// Index of the speed in the request.
    pub(crate) index: u32,
    /// Displacement of the contact node that moves most.
    pub(crate) displacement: f64,
    /// Neglected shares, or the reason why the field could not be relaxed.
    pub(crate) neglected: Result<Neglected, NotRelaxed>,
}

/// Shares of a motion that linear theory neglects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neglected {
    /// Excess κ of the relaxed energy over the linear one, as a share of it.
    pub(crate) excess: f64,
    /// Largest second-order change of a contact node's distance to the casing, as a share of its clearance.
    pub(crate) gap: Option<f64>,
}

/// Reason why no motion can be measured.
#[derive(Debug, thiserror::Error)]
pub enum NotMeasured {
    /// Basis that cannot be read.
    #[error("the basis of the reduction cannot be read: {0}")]
    Basis(#[from] std::io::Error),
    /// Cancelled by the caller.
    #[error("cancelled")]
    Cancelled,
    /// Too little memory.
    #[error("measuring takes {} MB of memory, more than the service has for it (`--memory-bytes`)", bytes.div_ceil(1 << 20))]
    Memory {
        /// Bytes that are needed.
        bytes: u64,
    },
    /// Sector whose fields cannot be relaxed, with the reason.
    #[error("{0}")]
    Relaxed(String),
}

impl From<NotRelaxed> for NotMeasured {
    fn from(error: NotRelaxed) -> Self {
        Self::Relaxed(error.to_string())
    }
}

impl LargestMotion {
    /// Largest motion among recorded states of speed `index`.
    pub(crate) fn of(
        index: u32,
        states: &WheelStates,
        reduced: &ReducedWheel,
        clearance: Option<Vec<f64>>,
    ) -> Option<Self> {
        let mut largest = (0.0, 0, 0);
        for sector in 0..reduced.sectors {
            let turns: Vec<c64> =
                states.harmonics.iter().map(|of| phase(reduced.sectors, of.harmonic, sector)).collect();
            for instant in 0..states.revolutions.len() {
                for node in 0..reduced.contact.len() {
                    // Contact nodes are the first coordinates.
                    let component = |k: usize| {
                        let of = states.harmonics.iter().zip(&turns);
                        of.map(|(of, turn)| (turn * of.coordinates[(3 * node + k, instant)]).re).sum::<f64>()
                    };
                    let squared = (0..3).map(|k| component(k).powi(2)).sum::<f64>();
                    if squared > largest.0 {
                        largest = (squared, instant, sector);
                    }
                }
            }
        }
        let (squared, instant, sector) = largest;
        let coordinates = states.harmonics.iter();
        let column = |of: &Mat<c64>| (0..of.nrows()).map(|row| of[(row, instant)]).collect::<Vec<c64>>();
        (squared > 0.0 && squared.is_finite()).then(|| Self {
            index,
            sector,
            displacement: squared.sqrt(),
            coordinates: coordinates.map(|of| (of.harmonic, column(&of.coordinates))).collect(),
            clearance,
        })
    }
}

/// Measures motions of the wheel that `mesh` and `nodes`, in the same order, are a sector of. The factor is made once for all of them. A motion
/// whose field cannot be relaxed leaves the others theirs.
///
/// # Errors
/// A basis that cannot be read; a sector whose fields cannot be relaxed; cancellation.
pub fn measure(
    (mesh, nodes): (&SectorMesh, &[SectorNode]),
    reduced: &ReducedWheel,
    motions: &[LargestMotion],
    basis: BasisProduct<'_>,
    monitor: &dyn Monitor,
) -> Result<Vec<MeasuredMotion>, NotMeasured> {
    monitor.progress(0.0, PHASE);
    let fields = fields((mesh, nodes), reduced, motions, basis)?;
    let sector = HeldSector::new(mesh, nodes).ok_or(NotRelaxed::CanMove)?;
    let relaxation = Relaxation::new(&sector)?;
    let of = |(place, (motion, field)): (usize, (&LargestMotion, &Vec<Vector3<f64>>))| {
        if monitor.is_cancelled() {
            return Err(NotMeasured::Cancelled);
        }
        monitor.progress(place as f64 / motions.len() as f64, PHASE);
        let clearance = motion.clearance.as_deref();
        let neglected = relaxation.relax(field).map(|relaxed| Neglected {
            excess: relaxed.relaxed / relaxed.linear - 1.0,
            gap: clearance.and_then(|clearance| gap(&relaxed, clearance, &reduced.contact)),
        });
        Ok(MeasuredMotion { index: motion.index, displacement: motion.displacement, neglected })
    };
    motions.iter().zip(&fields).enumerate().map(of).collect()
}

/// Computing time of the relaxation of one field, or of the factor and the modes before the first, of a sector with one DOF, s. It grows as the
/// power 3/2 of the DOF: measured at 3,024 and 21,222 DOF (docs/performance.md).
const RELAXING: f64 = 1.8e-6;

/// Computing time of relaxing so many motions of a sector with so many DOF, s.
pub(crate) fn relaxing_seconds(dofs: u32, motions: u32) -> f64 {
    RELAXING * f64::from(dofs).powf(1.5) * f64::from(1 + motions)
}

/// Bytes that measuring so many motions takes at most, for a mesh.
pub fn measuring_bytes(mesh: &SectorMesh, motions: usize) -> u64 {
    HeldSector::bytes(mesh) + fields_bytes(mesh.nodes.len(), motions)
}

/// Bytes that measuring so many motions takes about, at most, for so many elements and DOF.
pub(crate) fn expected_bytes(elements: usize, dofs: usize, motions: usize) -> u64 {
    HeldSector::expected_bytes(elements, dofs) + fields_bytes(dofs.div_ceil(3), motions)
}

pub(super) fn fields_bytes(nodes: usize, motions: usize) -> u64 {
    (200 * nodes * motions) as u64
}

/// Displacements in x, y, z of all nodes, for the sector that each motion moves most, turned into the place of the first sector.
pub(super) fn fields(
    (mesh, nodes): (&SectorMesh, &[SectorNode]),
    reduced: &ReducedWheel,
    motions: &[LargestMotion],
    basis: BasisProduct<'_>,
) -> Result<Vec<Vec<Vector3<f64>>>, NotMeasured> {
    // Own DOF of the sector of each motion, and of the next one, whose low face is this one's high face.
    let mut own: Vec<[Vec<f64>; 2]> = vec![[Vec::new(), Vec::new()]; motions.len()];
    for harmonic in 0..reduced.harmonics.len() {
        let of = |motion: &LargestMotion| {
            motion.coordinates.iter().find(|(of, _)| *of == harmonic).map(|(_, column)| column.clone())
        };
        let columns: Vec<Option<Vec<c64>>> = motions.iter().map(of).collect();
        let Some(unknowns) = columns.iter().flatten().map(Vec::len).next() else { continue };
        let columns = Mat::from_fn(unknowns, motions.len(), |row, column| {
            columns[column].as_ref().map_or(c64::ZERO, |column| column[row])
        });
        let shapes = basis(harmonic, columns.as_ref())?;
        for (column, (motion, own)) in motions.iter().zip(&mut own).enumerate() {
            for (next, own) in own.iter_mut().enumerate() {
                own.resize(shapes.nrows(), 0.0);
                let turn = phase(reduced.sectors, harmonic, motion.sector + next);
                own.iter_mut().enumerate().for_each(|(dof, sum)| *sum += (turn * shapes[(dof, column)]).re);
            }
        }
    }
    own.iter().map(|own| at_nodes((mesh, nodes), own)).collect()
}

/// Displacements in x, y, z of all nodes, for own DOF of the first sector and of the next one, whose low face is its high face.
pub(super) fn at_nodes(
    (mesh, nodes): (&SectorMesh, &[SectorNode]),
    own: &[Vec<f64>; 2],
) -> Result<Vec<Vector3<f64>>, NotMeasured> {
    let frame = AxisFrame::new(mesh.axis.0, mesh.axis.1).ok_or(NotRelaxed::CanMove)?;
    let displacement = |node: &SectorNode| {
        let own = &own[usize::from(node.on_high_face)];
        let mut local = Vector3::zeros();
        for dof in node.dofs.iter().flatten() {
            local += Vector3::from(dof.components) * own.get(dof.dof).copied().unwrap_or(0.0);
        }
        frame.cylindrical(node.coordinates[1]).tr_mul(&local)
    };
    Ok(nodes.iter().map(displacement).collect())
}

/// Largest second-order change of the distance to the casing over the clearance, over the contact nodes that have one.
fn gap(relaxed: &Relaxed, clearance: &[f64], contact: &[ContactNode]) -> Option<f64> {
    let of_nodes = relaxed.to_casing.iter().zip(&relaxed.second_order).zip(clearance.iter().zip(contact));
    of_nodes
        .filter(|&(_, (&clearance, _))| clearance > 0.0)
        .map(|((&[radius, height], &[_, around, _]), (clearance, node))| {
            let [r, t, z] = node.normal;
            (r * radius + t * around + z * height).abs() / clearance
        })
        .reduce(f64::max)
}

/// Phase e^{jisα} of nodal diameter i in sector s.
pub(super) fn phase(sectors: usize, harmonic: usize, sector: usize) -> c64 {
    let (sin, cos) = (TAU * (harmonic * sector % sectors) as f64 / sectors as f64).sin_cos();
    c64::new(cos, sin)
}
