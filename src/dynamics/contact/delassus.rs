//! The contact operator of a tuned wheel: one block-circulant table per speed and step (§7).

use faer::{Mat, c64};

use super::flexibility::ridge;
use crate::numerics::complementarity::SymmetricOperator;
use crate::numerics::sector_fourier::{SectorFourier, is_single};

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

impl Delassus {
    /// W = Σ_i w_i² Re(W_i e^{jiα(s−s')}) from the `nodes × nodes` blocks W_i of the nodal diameters, with a
    /// [`ridge`] if they are singular.
    pub(crate) fn new(blocks: &[Mat<c64>], stride: usize, fourier: &SectorFourier) -> Self {
        let (sectors, nodes) = (fourier.sectors(), blocks[0].nrows());
        let mut table = vec![0.0; sectors * nodes * stride];
        let mut column = 0;
        for (harmonic, block) in blocks.iter().enumerate() {
            let single = is_single(harmonic, sectors);
            let first = fourier.row(0)[column];
            for distance in 0..sectors {
                // Row 0 of a cosine column is w, of a sine column 0: F[0]·F[δ] gives w² cos and −w² sin.
                let cos = first * fourier.row(distance)[column];
                let sin = if single { 0.0 } else { -first * fourier.row(distance)[column + 1] };
                for from in 0..nodes {
                    for to in 0..nodes {
                        let value = block[(to, from)];
                        table[(distance * nodes + from) * stride + to] += value.re * cos - value.im * sin;
                    }
                }
            }
            column += if single { 1 } else { 2 };
        }
        Self { sectors, nodes, stride, table, ridge: ridge(blocks, sectors) }
    }

    fn place(&self, index: usize) -> (usize, usize) {
        (index / self.stride, index % self.stride)
    }

    fn column(&self, distance: usize, node: usize) -> &[f64] {
        &self.table[(distance * self.nodes + node) * self.stride..][..self.stride]
    }
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
