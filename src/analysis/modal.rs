//! Natural frequencies over speed and the linear criterion.

use std::f64::consts::TAU;
use std::time::Instant;

use super::error::AnalysisError;
use super::model::ReducedSector;
use super::monitor::Monitor;
use super::request::ModalAnalysisRequest;
use super::result::{AbsoluteFrequencies, Campbell};
use super::run::VERSION;
use crate::dynamics::error::ModelError;
use crate::dynamics::modal_wheel::natural_frequencies;
use crate::dynamics::reduction::ReducedWheel;
use crate::numerics::sector_fourier::harmonic_count;
use crate::response::campbell::{Frequencies, absolute_frequency, crossings, driven_crossings};

/// The reduced wheel as a source of frequencies in Hz.
pub(super) struct WheelFrequencies<'a> {
    pub(super) wheel: &'a ReducedWheel,
    pub(super) stiffening: bool,
}

impl Frequencies for WheelFrequencies<'_> {
    fn at(&self, speed_rad_s: f64, nodal_diameter: u32) -> Option<Vec<f64>> {
        self.hertz(speed_rad_s, nodal_diameter).ok()
    }
}

impl WheelFrequencies<'_> {
    fn hertz(&self, speed_rad_s: f64, nodal_diameter: u32) -> Result<Vec<f64>, ModelError> {
        let harmonic = &self.wheel.harmonics[nodal_diameter as usize];
        let omega = natural_frequencies(harmonic, speed_rad_s, self.stiffening)?;
        Ok(omega.into_iter().map(|w| w / TAU).collect())
    }

    /// `[nodal diameter][family]` in Hz at one speed, the first `families`.
    pub(super) fn row(&self, speed: f64, families: usize) -> Result<Vec<Vec<f64>>, ModelError> {
        let of = |i: u32| {
            let mut frequencies = self.hertz(speed, i)?;
            frequencies.truncate(families);
            Ok(frequencies)
        };
        (0..harmonic_count(self.wheel.sectors) as u32).map(of).collect()
    }

    /// The same at every speed, `[speed][nodal diameter][family]`.
    fn table(
        &self,
        speeds: &[f64],
        families: usize,
        monitor: &dyn Monitor,
    ) -> Result<Vec<Vec<Vec<f64>>>, AnalysisError> {
        let mut table = Vec::with_capacity(speeds.len());
        for (index, &speed) in speeds.iter().enumerate() {
            monitor.progress(index as f64 / speeds.len() as f64, "natural frequencies");
            if monitor.is_cancelled() {
                return Err(AnalysisError::Cancelled);
            }
            table.push(self.row(speed, families)?);
        }
        Ok(table)
    }
}

/// Natural frequencies over speed and the linear criterion.
pub fn modal_analysis(
    reduced: &ReducedSector,
    request: &ModalAnalysisRequest,
    monitor: &dyn Monitor,
) -> Result<Campbell, AnalysisError> {
    let start = Instant::now();
    let speeds = request.speeds.ascending().map_err(AnalysisError::Refused)?;
    let families = request.families as usize;
    let source = WheelFrequencies { wheel: &reduced.wheel, stiffening: true };
    let table = source.table(&speeds, families, monitor)?;
    let absolute = |n: u32| {
        let at = |(row, &speed): (&Vec<Vec<f64>>, &f64)| {
            let of = |(i, line): (usize, &Vec<f64>)| {
                line.iter().map(|&f| absolute_frequency(f, i as u32, n, speed)).collect()
            };
            row.iter().enumerate().map(of).collect()
        };
        let frequencies_hz = table.iter().zip(&speeds).map(at).collect();
        AbsoluteFrequencies { superharmonic: n, frequencies_hz }
    };
    Ok(Campbell {
        absolute_frequencies_hz: request.superharmonics.iter().map(|&n| absolute(n)).collect(),
        crossings: crossings(&source, &table, &speeds, families, &request.superharmonics),
        driven_crossings: driven_crossings(
            &source,
            &table,
            &speeds,
            families,
            request.lobes,
            request.max_engine_order,
            reduced.wheel.sectors as u32,
        ),
        frequencies_hz: table,
        speeds_rad_s: speeds,
        reduction: reduced.report.clone(),
        settings: request.clone(),
        wall_time_s: start.elapsed().as_secs_f64(),
        version: VERSION.to_owned(),
    })
}
