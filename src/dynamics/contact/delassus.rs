//! The Delassus operator W of a tuned wheel: one block-circulant table per speed and step (§7).

use faer::{Mat, c64};

use super::super::modal_wheel::ModalWheel;
use super::super::oscillators::{Oscillators, Rows};
use crate::numerics::complementarity::SymmetricOperator;
use crate::numerics::hermitian::eigenvalues;
use crate::numerics::sector_fourier::SectorFourier;

/// W over all contact nodes of all sectors, index = sector·stride + node (nodes padded to `stride`).
#[derive(Debug, Clone)]
pub(crate) struct Delassus {
    sectors: usize,
    nodes: usize,
    stride: usize,
    /// `[sector distance][column node][row node]`.
    table: Vec<f64>,
    ridge: f64,
}

/// Smallest over largest eigenvalue of W below which its nodes count as indistinguishable.
const SINGULAR: f64 = 1e-10;

impl Delassus {
    /// W = Σ_i w_i² Re(B_i diag(β) B_iᴴ e^{jiα(s−s')}) with B_i = nᵀφ⁽ⁱ⁾ and β = h²/(1 + ζωh).
    ///
    /// Coincident nodes, or a basis that cannot tell two nodes apart, make W singular. A ridge of 1e-10 of its
    /// largest diagonal entry then keeps the forces finite; what it leaves of the gap is reported as penetration.
    pub(crate) fn new(
        wheel: &ModalWheel,
        rows: &Rows,
        oscillators: &Oscillators,
        fourier: &SectorFourier,
    ) -> Self {
        let (sectors, nodes, stride) = (fourier.sectors(), rows.count, rows.stride);
        let mut table = vec![0.0; sectors * nodes * stride];
        let (mut smallest, mut largest) = (f64::INFINITY, 0.0f64);
        for (index, harmonic) in wheel.harmonics.iter().enumerate() {
            let block = harmonic_block(index, rows, oscillators, harmonic.omega.len());
            // A block that cannot be decomposed counts as singular.
            let eigen = eigenvalues(block.as_ref()).unwrap_or_else(|_| vec![0.0; nodes]);
            smallest = smallest.min(eigen[0]);
            largest = largest.max(eigen[nodes - 1]);
            let column = fourier.columns().iter().position(|&(i, _)| i == harmonic.harmonic);
            let column = column.expect("the Fourier basis has every nodal diameter");
            let first = fourier.row(0)[column];
            for distance in 0..sectors {
                // Row 0 of a cosine column is w, of a sine column 0: F[0]·F[δ] gives w² cos and −w² sin.
                let cos = first * fourier.row(distance)[column];
                let sin = if harmonic.single { 0.0 } else { -first * fourier.row(distance)[column + 1] };
                for from in 0..nodes {
                    for to in 0..nodes {
                        let value = block[(to, from)];
                        table[(distance * nodes + from) * stride + to] += value.re * cos - value.im * sin;
                    }
                }
            }
        }
        let diagonal = (0..nodes).map(|k| table[k * stride + k]).fold(0.0, f64::max);
        let ridge = if smallest <= SINGULAR * largest { SINGULAR * diagonal } else { 0.0 };
        Self { sectors, nodes, stride, table, ridge }
    }

    fn place(&self, index: usize) -> (usize, usize) {
        (index / self.stride, index % self.stride)
    }

    fn column(&self, distance: usize, node: usize) -> &[f64] {
        &self.table[(distance * self.nodes + node) * self.stride..][..self.stride]
    }
}

/// B diag(β) Bᴴ of one nodal diameter, `nodes × nodes`.
fn harmonic_block(index: usize, rows: &Rows, oscillators: &Oscillators, modes: usize) -> Mat<c64> {
    let receptance = oscillators.receptance(index);
    Mat::from_fn(rows.count, rows.count, |to, from| {
        let (a_re, a_im) = rows.row(index, to);
        let (b_re, b_im) = rows.row(index, from);
        (0..modes)
            .map(|m| c64::new(a_re[m], a_im[m]) * c64::new(b_re[m], -b_im[m]) * receptance[m])
            .sum::<c64>()
    })
}

impl SymmetricOperator for Delassus {
    fn size(&self) -> usize {
        self.sectors * self.stride
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let ((to_sector, to), (from_sector, from)) = (self.place(i), self.place(j));
        let distance = (to_sector + self.sectors - from_sector) % self.sectors;
        self.column(distance, from)[to] + if i == j { self.ridge } else { 0.0 }
    }

    #[inline(always)]
    fn add_column(&self, j: usize, scale: f64, out: &mut [f64]) {
        let (from_sector, from) = self.place(j);
        // Sectors from `from_sector` on are 0, 1, 2 … away, those before it follow around the wheel.
        let (before, onwards) = out.split_at_mut(from_sector * self.stride);
        let targets = onwards.chunks_exact_mut(self.stride).chain(before.chunks_exact_mut(self.stride));
        let block = self.nodes * self.stride;
        let columns = self.table.chunks_exact(block).map(|block| &block[from * self.stride..][..self.stride]);
        for (out, column) in targets.zip(columns) {
            for (out, w) in out.iter_mut().zip(column) {
                *out += w * scale;
            }
        }
    }
}
