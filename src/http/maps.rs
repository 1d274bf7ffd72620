//! Interaction maps.

use std::collections::BTreeSet;
use std::io;

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::{Answer, Download, DownloadQuery, Next, lasting};
use super::extract::{JobPath, Parameters};
use super::form::Form;
use super::map_body::{self, MapBody};
use super::problem::Problem;
use super::results::{check_sensor, find, sweep};
use super::spectra::ROW_MEMORY;
use super::state::AppState;
use super::{selection, stream};
use crate::analysis::request::{Sensor, SpeedUnit};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{CriticalSpeeds, InteractionMap, SpeedSpectra};
use crate::analysis::run;
use crate::export::maps::Maps;
use crate::plot::{self, VerticalAxis, Window};
use crate::store::jobs::{Job, JobId};
use crate::store::results::Document;
use crate::store::{Store, StoreError};
use crate::tokens::Principal;

/// Memory of a map that is drawn, over its amplitudes.
const DRAWN_MEMORY: u64 = 3;

/// Which part of an interaction map to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct MapQuery {
    /// Index of the sensor in the request; default 0.
    sensor: Option<u32>,
    /// In place of `sensor`: indices of sensors and ranges of them, such as `0-2,5`. Amplitudes are then `[sensor][speed][engine order]`,
    /// even of one.
    #[param(max_length = 1000)]
    sensors: Option<String>,
    /// Only these speeds: indices in the request and ranges of them, or ranges in rpm, rad_s or hz, such as `0-9,15` or
    /// `24000-28000rpm`. A drawing shows what is from the slowest to the fastest of them.
    #[param(max_length = 1000)]
    speeds: Option<String>,
    /// Only these engine orders: numbers and ranges, such as `0-8,12`. A drawing shows what is from the lowest to the highest.
    #[param(max_length = 1000)]
    orders: Option<String>,
    /// Only the wheel's component in this nodal diameter.
    nodal_diameter: Option<u32>,
    /// Of a drawing, in place of `nodal_diameter`: a sheet with a map of each of these nodal diameters, such as `0-4`.
    #[param(max_length = 1000)]
    nodal_diameters: Option<String>,
    /// Of a drawing: the axis upwards; default `engine_order`. A sheet has engine orders.
    #[param(inline)]
    axis: Option<MapAxis>,
}

/// Axis of an interaction map upwards.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum MapAxis {
    /// Engine-order lines are horizontal.
    EngineOrder,
    /// Engine-order lines rise with speed.
    Frequency,
}

