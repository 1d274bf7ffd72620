//! Modified Craig–Bampton reduction per nodal diameter (docs/method.md, Reduction; Eqs 4–6).
//!
//! Contact DOF stay physical. The internal ones follow through the static modes at rest and an orthonormal basis of
//! the fixed-interface modes at all given speeds:
//!
//! ```text
//! Υ̂(i) = [ I       0  ]      Y_r(i) = Υ̂(i)ᴴ Ŷ(i) Υ̂(i)      Y = M, K0, K1, K2
//!        [ Ψ_s(0)  Ψ* ]
//! ```
//!
//! The gyroscopic matrix, if the sector has one, is projected on the same basis.

mod assembly;
mod basis;
mod checkpoints;
mod comparison;
mod count;
mod interpolation;
pub mod mass;
mod memory;
mod modes;
mod sector_factor;
mod speed;
mod tied_factor;
mod untied;

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::centrifugal::StiffnessPolynomial;
use super::error::ModelError;
use super::modal_wheel::natural_frequencies;
use super::sector::{ContactNode, SectorModel};
use basis::Basis;
use mass::NegativeMass;
use rubmap_numerics::matrix_serde;
use rubmap_numerics::sector_fourier::harmonic_count;
use speed::{SpeedPart, Work};
use untied::UntiedSector;

pub use checkpoints::{Checkpoints, NoCheckpoints};
pub use comparison::FrequencyComparison;
pub use count::{Completeness, ModeCount};
pub use interpolation::{InterpolationCheck, InterpolationVerdict, MatrixRatios};

/// Settings of the reduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReductionOptions {
    /// Fixed-interface modes per given speed and nodal diameter: the accuracy dial k. All of them where a sector has
    /// fewer internal DOF.
    pub modes_per_speed: usize,
    /// Directions of the joint basis with a singular value below this fraction of the largest are dropped. 1e-5:
    /// smaller values keep nearly dependent directions, which only become the stiffest modes of the wheel and
    /// shrink the stable step (1560 unknowns: 1.9 times at 1e-8).
    pub basis_tolerance: f64,
    /// Bytes the reduction may use; it refuses to start where it needs more.
    pub memory_bytes: Option<u64>,
}

impl ReductionOptions {
    /// `modes_per_speed` modes with the default tolerance and no limit on memory.
    pub fn new(modes_per_speed: usize) -> Self {
        Self { modes_per_speed, basis_tolerance: 1e-5, memory_bytes: None }
    }
}

/// Reduced matrices of one nodal diameter: contact DOF first (r, θ, z per node), then modal coordinates.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedHarmonic {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// M_r, Hermitian.
    #[serde(with = "matrix_serde")]
    pub mass: Mat<c64>,
    /// K_r(Ω).
    pub stiffness: StiffnessPolynomial,
    /// G_r per unit speed, skew-Hermitian; absent if the sector has none.
    #[serde(with = "matrix_serde::option")]
    pub gyroscopic: Option<Mat<c64>>,
    /// Its fixed-interface modes at each given speed, with the proof that they are the lowest ones.
    pub certificates: Vec<ModeCertificate>,
}

/// Fixed-interface modes of one nodal diameter at one given speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeCertificate {
    /// Speed of the stiffness, rad/s.
    pub speed_rad_s: f64,
    /// Eigenvalues λ = ω², ascending, (rad/s)².
    pub eigenvalues: Vec<f64>,
    /// ‖Kx − λMx‖/‖Kx‖ of each.
    pub residuals: Vec<f64>,
    /// Whether they are known to be the lowest.
    pub completeness: Completeness,
}

impl ReducedHarmonic {
    /// Largest ‖Kx − λMx‖/‖Kx‖ of its fixed-interface modes.
    pub fn largest_mode_residual(&self) -> f64 {
        self.certificates.iter().flat_map(|certificate| &certificate.residuals).fold(0.0, |m, &r| m.max(r))
    }
}

