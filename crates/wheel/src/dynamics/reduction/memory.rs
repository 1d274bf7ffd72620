//! What a reduction will need, before it starts.

use super::speed::{COMPARED, TOGETHER};
use super::untied::UntiedSector;
use crate::dynamics::sector::{CyclicMatrix, SectorModel};

/// Krylov vectors per mode asked for, seen over many sectors, with a margin.
const KRYLOV_VECTORS_PER_MODE: usize = 8;

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
    // Between the given speeds all of K(Ω)'s matrices meet: their entries, sorted columns, the sum.
    let assembly = ENTRY * (2 * speeds + 1) * stiffness;
    let factor = REAL * (untied.analysis.factor_entries() + untied.analysis.working_entries());
    let boundary = untied.face() + untied.contact();
    let tied = COMPLEX * boundary * boundary * harmonics;
    let rows = untied.internal() + untied.contact();
    let krylov_vectors = KRYLOV_VECTORS_PER_MODE * modes_per_speed.max(COMPARED);
    let krylov = COMPLEX * rows * harmonics.min(TOGETHER) * krylov_vectors;
    // Modes at every speed and static modes; while they are projected, the bases made of them too.
    let kept = COMPLEX * rows * harmonics * (speeds * modes_per_speed + untied.contact());
    let search = ENTRY * stiffness + factor + tied + krylov;
    (given + ENTRY * mass + kept + assembly.max(search).max(kept + ENTRY * stiffness)) as u64
}
