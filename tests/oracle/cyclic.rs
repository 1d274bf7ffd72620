//! Harmonic matrices of the wheel: Ŷ(i) = Y0 + Y1 e^{jiα} + Y1ᵀ e^{−jiα}, α = 2π/N (docs/method.md, From a sector
//! to harmonic matrices; Eqs 1, 2).
//!
//! The paper writes the same Hermitian operator as a doubled real matrix; in complex form it is half the size and
//! does not double every eigenvalue.

use std::f64::consts::TAU;

use faer::c64;
use faer::sparse::{SparseColMat, Triplet};

use rubmap::dynamics::sector::CyclicMatrix;

/// Partition of the rows of Ŷ into internal (with the low face) and contact DOF (Eq. 1).
#[derive(Debug, Clone)]
pub(crate) struct Partition {
    /// Own DOF index of each internal row.
    pub(crate) internal: Vec<usize>,
    /// Own DOF index of each contact row: r, θ, z of every contact node.
    pub(crate) contact: Vec<usize>,
    place: Vec<Place>,
}

#[derive(Debug, Clone, Copy)]
enum Place {
    Internal(usize),
    Contact(usize),
}

impl Partition {
    /// Splits `size` own DOF; all but `contact` are internal.
    pub(crate) fn new(size: usize, contact: Vec<usize>) -> Self {
        let mut place = vec![Place::Internal(0); size];
        for (position, &dof) in contact.iter().enumerate() {
            place[dof] = Place::Contact(position);
        }
        let mut internal = Vec::with_capacity(size - contact.len());
        for (dof, place) in place.iter_mut().enumerate() {
            if let Place::Internal(position) = place {
                *position = internal.len();
                internal.push(dof);
            }
        }
        Self { internal, contact, place }
    }
}

/// Blocks of Ŷ(i): internal first, contact second; Ŷ_bi = Ŷ_ibᴴ.
#[derive(Debug, Clone)]
pub(crate) struct HarmonicMatrix {
    /// Internal block Ŷ_ii, `n_i × n_i`, both triangles.
    pub(crate) internal: SparseColMat<usize, c64>,
    /// Coupling block Ŷ_ib, `n_i × n_b`.
    pub(crate) coupling: SparseColMat<usize, c64>,
    /// Contact block Ŷ_bb, `n_b × n_b`.
    pub(crate) contact: SparseColMat<usize, c64>,
}

/// Matrix Ŷ(i) of nodal diameter `harmonic` for a wheel of `sectors`.
pub(crate) fn harmonic_matrix(
    matrix: &CyclicMatrix,
    harmonic: usize,
    sectors: usize,
    partition: &Partition,
) -> HarmonicMatrix {
    let phase = phase(harmonic, sectors);
    let (n_i, n_b) = (partition.internal.len(), partition.contact.len());
    let mut internal = Vec::with_capacity(matrix.own.compute_nnz());
    let mut coupling = Vec::new();
    let mut contact = Vec::new();
    let mut add =
        |row: usize, column: usize, value: c64| match (partition.place[row], partition.place[column]) {
            (Place::Internal(r), Place::Internal(c)) => internal.push(Triplet::new(r, c, value)),
            (Place::Internal(r), Place::Contact(c)) => coupling.push(Triplet::new(r, c, value)),
            (Place::Contact(r), Place::Contact(c)) => contact.push(Triplet::new(r, c, value)),
            (Place::Contact(_), Place::Internal(_)) => {}
        };
    for entry in matrix.own.triplet_iter() {
        add(entry.row, entry.col, c64::new(*entry.val, 0.0));
    }
    for entry in matrix.next.triplet_iter() {
        add(entry.row, entry.col, phase * *entry.val);
        add(entry.col, entry.row, phase.conj() * *entry.val);
    }
    let assemble = |rows, columns, triplets: &[Triplet<usize, usize, c64>]| {
        SparseColMat::try_new_from_triplets(rows, columns, triplets)
            .expect("a partition keeps indices in range")
    };
    HarmonicMatrix {
        internal: assemble(n_i, n_i, &internal),
        coupling: assemble(n_i, n_b, &coupling),
        contact: assemble(n_b, n_b, &contact),
    }
}

/// Phase e^{jiα}, exactly real where the harmonic is.
fn phase(harmonic: usize, sectors: usize) -> c64 {
    if harmonic == 0 {
        c64::new(1.0, 0.0)
    } else if 2 * harmonic == sectors {
        c64::new(-1.0, 0.0)
    } else {
        let angle = TAU * harmonic as f64 / sectors as f64;
        c64::new(angle.cos(), angle.sin())
    }
}
