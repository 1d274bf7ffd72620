//! Complex vectors side by side.

use faer::{Mat, MatMut, MatRef, c64};

use super::panel::Panel;

/// Several complex vectors as a panel of real ones, real parts before imaginary parts; vectors known to be real have no imaginary parts.
#[derive(Debug, Clone)]
pub struct VectorBlock {
    count: usize,
    real: bool,
    panel: Panel,
}

impl VectorBlock {
    /// Block of `count` vectors of `size` zeros.
    pub fn zeros(count: usize, size: usize, real: bool) -> Self {
        Self { count, real, panel: Panel::zeros(if real { count } else { 2 * count }, size) }
    }

    /// Block of the columns of `vectors`; of their real parts where they are known to be `real`.
    pub fn of(vectors: MatRef<'_, c64>, real: bool) -> Self {
        let mut block = Self::zeros(vectors.ncols(), vectors.nrows(), real);
        for row in 0..vectors.nrows() {
            for j in 0..vectors.ncols() {
                block.set(row, j, vectors[(row, j)]);
            }
        }
        block
    }

    /// Number of vectors.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.panel.size()
    }

    /// Whether the vectors are known to be real.
    pub fn is_real(&self) -> bool {
        self.real
    }

    /// Real and imaginary parts of the vectors.
    pub fn parts(&self) -> &Panel {
        &self.panel
    }

    /// Real and imaginary parts of the vectors, to be changed.
    pub fn parts_mut(&mut self) -> &mut Panel {
        &mut self.panel
    }

    /// Unknown `row` of vector `j`.
    #[inline]
    pub fn get(&self, row: usize, j: usize) -> c64 {
        let parts = self.panel.row(row);
        c64::new(parts[j], if self.real { 0.0 } else { parts[self.count + j] })
    }

    /// Sets unknown `row` of vector `j`, to its real part where vectors are real.
    #[inline]
    pub fn set(&mut self, row: usize, j: usize, value: c64) {
        let parts = self.panel.row_mut(row);
        parts[j] = value.re;
        if !self.real {
            parts[self.count + j] = value.im;
        }
    }

    /// Writes the unknowns from `first` on into `rows`, a column per vector.
    pub fn copy_to(&self, first: usize, mut rows: MatMut<'_, c64>) {
        for row in 0..rows.nrows() {
            for j in 0..self.count {
                rows[(row, j)] = self.get(first + row, j);
            }
        }
    }

    /// Sets the unknowns from `first` on to `rows`.
    pub fn copy_from(&mut self, first: usize, rows: MatRef<'_, c64>) {
        for row in 0..rows.nrows() {
            for j in 0..self.count {
                self.set(first + row, j, rows[(row, j)]);
            }
        }
    }

    /// Products Xᴴ Y for the vectors X of all `blocks` and Y of this one.
    pub fn products(&self, blocks: &[Self]) -> Mat<c64> {
        let panels: Vec<&Panel> = blocks.iter().map(|block| &block.panel).collect();
        let mut products = Mat::zeros(blocks.iter().map(|block| block.count).sum(), self.count);
        let mut first = 0;
        for (block, of_block) in blocks.iter().zip(self.panel.products(&panels)) {
            let part = |x: usize, y: usize| of_block[y * block.panel.room() + x];
            for j in 0..self.count {
                for i in 0..block.count {
                    let mut value = c64::new(part(i, j), 0.0);
                    if !self.real {
                        value.im += part(i, self.count + j);
                    }
                    if !block.real {
                        value.im -= part(block.count + i, j);
                        if !self.real {
                            value.re += part(block.count + i, self.count + j);
                        }
                    }
                    products[(first + i, j)] = value;
                }
            }
            first += block.count;
        }
        products
    }

    /// Adds Y ← Y + X C for the vectors X of all `blocks`, all real or none, as the vectors Y of this one are.
    pub fn add(&mut self, blocks: &[Self], coefficients: MatRef<'_, c64>) {
        debug_assert!(blocks.iter().all(|block| block.real == self.real));
        let room = self.panel.room();
        let mut first = 0;
        let of_block = |block: &Self| {
            let mut real = vec![0.0; block.panel.room() * room];
            for j in 0..self.count {
                for i in 0..block.count {
                    let value = coefficients[(first + i, j)];
                    real[i * room + j] = value.re;
                    if !self.real {
                        real[i * room + self.count + j] = value.im;
                        real[(block.count + i) * room + j] = -value.im;
                        real[(block.count + i) * room + self.count + j] = value.re;
                    }
                }
            }
            first += block.count;
            real
        };
        let real: Vec<Vec<f64>> = blocks.iter().map(of_block).collect();
        let panels: Vec<&Panel> = blocks.iter().map(|block| &block.panel).collect();
        self.panel.add(&panels, &real);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(n: usize, count: usize, seed: usize, real: bool) -> (Mat<c64>, VectorBlock) {
        let imaginary = if real { 0.0 } else { 1.0 };
        let entry = |i: usize, j: usize| {
            let at = (i * 7 + (j + seed) * 3 + 1) as f64;
            c64::new(at.sin(), imaginary * (at * 0.7).cos())
        };
        let vectors = Mat::from_fn(n, count, entry);
        let block = VectorBlock::of(vectors.as_ref(), real);
        (vectors, block)
    }

    #[test]
    fn products_and_sums_are_those_of_dense_matrices() {
        for (n, count, real) in
            [(1, 1, false), (700, 3, false), (513, 4, true), (300, 9, false), (256, 17, true)]
        {
            let known: Vec<_> = (0..3).map(|seed| block(n, count, 5 * seed, real)).collect();
            let (y, mut sum) = block(n, count.min(5), 40, real);
            let blocks: Vec<VectorBlock> = known.iter().map(|(_, block)| block.clone()).collect();
            let all = Mat::from_fn(n, 3 * count, |i, j| known[j / count].0[(i, j % count)]);
            let products = sum.products(&blocks);
            assert!((&products - all.adjoint() * &y).norm_max() < 1e-10, "{n} {count}");
            sum.add(&blocks, products.as_ref());
            let expected = y + &all * products;
            let mut found = Mat::zeros(n, expected.ncols());
            sum.copy_to(0, found.as_mut());
            assert!((found - &expected).norm_max() < 1e-10 * (1.0 + expected.norm_max()), "{n} {count}");
        }
    }
}
