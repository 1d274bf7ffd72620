//! Sector with its faces untied: one set of real matrices for every nodal diameter (docs/method.md, From a sector to harmonic matrices).
//!
//! Rows are the interior in elimination order, the low face, the high face, the contact DOF (and the high copies of
//! those of them that lie on the low face). A nodal diameter ties the high face to the low one, u_H = e^{jiα} u_L; its
//! vectors hold interior, low face and contact DOF:
//!
//! ```text
//! untied  [ I | L | H | b ]        tied  [ I | L | b ],  u_H = e^{jiα} u_L        Ŷ(i) = Tᴴ Y T
//! ```
//!
//! Nodes on the axis stand among the low face, without a copy on the high one. Their displacement u in the components of one sector is
//! that of the next one, R(α)ᵀu = e^{jiα}u: u = q e_z for i = 0, u = q (e_1 + j e_2)/√2 for i = 1, and u = 0 for others, where T leaves their rows no motion.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use faer::sparse::SparseColMat;
use faer::{Mat, MatRef, c64};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::ordering::interior_order;
use crate::dynamics::sector::{AxisNode, CyclicMatrix, SectorModel};
use rubmap_numerics::multifrontal::{Analysis, postorder};

use rubmap_numerics::panel::Panel;
use rubmap_numerics::sector_fourier::is_single;
use rubmap_numerics::sparse_product::row_product;
use rubmap_numerics::vector_block::VectorBlock;

/// Tie of the faces, and of the sectors at the axis, by one nodal diameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tie {
    /// Nodal diameter i.
    pub(super) harmonic: usize,
    /// Phase e^{jiα} from face to face.
    phase: c64,
    /// Motion of nodes on the axis across it.
    across: Across,
    /// Whether the vectors of the nodal diameter are real.
    single: bool,
}

/// Motion of nodes on the axis across it.
#[derive(Debug, Clone, Copy)]
enum Across {
    /// No motion.
    Held,
    /// Both directions on their own: the turn by one sector reverses both, or neither.
    Free,
    /// One coordinate that moves both directions by these factors.
    Wave([c64; 2]),
}

/// Numbering of the untied rows, and the analysis of their factorisation.
#[derive(Debug)]
pub(super) struct UntiedSector {
    sectors: usize,
    /// Number of rows of the interior.
    interior: usize,
    /// Number of rows of one face.
    face: usize,
    /// Number of contact DOF.
    contact: usize,
    /// Contact DOF that lie on the low face: their high copies come last.
    shared: Vec<usize>,
    /// Nodes on the axis, by their rows on the low face.
    axis: Vec<AxisNode>,
    /// Untied row of each own DOF.
    pub(super) place: Vec<usize>,
    /// Row on the high face of each low-face DOF; the DOF's own row elsewhere.
    pub(super) high: Vec<usize>,
    /// Elimination of the interior, for every matrix of the sector.
    pub(super) analysis: Analysis,
}