/// The reduced wheel at every speed: all that simulations need of a sector.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedWheel {
    /// N.
    pub sectors: usize,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<ContactNode>,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// One per nodal diameter 0 … ⌊N/2⌋.
    pub harmonics: Vec<ReducedHarmonic>,
    /// How far K(Ω) can be trusted between the given speeds.
    pub interpolation: InterpolationCheck,
    /// The lowest frequencies beside the full sector's, at the given speeds and between them.
    pub comparison: Vec<FrequencyComparison>,
}

impl ReducedWheel {
    /// Number of contact DOF n_b of a sector.
    pub fn contact_dofs(&self) -> usize {
        3 * self.contact.len()
    }
}

/// Why a reduction ended without a result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// The model cannot be reduced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It would not fit into the memory allowed.
    #[error("the reduction needs some {needed_bytes} bytes of memory, and {allowed_bytes} are allowed")]
    Memory {
        /// Estimate.
        needed_bytes: u64,
        /// From the options.
        allowed_bytes: u64,
    },
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// Watches a reduction: called with the share of work done and what comes next; `false` stops it.
pub type Watch<'a> = &'a (dyn Fn(f64, &str) -> bool + 'a);

/// Reduces `sector`.
///
/// One real factor of the untied sector per speed serves every nodal diameter (sector_factor.rs). Deterministic: what runs
/// in parallel, on the current rayon pool, is independent or summed in a fixed order. Parts that `checkpoints` has
/// are not computed again.
pub fn reduce(
    sector: &SectorModel,
    options: &ReductionOptions,
    checkpoints: &dyn Checkpoints,
    watch: Watch<'_>,
) -> Result<ReducedWheel, ReductionError> {
    let scoped = |from: f64, to: f64| {
        move |share: f64, phase: &str| watch(from + (to - from) * share, &format!("reduction: {phase}"))
    };
    let harmonics = harmonic_count(sector.sectors);
    if !watch(0.0, "reduction: ordering") {
        return Err(ReductionError::Cancelled);
    }
    let matrices: Vec<_> =
        std::iter::once(&sector.mass).chain(&sector.stiffness).chain(&sector.gyroscopic).collect();
    let untied = UntiedSector::new(sector, &matrices);
    let modes_per_speed = options.modes_per_speed.min(untied.internal());
    let needed_bytes = memory::needed_bytes(sector, &untied, modes_per_speed, harmonics);
    if let Some(allowed_bytes) = options.memory_bytes.filter(|&allowed| needed_bytes > allowed) {
        return Err(ReductionError::Memory { needed_bytes, allowed_bytes });
    }
    // Modes see only the low end of the spectrum; a negative mass may hide at the other.
    mass::check_mass(sector, f64::INFINITY).map_err(|negative| {
        let NegativeMass { nodal_diameter, dof } = negative;
        ModelError::NegativeMass { nodal_diameter, dof }
    })?;
    let mass = untied.assemble(&[(1.0, &sector.mass)]);
    let work = Work { sector, untied: &untied, mass: &mass, modes_per_speed, harmonics, checkpoints };

    let given = sector.speeds_rad_s.len() as f64;
    let mut parts = Vec::with_capacity(sector.speeds_rad_s.len());
    for index in 0..sector.speeds_rad_s.len() {
        let (from, to) = (0.02 + 0.73 * index as f64 / given, 0.02 + 0.73 * (index as f64 + 1.0) / given);
        parts.push(work.at_given_speed(index, &scoped(from, to))?);
    }
    let mut full: Vec<_> =
        sector.speeds_rad_s.iter().copied().zip(parts.iter().map(|p| p.full.clone())).collect();
    if let [_, _, top] = *sector.speeds_rad_s {
        let block = parts.iter().map(|part| part.full_block).max().unwrap_or(1);
        for (name, speed, from) in [("between-1", 0.25 * top, 0.75), ("between-2", 0.75 * top, 0.84)] {
            full.push((speed, work.at_speed_between(name, speed, block, &scoped(from, from + 0.09))?));
        }
    }
    let harmonics = project(&work, options, &parts, &scoped(0.93, 1.0))?;
    drop(parts);
    let interpolation = interpolation::check(sector, &harmonics)?;
    let comparison =
        full.iter().flat_map(|(speed, full)| comparison::compare(&harmonics, *speed, full)).collect();
    Ok(ReducedWheel {
        sectors: sector.sectors,
        contact: sector.contact.clone(),
        speeds_rad_s: sector.speeds_rad_s.clone(),
        harmonics,
        interpolation,
        comparison,
    })
}

/// The reduced matrices of every nodal diameter (Eq. 6).
fn project(
    work: &Work<'_>,
    options: &ReductionOptions,
    parts: &[SpeedPart],
    watch: Watch<'_>,
) -> Result<Vec<ReducedHarmonic>, ReductionError> {
    let speeds = &work.sector.speeds_rad_s;
    let mut projected: Vec<Vec<Mat<c64>>> = vec![Vec::new(); work.harmonics];
    let bases: Vec<Basis<'_>> = (0..work.harmonics)
        .map(|h| {
            let modes: Vec<&Mat<c64>> = parts.iter().map(|part| &part.harmonics[h].modes.vectors).collect();
            let static_modes = parts[0].harmonics[h].static_modes();
            Basis::new(
                work.untied,
                work.mass,
                work.untied.tie(h),
                static_modes,
                &modes,
                options.basis_tolerance,
            )
        })
        .collect::<Result<_, _>>()?;
    let count = 1 + speeds.len() + usize::from(work.sector.gyroscopic.is_some());
    let mut project_all = |number: usize, name: &str, project: &dyn Fn(&Basis<'_>) -> Mat<c64>| {
        for (h, (basis, projected)) in bases.iter().zip(&mut projected).enumerate() {
            if !watch(
                (number as f64 + h as f64 / bases.len() as f64) / count as f64,
                &format!("projecting {name}, nodal diameter {h}"),
            ) {
                return Err(ReductionError::Cancelled);
            }
            projected.push(project(basis));
        }
        Ok(())
    };
    project_all(0, "the mass", &|basis| basis.project(work.mass))?;
    for (index, speed) in speeds.iter().enumerate() {
        let stiffness = work.untied.assemble(&[(1.0, &work.sector.stiffness[index])]);
        let name = format!("the stiffness at {speed} rad/s");
        project_all(1 + index, &name, &|basis| basis.project(&stiffness))?;
    }
    if let Some(gyroscopic) = &work.sector.gyroscopic {
        let transpose = work.untied.assemble_skew_transpose(gyroscopic);
        project_all(count - 1, "the gyroscopic matrix", &|basis| basis.project_skew(&transpose))?;
    }
    let finish = |(h, mut matrices): (usize, Vec<Mat<c64>>)| {
        let gyroscopic = matrices.split_off(1 + speeds.len()).pop();
        let stiffness = matrices.split_off(1);
        let certificate = |(part, &speed_rad_s): (&SpeedPart, &f64)| ModeCertificate {
            speed_rad_s,
            eigenvalues: part.harmonics[h].modes.values.clone(),
            residuals: part.harmonics[h].modes.residuals.clone(),
            completeness: part.completeness[h],
        };
        let reduced = ReducedHarmonic {
            harmonic: h,
            mass: matrices.remove(0),
            stiffness: StiffnessPolynomial::fit(stiffness, speeds),
            gyroscopic,
            certificates: parts.iter().zip(speeds).map(certificate).collect(),
        };
        // A wheel that is not held at rest is no model at any speed.
        natural_frequencies(&reduced, 0.0, true)?;
        Ok(reduced)
    };
    projected.into_iter().enumerate().map(finish).collect()
}
