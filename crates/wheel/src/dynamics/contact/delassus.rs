//! Contact operator of a tuned wheel: one block-circulant table per speed and step (docs/method.md, Contact).

use std::ops::Range;

use faer::{Mat, c64};

use super::super::bending::MOST_COORDINATES;
use super::super::oscillators::lanes::LANES;
use super::slopes::{Slopes, add_column};
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::complementarity::{ContactOperator, any_below};
use rubmap_numerics::sector_fourier::{SectorFourier, is_single};

/// Contact operator W over all contact nodes of all sectors, index = sector·stride + node (nodes padded to `stride`).
#[derive(Debug, Clone)]
pub(crate) struct Delassus {
    sectors: usize,
    /// Rows of a sector: contact nodes, and behind them coordinates of blades that bend far.
    nodes: usize,
    stride: usize,
    /// Entries of W, `[sector distance][column node][row node]`.
    table: Aligned,
    ridge: f64,
    /// Largest magnitude of any entry, by sector distance.
    largest: Vec<f64>,
    /// Sector and node of every index.
    places: Vec<(usize, usize)>,
    /// Motion of contact nodes by the coordinates of their sector, if there are any.
    slopes: Option<Slopes>,
    /// Upper bound of the factor by which slopes enlarge the largest entry: (1 + Σ |slope|)².
    steepest: f64,
}

impl Delassus {
    /// Operator W = Σ_i w_i² Re(W_i e^{jiα(s−s')}) from the `nodes × nodes` blocks W_i of the nodal diameters, with the
    /// [`ridge`](super::flexibility::ridge) of the blocks without friction. The last of the nodes are the coordinates of blades that
    /// bend far, by which contact nodes move with `slopes`.
    pub(crate) fn new(
        blocks: &[Mat<c64>],
        ridge: f64,
        stride: usize,
        slopes: Option<Slopes>,
        fourier: &SectorFourier,
    ) -> Self {
        let (sectors, nodes) = (fourier.sectors(), blocks[0].nrows());
        let mut table = Aligned::zeros(sectors * nodes * stride);
        circulant(blocks, fourier, |distance, to, from, value| {
            table[(distance * nodes + from) * stride + to] += value;
        });
        let places = (0..sectors * stride).map(|index| (index / stride, index % stride)).collect();
        let mut this =
            Self { sectors, nodes, stride, table, ridge, largest: Vec::new(), places, slopes, steepest: 1.0 };
        this.find_largest();
        this
    }

    /// Adds the opening of a gap by a unit force at another node, `term(sector distance, to, from)`.
    pub(crate) fn add(&mut self, term: impl Fn(usize, usize, usize) -> f64) {
        let nodes = self.contact_nodes();
        for distance in 0..self.sectors {
            for from in 0..nodes {
                for to in 0..nodes {
                    self.table[(distance * self.nodes + from) * self.stride + to] += term(distance, to, from);
                }
            }
        }
        self.find_largest();
    }

    fn find_largest(&mut self) {
        let largest = |block: &[f64]| block.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        self.largest = self.table.chunks_exact(self.nodes * self.stride).map(largest).collect();
    }

    /// Number of contact nodes of a sector.
    pub(crate) fn contact_nodes(&self) -> usize {
        self.nodes - self.slopes.as_ref().map_or(0, Slopes::coordinates)
    }

    /// Takes the coordinates of all sectors from `linear`, `[sector][row]`, the linear displacement of nodes and coordinates: W becomes J W Jᵀ, J
    /// reading a node and by its slopes the coordinates.
    #[inline(always)]
    pub(crate) fn bend(&mut self, linear: &[f64]) {
        if let Some(slopes) = &mut self.slopes {
            self.steepest = (1.0 + slopes.move_to(linear)).powi(2);
        }
    }

    /// Motion of nodes by coordinates, if there are any.
    #[inline(always)]
    pub(crate) fn slopes(&self) -> Option<&Slopes> {
        self.slopes.as_ref()
    }

