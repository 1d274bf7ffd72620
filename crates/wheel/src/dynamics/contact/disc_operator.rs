//! Contact operator of a tuned wheel along the normals and in the contact planes: [`super::delassus`] in three directions.

use faer::{Mat, c64};

use super::super::oscillators::lanes::LANES;
use super::delassus::circulant;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::complementarity::any_below;
use rubmap_numerics::complementarity::disc::{Block, DiscOperator, Forces};
use rubmap_numerics::sector_fourier::SectorFourier;

/// Contact operator W over all contact nodes of all sectors, index = sector·stride + node (nodes padded to `stride`).
#[derive(Debug, Clone)]
pub(crate) struct DiscTable {
    sectors: usize,
    nodes: usize,
    stride: usize,
    /// Entries that open gaps, `[sector distance][column node][force][row node]`.
    gaps: Aligned,
    /// Blocks of all entries, `[sector distance][column node][row node]`.
    blocks: Vec<Block>,
    /// Ridges added to the diagonal, along the normals and in the contact planes.
    ridges: [f64; 2],
    /// Largest magnitude of an entry that opens a gap, by sector distance and force.
    largest: Vec<Forces>,
}

impl DiscTable {
    /// Operator from the blocks of the nodal diameters, whose rows and columns are the three directions of one node after the other.
    pub(crate) fn new(blocks: &[Mat<c64>], ridges: [f64; 2], stride: usize, fourier: &SectorFourier) -> Self {
        let (sectors, nodes) = (fourier.sectors(), blocks[0].nrows() / 3);
        let mut this = Self {
            sectors,
            nodes,
            stride,
            gaps: Aligned::zeros(3 * sectors * nodes * stride),
            blocks: vec![[[0.0; 3]; 3]; sectors * nodes * nodes],
            ridges,
            largest: Vec::new(),
        };
        circulant(blocks, fourier, |distance, to, from, value| {
            this.blocks[(distance * nodes + from / 3) * nodes + to / 3][to % 3][from % 3] += value;
        });
        this.spread();
        this
    }

    /// Adds the opening of a gap by a unit normal force at another node, `term(sector distance, to, from)`.
    pub(crate) fn add(&mut self, term: impl Fn(usize, usize, usize) -> f64) {
        for distance in 0..self.sectors {
            for from in 0..self.nodes {
                for to in 0..self.nodes {
                    self.blocks[(distance * self.nodes + from) * self.nodes + to][0][0] +=
                        term(distance, to, from);
                }
            }
        }
        self.spread();
    }

    /// Fills the entries that open gaps from the blocks.
    fn spread(&mut self) {
        self.largest = vec![[0.0; 3]; self.sectors];
        for (column, blocks) in self.blocks.chunks_exact(self.nodes).enumerate() {
            let largest = &mut self.largest[column / self.nodes];
            for (to, block) in blocks.iter().enumerate() {
                for (by, largest) in largest.iter_mut().enumerate() {
                    self.gaps[(3 * column + by) * self.stride + to] = block[0][by];
                    *largest = largest.max(block[0][by].abs());
                }
            }
        }
    }

    /// Number of sectors from one to another, counted forwards.
    #[inline(always)]
    fn distance(&self, to: usize, from: usize) -> usize {
        let turns = if to < from { self.sectors } else { 0 };
        to + turns - from
    }
}

impl DiscOperator for DiscTable {
    fn block(&self, i: usize, j: usize) -> Block {
        let (to, from) = ((i / self.stride, i % self.stride), (j / self.stride, j % self.stride));
        let column = self.distance(to.0, from.0) * self.nodes + from.1;
        let mut block = self.blocks[column * self.nodes + to.1];
        if i == j {
            for (a, ridge) in [self.ridges[0], self.ridges[1], self.ridges[1]].into_iter().enumerate() {
                block[a][a] += ridge;
            }
        }
        block
    }

    #[inline(always)]
    fn gaps(&self, active: &[usize], forces: &[Forces], q: &[f64], gap: &mut [f64]) {
        let sectors = q.chunks_exact(self.stride).zip(gap.chunks_exact_mut(self.stride));
        for (sector, (q, gap)) in sectors.enumerate() {
            let reach = |(&j, x): (&usize, &Forces)| {
                let largest = &self.largest[self.distance(sector, j / self.stride)];
                largest.iter().zip(x).map(|(largest, x)| largest * x.abs()).sum::<f64>()
            };
            gap.copy_from_slice(q);
            if !any_below(q, active.iter().zip(forces).map(reach).sum()) {
                continue;
            }
            for (&j, x) in active.iter().zip(forces) {
                let column = self.distance(sector, j / self.stride) * self.nodes + j % self.stride;
                let columns = &self.gaps[3 * column * self.stride..][..3 * self.stride];
                let (n, planar) = columns.split_at(self.stride);
                let (t, across) = planar.split_at(self.stride);
                let gap = gap.as_chunks_mut::<LANES>().0.iter_mut();
                let chunks = n.as_chunks::<LANES>().0.iter().zip(t.as_chunks::<LANES>().0);
                for (gap, ((n, t), across)) in gap.zip(chunks.zip(across.as_chunks::<LANES>().0)) {
                    for lane in 0..LANES {
                        gap[lane] += n[lane] * x[0] + t[lane] * x[1] + across[lane] * x[2];
                    }
                }
            }
        }
    }
}
