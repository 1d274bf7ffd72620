//! Fields of a recorded run: at instants, and the deflection shape of an engine order.

use std::f64::consts::TAU;

use faer::{Mat, c64};

use super::error::FieldError;
use super::field::{BasisProduct, Field, Frame};
use super::sector::FieldSector;
use rubmap_wheel::dynamics::reduction::ReducedWheel;
use rubmap_wheel::dynamics::states::WheelStates;

/// Field of the wheel at instants of a recorded run, by their index.
///
/// # Errors
/// Instant that was not recorded; basis that cannot be read.
pub fn instants(
    states: &WheelStates,
    sector: &FieldSector,
    at: &[usize],
    basis: BasisProduct<'_>,
) -> Result<Field, FieldError> {
    let recorded = states.revolutions.len();
    if let Some(instant) = at.iter().find(|&&instant| instant >= recorded) {
        let message =
            format!("{instant} is none of the recorded instants 0 to {}", recorded.saturating_sub(1));
        return Err(FieldError::parameter("instant", message));
    }
    let columns: Vec<(usize, Mat<c64>)> = states
        .harmonics
        .iter()
        .map(|of| {
            let x = &of.coordinates;
            (of.harmonic, Mat::from_fn(x.nrows(), at.len(), |row, column| x[(row, at[column])]))
        })
        .collect();
    let one = c64::new(1.0, 0.0);
    let frame = |(column, &instant): (usize, &usize)| Frame {
        time: states.revolutions[instant],
        weights: vec![(column, one)],
        before: Vec::new(),
    };
    let frames: Vec<Frame> = at.iter().enumerate().map(frame).collect();
    let title = match at {
        [instant] => format!("after {:.4} revolutions (instant {instant})", states.revolutions[*instant]),
        _ => format!("{} instants", at.len()),
    };
    Ok(Field::new(sector, &columns, frames, basis)?.titled(title, Vec::new()))
}

/// Deflection shape of an engine order over all recorded revolutions, `frames` of them over a period from `phase` (rad) on.
///
/// ```text
/// û_s = Σ_i e^{jisα} Υ̂_i X̂_i(E) + conj(e^{jisα} Υ̂_i X̂_i(−E)),   X̂_i(E) = 1/M Σ_m X_i(θ_m) e^{−jEθ_m}
/// u_s(φ) = Re û_s e^{jφ},   φ = Eθ
/// ```
///
/// For E = 0 it is the mean.
///
/// # Errors
/// Engine order above half the samples of a revolution; basis that cannot be read.
pub fn deflection_shape(
    states: &WheelStates,
    sector: &FieldSector,
    engine_order: u32,
    (phase, frames): (f64, usize),
    basis: BasisProduct<'_>,
) -> Result<Field, FieldError> {
    let most = largest_engine_order(states);
    if engine_order > most {
        let message = format!("the samples of a revolution resolve engine orders 0 to {most}");
        return Err(FieldError::parameter("engine_order", message));
    }
    let order = f64::from(engine_order);
    let count = states.revolutions.len() as f64;
    let fourier = |x: &Mat<c64>, row: usize, order: f64| {
        let sum: c64 = states.revolutions.iter().enumerate().fold(c64::new(0.0, 0.0), |sum, (m, at)| {
            // Whole turns first, so that the angle stays exact.
            let (sin, cos) = (-TAU * (order * at).rem_euclid(1.0)).sin_cos();
            sum + x[(row, m)] * c64::new(cos, sin)
        });
        sum / count
    };
    let columns: Vec<(usize, Mat<c64>)> = states
        .harmonics
        .iter()
        .map(|of| {
            let x = &of.coordinates;
            let column = |row, column| match (column, engine_order) {
                (0, _) => fourier(x, row, order),
                (_, 0) => c64::new(0.0, 0.0),
                _ => fourier(x, row, -order),
            };
            (of.harmonic, Mat::from_fn(x.nrows(), 2, column))
        })
        .collect();
    let unit = |angle: f64| c64::new(angle.cos(), angle.sin());
    let at = |angle: f64| vec![(0, unit(angle)), (1, unit(-angle))];
    let frame = |k: usize| {
        let part = k as f64 / frames as f64;
        let angle = phase + TAU * part;
        match engine_order {
            0 => Frame { time: part, weights: at(0.0), before: Vec::new() },
            _ => Frame { time: part, weights: at(angle), before: at(angle - TAU / 4.0) },
        }
    };
    let frames = (0..frames).map(frame).collect();
    let title = format!("deflection shape of engine order {engine_order}");
    Ok(Field::new(sector, &columns, frames, basis)?.titled(title, Vec::new()))
}

/// Highest engine order below half the samples of a revolution.
fn largest_engine_order(states: &WheelStates) -> u32 {
    match states.revolutions[..] {
        [first, second, ..] if second > first => {
            // A whole number but for rounding.
            let samples = (second - first).recip().round() as u32;
            samples.saturating_sub(1) / 2
        }
        _ => 0,
    }
}

/// Instant at which a contact node of any blade is displaced most; contact nodes are the first coordinates of a reduction.
pub fn largest_instant(states: &WheelStates, reduced: &ReducedWheel) -> Option<usize> {
    let sectors = reduced.sectors;
    let turn = |harmonic: usize, sector: usize| {
        let (sin, cos) = (TAU * (harmonic * sector % sectors) as f64 / sectors as f64).sin_cos();
        c64::new(cos, sin)
    };
    let squared = |instant: usize| {
        let mut largest = 0.0f64;
        for sector in 0..sectors {
            for node in 0..reduced.contact.len() {
                let component = |k: usize| {
                    let of = |of: &rubmap_wheel::dynamics::states::HarmonicStates| {
                        (turn(of.harmonic, sector) * of.coordinates[(3 * node + k, instant)]).re
                    };
                    states.harmonics.iter().map(of).sum::<f64>()
                };
                largest = largest.max((0..3).map(|k| component(k).powi(2)).sum());
            }
        }
        largest
    };
    let all = (0..states.revolutions.len()).map(|instant| (instant, squared(instant)));
    all.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(instant, _)| instant)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Engine order of half the samples: it is its own negative and would count twice.
    #[test]
    fn engine_orders_stay_below_half_the_samples() {
        for samples in [1, 2, 3, 8, 9, 300, 360, 500, 1000] {
            for begin in [0, 7, 29, 149] {
                let instant = |sample: u32| f64::from(begin) + f64::from(sample) / f64::from(samples);
                let revolutions = (1..=2 * samples).map(instant).collect();
                let found = largest_engine_order(&WheelStates { revolutions, harmonics: Vec::new() });
                assert!(2 * found < samples && samples <= 2 * (found + 1), "{samples} from {begin}: {found}");
            }
        }
    }
}
