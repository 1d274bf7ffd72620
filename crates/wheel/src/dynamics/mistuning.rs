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

use faer::{Mat, MatRef, c64};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::modal_wheel::ModalWheel;
use rubmap_numerics::sector_fourier::SectorFourier;

/// The most that B of a mode may take of its stability limit, ω²B < 4, for the mode to be mistuned.
pub(crate) const RESOLVED: f64 = 3.0;

/// Deviations beyond this are another wheel: ω²B(1 + δ) stays below 4.
pub const LARGEST_DEVIATION: f64 = 0.25;

/// The coupling of the nodal diameters.
#[derive(Debug)]
pub(crate) struct ModalMistuning {
    /// Mistuned families.
    families: usize,
    /// ω e^{jψ}, `[harmonic][family]`.
    weight: Vec<Vec<c64>>,
    /// Fᵀ diag(δ) F over the Fourier columns, row-major.
    coupling: Vec<f64>,
    /// a in Fourier coordinates, `[column][family]`.
    amplitude: Vec<f64>,
    /// The same times `coupling`.
    pull: Vec<f64>,
}

/// Where a nodal diameter's modes are in the state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// Start of the real part.
    pub(crate) re: usize,
    /// Start of the imaginary part; none of a single harmonic.
    pub(crate) im: Option<usize>,
    /// Fourier column of the real part.
    pub(crate) column: usize,
}

impl ModalMistuning {
    /// `resolved` families of every nodal diameter are mistuned.
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
        let weight = |harmonic: &super::modal_wheel::ModalHarmonic| {
            let of = |m: usize| {
                let alike = reference.map_or(c64::ONE, |reference| {
                    let rows = 0..3 * contact_nodes;
                    rows.map(|row| reference.contact[(row, m)].conj() * harmonic.contact[(row, m)]).sum()
                });
                let size = alike.norm();
                let phase = if size > 0.0 { alike / size } else { c64::ONE };
                phase * harmonic.omega[m]
            };
            (0..families).map(of).collect()
        };
        let mut coupling = vec![0.0; sectors * sectors];
        for (sector, delta) in deviations.iter().enumerate() {
            let row = fourier.row(sector);
            for a in 0..sectors {
                for b in 0..sectors {
                    coupling[a * sectors + b] += row[a] * delta * row[b];
                }
            }
        }
        Self {
            families,
            weight: wheel.harmonics.iter().map(weight).collect(),
            coupling,
            amplitude: vec![0.0; sectors * families],
            pull: vec![0.0; sectors * families],
        }
    }

    /// −∂f/∂z of every mistuned family between the Fourier columns: Re(w̄ C w), symmetric.
    pub(crate) fn stiffness(&self, places: &[Place]) -> Vec<Mat<f64>> {
        let sectors = self.coupling.len().isqrt();
        let of = |family: usize| {
            // Amplitudes per unit z: of a pair the real and the imaginary part of w and of jw.
            let mut amplitude = Mat::zeros(sectors, sectors);
            for (place, weight) in places.iter().zip(&self.weight) {
                let (w, re) = (weight[family], place.column);
                amplitude[(re, re)] = w.re;
                if place.im.is_some() {
                    amplitude[(re + 1, re)] = w.im;
                    amplitude[(re, re + 1)] = -w.im;
                    amplitude[(re + 1, re + 1)] = w.re;
                }
            }
            let coupling = MatRef::from_row_major_slice(&self.coupling, sectors, sectors);
            amplitude.transpose() * (coupling * &amplitude)
        };
        (0..self.families).map(of).collect()
    }

    /// Writes the modal forces of the state `z`.
    pub(crate) fn force(&mut self, places: &[Place], z: &[f64], force: &mut [f64]) {
        let families = self.families;
        if families == 0 {
            return;
        }
        for (place, weight) in places.iter().zip(&self.weight) {
            let line = place.column * families;
            for (m, w) in weight.iter().enumerate() {
                let value = c64::new(z[place.re + m], place.im.map_or(0.0, |im| z[im + m])) * w;
                self.amplitude[line + m] = value.re;
                if place.im.is_some() {
                    self.amplitude[line + families + m] = value.im;
                }
            }
        }
        let sectors = self.amplitude.len() / families;
        for (row, pull) in self.pull.chunks_exact_mut(families).enumerate() {
            pull.fill(0.0);
            let factors = &self.coupling[row * sectors..][..sectors];
            for (factor, amplitude) in factors.iter().zip(self.amplitude.chunks_exact(families)) {
                for (pull, a) in pull.iter_mut().zip(amplitude) {
                    *pull += factor * a;
                }
            }
        }
        for (place, weight) in places.iter().zip(&self.weight) {
            let line = place.column * families;
            for (m, w) in weight.iter().enumerate() {
                let im = if place.im.is_some() { self.pull[line + families + m] } else { 0.0 };
                let value = c64::new(self.pull[line + m], im) * w.conj();
                force[place.re + m] = -value.re;
                if let Some(start) = place.im {
                    force[start + m] = -value.im;
                }
            }
        }
    }
}

/// δ of `sectors` sectors, normally distributed with standard deviation `spread` about 0 and cut at
/// [`LARGEST_DEVIATION`].
pub fn normal_deviations(spread: f64, seed: u64, sectors: usize) -> Vec<f64> {
    let cut = |x: f64| (spread * x).clamp(-LARGEST_DEVIATION, LARGEST_DEVIATION);
    normal_numbers(seed).take(sectors).map(cut).collect()
}

/// Normally distributed numbers of variance 1, the same for the same seed in every version (SplitMix64, Box–Muller).
pub fn normal_numbers(seed: u64) -> impl Iterator<Item = f64> {
    let mut generator = SplitMix64::seed_from_u64(seed);
    // In (0, 1].
    let mut uniform = move || ((generator.next_u64() >> 11) + 1) as f64 / (1u64 << 53) as f64;
    std::iter::repeat_with(move || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos())
}
