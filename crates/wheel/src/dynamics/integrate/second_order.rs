//! Displacement of second order of blades that bend far, at rows that are read.

use pulp::Simd;

use super::super::bending::{Bending, MOST_COORDINATES, products};
use super::super::contact::slopes::{Slopes, add_column};
use super::super::direction::{COMPONENTS, Direction};
use super::super::oscillators::lanes::padded;
use super::super::sector::ContactNode;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Displacement Σ_a c_a q_a(p) of second order of some rows, behind which the coordinates p are read as rows, too.
#[derive(Debug)]
pub(super) struct SecondOrder {
    /// Number of rows that move.
    rows: usize,
    /// Number of coordinates of a sector.
    coordinates: usize,
    /// Number of rows and coordinates, padded to whole vectors.
    stride: usize,
    /// Coefficients c, `[product][row]`, padded by zeros.
    curvature: Aligned,
    /// Coordinates of each product.
    products: Vec<(usize, usize)>,
    /// Displacement of the rows of one sector.
    moved: Vec<f64>,
}

impl SecondOrder {
    /// Displacement along `directions`; of places that are no contact nodes it is not known and left out.
    pub(super) fn along(bending: Bending<'_>, directions: &[Direction]) -> Self {
        let of = &bending.blade.second_order;
        Self::of(bending, directions.len(), |row, product| {
            let Direction { node, components } = directions[row];
            let known = COMPONENTS * (node + 1) <= of.nrows();
            let along = components.iter().enumerate();
            if known { along.map(|(d, c)| c * of[(COMPONENTS * node + d, product)]).sum() } else { 0.0 }
        })
    }

    /// Motion of contact nodes towards the casing: along their normals, and what a tangential motion adds to their radius.
    pub(super) fn towards_casing(bending: Bending<'_>, nodes: &[ContactNode]) -> Self {
        let (linear, of) = (&bending.blade.linear, &bending.blade.second_order);
        let pairs: Vec<_> = products(bending.blade.coordinates()).collect();
        Self::of(bending, nodes.len(), |row, product| {
            let ContactNode { normal, position, .. } = &nodes[row];
            let along = normal.iter().enumerate();
            let moved: f64 = along.map(|(d, n)| n * of[(COMPONENTS * row + d, product)]).sum();
            let around = |j: usize| linear[(COMPONENTS * row + 1, j)];
            let (j, k) = pairs[product];
            let twice = if j == k { 1.0 } else { 2.0 };
            let outward = twice * around(j) * around(k) / (2.0 * position[0]);
            moved + if position[0] > 0.0 { normal[0] * outward } else { 0.0 }
        })
    }

    fn of(bending: Bending<'_>, rows: usize, c: impl Fn(usize, usize) -> f64) -> Self {
        let coordinates = bending.blade.coordinates();
        let products: Vec<_> = products(coordinates).collect();
        let stride = padded(rows + coordinates);
        let mut curvature = Aligned::zeros(products.len() * stride);
        for (product, of) in curvature.chunks_exact_mut(stride).enumerate() {
            of[..rows].iter_mut().enumerate().for_each(|(row, of)| *of = c(row, product));
        }
        Self { rows, coordinates, stride, curvature, products, moved: vec![0.0; stride] }
    }

    /// Adds the displacement to the rows in Fourier coordinates, `[column][row]`, padded, the coordinates behind the rows.
    #[inline(always)]
    pub(super) fn add(&mut self, fourier: &SectorFourier, harmonic: &mut [f64]) {
        let Self { rows, coordinates: m, stride, curvature, products, moved } = self;
        let mut p = [0.0; MOST_COORDINATES];
        // The coordinates stay as they are while the rows before them are added to.
        for sector in 0..fourier.sectors() {
            coordinates(fourier, sector, &harmonic[*rows..], *stride, &mut p[..*m]);
            moved.fill(0.0);
            for (c, &(j, k)) in curvature.chunks_exact(*stride).zip(&*products) {
                add_column(c, p[j] * p[k], moved);
            }
            for (row, column) in fourier.row(sector).iter().zip(harmonic.chunks_exact_mut(*stride)) {
                add_column(moved, *row, column);
            }
        }
    }

    /// Takes the displacement of the rows of a sector from their gaps; returns the smallest. `linear` is the linear displacement of rows and
    /// coordinates, both padded.
    #[inline(always)]
    pub(super) fn close<S: Simd>(&self, simd: S, linear: &[f64], gap: &mut [S::f64s]) -> S::f64s {
        let p = &linear[self.rows..][..self.coordinates];
        let curvature = S::as_simd_f64s(&self.curvature).0;
        for (c, &(j, k)) in curvature.chunks_exact(gap.len()).zip(&self.products) {
            let q = simd.splat_f64s(p[j] * p[k]);
            for (gap, &c) in gap.iter_mut().zip(c) {
                *gap = simd.negate_mul_add_e_f64s(q, c, *gap);
            }
        }
        let mut smallest = simd.splat_f64s(f64::INFINITY);
        for &gap in &*gap {
            smallest = simd.min_f64s(smallest, gap);
        }
        smallest
    }

    /// Derivatives of the displacement by the coordinates.
    pub(super) fn slopes(&self, sectors: usize) -> Slopes {
        let Self { rows, coordinates, stride, curvature, products, .. } = self;
        Slopes::new(sectors, *rows, *coordinates, curvature.clone(), *stride, products.clone())
    }
}

/// Writes the coordinates of a sector, given in Fourier coordinates `[column][coordinate]` padded to `stride`, into `p`.
#[inline(always)]
fn coordinates(fourier: &SectorFourier, sector: usize, harmonic: &[f64], stride: usize, p: &mut [f64]) {
    p.fill(0.0);
    for (&row, column) in fourier.row(sector).iter().zip(harmonic.chunks(stride)) {
        p.iter_mut().zip(column).for_each(|(p, value)| *p += row * value);
    }
}
