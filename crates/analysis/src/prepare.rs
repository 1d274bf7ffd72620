//! Reduction of a sector, with a report.

use std::sync::Arc;
use std::time::Instant;

use crate::error::AnalysisError;
use crate::family_track::FamilyTracks;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::result::{FrequencyDifference, LargestDifference, ReductionReport};
use crate::stiffening::stiffening_report;
use rubmap_numerics::sector_fourier::is_single;
use rubmap_wheel::dynamics::node_rows::NodeRows;
use rubmap_wheel::dynamics::reduction::{
    Checkpoints, Completeness, ReducedWheel, ReductionError, ReductionOptions, reduce,
};
use rubmap_wheel::dynamics::sector::SectorModel;
use rubmap_wheel::revision::VERSION;

/// Reduces a sector (docs/method.md, Reduction). Deterministic. Takes at most `memory_bytes`, if given; continues from `checkpoints`.
pub fn prepare(
    sector: &SectorModel,
    modes_per_speed: u32,
    memory_bytes: Option<u64>,
    checkpoints: &dyn Checkpoints,
    monitor: &dyn Monitor,
) -> Result<ReducedSector, AnalysisError> {
    let start = Instant::now();
    let options = ReductionOptions { memory_bytes, ..ReductionOptions::new(modes_per_speed as usize) };
    let watch = |fraction: f64, phase: &str| {
        monitor.progress(fraction, phase);
        !monitor.is_cancelled()
    };
    let wheel = reduce(sector, &options, checkpoints, &watch).map_err(|error| match error {
        ReductionError::Cancelled => AnalysisError::Cancelled,
        ReductionError::Memory { needed_bytes, allowed_bytes } => {
            AnalysisError::Memory { needed_bytes, allowed_bytes }
        }
        ReductionError::Model(error) => error.into(),
    })?;
    let report = report(&wheel, &options, sector, start.elapsed().as_secs_f64());
    Ok(ReducedSector {
        units: sector.units.clone(),
        wheel: Arc::new(wheel),
        report,
        nodes: NodeRows::default(),
        stress: None,
        growth: None,
        euler_load: None,
        bending: None,
        has_basis: false,
        tip_thickness: None,
        families: FamilyTracks::default(),
    })
}

fn report(
    wheel: &ReducedWheel,
    options: &ReductionOptions,
    sector: &SectorModel,
    wall_time_s: f64,
) -> ReductionReport {
    let size = |i: usize| wheel.harmonics[i].mass.nrows() as u32;
    let copies = |i: usize| if is_single(i, wheel.sectors) { 1 } else { 2 };
    let residual = wheel.harmonics.iter().fold(0.0f64, |m, h| m.max(h.largest_mode_residual()));
    ReductionReport {
        modes_per_speed: options.modes_per_speed as u32,
        unknowns: (0..wheel.harmonics.len()).map(size).collect(),
        wheel_unknowns: (0..wheel.harmonics.len()).map(|i| copies(i) * size(i)).sum(),
        largest_mode_residual: residual,
        counted_modes: wheel
            .harmonics
            .iter()
            .flat_map(|h| &h.certificates)
            .filter(|certificate| certificate.completeness != Completeness::Unproven)
            .map(|certificate| certificate.eigenvalues.len() as u32)
            .sum(),
        modes: wheel
            .harmonics
            .iter()
            .flat_map(|h| &h.certificates)
            .map(|certificate| certificate.eigenvalues.len() as u32)
            .sum(),
        full_model: frequency_differences(wheel),
        basis_tolerance: options.basis_tolerance,
        stiffening: stiffening_report(&wheel.interpolation, sector),
        wall_time_s,
        version: VERSION.to_owned(),
    }
}

/// Frequency differences, one line per speed, ascending.
fn frequency_differences(wheel: &ReducedWheel) -> Vec<FrequencyDifference> {
    let mut speeds: Vec<f64> = wheel.comparison.iter().map(|c| c.speed_rad_s).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let at = |speed_rad_s: f64| {
        let here = || wheel.comparison.iter().filter(move |c| c.speed_rad_s == speed_rad_s);
        let worst = here()
            .filter_map(|c| c.largest_difference().map(|(difference, mode)| (difference, mode, c)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        FrequencyDifference {
            speed_rad_s,
            largest: worst.map(|(relative, mode, comparison)| LargestDifference {
                relative,
                nodal_diameter: comparison.harmonic as u32,
                mode: mode as u32 + 1,
                full_hz: comparison.full[mode] / std::f64::consts::TAU,
            }),
            indefinite: here().filter(|c| c.full.is_empty()).map(|c| c.harmonic as u32).collect(),
        }
    };
    speeds.into_iter().map(at).collect()
}
