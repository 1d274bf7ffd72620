//! Veerings and crossings of modal families of one nodal diameter.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::dynamics::families::FamilyModes;

/// Largest distance, as a share of the frequency, at which families that stay on their branches count as veering.
const NEAR: f64 = 0.05;

/// Distance, as a share of the frequency, below which two branches cross, as far as double precision can tell.
const TOUCHING: f64 = 1e-6;

/// Course of two families where their frequencies come closest. A family that `crosses` goes straight on; one that `exchanges` goes with its shape
/// to the other branch of a sharp veering, and its frequency jumps by about the distance; one that `stays` keeps to its branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Course {
    /// Crossing: the frequencies are equal at the speed, the shapes do not mix.
    Crosses,
    /// Sharp veering: the branches do not meet but exchange their shapes within a step of the speeds on which families are followed. Families go with
    /// their shapes, so that their frequencies jump at the speed by about the distance.
    Exchanges,
    /// Families that come near and stay on their branches: a wide veering, in which shapes turn slowly, or none.
    Stays,
}

/// Closest approach of two families of one nodal diameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Veering {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Families, from 1: first the one with the lower frequency below the speed.
    pub families: [u32; 2],
    /// Speed at which the frequencies are closest, rad/s.
    pub speed_rad_s: f64,
    /// Middle of both frequencies at the speed, Hz.
    pub frequency_hz: f64,
    /// Least distance of the two frequencies, Hz.
    pub distance_hz: f64,
    /// Course of the families there.
    pub course: Course,
}

/// Veerings and crossings of the first `families` of a nodal diameter with others, whose `modes` are followed over the ascending speeds of `grid`; of
/// pairs that only come near, those nearer than 5 % of their frequency. `omega` gives natural frequencies at any speed, rad/s, or none.
pub fn veerings(
    grid: &[f64],
    modes: &[FamilyModes],
    nodal_diameter: u32,
    families: usize,
    omega: impl Fn(f64) -> Option<Vec<f64>>,
) -> Vec<Veering> {
    let points = grid.len().min(modes.len());
    let ranks = modes.iter().map(|modes| modes.omega.len()).min().unwrap_or(0);
    let mut found = Vec::new();
    for lower in 0..ranks.saturating_sub(1) {
        let gap = |point: usize| modes[point].omega[lower + 1] - modes[point].omega[lower];
        for point in 0..points.saturating_sub(1) {
            let pair = [lower, lower + 1].map(|rank| modes[point].family(rank));
            let [Some(a), Some(b)] = pair else { continue };
            // K depends on Ω²: the gap is symmetric about rest.
            let before = if point == 0 { gap(1) } else { gap(point - 1) };
            if a.min(b) >= families || gap(point) > before || gap(point) >= gap(point + 1) {
                continue;
            }
            let bracket = (grid[point.saturating_sub(1)], grid[point + 1]);
            let distance = |speed: f64| omega(speed).map(|omega| omega[lower + 1] - omega[lower]);
            let Some(speed) = least(bracket, distance) else { continue };
            // At rest every distance is stationary.
            let Some(at) = omega(speed).filter(|_| speed > 1e-3 * grid[1]) else { continue };
            let (middle, distance) = (0.5 * (at[lower] + at[lower + 1]), at[lower + 1] - at[lower]);
            let order = |point: usize| modes[point].ranks[a] < modes[point].ranks[b];
            let (below, above) = (order(point.saturating_sub(2)), order((point + 2).min(points - 1)));
            let course = match below == above {
                true if distance > NEAR * middle => continue,
                true => Course::Stays,
                false if distance <= TOUCHING * middle => Course::Crosses,
                false => Course::Exchanges,
            };
            let families = if below { [a, b] } else { [b, a] };
            found.push(Veering {
                nodal_diameter,
                families: families.map(|family| family as u32 + 1),
                speed_rad_s: speed,
                frequency_hz: middle / TAU,
                distance_hz: distance / TAU,
                course,
            });
        }
    }
    found.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    found
}

/// Argument of the least value of `of` in an interval with one minimum, by golden section; none where a value is missing.
fn least((mut low, mut high): (f64, f64), of: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| (high - golden * (high - low), low + golden * (high - low));
    let (mut left, mut right) = inner(low, high);
    let (mut at_left, mut at_right) = (of(left)?, of(right)?);
    while high - low > 1e-9 * high {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = inner(low, high).0;
            at_left = of(left)?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = inner(low, high).1;
            at_right = of(right)?;
        }
    }
    Some(0.5 * (low + high))
}
