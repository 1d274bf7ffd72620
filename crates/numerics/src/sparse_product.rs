//! Product of a sparse square matrix with many vectors.

use faer::sparse::SparseColMat;
use pulp::{Simd, WithSimd};

use super::panel::Panel;

/// Product xᵀ A for a sparse A (`n × n`) and every vector of `x`: A x where A is symmetric, −A x where it is skew-symmetric.
///
/// Every entry of A is read once per group of vectors and meets contiguous memory (some ten times faster than a product
/// column by column on the matrices of a sector).
pub fn row_product(a: &SparseColMat<usize, f64>, x: &Panel) -> Panel {
    assert!(a.nrows() == a.ncols() && a.ncols() == x.size(), "one row of the panel per unknown");
    crate::vectors::arch().dispatch(Product { a, x })
}

struct Product<'a> {
    a: &'a SparseColMat<usize, f64>,
    x: &'a Panel,
}

impl WithSimd for Product<'_> {
    type Output = Panel;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Panel {
        let Self { a, x } = self;
        let registers = x.registers::<S>();
        let mut product = Panel::zeros(x.width(), x.size());
        let (x, sums) = (x.as_registers::<S>(), product.as_mut_registers::<S>());
        // Sums of three columns, one unknown of X and a factor are held at once.
        let most = if S::REGISTER_COUNT < 32 { 3 } else { 6 };
        let mut first = 0;
        while first < a.ncols() {
            let rows = a.row_idx_of_col_raw(first);
            let same = |column: &usize| *column < a.ncols() && a.row_idx_of_col_raw(*column) == rows;
            let count = 1 + (first + 1..first + 3).take_while(same).count();
            let values = [0, 1, 2].map(|column| a.val_of_col(first + column.min(count - 1)));
            let sums = &mut sums[first * registers..][..count * registers];
            let mut group = 0;
            while group < registers {
                let from = &x[group..];
                let width = most.min(registers - group);
                macro_rules! columns {
                    ($($G:literal)*) => {
                        match (width, count) {
                            $(
                                ($G, 1) => columns::<S, $G, 1, $G>(simd, rows, values, from, registers, sums, group),
                                ($G, 2) => columns::<S, $G, 2, { 2 * $G }>(simd, rows, values, from, registers, sums, group),
                                ($G, _) => columns::<S, $G, 3, { 3 * $G }>(simd, rows, values, from, registers, sums, group),
                            )*
                            _ => unreachable!("at most {most} registers at once"),
                        }
                    };
                }
                columns!(1 2 3 4 5 6);
                group += width;
            }
            first += count;
        }
        product
    }
}

/// Sums Σ_i a_i x_i over `C` columns of A with entries in the same `rows`, as those of a node have, for `G` registers: `N` = `C` `G` sums,
/// all in registers.
#[inline(always)]
fn columns<S: Simd, const G: usize, const C: usize, const N: usize>(
    simd: S,
    rows: &[usize],
    values: [&[f64]; 3],
    x: &[S::f64s],
    registers: usize,
    sums: &mut [S::f64s],
    group: usize,
) {
    let mut kept = [simd.splat_f64s(0.0); N];
    let [first, second, third] = values;
    for (((&row, &first), &second), &third) in rows.iter().zip(first).zip(second).zip(third) {
        let from = &x[row * registers..][..G];
        let factors = [first, second, third];
        for c in 0..C {
            let factor = simd.splat_f64s(factors[c]);
            for g in 0..G {
                kept[c * G + g] = simd.mul_add_e_f64s(factor, from[g], kept[c * G + g]);
            }
        }
    }
    for c in 0..C {
        sums[c * registers + group..][..G].copy_from_slice(&kept[c * G..][..G]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;
    use faer::sparse::Triplet;

    #[test]
    fn equals_the_dense_product() {
        let entry = |i: usize, j: usize| (i * 7 + j) as f64 % 5.0 - 2.0;
        let mut triplets = Vec::new();
        for e in 0..60 {
            let (i, j) = (e * 3 % 23, e * 5 % 19);
            triplets.push(Triplet::new(i, j, entry(i, e)));
            triplets.push(Triplet::new(j, i, 0.5 * entry(i, e)));
        }
        let a = SparseColMat::try_new_from_triplets(23, 23, &triplets).unwrap();
        for width in [0, 1, 8, 13, 40, 57] {
            let mut x = Panel::zeros(width, 23);
            (0..23).for_each(|j| x.row_mut(j).iter_mut().enumerate().for_each(|(i, x)| *x = entry(i, j)));
            let product = row_product(&a, &x);
            let dense = Mat::from_fn(width, 23, entry) * a.to_dense();
            for j in 0..23 {
                assert!(product.row(j).iter().zip(dense.col(j).iter()).all(|(a, b)| (a - b).abs() < 1e-12));
            }
        }
    }
}
