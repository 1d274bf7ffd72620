//! Displacement of second order of blades that bend far, at rows that are read.

use super::super::bending::{Bending, products};
use super::super::direction::{COMPONENTS, Direction};
use super::super::oscillators::driven::coordinates;
use super::super::sector::ContactNode;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Displacement Σ_a c_a q_a(p) of second order of some rows, behind which the coordinates p are read as rows, too.
#[derive(Debug)]
pub(super) struct SecondOrder {
    /// Number of rows that move.
    rows: usize,
    /// Coefficients c, `[product][row]`.
    curvature: Vec<f64>,
    /// Coordinates of one sector.
    p: Vec<f64>,
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

    fn of(bending: Bending<'_>, rows: usize, curvature: impl Fn(usize, usize) -> f64) -> Self {
        let m = bending.blade.coordinates();
        let all = (0..products(m).count()).flat_map(|product| (0..rows).map(move |row| (row, product)));
        Self {
            rows,
            curvature: all.map(|(row, product)| curvature(row, product)).collect(),
            p: vec![0.0; m],
            moved: vec![0.0; rows],
        }
    }

    /// Adds the displacement to the rows in Fourier coordinates, `[column][row]` padded to `stride`, the coordinates behind the rows.
    #[inline(always)]
    pub(super) fn add(&mut self, fourier: &SectorFourier, harmonic: &mut [f64], stride: usize) {
        let Self { rows, curvature, p, moved } = self;
        // The coordinates stay as they are while the rows before them are added to.
        for sector in 0..fourier.sectors() {
            coordinates(fourier, sector, &harmonic[*rows..], stride, p);
            moved.fill(0.0);
            for (curvature, (j, k)) in curvature.chunks_exact((*rows).max(1)).zip(products(p.len())) {
                let q = p[j] * p[k];
                moved.iter_mut().zip(curvature).for_each(|(moved, c)| *moved += c * q);
            }
            for (&row, column) in fourier.row(sector).iter().zip(harmonic.chunks_mut(stride)) {
                column.iter_mut().zip(&*moved).for_each(|(sum, moved)| *sum += row * moved);
            }
        }
    }

    /// Writes the derivatives of the displacement by the coordinates, `[sector][row][coordinate]`, at those in `harmonic` as of [`Self::add`].
    #[inline(always)]
    pub(super) fn slopes(
        &mut self,
        fourier: &SectorFourier,
        harmonic: &[f64],
        stride: usize,
        slopes: &mut [f64],
    ) {
        let Self { rows, curvature, p, .. } = self;
        let m = p.len();
        for (sector, slopes) in slopes.chunks_exact_mut(*rows * m).enumerate() {
            coordinates(fourier, sector, &harmonic[*rows..], stride, p);
            slopes.fill(0.0);
            for (curvature, (j, k)) in curvature.chunks_exact(*rows).zip(products(m)) {
                for (slope, c) in slopes.chunks_exact_mut(m).zip(curvature) {
                    slope[j] += c * p[k];
                    slope[k] += c * p[j];
                }
            }
        }
    }
}
