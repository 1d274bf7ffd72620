//! Bounds of displacements that need no transform to the sectors.

use std::f64::consts::SQRT_2;

use pulp::Simd;

use rubmap_numerics::sector_fourier::{SectorFourier, Wave};

/// Sums the amplitudes of all nodal diameters of every row of `harmonic[column][row]`, rows padded to whole vectors: no row is displaced by more in
/// any sector. The amplitude of a pair is estimated by a number nowhere below √(re² + im²) and at most 8.3 % above it. NaN stays NaN.
#[inline(always)]
pub(super) fn amplitude_sums<S: Simd>(simd: S, fourier: &SectorFourier, harmonic: &[f64], sums: &mut [f64]) {
    let harmonic = S::as_simd_f64s(harmonic).0;
    let sums = S::as_mut_simd_f64s(sums).0;
    let vectors = sums.len();
    // max + (√2 − 1) min, the chord of √(1 + x²) between 0 and 1, as re + im − (2 − √2) min.
    let less = simd.splat_f64s(2.0 - SQRT_2);
    sums.fill(simd.splat_f64s(0.0));
    for (column, &(_, wave)) in fourier.columns().iter().enumerate() {
        let first = match wave {
            Wave::Single => column,
            Wave::Cosine => continue,
            Wave::NegativeSine => column - 1,
        };
        let weight = simd.splat_f64s(fourier.row(0)[first]);
        let (re, im) = (&harmonic[first * vectors..][..vectors], &harmonic[column * vectors..][..vectors]);
        for v in 0..vectors {
            let (re, im) = (simd.abs_f64s(re[v]), simd.abs_f64s(im[v]));
            let amplitude = match wave {
                Wave::Single => re,
                _ => simd.negate_mul_add_e_f64s(less, simd.min_f64s(re, im), simd.add_f64s(re, im)),
            };
            sums[v] = simd.mul_add_e_f64s(weight, amplitude, sums[v]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::Numbers;
    use super::*;

    const ROWS: usize = 8;

    fn sums(sectors: usize, harmonic: &[f64]) -> Vec<f64> {
        let mut sums = vec![f64::NAN; ROWS];
        amplitude_sums(pulp::Scalar, &SectorFourier::new(sectors), harmonic, &mut sums);
        sums
    }

    #[test]
    fn no_sector_is_displaced_by_more_and_a_single_wave_hardly_by_less() {
        let mut numbers = Numbers(11);
        for sectors in [1, 2, 3, 8, 17] {
            let fourier = SectorFourier::new(sectors);
            for only in (0..=sectors / 2).map(Some).chain([None]) {
                let kept = |column: usize| only.is_none_or(|only| fourier.columns()[column].0 == only);
                let mut harmonic = vec![0.0; sectors * ROWS];
                for (at, value) in harmonic.iter_mut().enumerate().filter(|&(at, _)| kept(at / ROWS)) {
                    // Rows of every phase, the worst among them.
                    *value = if at % ROWS == 0 { 1.0 } else { numbers.next() };
                }
                for (row, sum) in sums(sectors, &harmonic).into_iter().enumerate() {
                    // Between the sectors, too: they need not meet the crest of a wave.
                    let largest = (0..1000).map(|turn| {
                        let wave = |column: usize, harmonic: usize, wave: Wave| {
                            let angle = std::f64::consts::TAU * (harmonic * turn) as f64 / 1000.0;
                            let amplitude =
                                fourier.row(0)[if wave == Wave::NegativeSine { column - 1 } else { column }];
                            amplitude
                                * match wave {
                                    Wave::NegativeSine => -angle.sin(),
                                    Wave::Cosine => angle.cos(),
                                    // Seen in sectors only, where it is all or minus that.
                                    Wave::Single => 1.0,
                                }
                        };
                        let columns = fourier.columns().iter().enumerate();
                        columns
                            .map(|(c, &(h, w))| wave(c, h, w) * harmonic[c * ROWS + row])
                            .sum::<f64>()
                            .abs()
                    });
                    let largest = largest.fold(0.0, f64::max);
                    let exact = (0..sectors).map(|sector| {
                        let columns = fourier.row(sector).iter().enumerate();
                        columns.map(|(c, f)| f * harmonic[c * ROWS + row]).sum::<f64>().abs()
                    });
                    let exact = exact.fold(0.0, f64::max);
                    assert!(sum >= exact * (1.0 - 1e-14), "{sectors} {only:?} {row}: {sum} {exact}");
                    if only.is_some() {
                        assert!(sum <= 1.083 * largest, "{sectors} {only:?} {row}: {sum} {largest}");
                    }
                }
            }
        }
    }

    #[test]
    fn no_number_stays_none() {
        for column in 0..4 {
            let mut harmonic = vec![0.5; 4 * ROWS];
            harmonic[column * ROWS + 3] = f64::NAN;
            let sums = sums(4, &harmonic);
            assert!(
                sums.iter().enumerate().all(|(row, sum)| sum.is_nan() == (row == 3)),
                "{column}: {sums:?}"
            );
        }
    }
}
