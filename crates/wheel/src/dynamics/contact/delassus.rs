//! The contact operator of a tuned wheel: one block-circulant table per speed and step (docs/method.md, Contact).

use faer::{Mat, c64};

use super::super::oscillators::lanes::LANES;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::complementarity::{ContactOperator, any_below};
use rubmap_numerics::sector_fourier::{SectorFourier, is_single};

/// W over all contact nodes of all sectors, index = sector·stride + node (nodes padded to `stride`).
#[derive(Debug, Clone)]
pub(crate) struct Delassus {
    sectors: usize,
    nodes: usize,
    stride: usize,
    /// `[sector distance][column node][row node]`.
    table: Aligned,
    ridge: f64,
    /// Largest magnitude of any entry.
    largest: f64,
    /// (sector, node) of every index.
    places: Vec<(usize, usize)>,
}

impl Delassus {
    /// W = Σ_i w_i² Re(W_i e^{jiα(s−s')}) from the `nodes × nodes` blocks W_i of the nodal diameters, with the
    /// [`ridge`](super::flexibility::ridge) of those without friction.
    pub(crate) fn new(blocks: &[Mat<c64>], ridge: f64, stride: usize, fourier: &SectorFourier) -> Self {
        let (sectors, nodes) = (fourier.sectors(), blocks[0].nrows());
        let mut table = Aligned::zeros(sectors * nodes * stride);
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
        let places = (0..sectors * stride).map(|index| (index / stride, index % stride)).collect();
        let largest = table.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        Self { sectors, nodes, stride, table, ridge, largest, places }
    }

    /// Adds what a unit force at a node opens at another, `term(sector distance, to, from)`.
    pub(crate) fn add(&mut self, term: impl Fn(usize, usize, usize) -> f64) {
        for distance in 0..self.sectors {
            for from in 0..self.nodes {
                for to in 0..self.nodes {
                    self.table[(distance * self.nodes + from) * self.stride + to] += term(distance, to, from);
                }
            }
        }
        self.largest = self.table.iter().fold(0.0, |m, w| m.max(w.abs()));
    }

    /// Sector and contact node of an index.
    #[inline(always)]
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        self.places[index]
    }

    fn column(&self, distance: usize, node: usize) -> &[f64] {
        &self.table[(distance * self.nodes + node) * self.stride..][..self.stride]
    }
}

impl ContactOperator for Delassus {
    fn size(&self) -> usize {
        self.sectors * self.stride
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let ((to_sector, to), (from_sector, from)) = (self.place(i), self.place(j));
        let distance = (to_sector + self.sectors - from_sector) % self.sectors;
        self.column(distance, from)[to] + if i == j { self.ridge } else { 0.0 }
    }

    #[inline(always)]
    fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
        let reach = self.largest * lambda.iter().map(|l| l.abs()).sum::<f64>();
        let blocks = q.chunks_exact(self.stride).zip(gap.chunks_exact_mut(self.stride));
        for (sector, (q, gap)) in blocks.enumerate() {
            if !any_below(q, reach) {
                gap.copy_from_slice(q);
                continue;
            }
            let chunks = q.as_chunks::<LANES>().0.iter().zip(gap.as_chunks_mut::<LANES>().0);
            for (chunk, (q, gap)) in chunks.enumerate() {
                let mut sums = *q;
                for (&j, &lambda) in active.iter().zip(lambda) {
                    let (from_sector, from) = self.place(j);
                    let turns = if sector < from_sector { self.sectors } else { 0 };
                    let column = self.column(sector + turns - from_sector, from);
                    let column = &column.as_chunks::<LANES>().0[chunk];
                    for (sum, w) in sums.iter_mut().zip(column) {
                        *sum += w * lambda;
                    }
                }
                *gap = sums;
            }
        }
    }
}
