//! Natural frequencies over speed and the linear criterion.

use std::time::Instant;

use crate::diagram::FrequencyDiagram;
use crate::error::AnalysisError;
use crate::families::Families;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::request::FamiliesBy;
use crate::resolved::ResolvedModalAnalysis;
use crate::result::{AbsoluteFrequencies, Campbell, FollowedFamilies, WaveTables};
use rubmap_wheel::dynamics::modal_wheel::RotationEffects;
use rubmap_wheel::dynamics::waves::WaveModes;
use rubmap_wheel::response::campbell::{absolute_frequency, multiples};
use rubmap_wheel::response::waves::Table;
use rubmap_wheel::revision::VERSION;

/// Computes the natural frequencies over speed and the crossings of the linear criterion.
pub fn modal_analysis(
    reduced: &ReducedSector,
    request: &ResolvedModalAnalysis,
    monitor: &dyn Monitor,
) -> Result<Campbell, AnalysisError> {
    let start = Instant::now();
    let speeds = request.speeds.ascending();
    let top = speeds.last().copied().unwrap_or(0.0);
    let effects = RotationEffects { stiffening: true, coriolis: request.coriolis };
    let count = request.families as usize;
    let mut diagram = FrequencyDiagram::new(&reduced.wheel, effects, count);
    for (index, &speed) in speeds.iter().enumerate() {
        monitor.progress(0.5 * index as f64 / speeds.len() as f64, "natural frequencies");
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        diagram.push(speed)?;
    }
    monitor.progress(0.5, "families over speed");
    let families = match request.families_by {
        FamiliesBy::Rank => Families::by_rank(&reduced.wheel, effects),
        FamiliesBy::Shape => Families::followed(&reduced.wheel, effects, &speeds, top, monitor)?,
    };
    let Named { frequencies_hz, waves, mut followed } = named(&diagram, &families, count)?;
    if let Some(followed) = &mut followed {
        followed.veerings = families.veerings(count, top);
    }
    let table = waves.as_ref().map_or(&frequencies_hz, |waves| &waves.backward_hz);
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
        crossings: diagram.crossings(&families, &request.superharmonics),
        driven_crossings: diagram
            .driven_crossings(&families, &multiples(request.lobes, request.max_engine_order)),
        frequencies_hz,
        followed,
        waves,
        speeds_rad_s: speeds,
        reduction: reduced.report.clone(),
        settings: request.clone().into(),
        wall_time_s: start.elapsed().as_secs_f64(),
        version: VERSION.to_owned(),
    })
}

/// Frequencies of the families.
struct Named {
    frequencies_hz: Table,
    waves: Option<WaveTables>,
    followed: Option<FollowedFamilies>,
}

/// Frequencies of the first `count` families, at the speeds of the diagram.
fn named(
    diagram: &FrequencyDiagram<'_>,
    families: &Families<'_>,
    count: usize,
) -> Result<Named, AnalysisError> {
    let mut found = Named {
        frequencies_hz: Vec::new(),
        waves: diagram.waves.as_ref().map(|_| WaveTables::default()),
        followed: None,
    };
    for (index, (&speed, by_rank)) in diagram.speeds.iter().zip(&diagram.frequencies_hz).enumerate() {
        let modes: Vec<_> = (0..by_rank.len()).map(|i| families.at(i, speed)).collect();
        let ranks: Vec<Vec<usize>> = std::iter::zip(by_rank, &modes)
            .map(|(line, modes)| {
                let count = count.min(line.len());
                modes.map_or_else(|| (0..count).collect(), |modes| modes.ranks[..count].to_vec())
            })
            .collect();
        found
            .frequencies_hz
            .push(std::iter::zip(by_rank, &ranks).map(|(line, ranks)| picked(line, ranks)).collect());
        if let (Some(named), Some(by_rank)) = (&mut found.waves, &diagram.waves) {
            let (mut forward, mut backward) = (Vec::new(), Vec::new());
            for (i, ranks) in ranks.iter().enumerate() {
                let [with, against] = match families.waves(i, speed)? {
                    None => [ranks.clone(), ranks.clone()],
                    Some(WaveModes { forward, backward }) => [forward, backward].map(|modes| {
                        let wave = |rank: &usize| modes.iter().position(|mode| mode == rank);
                        ranks.iter().map(|rank| wave(rank).unwrap_or(*rank)).collect()
                    }),
                };
                forward.push(picked(&by_rank.forward_hz[index][i], &with));
                backward.push(picked(&by_rank.backward_hz[index][i], &against));
            }
            named.forward_hz.push(forward);
            named.backward_hz.push(backward);
        }
        let modes: Vec<_> = modes.into_iter().flatten().collect();
        if !modes.is_empty() {
            let followed = found.followed.get_or_insert_default();
            let assured =
                std::iter::zip(&modes, &ranks).map(|(modes, ranks)| modes.assurance[..ranks.len()].to_vec());
            followed.assurance.push(assured.collect());
            let from_one = |ranks: Vec<usize>| ranks.into_iter().map(|rank| rank as u32 + 1).collect();
            followed.ranks.push(ranks.into_iter().map(from_one).collect());
        }
    }
    Ok(found)
}

fn picked(line: &[f64], ranks: &[usize]) -> Vec<f64> {
    ranks.iter().map(|&rank| line[rank]).collect()
}
