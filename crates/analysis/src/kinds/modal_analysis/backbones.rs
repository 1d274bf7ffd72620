//! Backbone curves of a modal analysis: their checks, and how they are found.

use std::f64::consts::TAU;

use faer::c64;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::backbone_curves::{BackboneCurve, BackbonePoint, Backbones};
use super::request::BackbonesRequest;
use super::resolved::ResolvedModalAnalysis;
use super::result::Campbell;
use crate::effects::geometric_nonlinearity::check::check_bending;
use crate::error::{AnalysisError, Violation};
use crate::model::{ModelFacts, ReducedSector};
use crate::monitor::Monitor;
use crate::request::Component;
use crate::resolve::findings::{Findings, check_reach};
use crate::resolve::limits;
use crate::validity::MOST_OUTSIDE;
use rubmap_wheel::dynamics::bending::BladeBending;
use rubmap_wheel::dynamics::bending::backbone::{self, Backbone, BackboneEnd, FreeMode, FreeModes};
use rubmap_wheel::dynamics::direction::COMPONENTS;
use rubmap_wheel::dynamics::integrate::DIVERGED_SHARE_OF_RADIUS;
use rubmap_wheel::revision::VERSION;

/// Phase of the job, in words.
const PHASE: &str = "backbone curves";

/// Share of a modal analysis that is done before its backbone curves.
const BEFORE: f64 = 0.5;

/// Thicknesses of the blade at its tip to which curves go, unless they are asked to go elsewhere.
const TIP_THICKNESSES: f64 = 2.0;

/// Seconds that a curve in four coordinates takes, about.
const SECONDS: f64 = 0.1;

/// Checks backbone curves and fills in what was not given.
pub(crate) fn resolve(
    found: &mut Findings,
    asked: &mut BackbonesRequest,
    fields: Option<bool>,
    facts: &ModelFacts,
) {
    const AT: &str = "/backbones";
    check_bending(found, (asked.coordinates, AT), fields, facts);
    let highest = facts.sectors / 2;
    for (index, i) in asked.nodal_diameters.iter().enumerate().take(highest as usize + 2) {
        let at = format!("{AT}/nodal_diameters/{index}");
        found.require(*i <= highest, &at, format!("nodal diameters of this wheel go from 0 to {highest}"));
        found.require(
            !asked.nodal_diameters[..index].contains(i),
            &at,
            format!("{i} is in the list already"),
        );
    }
    asked.nodal_diameters.sort_unstable();
    if asked.nodal_diameters.is_empty() {
        asked.nodal_diameters = (0..=highest).collect();
    }
    let Some(mesh) = &facts.mesh else { return };
    let reach = facts.contact_radius.map_or(f64::INFINITY, |radius| DIVERGED_SHARE_OF_RADIUS * radius);
    let far = || mesh.tip_thickness.map(|thickness| reach.min(TIP_THICKNESSES * thickness));
    asked.largest_amplitude = asked.largest_amplitude.or_else(far);
    let words = match asked.largest_amplitude {
        Some(_) => "a length above 0 and below 1e30",
        None => {
            "give the amplitude at which curves end: the thickness of this blade at its tip, of which it would be twice, is not known"
        }
    };
    if let Some(length) = asked.largest_amplitude {
        check_reach(found, length, &format!("{AT}/largest_amplitude"), facts);
    }
    let is_length = asked.largest_amplitude.is_some_and(|length| limits::LENGTH.contains(&length));
    found.require(is_length, &format!("{AT}/largest_amplitude"), words);
}

/// Seconds that a curve in so many coordinates takes.
pub(crate) fn curve_seconds(coordinates: u32) -> f64 {
    SECONDS * (f64::from(coordinates) / 4.0).powi(2)
}

