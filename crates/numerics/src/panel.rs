//! Real vectors side by side.

use pulp::{Simd, WithSimd};

use super::aligned::Aligned;
use super::vectors::arch;

/// Numbers taken together; see [`Panel::LANES`].
const LANES: usize = Panel::LANES;
/// Unknowns that are taken through all panels before the next ones: few enough to stay in a cache, enough for memory to be
/// read in long runs.
const TILE: usize = 1024;

/// Several real vectors over the same unknowns: all values of one unknown lie together, one for each vector, so that whatever is done to an
/// unknown is done to wide registers.
#[derive(Debug, Clone)]
pub struct Panel {
    width: usize,
    stride: usize,
    size: usize,
    values: Aligned,
}

impl Panel {
    /// Number of vectors of which the room for an unknown is a multiple, so that it fills whole registers of any processor.
    pub const LANES: usize = 8;

    /// Panel of `width` vectors of `size` zeros.
    pub fn zeros(width: usize, size: usize) -> Self {
        let stride = width.next_multiple_of(LANES);
        Self { width, stride, size, values: Aligned::zeros(size * stride) }
    }

    /// Number of vectors.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Unknown `row` of every vector.
    #[inline]
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.stride..][..self.width]
    }

    /// Unknown `row` of every vector.
    #[inline]
    pub fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.values[row * self.stride..][..self.width]
    }

    /// Products xᵀ y for every vector x of every panel and every vector y of this one: of each panel a row per vector of this one, with a
    /// number per vector that the panel has room for.
    pub(super) fn products(&self, panels: &[&Panel]) -> Vec<Vec<f64>> {
        arch().dispatch(Products { panels, with: self })
    }

    /// Adds y ← y + Σ C_xy x over all vectors x of every panel, for every vector y of this one: `coefficients` of each panel have a row per
    /// vector that it has room for, with a number per vector that this one has room for.
    pub(super) fn add(&mut self, panels: &[&Panel], coefficients: &[Vec<f64>]) {
        arch().dispatch(Add { panels, coefficients, to: self });
    }

    /// Number of vectors there is room for.
    pub(super) fn room(&self) -> usize {
        self.stride
    }

    /// Number of registers that hold one unknown.
    pub(super) fn registers<S: Simd>(&self) -> usize {
        self.stride / S::F64_LANES
    }

    /// All unknowns, [`registers`](Self::registers) each.
    pub(super) fn as_registers<S: Simd>(&self) -> &[S::f64s] {
        S::as_simd_f64s(&self.values).0
    }

    /// All unknowns, [`registers`](Self::registers) each.
    pub(super) fn as_mut_registers<S: Simd>(&mut self) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(&mut self.values).0
    }

    /// The vectors from `8 chunk` on of the unknowns from `first` on.
    fn lanes(&self, first: usize, chunk: usize) -> impl Iterator<Item = &[f64; LANES]> {
        let step = self.stride / LANES;
        let lanes: &[[f64; LANES]] = self.values.as_chunks().0;
        lanes[(first * step + chunk).min(lanes.len())..].iter().step_by(step.max(1))
    }
}

struct Products<'a> {
    panels: &'a [&'a Panel],
    with: &'a Panel,
}

impl WithSimd for Products<'_> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<Vec<f64>> {
        let Self { panels, with } = self;
        let mut products: Vec<Vec<f64>> =
            panels.iter().map(|panel| vec![0.0; with.stride * panel.stride]).collect();
        for first in (0..with.size).step_by(TILE) {
            let count = TILE.min(with.size - first);
            for (panel, products) in panels.iter().zip(&mut products) {
                let registers = panel.registers::<S>();
                let x = &panel.as_registers::<S>()[first * registers..][..count * registers];
                let products = S::as_mut_simd_f64s(products).0;
                for chunk in 0..with.stride / LANES {
                    for group in 0..registers {
                        let sums =
                            sums::<S, LANES, 1, LANES>(simd, with.lanes(first, chunk), x, registers, group);
                        for (i, sum) in sums.iter().enumerate() {
                            let at = &mut products[(LANES * chunk + i) * registers + group];
                            *at = simd.add_f64s(*at, *sum);
                        }
                    }
                }
            }
        }
        products
    }
}

struct Add<'a> {
    panels: &'a [&'a Panel],
    coefficients: &'a [Vec<f64>],
    to: &'a mut Panel,
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { panels, coefficients, to } = self;
        let registers = to.registers::<S>();
        for first in (0..to.size).step_by(TILE) {
            let count = TILE.min(to.size - first);
            let y = &mut to.as_mut_registers::<S>()[first * registers..][..count * registers];
            for (panel, coefficients) in panels.iter().zip(coefficients) {
                let coefficients = S::as_simd_f64s(coefficients).0;
                for chunk in 0..panel.stride / LANES {
                    for group in 0..registers {
                        let mut factors = [simd.splat_f64s(0.0); LANES];
                        for i in 0..LANES {
                            factors[i] = coefficients[(LANES * chunk + i) * registers + group];
                        }
                        add::<S, LANES, 1, LANES>(
                            simd,
                            panel.lanes(first, chunk),
                            &factors,
                            y,
                            registers,
                            group,
                        );
                    }
                }
            }
        }
    }
}

/// Sums over the unknowns of `x`, `R` of them, of one group of `G` of their registers each: Σ_k `factors`_ki x_k; `N` = `R` `G`.
#[inline(always)]
pub(super) fn sums<'a, S: Simd, const R: usize, const G: usize, const N: usize>(
    simd: S,
    factors: impl Iterator<Item = &'a [f64; R]>,
    x: &[S::f64s],
    registers: usize,
    group: usize,
) -> [S::f64s; N] {
    let mut sums = [simd.splat_f64s(0.0); N];
    for (x, factors) in x.chunks_exact(registers).zip(factors) {
        let x = &x[group..][..G];
        for i in 0..R {
            let factor = simd.splat_f64s(factors[i]);
            for g in 0..G {
                sums[i * G + g] = simd.mul_add_e_f64s(factor, x[g], sums[i * G + g]);
            }
        }
    }
    sums
}

/// Adds `R` terms to every unknown of `x`, to one group of `G` of its registers: x_k ← x_k + Σ_i `factors`_ki y_i;
/// `N` = `R` `G`.
#[inline(always)]
pub(super) fn add<'a, S: Simd, const R: usize, const G: usize, const N: usize>(
    simd: S,
    factors: impl Iterator<Item = &'a [f64; R]>,
    y: &[S::f64s; N],
    x: &mut [S::f64s],
    registers: usize,
    group: usize,
) {
    for (x, factors) in x.chunks_exact_mut(registers).zip(factors) {
        let x = &mut x[group..][..G];
        let mut kept = [simd.splat_f64s(0.0); G];
        kept.copy_from_slice(x);
        for i in 0..R {
            let factor = simd.splat_f64s(factors[i]);
            for g in 0..G {
                kept[g] = simd.mul_add_e_f64s(factor, y[i * G + g], kept[g]);
            }
        }
        x.copy_from_slice(&kept);
    }
}