impl UntiedSector {
    /// Numbers and analyses the sector for `matrices` and their combinations.
    pub(super) fn new(sector: &SectorModel, matrices: &[&CyclicMatrix]) -> Self {
        let own = sector.own_dofs();
        let contact: Vec<usize> = sector.contact.iter().flat_map(|node| node.dofs).collect();
        let mut on_low = vec![false; own];
        for matrix in matrices {
            for (column, on_low) in on_low.iter_mut().enumerate() {
                *on_low |= !matrix.next.row_idx_of_col_raw(column).is_empty();
            }
        }
        for dof in sector.axis.iter().flat_map(AxisNode::rows).flatten() {
            on_low[dof] = true;
        }
        let mut inside: Vec<bool> = on_low.iter().map(|low| !low).collect();
        contact.iter().for_each(|&dof| inside[dof] = false);
        let interior: Vec<usize> = interior_order(sector, matrices, &inside);
        let shared: Vec<usize> = (0..contact.len()).filter(|&k| on_low[contact[k]]).collect();
        contact.iter().for_each(|&dof| on_low[dof] = false);
        let low: Vec<usize> = (0..own).filter(|&dof| on_low[dof]).collect();
        let mut untied = Self {
            sectors: sector.sectors,
            interior: interior.len(),
            face: low.len(),
            contact: contact.len(),
            shared,
            axis: Vec::new(),
            place: vec![usize::MAX; own],
            high: Vec::new(),
            analysis: Analysis::default(),
        };
        let rows = interior.iter().chain(&low);
        rows.enumerate().for_each(|(row, &dof)| untied.place[dof] = row);
        let on_low = |dof: usize| untied.place[dof] - interior.len();
        let face_rows = |node: &AxisNode| AxisNode {
            axial: node.axial.map(on_low),
            lateral: node.lateral.map(|dof| dof.map(on_low)),
        };
        untied.axis = sector.axis.iter().map(face_rows).collect();
        let first_contact = interior.len() + 2 * low.len();
        contact.iter().enumerate().for_each(|(k, &dof)| untied.place[dof] = first_contact + k);
        untied.high = untied.place.clone();
        low.iter().for_each(|&dof| untied.high[dof] += low.len());
        let after = first_contact + contact.len();
        untied.shared.iter().enumerate().for_each(|(row, &k)| untied.high[contact[k]] = after + row);

        let pattern = untied.pattern(matrices);
        let order = postorder(pattern.as_ref(), 0..untied.interior);
        let mut new_row = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| new_row[old] = new);
        untied.place.iter_mut().chain(&mut untied.high).for_each(|row| *row = new_row[*row]);
        untied.analysis = Analysis::new(untied.pattern(matrices).as_ref(), untied.interior);
        untied
    }

    /// Number of rows of untied matrices.
    pub(super) fn size(&self) -> usize {
        self.interior + 2 * self.face + self.contact + self.shared.len()
    }

    /// Number of rows of the interior.
    pub(super) fn interior(&self) -> usize {
        self.interior
    }

    /// Number of rows of one face.
    pub(super) fn face(&self) -> usize {
        self.face
    }

    /// Number of contact DOF n_b.
    pub(super) fn contact(&self) -> usize {
        self.contact
    }

    /// Number of internal rows n_i of tied vectors: interior and low face.
    pub(super) fn internal(&self) -> usize {
        self.interior + self.face
    }

    /// Tie of nodal diameter `harmonic`.
    pub(super) fn tie(&self, harmonic: usize) -> Tie {
        let angle = TAU * harmonic as f64 / self.sectors as f64;
        let single = is_single(harmonic, self.sectors);
        // Exactly real where the nodal diameter is.
        let phase = match harmonic {
            0 => c64::new(1.0, 0.0),
            _ if single => c64::new(-1.0, 0.0),
            _ => c64::new(angle.cos(), angle.sin()),
        };
        let across = match (harmonic, self.sectors) {
            (_, 1) | (1, 2) => Across::Free,
            (1, _) => Across::Wave([c64::new(FRAC_1_SQRT_2, 0.0), c64::new(0.0, FRAC_1_SQRT_2)]),
            _ => Across::Held,
        };
        Tie { harmonic, phase, across, single }
    }

    /// Tied row and factor of every boundary row (low face, high face, contact), u_F = T u: rows count from the
    /// first face row.
    pub(super) fn boundary(&self, tie: &Tie) -> Vec<(usize, c64)> {
        let one = c64::new(1.0, 0.0);
        let low = (0..self.face).map(|row| (row, one));
        let high = (0..self.face).map(|row| (row, tie.phase));
        let contact = (0..self.contact).map(|row| (self.face + row, one));
        let shared = self.shared.iter().map(|&row| (self.face + row, tie.phase));
        let mut rows: Vec<(usize, c64)> = low.chain(high).chain(contact).chain(shared).collect();
        for node in &self.axis {
            for row in node.rows().into_iter().flatten() {
                rows[row].1 = c64::ZERO;
                rows[self.face + row].1 = c64::ZERO;
            }
            for (row, image) in tie.on_axis(node) {
                rows[row] = image;
            }
        }
        rows
    }

    /// Tied rows on which a nodal diameter leaves no motion: directions of nodes on the axis.
    pub(super) fn held(&self, tie: &Tie) -> Vec<usize> {
        let mut held = Vec::new();
        for node in &self.axis {
            let moved: Vec<usize> = tie.on_axis(node).map(|(_, (row, _))| row).collect();
            held.extend(node.rows().into_iter().flatten().filter(|row| !moved.contains(row)));
        }
        held.iter_mut().for_each(|row| *row += self.interior);
        held
    }

    /// Whether nodes lie on the axis.
    pub(super) fn has_axis(&self) -> bool {
        !self.axis.is_empty()
    }

    /// Tied row that moves an own DOF, and the factor from one to the other.
    pub(super) fn tied_row(&self, tie: &Tie, dof: usize) -> (usize, c64) {
        let row = self.place[dof];
        match row.checked_sub(self.interior) {
            None => (row, c64::ONE),
            Some(row) if row < self.face => {
                let (tied, factor) = self.face_row(tie, row);
                (self.interior + tied, factor)
            }
            Some(row) => (self.interior + row - self.face, c64::ONE),
        }
    }

    /// Tied row and factor of a row of the low face, both counted from its first.
    fn face_row(&self, tie: &Tie, row: usize) -> (usize, c64) {
        let is_of = |node: &&AxisNode| node.rows().contains(&Some(row));
        let Some(node) = self.axis.iter().find(is_of) else { return (row, c64::ONE) };
        tie.on_axis(node).find(|&(moved, _)| moved == row).map_or((row, c64::ZERO), |(_, image)| image)
    }

    /// Own DOF of a tied row.
    pub(super) fn dof_of(&self, tied: usize) -> usize {
        let row = if tied < self.internal() { tied } else { tied + self.face };
        self.place
            .iter()
            .position(|&place| place == row)
            .unwrap_or_else(|| unreachable!("every row has a DOF"))
    }

    /// Whether boundary row `row` (see [`boundary`](Self::boundary)) is a copy on the high face.
    pub(super) fn is_high(&self, row: usize) -> bool {
        (self.face..2 * self.face).contains(&row) || row >= 2 * self.face + self.contact
    }

    /// Whether the vectors of a nodal diameter can be real.
    pub(super) fn is_real(tie: &Tie) -> bool {
        tie.single
    }

    /// Writes T x for tied vectors `x` into the vectors of `into` from number `first` on. Contact rows missing in `x` are
    /// zero.
    pub(super) fn expand(&self, tie: &Tie, x: &VectorBlock, into: &mut Panel, first: usize) {
        let parts = x.parts();
        for row in 0..self.interior {
            into.row_mut(row)[first..][..parts.width()].copy_from_slice(parts.row(row));
        }
        let count = x.count();
        for (row, &(tied, factor)) in self.boundary(tie).iter().enumerate() {
            let tied = self.interior + tied;
            if tied < x.size() {
                let to = &mut into.row_mut(self.interior + row)[first..][..parts.width()];
                for q in 0..count {
                    let value = x.get(tied, q) * factor;
                    to[q] = value.re;
                    if !tie.single {
                        to[count + q] = value.im;
                    }
                }
            }
        }
    }

    /// Folds Tᴴ y from the untied vectors of `y` from number `first` on that stand for `count` tied ones, the first `rows` rows of these.
    pub(super) fn fold(&self, tie: &Tie, y: &Panel, first: usize, count: usize, rows: usize) -> VectorBlock {
        let mut folded = VectorBlock::zeros(count, rows, tie.single);
        let width = folded.parts().width();
        for row in 0..self.interior {
            folded.parts_mut().row_mut(row).copy_from_slice(&y.row(row)[first..][..width]);
        }
        for (row, (tied, factor)) in self.boundary(tie).into_iter().enumerate() {
            let tied = self.interior + tied;
            if tied < rows {
                let from = &y.row(self.interior + row)[first..][..width];
                for q in 0..count {
                    let value = c64::new(from[q], if tie.single { 0.0 } else { from[count + q] });
                    folded.set(tied, q, folded.get(tied, q) + value * factor.conj());
                }
            }
        }
        folded
    }

    /// Product Ŷ(i) x for tied vectors `x`, with `matrix` the untied Yᵀ, which is Y for all but the gyroscopic matrix; as many rows as `x`
    /// has. Columns in parallel.
    pub(super) fn product(
        &self,
        matrix: &SparseColMat<usize, f64>,
        tie: &Tie,
        x: MatRef<'_, c64>,
    ) -> Mat<c64> {
        const COLUMNS: usize = 12;
        let parts: Vec<VectorBlock> = (0..x.ncols().div_ceil(COLUMNS))
            .into_par_iter()
            .map(|part| {
                let first = part * COLUMNS;
                let columns = x.subcols(first, COLUMNS.min(x.ncols() - first));
                let columns = VectorBlock::of(columns, tie.single);
                let mut panel = Panel::zeros(columns.parts().width(), self.size());
                self.expand(tie, &columns, &mut panel, 0);
                self.fold(tie, &row_product(matrix, &panel), 0, columns.count(), x.nrows())
            })
            .collect();
        let mut product = Mat::zeros(x.nrows(), x.ncols());
        for (part, columns) in parts.iter().enumerate() {
            columns.copy_to(0, product.subcols_mut(part * COLUMNS, columns.count()));
        }
        product
    }

    /// Block of Ŷ(i), its first `rows` rows and columns, with `matrix` the untied Y; `held` on the diagonal of rows without motion.
    pub(super) fn tied_dense(
        &self,
        matrix: &SparseColMat<usize, f64>,
        tie: &Tie,
        rows: usize,
        held: f64,
    ) -> Mat<c64> {
        let boundary = self.boundary(tie);
        let place = |row: usize| match row.checked_sub(self.interior) {
            None => (row, c64::new(1.0, 0.0)),
            Some(row) => (self.interior + boundary[row].0, boundary[row].1),
        };
        let mut dense = Mat::zeros(rows, rows);
        for entry in matrix.triplet_iter() {
            let ((row, left), (column, right)) = (place(entry.row), place(entry.col));
            if row < rows && column < rows {
                dense[(row, column)] += left.conj() * right * *entry.val;
            }
        }
        self.held(tie).into_iter().for_each(|row| dense[(row, row)] = c64::new(held, 0.0));
        dense
    }
}

impl Tie {
    /// Rows of a node on the axis that can move, each with the row that moves it and the factor from one to the other.
    fn on_axis(&self, node: &AxisNode) -> impl Iterator<Item = (usize, (usize, c64))> + use<> {
        let own = |row: Option<usize>| row.map(|row| (row, (row, c64::ONE)));
        let axial = if self.harmonic == 0 { own(node.axial) } else { None };
        let lateral = match (self.across, node.lateral) {
            (Across::Free, rows) => rows.map(own),
            (Across::Wave(factors), [Some(first), Some(second)]) => {
                [Some((first, (first, factors[0]))), Some((second, (first, factors[1])))]
            }
            // A wave needs both directions.
            (Across::Wave(_) | Across::Held, _) => [None; 2],
        };
        [axial, lateral[0], lateral[1]].into_iter().flatten()
    }

    /// Tie by the magnitudes of all phases and factors.
    pub(super) fn magnitudes(&self) -> Self {
        let across = match self.across {
            Across::Wave(factors) => Across::Wave(factors.map(|factor| c64::new(factor.norm(), 0.0))),
            other => other,
        };
        Self { phase: c64::ONE, across, single: true, ..*self }
    }
}
