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
mod between;
mod checkpoints;
mod comparison;
mod convex;
mod count;
mod findings;
mod free_interface;
mod interpolation;
pub mod mass;
mod memory;
mod modes;
mod options;
mod ordering;
pub(super) mod reduced;
mod rows;
mod sector_factor;
mod speed;
mod static_response;
mod tied_factor;
mod untied;

use faer::{Mat, c64};

use super::centrifugal::StiffnessPolynomial;
use super::error::ModelError;
use super::modal_wheel::natural_frequencies;
use super::sector::SectorModel;
use basis::Basis;
use mass::NegativeMass;
use rubmap_numerics::sector_fourier::harmonic_count;
use speed::{SpeedPart, Work};
use untied::UntiedSector;

pub use checkpoints::{Checkpoints, NoCheckpoints};
pub use count::{Completeness, ModeCount};
pub use findings::{FrequencyComparison, InterpolationCheck, InterpolationVerdict};
pub use free_interface::{FreeInterfaceModes, FreeInterfaceShapes, free_interface_modes};
pub use interpolation::MatrixRatios;
pub use options::{ReductionError, ReductionOptions, Watch};
pub use reduced::{ModeCertificate, ReducedHarmonic, ReducedWheel};
pub use rows::BasisRows;
pub use static_response::{StaticResponse, StaticSpan, static_response};

/// Reduces `sector`.
///
/// One real factor of the untied sector per speed serves every nodal diameter (sector_factor.rs). Deterministic: work in parallel, on the
/// current rayon pool, is independent or summed in a fixed order. Parts that `checkpoints` has are not computed again.
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
    let mut last = None;
    for index in 0..sector.speeds_rad_s.len() {
        let (from, to) = (0.02 + 0.73 * index as f64 / given, 0.02 + 0.73 * (index as f64 + 1.0) / given);
        // Two factors at once would be the most ever held: the last one goes first.
        drop(last.take());
        let (part, factored) = work.at_given_speed(index, &scoped(from, to))?;
        parts.push(part);
        last = factored;
    }
    let given = parts.iter().map(SpeedPart::full_frequencies);
    let mut full: Vec<_> = sector.speeds_rad_s.iter().copied().zip(given).collect();
    full.extend(work.between(&parts, last, &scoped(0.75, 0.93))?);
    parts.iter_mut().flat_map(|part| &mut part.harmonics).for_each(|part| part.full = None);
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

/// Reduced matrices of every nodal diameter (Eq. 6).
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
        if !watch(1.0, &format!("keeping the basis, nodal diameter {h}")) {
            return Err(ReductionError::Cancelled);
        }
        work.checkpoints.keep_basis(&BasisRows::new(h, &bases[h], &reduced.mass));
        Ok(reduced)
    };
    projected.into_iter().enumerate().map(finish).collect()
}
