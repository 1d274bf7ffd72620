//! Natural frequencies over speed and the linear criterion.

use std::time::Instant;

use crate::diagram::FrequencyDiagram;
use crate::error::AnalysisError;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::resolved::ResolvedModalAnalysis;
use crate::result::{AbsoluteFrequencies, Campbell};
use rubmap_wheel::dynamics::modal_wheel::RotationEffects;
use rubmap_wheel::response::campbell::{absolute_frequency, multiples};
use rubmap_wheel::revision::VERSION;

/// Computes the natural frequencies over speed and the crossings of the linear criterion.
pub fn modal_analysis(
    reduced: &ReducedSector,
    request: &ResolvedModalAnalysis,
    monitor: &dyn Monitor,
) -> Result<Campbell, AnalysisError> {
    let start = Instant::now();
    let speeds = request.speeds.ascending();
    let effects = RotationEffects { stiffening: true, coriolis: request.coriolis };
    let mut diagram = FrequencyDiagram::new(&reduced.wheel, effects, request.families as usize);
    for (index, &speed) in speeds.iter().enumerate() {
        monitor.progress(index as f64 / speeds.len() as f64, "natural frequencies");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        diagram.push(speed)?;
    }
    let table = diagram.waves.as_ref().map_or(&diagram.frequencies_hz, |waves| &waves.backward_hz);
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
        crossings: diagram.crossings(&request.superharmonics),
        driven_crossings: diagram.driven_crossings(&multiples(request.lobes, request.max_engine_order)),
        frequencies_hz: diagram.frequencies_hz,
        waves: diagram.waves,
        speeds_rad_s: speeds,
        reduction: reduced.report.clone(),
        settings: request.clone().into(),
        wall_time_s: start.elapsed().as_secs_f64(),
        version: VERSION.to_owned(),
    })
}
