//! Mode shapes and their frequencies.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::error::FieldError;
use super::field::{BasisProduct, Field, Frame};
use super::sector::FieldSector;
use rubmap_numerics::sector_fourier::is_single;
use rubmap_wheel::dynamics::modal_wheel::{natural_frequencies, natural_modes};
use rubmap_wheel::dynamics::reduction::ReducedWheel;

/// Kind of motion of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Standing wave: its nodal lines stay where they are on the wheel; the phase turns them about it.
    Standing,
    /// Wave travelling around the wheel, in the direction of rotation; the phase is the angle travelled.
    Travelling,
}

/// Mode shape that is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeRequest {
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Whether K(Ω) is used instead of the stiffness at rest.
    pub stiffening: bool,
    /// Nodal diameter.
    pub nodal_diameter: usize,
    /// Number of lowest modes that are valid for the wheel; higher ones are artefacts of the reduction.
    pub modes: usize,
    /// Number of the mode, from 1, by ascending frequency.
    pub mode: usize,
    /// Kind of motion.
    pub motion: Motion,
    /// Phase of the first frame, rad.
    pub phase: f64,
    /// Frames over one period.
    pub frames: usize,
}

/// Natural frequencies of a nodal diameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ShapeFrequencies {
    /// Nodal diameter.
    pub nodal_diameter: u32,
    /// Frequencies of its modes in the rotating frame, ascending, Hz: as many as the reduction keeps at each given speed. Higher ones
    /// belong to the reduction, not to the wheel, and are left out.
    pub frequencies_hz: Vec<f64>,
}

/// Frequencies of the lowest `modes` of every nodal diameter at a speed.
///
/// # Errors
/// K(Ω) that is not positive definite.
pub fn mode_frequencies(
    reduced: &ReducedWheel,
    speed_rad_s: f64,
    stiffening: bool,
    modes: usize,
) -> Result<Vec<ShapeFrequencies>, FieldError> {
    let of = |harmonic| {
        let omega = natural_frequencies(harmonic, speed_rad_s, stiffening)?;
        let frequencies_hz = omega.into_iter().take(modes).map(|omega| omega / TAU).collect();
        Ok(ShapeFrequencies { nodal_diameter: harmonic.harmonic as u32, frequencies_hz })
    };
    reduced.harmonics.iter().map(of).collect()
}

/// Shape of a mode, scaled to a largest displacement of 1 over a period.
///
/// # Errors
/// Nodal diameter or mode that does not exist; K(Ω) that is not positive definite; basis that cannot be read.
pub fn mode_field(
    reduced: &ReducedWheel,
    sector: &FieldSector,
    asked: &ModeRequest,
    basis: BasisProduct<'_>,
) -> Result<Field, FieldError> {
    let most = reduced.harmonics.len() - 1;
    if asked.nodal_diameter > most {
        let message = format!("the wheel has nodal diameters 0 to {most}");
        return Err(FieldError::parameter("nodal_diameter", message));
    }
    if asked.motion == Motion::Travelling && is_single(asked.nodal_diameter, reduced.sectors) {
        let message = format!("nodal diameter {} cannot travel: its modes are single", asked.nodal_diameter);
        return Err(FieldError::parameter("motion", message));
    }
    let (omega, shapes) = natural_modes(reduced, asked.nodal_diameter, asked.speed_rad_s, asked.stiffening)?;
    let most = omega.len().min(asked.modes);
    let mode = asked.mode.checked_sub(1).filter(|&mode| mode < most).ok_or_else(|| {
        let message = format!("of nodal diameter {} modes 1 to {most} are known", asked.nodal_diameter);
        FieldError::parameter("mode", message)
    })?;
    let column = Mat::from_fn(shapes.nrows(), 1, |row, _| shapes[(row, mode)]);
    let frames = (0..asked.frames).map(|k| frame(asked, k as f64 / asked.frames as f64)).collect();
    let mut field = Field::new(sector, &[(asked.nodal_diameter, column)], frames, basis)?;
    let largest = field.largest_amplitude(sector);
    if largest > 0.0 {
        field.scale(1.0 / largest);
    }
    let title =
        format!("nodal diameter {}, mode {}, {:.2} Hz", asked.nodal_diameter, asked.mode, omega[mode] / TAU);
    let scaled =
        if sector.has_stress() { "largest displacement 1, stress for it" } else { "largest displacement 1" };
    Ok(field.titled(title, vec![scaled.to_owned()]).at_speed(asked.speed_rad_s))
}

/// Frame of the mode after a part of its period.
fn frame(asked: &ModeRequest, part: f64) -> Frame {
    let unit = |angle: f64| c64::new(angle.cos(), angle.sin());
    let at = |angle: f64| match asked.motion {
        // The pattern where the phase puts it, up and down.
        Motion::Standing => unit(asked.phase) * angle.cos(),
        // e^{j(isα − φ)} moves on to larger angles.
        Motion::Travelling => unit(-asked.phase - angle),
    };
    let angle = TAU * part;
    Frame { time: part, weights: vec![(0, at(angle))], before: vec![(0, at(angle - TAU / 4.0))] }
}
