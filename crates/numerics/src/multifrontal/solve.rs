//! Half solves with many right-hand sides at once.

use pulp::{Simd, WithSimd};

use super::factor::PartialFactor;
use super::slab::{OwnRows, ROWS, Slab};
use crate::panel::{Panel, add, sums};
use crate::vectors::arch;

impl PartialFactor<'_> {
    /// Computes x_I ← L⁻¹ x_I, x_F ← x_F − L_F L⁻¹ x_I for every vector of `x`.
    pub fn forward(&self, x: &mut Panel) {
        arch().dispatch(Forward { factor: self, x });
    }

    /// Computes x_I ← L⁻ᵀ (x_I − L_Fᵀ x_F) for every vector of `x`; x_F stays.
    pub fn backward(&self, x: &mut Panel) {
        arch().dispatch(Backward { factor: self, x });
    }

    /// Slabs, each with the rows after its own.
    fn slabs(&self) -> impl DoubleEndedIterator<Item = (&Slab, impl Fn(usize) -> Option<usize>)> {
        self.analysis.fronts.iter().zip(&self.slabs).flat_map(|(front, slabs)| {
            slabs.iter().map(move |slab| {
                let first = slab.start - front.start + slab.width;
                let last = front.pivots + front.rows.len();
                (slab, move |i: usize| (first + i < last).then(|| front.row(first + i)))
            })
        })
    }
}

struct Forward<'a> {
    factor: &'a PartialFactor<'a>,
    x: &'a mut Panel,
}

struct Backward<'a> {
    factor: &'a PartialFactor<'a>,
    x: &'a mut Panel,
}

/// Runs the kernel for the registers of an unknown in groups of `G`, as many as there are registers to hold `N` = `ROWS` `G`
/// numbers and their factors.
macro_rules! groups {
    ($S:ty, $registers:expr, |$group:ident, $G:ident, $N:ident| $kernel:expr) => {
        let most = if <$S>::REGISTER_COUNT < 32 { 2 } else { 6 };
        let mut $group = 0;
        while $group < $registers {
            let width = most.min($registers - $group);
            groups!(@ width, $G, $N, $kernel, 1 2 3 4 5 6);
            $group += width;
        }
    };
    (@ $width:ident, $G:ident, $N:ident, $kernel:expr, $($size:literal)*) => {
        match $width {
            $($size => {
                const $G: usize = $size;
                const $N: usize = ROWS * $size;
                $kernel;
            })*
            _ => unreachable!("groups of at most six"),
        }
    };
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let registers = self.x.registers::<S>();
        let x = self.x.as_mut_registers::<S>();
        for (slab, row_after) in self.factor.slabs() {
            for panel in 0..slab.panels() {
                let OwnRows { first, count, before, triangle } = slab.own(panel);
                groups!(S, registers, |group, G, N| {
                    let known = &x[slab.start * registers..first * registers];
                    let mut sums = sums::<S, ROWS, G, N>(simd, before.iter(), known, registers, group);
                    for j in 0..ROWS {
                        if j < count {
                            let at = &mut x[(first + j) * registers + group..][..G];
                            for g in 0..G {
                                at[g] = simd.sub_f64s(at[g], sums[j * G + g]);
                            }
                            for i in j + 1..ROWS {
                                let factor = simd.splat_f64s(triangle[j][i]);
                                for g in 0..G {
                                    sums[i * G + g] = simd.mul_add_e_f64s(factor, at[g], sums[i * G + g]);
                                }
                            }
                        }
                    }
                });
            }
            for (panel, columns) in slab.below().enumerate() {
                groups!(S, registers, |group, G, N| {
                    let known = &x[slab.start * registers..(slab.start + slab.width) * registers];
                    let sums = sums::<S, ROWS, G, N>(simd, columns.iter(), known, registers, group);
                    for i in 0..ROWS {
                        if let Some(row) = row_after(ROWS * panel + i) {
                            let at = &mut x[row * registers + group..][..G];
                            for g in 0..G {
                                at[g] = simd.sub_f64s(at[g], sums[i * G + g]);
                            }
                        }
                    }
                });
            }
        }
    }
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let registers = self.x.registers::<S>();
        let x = self.x.as_mut_registers::<S>();
        for (slab, row_after) in self.factor.slabs().rev() {
            for (panel, columns) in slab.below().enumerate() {
                groups!(S, registers, |group, G, N| {
                    let mut minus = [simd.splat_f64s(0.0); N];
                    for i in 0..ROWS {
                        if let Some(row) = row_after(ROWS * panel + i) {
                            let from = &x[row * registers + group..][..G];
                            for g in 0..G {
                                minus[i * G + g] = simd.neg_f64s(from[g]);
                            }
                        }
                    }
                    let known = &mut x[slab.start * registers..(slab.start + slab.width) * registers];
                    add::<S, ROWS, G, N>(simd, columns.iter(), &minus, known, registers, group);
                });
            }
            for panel in (0..slab.panels()).rev() {
                let OwnRows { first, count, before, triangle } = slab.own(panel);
                groups!(S, registers, |group, G, N| {
                    let mut minus = [simd.splat_f64s(0.0); N];
                    for i in 0..ROWS {
                        if i < count {
                            let from = &x[(first + i) * registers + group..][..G];
                            for g in 0..G {
                                minus[i * G + g] = simd.neg_f64s(from[g]);
                            }
                        }
                    }
                    for i in (0..ROWS).rev() {
                        for j in 0..i {
                            let factor = simd.splat_f64s(-triangle[j][i]);
                            for g in 0..G {
                                minus[j * G + g] =
                                    simd.mul_add_e_f64s(factor, minus[i * G + g], minus[j * G + g]);
                            }
                        }
                        if i < count {
                            let at = &mut x[(first + i) * registers + group..][..G];
                            for g in 0..G {
                                at[g] = simd.neg_f64s(minus[i * G + g]);
                            }
                        }
                    }
                    let known = &mut x[slab.start * registers..first * registers];
                    add::<S, ROWS, G, N>(simd, before.iter(), &minus, known, registers, group);
                });
            }
        }
    }
}