    /// Entry that the slopes add to that of the table.
    fn bent_entry(&self, slopes: &Slopes, i: usize, j: usize) -> f64 {
        let ((to_sector, to), (from_sector, from)) = (self.place(i), self.place(j));
        let (distance, coordinates) = (self.distance(to_sector, from_sector), self.coordinates(slopes));
        // Motion of the coordinates, and of the node but for its slopes.
        let mut moved = [0.0; MOST_COORDINATES];
        add_scaled(&mut moved, &self.column(distance, from)[coordinates.clone()], 1.0);
        let mut entry = 0.0;
        for (column, slope) in coordinates.clone().zip(slopes.of(from_sector, from)) {
            let column = self.column(distance, column);
            entry += slope * column[to];
            add_scaled(&mut moved, &column[coordinates.clone()], slope);
        }
        for (slope, moved) in slopes.of(to_sector, to).iter().zip(moved) {
            entry += slope * moved;
        }
        entry
    }

    /// Rows and columns of the coordinates.
    #[inline(always)]
    fn coordinates(&self, slopes: &Slopes) -> Range<usize> {
        self.nodes - slopes.coordinates()..self.nodes
    }

    /// Adds to the gaps of `sector` what bending adds to W λ.
    #[inline(always)]
    fn add_bent(&self, slopes: &Slopes, sector: usize, active: &[usize], lambda: &[f64], gap: &mut [f64]) {
        let coordinates = self.coordinates(slopes);
        let mut moved = [0.0; MOST_COORDINATES];
        let mut loads = active.iter().zip(lambda).peekable();
        while let Some(&(&index, _)) = loads.peek() {
            let from_sector = self.place(index).0;
            let distance = self.distance(sector, from_sector);
            // Forces of one sector push the same coordinates.
            let mut pushed = [0.0; MOST_COORDINATES];
            while let Some((&index, &lambda)) =
                loads.next_if(|&(&index, _)| self.place(index).0 == from_sector)
            {
                let from = self.place(index).1;
                add_scaled(&mut pushed, &slopes.of(from_sector, from), lambda);
                add_scaled(&mut moved, &self.column(distance, from)[coordinates.clone()], lambda);
            }
            for (column, force) in coordinates.clone().zip(pushed) {
                let column = self.column(distance, column);
                add_scaled(&mut moved, &column[coordinates.clone()], force);
                add_column(column, force, gap);
            }
        }
        slopes.add(sector, &moved, gap);
    }

    /// Sector and contact node of an index.
    #[inline(always)]
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        self.places[index]
    }

    /// Number of sectors from one to another, counted forwards.
    #[inline(always)]
    fn distance(&self, to: usize, from: usize) -> usize {
        let turns = if to < from { self.sectors } else { 0 };
        to + turns - from
    }

    /// Writes into the first number of every sector of `gap` the largest change that `lambda` can make to any gap of the sector.
    #[inline(always)]
    fn reach(&self, active: &[usize], lambda: &[f64], gap: &mut [f64]) {
        let stride = self.stride;
        for sector in 0..self.sectors {
            gap[sector * stride] = 0.0;
        }
        let loads = active.iter().zip(lambda).map(|(&j, &lambda)| (self.place(j).0, lambda.abs()));
        let mut loads = loads.peekable();
        while let Some((from, mut force)) = loads.next() {
            while let Some((_, more)) = loads.next_if(|&(sector, _)| sector == from) {
                force += more;
            }
            for to in 0..self.sectors {
                gap[to * stride] += self.steepest * force * self.largest[self.distance(to, from)];
            }
        }
    }

    fn column(&self, distance: usize, node: usize) -> &[f64] {
        &self.table[(distance * self.nodes + node) * self.stride..][..self.stride]
    }
}

/// Adds `by` times `values` to the numbers of coordinates.
#[inline(always)]
fn add_scaled(sums: &mut [f64; MOST_COORDINATES], values: &[f64], by: f64) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += value * by;
    }
}

/// Sums Σ_i w_i² Re(B_i e^{jiα(s−s')}) of the blocks B_i of the nodal diameters, term by term: `add(sector distance, to, from, term)`.
pub(super) fn circulant(
    blocks: &[Mat<c64>],
    fourier: &SectorFourier,
    mut add: impl FnMut(usize, usize, usize, f64),
) {
    let sectors = fourier.sectors();
    let mut column = 0;
    for (harmonic, block) in blocks.iter().enumerate() {
        let single = is_single(harmonic, sectors);
        let first = fourier.row(0)[column];
        for distance in 0..sectors {
            // Row 0 of a cosine column is w, of a sine column 0: F[0]·F[δ] gives w² cos and −w² sin.
            let cos = first * fourier.row(distance)[column];
            let sin = if single { 0.0 } else { -first * fourier.row(distance)[column + 1] };
            for from in 0..block.ncols() {
                for to in 0..block.nrows() {
                    let value = block[(to, from)];
                    add(distance, to, from, value.re * cos - value.im * sin);
                }
            }
        }
        column += if single { 1 } else { 2 };
    }
}

