//! What displacements are in no sector beyond, without transforming them to any.

use std::f64::consts::SQRT_2;

use pulp::Simd;

use rubmap_numerics::sector_fourier::{SectorFourier, Wave};

/// Σ over nodal diameters of the amplitude of every row of `harmonic[column][row]`, rows padded to whole vectors, into `farthest[row]`:
/// |u| of a single nodal diameter and, of a pair, what is nowhere below √(re² + im²) and at most 8 % above it.
#[inline(always)]
pub(super) fn farthest_anywhere<S: Simd>(
    simd: S,
    fourier: &SectorFourier,
    harmonic: &[f64],
    farthest: &mut [f64],
) {
    let harmonic = S::as_simd_f64s(harmonic).0;
    let farthest = S::as_mut_simd_f64s(farthest).0;
    let vectors = farthest.len();
    // The chord of √(1 + x²) between 0 and 1.
    let slope = simd.splat_f64s(SQRT_2 - 1.0);
    farthest.fill(simd.splat_f64s(0.0));
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
                _ => simd.mul_add_e_f64s(slope, simd.min_f64s(re, im), simd.max_f64s(re, im)),
            };
            farthest[v] = simd.mul_add_e_f64s(weight, amplitude, farthest[v]);
        }
    }
}
