//! Mistuning: sectors of slightly different stiffness couple the nodal diameters.
//!
//! Sector s has (1 + δ_s) times the stiffness of the tuned wheel. Following the fundamental mistuning model (Feiner and
//! Griffin, J. Turbomachinery 124, 2002), the strain energy of a modal family is taken to lie in each sector as that of the
//! family's own coordinate there:
//!
//! ```text
//! V_δ = ½ Σ_s δ_s a_s²,   a_s = Σ_i Re(w_i e^{jisα} ω_i e^{jψ_i} z_i)
//! f = −∂V_δ/∂z
//! ```
//!
//! ψ_i turns the mode shapes of the family to one phase over the nodal diameters, that of the highest single one, whose
//! shape is real. Exact for a deviation common to all sectors (ω² → (1 + δ)ω²) and for sectors that hardly couple; good
//! where a family's shape hardly changes with the nodal diameter, which blade-dominated families do. Families are not
//! coupled to each other. Those that a step hardly resolves (ω²B > 3) stay tuned.
//!
//! The force acts at the middle instant of a step, so that its work is −ΔV_δ, with V_δ of two successive instants.

use faer::{Mat, c64};
use pulp::Simd;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::oscillators::lanes::padded;
use rubmap_numerics::aligned::Aligned;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Largest part of its stability limit, ω²B < 4, that B of a mode may take for the mode to be mistuned.
pub(crate) const RESOLVED: f64 = 3.0;

/// Largest deviation: beyond it the wheel is another one; within it ω²B(1 + δ) stays below 4.
pub const LARGEST_DEVIATION: f64 = 0.25;

/// Number of rows of the coupling at a time, which share the loads of amplitudes: their sums stay in registers.
const GROUP: usize = 5;

/// Coupling of the nodal diameters by mistuning.
#[derive(Debug)]
pub(crate) struct ModalMistuning {
    /// Number of mistuned families.
    families: usize,
    /// Number of mistuned families, padded to whole vectors.
    length: usize,
    /// Weights ω e^{jψ} of every nodal diameter.
    weight: Vec<Weight>,
    /// Coupling Fᵀ diag(δ) F over the Fourier columns, `[group of rows][column][row]`; the last group is padded.
    coupling: Vec<[f64; GROUP]>,
    /// Amplitudes a in Fourier coordinates, `[column][family]`, families padded.
    amplitude: Aligned,
    /// Amplitudes times `coupling`, `[column][family]`, families padded.
    pull: Aligned,
}

/// Complex number of every family, 0 in the padding.
#[derive(Debug)]
struct Weight {
    re: Aligned,
    im: Aligned,
}

impl Weight {
    #[inline(always)]
    fn vectors<S: Simd>(&self) -> (&[S::f64s], &[S::f64s]) {
        let re = S::as_simd_f64s(&self.re).0;
        (re, &S::as_simd_f64s(&self.im).0[..re.len()])
    }

    fn at(&self, family: usize) -> c64 {
        c64::new(self.re[family], self.im[family])
    }
}

/// Offsets of a nodal diameter's modes in the state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ModeOffsets {
    /// Start of the real part.
    pub(crate) re: usize,
    /// Start of the imaginary part; none of a single harmonic.
    pub(crate) im: Option<usize>,
    /// Fourier column of the real part.
    pub(crate) column: usize,
}

impl ModalMistuning {
    /// Mistunes `resolved` families of every nodal diameter.
    pub(crate) fn new(
        deviations: &[f64],
        wheel: &ModalWheel,
        contact_nodes: usize,
        fourier: &SectorFourier,
        resolved: usize,
    ) -> Self {
        let sectors = wheel.sectors;
        let families = wheel.harmonics.iter().map(|h| h.omega.len()).min().unwrap_or(0).min(resolved);
        // The last harmonic is the highest; of an odd number of sectors only the first one is single.
        let reference = wheel.harmonics.iter().rev().find(|h| h.single);
        let length = padded(families);
        let weight = |harmonic: &ModalHarmonic| {
            let of = |m: usize| {
                let alike = reference.map_or(c64::ONE, |reference| {
                    let rows = 0..3 * contact_nodes;
                    rows.map(|row| reference.contact[(row, m)].conj() * harmonic.contact[(row, m)]).sum()
                });
                let size = alike.norm();
                let phase = if size > 0.0 { alike / size } else { c64::ONE };
                phase * harmonic.omega[m]
            };
            let mut weight = Weight { re: Aligned::zeros(length), im: Aligned::zeros(length) };
            for m in 0..families {
                let w: c64 = of(m);
                (weight.re[m], weight.im[m]) = (w.re, w.im);
            }
            weight
        };
        let groups = sectors.div_ceil(GROUP);
        let mut coupling = vec![[0.0; GROUP]; groups * sectors];
        for (sector, delta) in deviations.iter().enumerate() {
            let row = fourier.row(sector);
            for a in 0..sectors {
                for b in 0..sectors {
                    coupling[a / GROUP * sectors + b][a % GROUP] += row[a] * delta * row[b];
                }
            }
        }
        Self {
            families,
            length,
            weight: wheel.harmonics.iter().map(weight).collect(),
            coupling,
            amplitude: Aligned::zeros(sectors * length),
            pull: Aligned::zeros(groups * GROUP * length),
        }
    }

