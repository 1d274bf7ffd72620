//! The real orthonormal Fourier basis over N equal sectors (Eq. 12's matrix F).

use std::f64::consts::TAU;

/// Wave that one column of the basis belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wave {
    /// Single wave of harmonic 0, or of N/2 for even N.
    Single,
    /// Wave cos(i s α): pairs with the real part of a complex amplitude.
    Cosine,
    /// Wave −sin(i s α): pairs with the imaginary part, since Re(x e^{jisα}) = Re x cos − Im x sin.
    NegativeSine,
}

/// Real orthonormal basis of functions over the sectors 0 … N−1, one column per wave, harmonics ascending:
/// Fᵀ F = I. Column values are 1/√N for single waves (±) and √(2/N) cos, −√(2/N) sin for pairs.
///
/// ```
/// use rubmap_numerics::sector_fourier::SectorFourier;
///
/// // Two nodal diameters over ten sectors belong to harmonic 2 alone, and keep their sum of squares.
/// let basis = SectorFourier::new(10);
/// let wave = |s: usize| (std::f64::consts::TAU * 2.0 * s as f64 / 10.0 + 0.3).cos();
/// let mut squares = 0.0;
/// for (column, &(harmonic, _)) in basis.columns().iter().enumerate() {
///     let share: f64 = (0..10).map(|s| basis.row(s)[column] * wave(s)).sum();
///     assert!(harmonic == 2 || share.abs() < 1e-14);
///     squares += share * share;
/// }
/// assert!((squares - 5.0).abs() < 1e-14);
/// ```
#[derive(Debug, Clone)]
pub struct SectorFourier {
    sectors: usize,
    columns: Vec<(usize, Wave)>,
    /// Values of the basis, row-major `[sector][column]`.
    table: Vec<f64>,
}

impl SectorFourier {
    /// The basis for `sectors` ≥ 1.
    pub fn new(sectors: usize) -> Self {
        assert!(sectors >= 1, "a wheel has at least one sector");
        let columns: Vec<_> = (0..=sectors / 2)
            .flat_map(|i| {
                if is_single(i, sectors) {
                    vec![(i, Wave::Single)]
                } else {
                    vec![(i, Wave::Cosine), (i, Wave::NegativeSine)]
                }
            })
            .collect();
        let single = (1.0 / sectors as f64).sqrt();
        let pair = (2.0 / sectors as f64).sqrt();
        let table = (0..sectors)
            .flat_map(|s| {
                columns.iter().map(move |&(i, wave)| {
                    // The reduced angle keeps cos and sin exact for large i·s.
                    let angle = TAU * ((i * s) % sectors) as f64 / sectors as f64;
                    match wave {
                        Wave::Single if i == 0 || s % 2 == 0 => single,
                        Wave::Single => -single,
                        Wave::Cosine => pair * angle.cos(),
                        Wave::NegativeSine => -pair * angle.sin(),
                    }
                })
            })
            .collect();
        Self { sectors, columns, table }
    }

    /// Number N of sectors.
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Harmonic and wave of each column.
    pub fn columns(&self) -> &[(usize, Wave)] {
        &self.columns
    }

    /// Values of all columns at one sector.
    pub fn row(&self, sector: usize) -> &[f64] {
        &self.table[sector * self.sectors..][..self.sectors]
    }
}

/// Number of harmonics (nodal diameters) of N sectors: 0 … ⌊N/2⌋.
pub fn harmonic_count(sectors: usize) -> usize {
    sectors / 2 + 1
}

/// Whether harmonic `i` of `sectors` is real and single (0, and N/2 for even N); all others are pairs.
pub fn is_single(i: usize, sectors: usize) -> bool {
    i == 0 || 2 * i == sectors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_orthonormal_for_odd_and_even_sector_counts() {
        for n in [1, 2, 3, 4, 7, 10, 64] {
            let basis = SectorFourier::new(n);
            assert_eq!(basis.columns().len(), n);
            for a in 0..n {
                for b in 0..n {
                    let dot: f64 = (0..n).map(|s| basis.row(s)[a] * basis.row(s)[b]).sum();
                    assert!((dot - f64::from(a == b)).abs() < 1e-14 * n as f64, "n={n} {a} {b}");
                }
            }
        }
    }
}