impl ContactOperator for Delassus {
    fn size(&self) -> usize {
        self.sectors * self.stride
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let ((to_sector, to), (from_sector, from)) = (self.place(i), self.place(j));
        let entry = self.column(self.distance(to_sector, from_sector), from)[to]
            + if i == j { self.ridge } else { 0.0 };
        match &self.slopes {
            Some(slopes) => entry + self.bent_entry(slopes, i, j),
            None => entry,
        }
    }

    #[inline(always)]
    fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
        self.reach(active, lambda, gap);
        let blocks = q.chunks_exact(self.stride).zip(gap.chunks_exact_mut(self.stride));
        for (sector, (q, gap)) in blocks.enumerate() {
            if !any_below(q, gap[0]) {
                gap.copy_from_slice(q);
                continue;
            }
            let chunks = q.as_chunks::<LANES>().0.iter().zip(gap.as_chunks_mut::<LANES>().0);
            for (chunk, (q, gap)) in chunks.enumerate() {
                let mut sums = *q;
                for (&j, &lambda) in active.iter().zip(lambda) {
                    let (from_sector, from) = self.place(j);
                    let column = self.column(self.distance(sector, from_sector), from);
                    let column = &column.as_chunks::<LANES>().0[chunk];
                    for (sum, w) in sums.iter_mut().zip(column) {
                        *sum += w * lambda;
                    }
                }
                *gap = sums;
            }
            if let Some(slopes) = &self.slopes {
                self.add_bent(slopes, sector, active, lambda, gap);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTORS: usize = 7;
    const NODES: usize = 2;

    /// Gaps of blades that hardly feel each other: far gaps keep their q, which forces cannot close; all others are q + Wλ.
    #[test]
    fn gaps_keep_their_q_only_where_no_force_can_close_them() {
        let fourier = SectorFourier::new(SECTORS);
        let block = |harmonic: usize| {
            Mat::from_fn(NODES, NODES, |i, j| {
                let common = if i == j { 2.0 } else { 0.7 };
                c64::new(
                    common + 0.2 * (harmonic as f64).cos(),
                    0.1 * (i as f64 - j as f64) * harmonic as f64,
                )
            })
        };
        let blocks: Vec<_> = (0..=SECTORS / 2).map(block).collect();
        let w = Delassus::new(&blocks, 0.0, LANES, None, &fourier);
        let mut kept = 0;
        for turn in 0..SECTORS {
            // Candidates may have forces of either sign.
            let mut loads =
                [(turn * LANES, 1.5), (turn * LANES + 1, -0.4), ((turn + 2) % SECTORS * LANES, 0.8)];
            loads.sort_by_key(|&(index, _)| index);
            let (active, lambda): (Vec<_>, Vec<_>) = loads.into_iter().unzip();
            let q: Vec<f64> = (0..SECTORS * LANES)
                .map(|i| {
                    if i % LANES < NODES {
                        1.5 * (1.3 * i as f64 + turn as f64).sin().abs() - 0.2
                    } else {
                        f64::INFINITY
                    }
                })
                .collect();
            let mut gap = vec![f64::NAN; q.len()];
            w.gaps(&active, &lambda, &q, &mut gap);
            for i in (0..q.len()).filter(|i| i % LANES < NODES) {
                let moved: f64 = active.iter().zip(&lambda).map(|(&j, lambda)| w.entry(i, j) * lambda).sum();
                let exact = q[i] + moved;
                if gap[i] == q[i] && moved != 0.0 {
                    kept += 1;
                    assert!(exact > 0.0, "{turn} {i}: {exact}");
                } else {
                    assert!((gap[i] - exact).abs() < 1e-12, "{turn} {i}: {} {exact}", gap[i]);
                }
            }
        }
        assert!(kept > SECTORS && kept < SECTORS * SECTORS * NODES / 2, "{kept}");
    }
}
