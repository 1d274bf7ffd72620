//! Second-order bending of the blades of a model: its coordinates, and all that is condensed on them (docs/method.md, Blades that bend far).
//!
//! Coordinates are amplitudes of the shapes Ψ that the lowest families of all nodal diameters have in common: the leading ones of an SVD of
//! their displacements in a sector, weighted by the mass of its free nodes and by 1/ω, so that all have the same energy.

use faer::{Mat, c64};
use nalgebra::Vector3;

use super::condense::condense;
use super::measure::{NotMeasured, at_nodes, expected_bytes, fields_bytes, phase, relaxing_seconds};
use super::relax::NotRelaxed;
use super::sector::HeldSector;
use crate::fields::BasisProduct;
use crate::model::ModelFacts;
use crate::monitor::Monitor;
use crate::resolved::ResolvedSweep;
use crate::result::{CostRange, Estimate};
use rubmap_numerics::dense::Dense;
use rubmap_numerics::sparse_cholesky::SparseCholesky;
use rubmap_solid::mesh::SectorMesh;
use rubmap_wheel::dynamics::bending::{BladeBending, products};
use rubmap_wheel::dynamics::direction::COMPONENTS;
use rubmap_wheel::dynamics::modal_wheel::natural_modes;
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::reduction::ReducedWheel;

/// Projection Υ̂_iᴴ f of a load on the own DOF to the unknowns of nodal diameter i.
pub type BasisProjection<'a> = &'a mut dyn FnMut(usize, &[f64]) -> std::io::Result<Vec<c64>>;

/// Phase of a job that makes second-order bending, in words.
const PHASE: &str = "bending of the blades";

/// Computes the second-order bending of the wheel that `mesh` and `nodes`, in the same order, are a sector of, in so many `coordinates`.
///
/// # Errors
/// A basis that cannot be read; a sector without a factor; cancellation.
pub fn blade_bending(
    (mesh, nodes): (&SectorMesh, &[SectorNode]),
    reduced: &ReducedWheel,
    coordinates: usize,
    (product, project): (BasisProduct<'_>, BasisProjection<'_>),
    monitor: &dyn Monitor,
) -> Result<BladeBending, NotMeasured> {
    monitor.progress(0.0, PHASE);
    let sector = HeldSector::new(mesh, nodes).ok_or(NotRelaxed::CanMove)?;
    let factor = SparseCholesky::new(&sector.symbolic, &sector.stiffness).map_err(NotRelaxed::from)?;
    let families = families((mesh, nodes), reduced, coordinates, product)?;
    let shapes = common_shapes(&sector, &families, coordinates).map_err(NotRelaxed::from)?;
    if monitor.is_cancelled() {
        return Err(NotMeasured::Cancelled);
    }
    monitor.progress(0.5, PHASE);
    let condensed = condense(&sector, &factor, &shapes);
    let own_dofs = nodes.iter().flat_map(|node| node.dofs.iter().flatten()).map(|dof| dof.dof + 1).max();
    let readers: Vec<Vec<f64>> = shapes
        .iter()
        .map(|shape| {
            let mut load = vec![0.0; own_dofs.unwrap_or(0)];
            let weighted = weighted(&sector, shape);
            sector.own.iter().zip(weighted).for_each(|(&dof, value)| load[dof] += value);
            load
        })
        .collect();
    let mut rows = Vec::with_capacity(reduced.harmonics.len());
    for harmonic in 0..reduced.harmonics.len() {
        let of: Vec<Vec<c64>> =
            readers.iter().map(|load| project(harmonic, load)).collect::<Result<_, _>>()?;
        rows.push(Mat::from_fn(of.len(), of.first().map_or(0, Vec::len), |j, unknown| of[j][unknown].conj()));
    }
    let at_contact = |fields: &[Vec<Vector3<f64>>]| {
        let rows = COMPONENTS * sector.contact.len();
        Mat::from_fn(rows, fields.len(), |row, field| {
            let place = &sector.contact[row / COMPONENTS];
            place.directions[row % COMPONENTS].dot(&fields[field][place.node as usize])
        })
    };
    Ok(BladeBending {
        asked: coordinates,
        rows,
        linear: at_contact(&shapes),
        second_order: at_contact(&condensed.second_order),
        potential: condensed.potential,
        inertia: condensed.inertia,
    })
}

/// Bytes that making the bending in so many coordinates takes at most, for a mesh.
pub fn bending_bytes(mesh: &SectorMesh, coordinates: usize) -> u64 {
    HeldSector::bytes(mesh) + fields_bytes(mesh.nodes.len(), fields_at_once(mesh.sectors, coordinates))
}

