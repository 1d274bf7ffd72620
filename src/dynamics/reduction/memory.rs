//! What a reduction will need, before it starts.

use super::speed::{COMPARED, TOGETHER};
use super::untied::UntiedSector;
use crate::dynamics::sector::SectorModel;

/// Krylov vectors per mode asked for, seen over many sectors, with a margin.
const KRYLOV_VECTORS_PER_MODE: usize = 8;

/// Bytes held at once by the sector's own matrices and its reduction, at most. An estimate from the symbolic
/// factorisation: within some ten per cent of what is used.
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
    let entries = |matrix: &crate::dynamics::sector::CyclicMatrix| {
        matrix.own.compute_nnz() + 2 * matrix.next.compute_nnz()
    };
    let mass = entries(&sector.mass);
    let stiffness = sector.stiffness.iter().map(entries).max().unwrap_or(0);
    let given = ENTRY * (mass + sector.stiffness.iter().map(entries).sum::<usize>());
    // Untied M and K, and another K while it is put together.
    let matrices = ENTRY * (mass + 2 * stiffness);
    let factor = REAL * (untied.analysis.factor_entries() + untied.analysis.working_entries());
    let boundary = untied.face() + untied.contact();
    let tied = COMPLEX * boundary * boundary * harmonics;
    let together = harmonics.min(TOGETHER);
    let rows = untied.internal() + untied.contact();
    let krylov = COMPLEX * rows * together * KRYLOV_VECTORS_PER_MODE * modes_per_speed.max(COMPARED);
    let kept = COMPLEX * rows * harmonics * (sector.stiffness.len() * modes_per_speed + untied.contact());
    (given + matrices + factor + tied + krylov + kept) as u64
}