/// Download the interaction map: amplitude over speed and engine order.
///
/// While the job runs, the map has the speeds finished so far; rows of the others are null (empty in csv, NaN in npz). A speed that
/// diverged or failed is in `points` with its message and has no amplitude. `speed_indices` has the indices of the speeds in the request.
///
/// In csv a line is a speed of a sensor and a column an engine order. In npz `amplitude` is `[speed][engine order]`, with `sensors`
/// `[sensor][speed][engine order]`; sensors, `units` and `settings` are texts in JSON.
#[utoipa::path(get, path = "/v1/jobs/{id}/interaction-map", operation_id = "get_interaction_map", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), MapQuery, DownloadQuery),
    responses(
        (status = 200, description = "The map.", body = MapBody),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_interaction_map(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<MapQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let part = Part::of(&job, &query)?;
    let answer = match download.begin(&state, lasting(&job), &Form::ALL)? {
        Next::Done(response) => return Ok(response),
        Next::Make(answer) => answer,
    };
    if answer.form.is_drawing() {
        return draw(&state, job, part, query.axis.unwrap_or(MapAxis::EngineOrder), answer).await;
    }
    if part.sheet {
        return Err(Problem::parameter("nodal_diameters", "a sheet is a drawing: ask for svg or png"));
    }
    let bytes = ROW_MEMORY * state.store.largest_spectra(id).await?;
    let leave = state.answers.leave(&state.jobs, bytes).await;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let head = move || Ok::<_, Problem>((part.head(&job, &store, &runtime)?, part, store, leave));
    let (map, part, store, leave) = stream::blocking(head).await??;
    let runtime = Handle::current();
    let (form, unit) = (answer.form, answer.unit);
    Ok(answer.written(leave, move |out| {
        // Speeds finished since the points were read are for the next reader.
        let finished: BTreeSet<u32> = map.points.iter().map(|point| point.index).collect();
        let row = |sensor: u32, index: u32| match finished.contains(&index) {
            true => part.row(&store, &runtime, id, sensor, index).map_err(io::Error::other),
            false => Ok(None),
        };
        let Part { speeds, sensors, several, .. } = &part;
        let maps = Maps { map, indices: speeds.clone(), sensors: sensors.clone(), several: *several, row };
        map_body::write(&maps, form, unit, out)
    }))
}

/// The part of a sweep's maps that is asked for.
struct Part {
    /// Indices in the request, ascending.
    sensors: Vec<(u32, Sensor)>,
    /// Whether they were asked for as several.
    several: bool,
    /// Indices in the request, ascending.
    speeds: Vec<u32>,
    /// Columns of the engine orders, ascending.
    columns: Vec<usize>,
    /// Whether these may be less than all.
    selects: (bool, bool),
    /// Nodal diameters; `None` is the whole wheel's motion.
    diameters: Vec<Option<u32>>,
    /// Whether these were asked for as several.
    sheet: bool,
}

impl Part {
    fn of(job: &Job, query: &MapQuery) -> Result<Self, Problem> {
        let (request, facts) = sweep(job)?;
        let sensors = match (query.sensor, &query.sensors) {
            (Some(_), Some(_)) => {
                return Err(Problem::parameter("sensors", "give either sensor or sensors"));
            }
            (_, Some(sensors)) => selection::sensors(sensors, request.sensors().len())?,
            (sensor, None) => {
                let sensor = sensor.unwrap_or(0);
                check_sensor(request.sensors(), sensor)?;
                vec![sensor]
            }
        };
        let largest = facts.sectors / 2;
        let diameters = match (query.nodal_diameter, &query.nodal_diameters) {
            (Some(_), Some(_)) => {
                return Err(Problem::parameter(
                    "nodal_diameters",
                    "give either nodal_diameter or nodal_diameters",
                ));
            }
            (_, Some(some)) => {
                let some = selection::list("nodal_diameters", some, largest as usize + 1, "nodal diameter")?;
                some.into_iter().map(Some).collect()
            }
            (Some(nodal_diameter), None) if nodal_diameter > largest => {
                let detail = format!("{} sectors have nodal diameters 0 to {largest}", facts.sectors);
                return Err(Problem::parameter("nodal_diameter", detail));
            }
            (nodal_diameter, None) => vec![nodal_diameter],
        };
        let (grid, orders) = (request.speeds().rad_s(), run::map_engine_orders(request));
        let speeds = query.speeds.as_ref().map(|some| selection::speeds(some, grid)).transpose()?;
        let columns = query.orders.as_ref().map(|some| selection::orders(some, &orders)).transpose()?;
        let all = whole(request);
        Ok(Self {
            sensors: sensors.into_iter().map(|index| (index, request.sensors()[index as usize])).collect(),
            several: query.sensors.is_some(),
            selects: (speeds.is_some(), columns.is_some()),
            speeds: speeds.unwrap_or(all.0),
            columns: columns.unwrap_or(all.1),
            diameters,
            sheet: query.nodal_diameters.is_some(),
        })
    }

    /// The map of the first sensor, without rows.
    fn head(&self, job: &Job, store: &Store, runtime: &Handle) -> Result<InteractionMap, Problem> {
        let (request, facts) = sweep(job)?;
        let errors = runtime.block_on(store.document(job.id, Document::Errors))?;
        let errors = errors.map(|errors| serde_json::from_str(&errors)).transpose()?;
        let points = runtime.block_on(store.points(job.id))?.into_iter().map(|point| (point, None)).collect();
        let sensor = self.sensors[0].0 as usize;
        let mut map = run::interaction_map(request, &facts.units, points, sensor, self.diameters[0]);
        map.speeds_rad_s = self.speeds.iter().map(|&index| map.speeds_rad_s[index as usize]).collect();
        map.engine_orders = self.columns.iter().map(|&column| map.engine_orders[column]).collect();
        map.points.retain(|point| self.speeds.binary_search(&point.index).is_ok());
        Ok(InteractionMap { plan: job.plan.clone(), errors, amplitude: Vec::new(), ..map })
    }

    /// The chosen columns of a row, of each nodal diameter one after the other.
    fn row(
        &self,
        store: &Store,
        runtime: &Handle,
        job: JobId,
        sensor: u32,
        index: u32,
    ) -> Result<Option<Vec<f64>>, StoreError> {
        let of = |spectra: &SpeedSpectra| {
            let mut chosen = Vec::with_capacity(self.diameters.len() * self.columns.len());
            for diameter in &self.diameters {
                let row = run::map_row(spectra, sensor as usize, *diameter)?;
                chosen.extend(self.columns.iter().filter_map(|&column| row.get(column)));
            }
            Some(chosen)
        };
        runtime.block_on(store.map_row(job, index, of))
    }

    /// The maps of the first sensor with their rows, one per nodal diameter.
    fn maps(&self, job: &Job, store: &Store, runtime: &Handle) -> Result<Vec<InteractionMap>, Problem> {
        let head = self.head(job, store, runtime)?;
        let empty = vec![None; self.speeds.len()];
        let of = |diameter: &Option<u32>| InteractionMap {
            nodal_diameter: *diameter,
            amplitude: empty.clone(),
            ..head.clone()
        };
        let mut maps: Vec<InteractionMap> = self.diameters.iter().map(of).collect();
        for point in &head.points {
            let Some(row) = self.row(store, runtime, job.id, self.sensors[0].0, point.index)? else {
                continue;
            };
            let place = self.speeds.partition_point(|index| *index < point.index);
            for (map, row) in maps.iter_mut().zip(row.chunks(self.columns.len())) {
                map.amplitude[place] = Some(row.to_vec());
            }
        }
        Ok(maps)
    }

    /// What a drawing shows: from the slowest to the fastest chosen speed, and from the lowest to the highest engine order.
    fn window(&self, request: &ResolvedSweep) -> Result<Window, Problem> {
        let range = |name: &str, values: &mut dyn Iterator<Item = f64>| {
            let ends =
                values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
            if ends.0 < ends.1 {
                Ok(ends)
            } else {
                Err(Problem::parameter(name, "a drawing goes from one to another: choose two at least"))
            }
        };
        let (grid, orders) = (request.speeds().rad_s(), run::map_engine_orders(request));
        let mut rpm = self.speeds.iter().map(|&index| grid[index as usize] / SpeedUnit::Rpm.rad_s());
        let mut chosen = self.columns.iter().map(|&column| orders[column]);
        Ok(Window {
            speeds_rpm: self.selects.0.then(|| range("speeds", &mut rpm)).transpose()?,
            engine_orders: self.selects.1.then(|| range("orders", &mut chosen)).transpose()?,
        })
    }
}

/// A drawing of one map, or a sheet of one per nodal diameter.
async fn draw(
    state: &AppState,
    job: Job,
    mut part: Part,
    axis: MapAxis,
    answer: Answer,
) -> Result<Response, Problem> {
    let (request, _) = sweep(&job)?;
    let window = part.window(request)?;
    (part.speeds, part.columns) = whole(request);
    let amplitudes =
        (part.diameters.len() * part.speeds.len() * part.columns.len() * size_of::<f64>()) as u64;
    let bytes = ROW_MEMORY * state.store.largest_spectra(job.id).await? + DRAWN_MEMORY * amplitudes;
    let leave = state.answers.leave(&state.jobs, bytes + answer.bytes()).await;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let draw = move || {
        let [(sensor, _)] = part.sensors[..] else {
            return Err(Problem::parameter("sensors", "a drawing is of one sensor"));
        };
        let maps = part.maps(&job, &store, &runtime)?;
        let critical = runtime.block_on(store.document(job.id, Document::CriticalSpeeds(sensor)))?;
        let critical: Option<CriticalSpeeds> =
            critical.map(|critical| serde_json::from_str(&critical)).transpose()?;
        let axis = match axis {
            MapAxis::EngineOrder => VerticalAxis::EngineOrder,
            MapAxis::Frequency => VerticalAxis::Frequency,
        };
        Ok(match &maps[..] {
            [map] if !part.sheet => plot::interaction_map(map, critical.as_ref(), None, axis, window),
            maps => plot::map_sheet(maps, window),
        })
    };
    answer.drawn(state, leave, draw).await
}

/// All speeds and all columns of a sweep's maps.
fn whole(request: &ResolvedSweep) -> (Vec<u32>, Vec<usize>) {
    let (speeds, orders) = (request.speeds().rad_s().len(), run::map_engine_orders(request).len());
    ((0..speeds as u32).collect(), (0..orders).collect())
}
