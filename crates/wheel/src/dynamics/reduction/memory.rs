//! Memory that a reduction will need, estimated before it starts.

use super::speed::{BEYOND_COMPARED, COMPARED, TOGETHER};
use super::untied::UntiedSector;
use crate::dynamics::sector::{CyclicMatrix, SectorModel};

/// Number of Krylov vectors per mode asked for, seen over many sectors, with a margin.
const KRYLOV_VECTORS_PER_MODE: usize = 6;

/// Bytes held at once by the sector's own matrices and its reduction, from the symbolic factorisation. An estimate:
/// searches that converge slowly need more.
pub(super) fn needed_bytes(
    sector: &SectorModel,
    untied: &UntiedSector,
    modes_per_speed: usize,
    harmonics: usize,
) -> u64 {
    const REAL: usize = size_of::<f64>();
    const COMPLEX: usize = 2 * REAL;
    // A value and a row.
    const ENTRY: usize = 2 * REAL;
    let entries = |matrix: &CyclicMatrix| matrix.own.compute_nnz() + 2 * matrix.next.compute_nnz();
    let (mass, stiffness) = (entries(&sector.mass), entries(&sector.stiffness[0]));
    let speeds = sector.stiffness.len();
    let gyroscopic = sector.gyroscopic.as_ref().map_or(0, entries);
    let given = ENTRY * (mass + speeds * stiffness + gyroscopic);
    // Between the given speeds all of K(Ω)'s matrices meet: their entries and the sorted columns.
    let assembly = ENTRY * (speeds + 1) * stiffness;
    let factor = REAL * (untied.analysis.factor_entries() + untied.analysis.working_entries());
    let boundary = untied.face() + untied.contact();
    let tied = COMPLEX * boundary * boundary * harmonics;
    let rows = untied.internal() + untied.contact();
    // Those of the basis and of the full sector at the same time.
    let compared = COMPARED + BEYOND_COMPARED;
    let krylov_vectors = KRYLOV_VECTORS_PER_MODE * (modes_per_speed + compared);
    let krylov = COMPLEX * rows * harmonics.min(TOGETHER) * krylov_vectors;
    // Modes at every speed and static modes; while they are projected, the bases made of them too.
    let kept = COMPLEX * rows * harmonics * (speeds * modes_per_speed + untied.contact());
    // Of the full sector, until the frequencies between the speeds are known.
    let full = COMPLEX * rows * harmonics * speeds * compared;
    // Between the speeds: what is tried, with its images under three matrices, and corrections.
    let trial = COMPLEX * rows * 4 * (speeds + 1) * compared;
    let at_speed = ENTRY * stiffness + factor + tied;
    let until_then = at_speed + krylov.max(assembly).max(ENTRY * stiffness + trial) + full;
    (given + ENTRY * mass + kept + until_then.max(kept + ENTRY * stiffness)) as u64
}