    /// Stiffness −∂f/∂z of every mistuned family between the Fourier columns: Re(w̄ C w), symmetric.
    pub(crate) fn stiffness(&self, offsets: &[ModeOffsets]) -> Vec<Mat<f64>> {
        let sectors = offsets.iter().map(|offset| 1 + usize::from(offset.im.is_some())).sum();
        let of = |family: usize| {
            // Amplitudes per unit z: of a pair the real and the imaginary part of w and of jw.
            let mut amplitude = Mat::<f64>::zeros(sectors, sectors);
            for (offset, weight) in offsets.iter().zip(&self.weight) {
                let (w, re) = (weight.at(family), offset.column);
                amplitude[(re, re)] = w.re;
                if offset.im.is_some() {
                    amplitude[(re + 1, re)] = w.im;
                    amplitude[(re, re + 1)] = -w.im;
                    amplitude[(re + 1, re + 1)] = w.re;
                }
            }
            let coupling: Mat<f64> =
                Mat::from_fn(sectors, sectors, |a, b| self.coupling[a / GROUP * sectors + b][a % GROUP]);
            amplitude.transpose() * (coupling * &amplitude)
        };
        (0..self.families).map(of).collect()
    }

    /// Writes the modal forces of the state `z`.
    #[inline(always)]
    pub(crate) fn force<S: Simd>(&mut self, simd: S, offsets: &[ModeOffsets], z: &[f64], force: &mut [f64]) {
        if self.families == 0 {
            return;
        }
        let Self { length, weight, coupling, amplitude, pull, .. } = self;
        let vectors = *length / S::F64_LANES;
        let line = |column: usize| column * vectors;
        let amplitude = S::as_mut_simd_f64s(amplitude).0;
        for (offset, weight) in offsets.iter().zip(&*weight) {
            let (w_re, w_im) = weight.vectors::<S>();
            let z_re = &S::as_simd_f64s(&z[offset.re..offset.re + *length]).0[..vectors];
            let amplitude = &mut amplitude[line(offset.column)..];
            match offset.im {
                Some(im) => {
                    let z_im = &S::as_simd_f64s(&z[im..im + *length]).0[..vectors];
                    let (a_re, a_im) = amplitude.split_at_mut(vectors);
                    for v in 0..vectors {
                        let (re, im) = (simd.mul_f64s(w_re[v], z_re[v]), simd.mul_f64s(w_re[v], z_im[v]));
                        a_re[v] = simd.negate_mul_add_e_f64s(w_im[v], z_im[v], re);
                        a_im[v] = simd.mul_add_e_f64s(w_im[v], z_re[v], im);
                    }
                }
                None => {
                    for v in 0..vectors {
                        amplitude[v] = simd.mul_f64s(w_re[v], z_re[v]);
                    }
                }
            }
        }
        let amplitude = &*amplitude;
        let columns = amplitude.len() / vectors;
        let pull = S::as_mut_simd_f64s(pull).0;
        for (pull, factors) in pull.chunks_exact_mut(GROUP * vectors).zip(coupling.chunks_exact(columns)) {
            for v in 0..vectors {
                let mut sums = [simd.splat_f64s(0.0); GROUP];
                for (factors, amplitude) in factors.iter().zip(amplitude.chunks_exact(vectors)) {
                    let a = amplitude[v];
                    for r in 0..GROUP {
                        sums[r] = simd.mul_add_e_f64s(simd.splat_f64s(factors[r]), a, sums[r]);
                    }
                }
                for r in 0..GROUP {
                    pull[line(r) + v] = sums[r];
                }
            }
        }
        for (offset, weight) in offsets.iter().zip(&*weight) {
            let (w_re, w_im) = weight.vectors::<S>();
            let pull = &pull[line(offset.column)..];
            let zero = simd.splat_f64s(0.0);
            for v in 0..vectors {
                let p_im = if offset.im.is_some() { pull[line(1) + v] } else { zero };
                let (w_re, w_im, p_re) = (w_re[v], w_im[v], pull[v]);
                let re = simd.mul_add_e_f64s(w_im, p_im, simd.mul_f64s(w_re, p_re));
                let im = simd.negate_mul_add_e_f64s(w_re, p_im, simd.mul_f64s(w_im, p_re));
                S::as_mut_simd_f64s(&mut force[offset.re..offset.re + *length]).0[v] = simd.neg_f64s(re);
                if let Some(start) = offset.im {
                    S::as_mut_simd_f64s(&mut force[start..start + *length]).0[v] = im;
                }
            }
        }
    }
}

/// Deviations δ of `sectors` sectors, normally distributed with standard deviation `spread` about 0 and cut at [`LARGEST_DEVIATION`].
pub fn normal_deviations(spread: f64, seed: u64, sectors: usize) -> Vec<f64> {
    let cut = |x: f64| (spread * x).clamp(-LARGEST_DEVIATION, LARGEST_DEVIATION);
    normal_numbers(seed).take(sectors).map(cut).collect()
}

/// Normally distributed numbers of variance 1; a seed gives equal numbers in every version (SplitMix64, Box–Muller).
pub fn normal_numbers(seed: u64) -> impl Iterator<Item = f64> {
    let mut generator = SplitMix64::seed_from_u64(seed);
    // In (0, 1].
    let mut uniform = move || ((generator.next_u64() >> 11) + 1) as f64 / (1u64 << 53) as f64;
    std::iter::repeat_with(move || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos())
}
