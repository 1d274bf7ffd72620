//! Interaction maps as answers show them: rows are read from the store while they are sent, as all of them may be larger than memory.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

use super::download;
use super::form::Form;
use super::stream::Read;
use crate::analysis::request::{Sensor, SpeedUnit, SweepRequest};
use crate::analysis::result::{
    ErrorEstimate, Estimate, InteractionMap, Point, Refinement, Spent, StiffeningVerdict,
};
use crate::dynamics::sector::Units;
use crate::export::maps::Maps;

/// Interaction map of one sensor, or maps of several, as `sensors` decides.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes the answer in the OpenAPI document only")]
pub(super) enum MapBody {
    /// Map of one sensor: the request has no `sensors`.
    One(InteractionMap),
    /// Maps of several sensors: the request has `sensors`.
    Several(SensorMaps),
}

/// Interaction maps of several sensors.
#[derive(Serialize, ToSchema)]
pub(super) struct SensorMaps {
    /// Speeds, rad/s.
    speeds_rad_s: Vec<f64>,
    /// Engine orders of the columns.
    engine_orders: Vec<f64>,
    /// Amplitudes `[sensor][speed][engine order]`; a row is null where that speed has no result.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    amplitude: Vec<Vec<Option<Vec<f64>>>>,
    /// Sensors of the maps.
    sensors: Vec<Sensor>,
    /// Nodal diameter to which the maps are restricted, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    nodal_diameter: Option<u32>,
    /// Units of the model.
    units: Units,
    /// Credentials of the finished speeds, in the order of the speeds.
    points: Vec<Point>,
    /// Worst verdict on K(Ω) of `points`; absent where none has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffening: Option<StiffeningVerdict>,
    /// Estimated errors of the amplitudes, once the job is successful; absent without control runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    errors: Option<ErrorEstimate>,
    /// Speeds that `refine` has added; absent without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    refinement: Option<Refinement>,
    /// Cost that the sweep was expected to have; absent before its speeds are queued.
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<Estimate>,
    /// Cost of the finished speeds.
    spent: Spent,
    /// Whole request as resolved.
    settings: SweepRequest,
    /// Version of the code.
    version: String,
}

impl SensorMaps {
    /// Maps of several sensors without their amplitudes.
    fn of(map: &InteractionMap, sensors: Vec<Sensor>) -> Self {
        let InteractionMap {
            speeds_rad_s,
            engine_orders,
            amplitude: _,
            sensor: _,
            nodal_diameter,
            units,
            points,
            stiffening,
            errors,
            refinement,
            plan,
            spent,
            settings,
            version,
        } = map.clone();
        Self {
            speeds_rad_s,
            engine_orders,
            amplitude: Vec::new(),
            sensors,
            nodal_diameter,
            units,
            points,
            stiffening,
            errors,
            refinement,
            plan,
            spent,
            settings,
            version,
        }
    }
}

/// Writes maps in one of the forms of numbers.
///
/// # Errors
/// Errors of writing and of reading rows.
pub(super) fn write<R>(
    maps: &Maps<R>,
    form: Form,
    unit: Option<SpeedUnit>,
    out: &mut dyn Write,
) -> io::Result<()>
where
    R: Fn(u32, u32) -> io::Result<Option<Vec<f64>>>,
{
    match form {
        Form::Csv => maps.csv(unit, out),
        Form::Npz => maps.npz(unit, out),
        _ => json(maps, unit, out),
    }
}

fn json<R>(maps: &Maps<R>, unit: Option<SpeedUnit>, out: &mut dyn Write) -> io::Result<()>
where
    R: Fn(u32, u32) -> io::Result<Option<Vec<f64>>>,
{
    let speeds = |sensor: u32| Read {
        items: maps.indices.len() as u32,
        item: move |place: u32| (maps.row)(sensor, maps.indices[place as usize]),
    };
    let sensors: Vec<Sensor> = maps.sensors.iter().map(|(_, sensor)| *sensor).collect();
    if maps.several {
        let of = |place: u32| Ok::<_, io::Error>(speeds(maps.sensors[place as usize].0));
        let amplitude = Read { items: sensors.len() as u32, item: of };
        in_pieces(&SensorMaps::of(&maps.map, sensors), maps, amplitude, unit, out)
    } else {
        in_pieces(&maps.map, maps, speeds(maps.sensors[0].0), unit, out)
    }
}

/// Map of which all but the amplitudes is in memory; those are read while they are written.
#[derive(Serialize)]
struct InPieces<'a, M, A> {
    amplitude: A,
    speed_indices: &'a [u32],
    /// Map without amplitudes.
    #[serde(flatten)]
    map: M,
}

fn in_pieces<R>(
    map: &impl Serialize,
    maps: &Maps<R>,
    amplitude: impl Serialize,
    unit: Option<SpeedUnit>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let speed_indices = &maps.indices;
    match unit {
        None => Ok(serde_json::to_writer(out, &InPieces { amplitude, speed_indices, map })?),
        Some(unit) => {
            let map: Value = download::with_unit(map, unit)?;
            Ok(serde_json::to_writer(out, &InPieces { amplitude, speed_indices, map })?)
        }
    }
}
