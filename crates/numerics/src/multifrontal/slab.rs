//! Columns of L as the solves read them.

use faer::MatRef;

/// Largest number of columns in a slab: their unknowns stay close to the first level of cache.
const COLUMNS: usize = 128;
/// Rows of L that are read together: sums of four rows over six registers are held at once, so that reading L takes no longer
/// than what is done with it.
pub(super) const ROWS: usize = 4;

/// Consecutive columns of L below the diagonal, four rows together, column after column: read once from first to last by a
/// solve in either direction.
///
/// The triangle of the columns' own rows comes first. Its panel t has the columns before its rows, 4 t, and four more for
/// its own, zero on and above the diagonal. Rows that are missing to four are zero.
#[derive(Debug)]
pub(super) struct Slab {
    /// First column, in elimination order.
    pub(super) start: usize,
    /// Number of columns.
    pub(super) width: usize,
    values: Vec<f64>,
}

/// A panel of a slab's own rows.
pub(super) struct OwnRows<'a> {
    /// First of the rows, in elimination order.
    pub(super) first: usize,
    /// Number of rows.
    pub(super) count: usize,
    /// Columns of the slab before these rows.
    pub(super) before: &'a [[f64; ROWS]],
    /// Columns of the rows themselves.
    pub(super) triangle: &'a [[f64; ROWS]],
}

impl Slab {
    /// The slabs of a front that begins at row `start`: `lower` has its columns, their own rows first, the strict upper
    /// triangle of which means nothing.
    pub(super) fn pack(start: usize, lower: MatRef<'_, f64>) -> Vec<Self> {
        let (rows, columns) = (lower.nrows(), lower.ncols());
        let pack = |first: usize| {
            let width = COLUMNS.min(columns - first);
            let panels = width.div_ceil(ROWS);
            let after = rows - first - width;
            let mut values =
                Vec::with_capacity(ROWS * (ROWS * panels * (panels + 1) / 2 + width * after.div_ceil(ROWS)));
            for panel in 0..panels {
                for column in 0..ROWS * (panel + 1) {
                    for row in ROWS * panel..ROWS * (panel + 1) {
                        let inside = row < width && column < row;
                        values.push(if inside { lower[(first + row, first + column)] } else { 0.0 });
                    }
                }
            }
            let last = first + width;
            for row in (last..rows).step_by(ROWS) {
                let there = ROWS.min(rows - row);
                for column in first..last {
                    let from = lower.col(column).subrows(row, there);
                    values.extend(from.iter());
                    values.extend(std::iter::repeat_n(0.0, ROWS - there));
                }
            }
            Self { start: start + first, width, values }
        };
        (0..columns).step_by(COLUMNS).map(pack).collect()
    }

    /// Panel `panel` of the slab's own rows.
    pub(super) fn own(&self, panel: usize) -> OwnRows<'_> {
        let before = ROWS * panel;
        let columns = &self.columns()[ROWS * panel * (panel + 1) / 2..][..before + ROWS];
        OwnRows {
            first: self.start + before,
            count: ROWS.min(self.width - before),
            before: &columns[..before],
            triangle: &columns[before..],
        }
    }

    /// Number of panels of the slab's own rows.
    pub(super) fn panels(&self) -> usize {
        self.width.div_ceil(ROWS)
    }

    /// Panels of the rows after the slab's own, each with all its columns.
    pub(super) fn below(&self) -> impl Iterator<Item = &[[f64; ROWS]]> {
        let panels = self.panels();
        self.columns()[ROWS * panels * (panels + 1) / 2..].chunks_exact(self.width)
    }

    fn columns(&self) -> &[[f64; ROWS]] {
        self.values.as_chunks().0
    }
}
