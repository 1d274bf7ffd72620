//! Spectra over whole revolutions, of sensors and of their nodal diameters (docs/method.md, Reading responses; Eqs 12, 13).

use rubmap_numerics::sector_fourier::{SectorFourier, harmonic_count};
use rubmap_numerics::spectrum::amplitudes;

/// Engine orders of the bins of a window of `window_revolutions`: 0, 1/R, 2/R … `max_engine_order`.
pub fn engine_orders(window_revolutions: u32, max_engine_order: u32) -> Vec<f64> {
    let bins = window_revolutions * max_engine_order + 1;
    (0..bins).map(|bin| f64::from(bin) / f64::from(window_revolutions)).collect()
}

/// Amplitudes over `[nodal diameter][bin]` from `[Fourier column][sample]`: the cosine and sine components of a pair are joined by root sum
/// of squares, so that Σ_i û_i² = Σ_s u_s² at every bin (Parseval).
pub fn nodal_diameter_amplitudes(
    columns: &[Vec<f64>],
    fourier: &SectorFourier,
    bins: usize,
) -> Vec<Vec<f64>> {
    let mut squares = vec![vec![0.0; bins]; harmonic_count(fourier.sectors())];
    for (line, &(harmonic, _)) in columns.iter().zip(fourier.columns()) {
        for (square, a) in squares[harmonic].iter_mut().zip(amplitudes(line, bins)) {
            *square += a * a;
        }
    }
    for line in &mut squares {
        line.iter_mut().for_each(|square| *square = square.sqrt());
    }
    squares
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Pattern of three engine orders turning past seven and ten blades.
    #[test]
    fn nodal_diameters_carry_the_whole_response() {
        for sectors in [1, 7, 10] {
            let fourier = SectorFourier::new(sectors);
            let (samples, bins) = (64, 33);
            let blade = |s: usize, n: usize| {
                let phase = TAU * (n as f64 / samples as f64 + s as f64 / sectors as f64);
                0.3 + (2.0 * phase).cos() - 0.7 * (6.0 * phase + 1.0).sin() + 0.1 * (5.0 * phase).cos()
            };
            let columns: Vec<Vec<f64>> = (0..sectors)
                .map(|c| {
                    let at = |n| (0..sectors).map(|s| fourier.row(s)[c] * blade(s, n)).sum();
                    (0..samples).map(at).collect()
                })
                .collect();
            let diameters = nodal_diameter_amplitudes(&columns, &fourier, bins);
            for bin in 0..bins {
                let of_blades: f64 = (0..sectors)
                    .map(|s| {
                        amplitudes(&(0..samples).map(|n| blade(s, n)).collect::<Vec<_>>(), bins)[bin].powi(2)
                    })
                    .sum();
                let of_diameters: f64 = diameters.iter().map(|line| line[bin].powi(2)).sum();
                assert!((of_blades - of_diameters).abs() < 1e-12, "{sectors} {bin}");
            }
            if sectors == 10 {
                // Order 6 folds onto nodal diameter 4, order 2 stays on 2, order 5 on 5.
                let scale = 10f64.sqrt();
                assert!((diameters[2][2] - scale).abs() < 1e-12);
                assert!((diameters[4][6] - 0.7 * scale).abs() < 1e-12);
                assert!((diameters[5][5] - 0.1 * scale).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn engine_orders_are_multiples_of_one_over_the_window() {
        assert_eq!(engine_orders(2, 2), [0.0, 0.5, 1.0, 1.5, 2.0]);
    }
}