/// Number of fields that are held at a time: families at two instants in every nodal diameter, loads and displacements of every product.
fn fields_at_once(sectors: usize, coordinates: usize) -> usize {
    2 * coordinates * (sectors / 2 + 1) + 2 * products(coordinates).count()
}

/// Seconds that making the bending in so many coordinates takes: a factor, and a solution for each product and coordinate.
pub(crate) fn bending_seconds(coordinates: u32, facts: &ModelFacts) -> f64 {
    let solutions = f64::from(coordinates) + products(coordinates as usize).count() as f64;
    relaxing_seconds(facts.own_dofs, 0) * (1.0 + solutions / SOLUTIONS_PER_FACTOR)
}

/// Cost of a sweep with that of making the bending of second order, if its scene has it.
pub(crate) fn with_bending_cost(all: Estimate, request: &ResolvedSweep, facts: &ModelFacts) -> Estimate {
    let (Some(mesh), Some(coordinates)) = (&facts.mesh, request.bending_coordinates()) else { return all };
    let seconds = bending_seconds(coordinates, facts);
    let coordinates = coordinates as usize;
    let once = CostRange { free: seconds, contact: seconds };
    let (dofs, fields) = (facts.own_dofs as usize, fields_at_once(facts.sectors as usize, coordinates));
    all.followed_by(Estimate {
        steps: 0,
        computing_time_s: once,
        wall_time_s: once,
        workers: 1,
        memory_bytes: expected_bytes(mesh.elements as usize, dofs, fields),
        speed_memory_bytes: 0,
    })
}

/// Number of solutions that take about as long as the factor.
const SOLUTIONS_PER_FACTOR: f64 = 50.0;

/// Displacements of all nodes in so many of the lowest modes at rest of every nodal diameter, at two instants a quarter of a period apart,
/// times 1/ω.
fn families(
    of: (&SectorMesh, &[SectorNode]),
    reduced: &ReducedWheel,
    count: usize,
    product: BasisProduct<'_>,
) -> Result<Vec<Vec<Vector3<f64>>>, NotMeasured> {
    let mut families = Vec::new();
    for harmonic in 0..reduced.harmonics.len() {
        let (omega, shapes) = natural_modes(reduced, harmonic, 0.0, false)
            .map_err(|error| NotMeasured::Relaxed(error.to_string()))?;
        let count = count.min(shapes.ncols());
        let own = product(harmonic, shapes.subcols(0, count))?;
        for (mode, &omega) in omega.iter().enumerate().take(count) {
            for instant in [c64::ONE, c64::new(0.0, 1.0)] {
                let turned = [0, 1].map(|next| {
                    let turn = instant * phase(reduced.sectors, harmonic, next) / omega;
                    (0..own.nrows()).map(|dof| (turn * own[(dof, mode)]).re).collect::<Vec<f64>>()
                });
                families.push(at_nodes(of, &turned)?);
            }
        }
    }
    Ok(families)
}

/// Shapes that fields have in common, orthonormal in the mass of the free nodes: the leading left singular vectors, at most `count`.
fn common_shapes(
    sector: &HeldSector,
    fields: &[Vec<Vector3<f64>>],
    count: usize,
) -> Result<Vec<Vec<Vector3<f64>>>, rubmap_numerics::hermitian::EigenError> {
    let weighted: Vec<Vec<f64>> = fields.iter().map(|field| weighted(sector, field)).collect();
    let free: Vec<Vec<f64>> = fields.iter().map(|field| sector.gathered(field)).collect();
    let gram: Mat<f64> = Mat::from_fn(fields.len(), fields.len(), |a, b| {
        free[a].iter().zip(&weighted[b]).map(|(u, m)| u * m).sum()
    });
    let pairs = Dense::eigenpairs(gram.as_ref())?;
    let largest = pairs.values.last().copied().unwrap_or(0.0);
    let leading = (0..fields.len()).rev().take(count).filter(|&at| pairs.values[at] > NOISE * largest);
    let shape = |at: usize| {
        let mut sum = vec![Vector3::zeros(); fields.first().map_or(0, Vec::len)];
        for (field, share) in fields.iter().zip(pairs.vectors.col(at).iter()) {
            let share = share / pairs.values[at].sqrt();
            sum.iter_mut().zip(field).for_each(|(sum, u)| *sum += u * share);
        }
        sum
    };
    Ok(leading.map(shape).collect())
}

/// Share of the largest singular value, squared, below which a shape is round-off.
const NOISE: f64 = 1e-12;

/// Product of the mass with the free displacements of a field.
fn weighted(sector: &HeldSector, field: &[Vector3<f64>]) -> Vec<f64> {
    let free = sector.gathered(field);
    let free = faer::ColRef::from_slice(&free);
    let product = &sector.mass * free;
    product.iter().copied().collect()
}