/// Computes the backbone curves that `request` asks for, if any, of the families of its diagram.
pub(super) fn backbones(
    reduced: &ReducedSector,
    request: &ResolvedModalAnalysis,
    campbell: &Campbell,
    monitor: &dyn Monitor,
) -> Result<Option<Backbones>, AnalysisError> {
    let Some(asked) = &request.backbones else { return Ok(None) };
    let unread = || {
        AnalysisError::Refused(vec![Violation::new("/backbones", "the bending of second order was not read")])
    };
    let (blade, largest) =
        (reduced.bending.as_ref().ok_or_else(unread)?, asked.largest_amplitude.ok_or_else(unread)?);
    let speed_rad_s = campbell.speeds_rad_s.last().copied().unwrap_or(0.0);
    let wheel = blade.free_wheel(&reduced.wheel, speed_rad_s, true)?;
    let mut curves = Vec::new();
    for (index, &nodal_diameter) in asked.nodal_diameters.iter().enumerate() {
        monitor.progress(BEFORE + (1.0 - BEFORE) * index as f64 / asked.nodal_diameters.len() as f64, PHASE);
        if monitor.is_cancelled() {
            return Err(AnalysisError::Cancelled);
        }
        let ranks = ranks(campbell, nodal_diameter as usize);
        let follow = |(family, rank): (usize, usize)| {
            let mode = FreeMode { nodal_diameter: nodal_diameter as usize, rank };
            let outside = outside(blade, &wheel.modes[nodal_diameter as usize], rank);
            let reach = if outside > MOST_OUTSIDE { 0.0 } else { largest };
            curve(nodal_diameter, family as u32 + 1, wheel.backbone(mode, reach), outside)
        };
        let ranks: Vec<_> = ranks.into_iter().enumerate().collect();
        curves.extend(ranks.into_par_iter().map(follow).collect::<Vec<_>>());
    }
    Ok(Some(Backbones {
        speed_rad_s,
        coordinates: blade.coordinates() as u32,
        curves,
        units: reduced.units.clone(),
        model: request.model.clone(),
        version: VERSION.to_owned(),
    }))
}

/// Ranks of the families of a nodal diameter at the highest speed.
fn ranks(campbell: &Campbell, nodal_diameter: usize) -> Vec<usize> {
    let followed = campbell.followed.as_ref().and_then(|followed| followed.ranks.last()?.get(nodal_diameter));
    let count = || campbell.frequencies_hz.last().and_then(|row| row.get(nodal_diameter)).map_or(0, Vec::len);
    followed
        .map_or_else(|| (0..count()).collect(), |ranks| ranks.iter().map(|&rank| rank as usize - 1).collect())
}

/// Share of the displacement of the contact nodes in a mode that the coordinates of the blade do not carry.
fn outside(blade: &BladeBending, modes: &FreeModes, rank: usize) -> f64 {
    let (mut all, mut outside) = (0.0, 0.0);
    for (row, u) in modes.contact.col(rank).iter().enumerate() {
        let of = (0..blade.coordinates()).map(|j| modes.rows[(j, rank)] * blade.linear[(row, j)]);
        all += u.norm_sqr();
        outside += (u - of.sum::<c64>()).norm_sqr();
    }
    if all > 0.0 { (outside / all).sqrt() } else { 0.0 }
}

fn curve(nodal_diameter: u32, family: u32, found: Backbone, outside_coordinates: f64) -> BackboneCurve {
    let linear = found.points.first().map_or(0.0, |point| point.omega);
    let components = [Component::Radial, Component::Tangential, Component::Axial];
    let point = |point: &backbone::BackbonePoint| BackbonePoint {
        amplitude: point.amplitude,
        frequency_hz: point.omega / TAU,
        change_percent: 100.0 * (point.omega / linear - 1.0),
        harmonics_percent: 100.0 * point.truncation,
    };
    let is_carried = outside_coordinates <= MOST_OUTSIDE;
    let end = match is_carried {
        true => found.end.to_string(),
        false => format!(
            "not followed: {:.0} % of the motion lies outside the coordinates; ask for more `coordinates`",
            100.0 * outside_coordinates
        ),
    };
    BackboneCurve {
        nodal_diameter,
        family,
        contact_node: (found.row / COMPONENTS) as u32,
        component: components[found.row % COMPONENTS],
        outside_coordinates,
        points: found.points.iter().map(point).collect(),
        passed: found.passed.iter().map(ToString::to_string).collect(),
        complete: is_carried && found.end == BackboneEnd::LargestAmplitude,
        end,
    }
}
