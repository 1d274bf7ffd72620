//! Results of one speed of a sweep: spectra and wear.

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, Next, lasting};
use super::extract::{Parameters, SpeedPath, job_not_found};
use super::form::Form;
use super::forms::Forms;
use super::problem::{Kind, Problem};
use super::results::{FrameWord, check_sensor, find, sweep};
use super::selection;
use super::state::AppState;
use crate::analysis::result::{ContactForces, Point, SpeedResult, SpeedSpectra, WearMap};
use crate::dynamics::sector::Units;
use crate::export::{self, Array, Export};
use crate::plot;
use crate::store::jobs::{Job, JobId};
use crate::tokens::Principal;

/// Memory of spectra that are being read, in multiples of their unpacked size: the row, its numbers deflated and inflated, the spectra.
pub(super) const ROW_MEMORY: u64 = 4;

/// Part of the spectra of a speed to download, and their drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SpectraQuery {
    /// Sensors to download: indices in the request and ranges of them, such as `0-2,5`; default all.
    #[param(max_length = 1000)]
    sensors: Option<String>,
    /// Engine orders to download: numbers and ranges, such as `0-8,12`; default all.
    #[param(max_length = 1000)]
    orders: Option<String>,
    /// Index, in the request, of the sensor that a drawing shows; default the first of `sensors`.
    sensor: Option<u32>,
    /// Frame in which a drawing shows the vibration; default `rotating`.
    #[param(inline)]
    frame: Option<FrameWord>,
}

/// Spectra, wear and contact of one speed of a sweep.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct SpectraBody {
    /// Credentials and summary of the speed.
    point: Point,
    /// Units of the model.
    units: Units,
    /// Amplitudes over engine order, per sensor and nodal diameter; null unless `point.status` is `completed`.
    #[schema(required)]
    spectra: Option<SpeedSpectra>,
    /// Wear of an abradable coating; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    wear: Option<WearMap>,
    /// Contact over the window, blade by blade; absent without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    contact: Option<ContactForces>,
    /// Indices of the sensors in the request.
    #[serde(skip)]
    sensors: Vec<u32>,
}

impl Export for SpectraBody {
    fn table(&self) -> Vec<Array> {
        self.spectra
            .as_ref()
            .map_or_else(Vec::new, |spectra| export::spectra::table(spectra, &self.sensors, &self.units))
    }

    fn arrays(&self) -> Vec<Array> {
        let spectra = self.spectra.as_ref();
        spectra.map_or_else(Vec::new, |spectra| export::spectra::arrays(&self.point, spectra, &self.units))
    }
}

/// Empty spectra, which are drawn of a speed that has none.
static NO_SPECTRA: SpeedSpectra = SpeedSpectra { engine_orders: Vec::new(), sensors: Vec::new() };

impl SpectraBody {
    fn known(&self) -> &SpeedSpectra {
        self.spectra.as_ref().unwrap_or(&NO_SPECTRA)
    }
}

/// Wear of an abradable coating at one speed of a sweep.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct WearBody {
    /// Credentials and summary of the speed.
    point: Point,
    /// Units of the model.
    units: Units,
    /// Depths of the wear.
    wear: WearMap,
}

impl Export for WearBody {
    fn table(&self) -> Vec<Array> {
        export::wear::table(&self.wear, &self.units)
    }

    fn arrays(&self) -> Vec<Array> {
        export::wear::arrays(&self.point, &self.wear, &self.units)
    }
}

/// Download the spectra of one speed.
///
/// A speed that is not completed has its credentials in json and no other form. In csv a line is an engine order of a sensor; in npz
/// `amplitude` is `[sensor][engine order]` and `nodal_diameters` `[sensor][nodal diameter][engine order]`.
#[utoipa::path(get, path = "/v1/jobs/{id}/spectra/{index}", operation_id = "get_spectra", tag = "results",
    params(
        ("id" = String, Path, description = "Id of a sweep."),
        ("index" = u32, Path, description = "Index of the speed in the request, from 0."),
        SpectraQuery, DownloadQuery,
    ),
    responses(
        (status = 200, description = "The speed.", body = SpectraBody),
        (status = 404, description = "There is no such job or speed, or the job ended before it.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep, or the speed is not finished yet, or has no spectra that the form \
            could show.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_spectra(
    state: State<AppState>,
    whose: Principal,
    SpeedPath(id, index): SpeedPath,
    Parameters(query): Parameters<SpectraQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, facts) = sweep(&job)?;
    let index = check_index(&job, index)?;
    let total = request.sensors().len();
    let sensors = match &query.sensors {
        Some(sensors) => selection::sensors(sensors, total)?,
        None => (0..total as u32).collect(),
    };
    let drawn = query.sensor.unwrap_or(sensors[0]);
    check_sensor(request.sensors(), drawn)?;
    finished(&state, &job, index).await?;
    let answer = match download.begin(&state, lasting(&job), &Form::ALL)? {
        Next::Done(response) => return Ok(response),
        Next::Make(answer) => answer,
    };
    let units = facts.units.clone();
    let frame = FrameWord::frame(query.frame);
    let place = sensors.iter().position(|sensor| *sensor == drawn).unwrap_or(0);
    let forms = Forms::drawn_by(move |body: &SpectraBody| {
        plot::spectrum(body.known(), &body.point, &body.units, place, frame)
    });
    let (form, orders) = (answer.form, query.orders);
    let bytes = ROW_MEMORY * state.store.largest_spectra(id).await?;
    let read = speed(&state, id, index);
    forms
        .make(&state, answer, bytes, move || {
            let SpeedResult { point, spectra, wear, contact, .. } = read()?;
            if spectra.is_none() && form != Form::Json {
                return Err(unavailable(&point, "spectra"));
            }
            let spectra = spectra.map(|spectra| chosen(spectra, &sensors, orders.as_deref())).transpose()?;
            Ok(SpectraBody { point, units, spectra, wear, contact, sensors })
        })
        .await
}

/// Download the wear of an abradable coating at one speed.
#[utoipa::path(get, path = "/v1/jobs/{id}/wear/{index}", operation_id = "get_wear", tag = "results",
    params(
        ("id" = String, Path, description = "Id of a sweep."),
        ("index" = u32, Path, description = "Index of the speed in the request, from 0."),
        DownloadQuery,
    ),
    responses(
        (status = 200, description = "The wear.", body = WearBody),
        (status = 404, description = "There is no such job or speed, or the job ended before it.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep, its scene has no abradable coating, or the speed is not finished yet or \
            not completed.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_wear(
    state: State<AppState>,
    whose: Principal,
    SpeedPath(id, index): SpeedPath,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, facts) = sweep(&job)?;
    let index = check_index(&job, index)?;
    if !request.is_worn() {
        return Err(Problem::new(Kind::ResultUnavailable, "the scene of the job has no abradable coating"));
    }
    finished(&state, &job, index).await?;
    let units = facts.units.clone();
    let bytes = ROW_MEMORY * state.store.largest_spectra(id).await?;
    let read = speed(&state, id, index);
    Forms::drawn_by(|body: &WearBody| plot::wear_map(&body.wear, &body.point, &body.units))
        .answer(&state, download, lasting(&job), bytes, move || {
            let SpeedResult { point, wear, .. } = read()?;
            let Some(wear) = wear else { return Err(unavailable(&point, "wear")) };
            Ok(WearBody { point, units, wear })
        })
        .await
}

/// Chosen part of spectra.
fn chosen(spectra: SpeedSpectra, sensors: &[u32], orders: Option<&str>) -> Result<SpeedSpectra, Problem> {
    let SpeedSpectra { engine_orders, sensors: all } = spectra;
    let mut sensors: Vec<_> = all
        .into_iter()
        .enumerate()
        .filter(|(index, _)| sensors.contains(&(*index as u32)))
        .map(|(_, sensor)| sensor)
        .collect();
    let Some(orders) = orders else { return Ok(SpeedSpectra { engine_orders, sensors }) };
    let columns = selection::orders(orders, &engine_orders)?;
    let part = |line: &[f64]| -> Vec<f64> { columns.iter().map(|&column| line[column]).collect() };
    for sensor in &mut sensors {
        sensor.amplitude = part(&sensor.amplitude);
        for line in &mut sensor.nodal_diameters {
            *line = part(line);
        }
    }
    Ok(SpeedSpectra { engine_orders: part(&engine_orders), sensors })
}

pub(super) fn check_index(job: &Job, index: Option<u32>) -> Result<u32, Problem> {
    let total = job.speeds.total;
    index.filter(|index| *index < total).ok_or_else(|| {
        Problem::new(Kind::SpeedNotFound, format!("the job has {total} speeds, counted from 0"))
    })
}

/// Refuses a speed that has not ended.
async fn finished(state: &AppState, job: &Job, index: u32) -> Result<(), Problem> {
    if state.store.is_speed_finished(job.id, index).await? {
        return Ok(());
    }
    Err(if job.status.is_final() {
        let status = job.status.as_str();
        Problem::new(Kind::SpeedNotFound, format!("the job was {status} before speed {index} was computed"))
    } else {
        Problem::new(Kind::ResultNotReady, format!("speed {index} is not finished yet"))
    })
}

/// Reader of a finished speed, for a thread that may wait.
fn speed(
    state: &AppState,
    job: JobId,
    index: u32,
) -> impl FnOnce() -> Result<SpeedResult, Problem> + Send + 'static {
    let (store, runtime) = (state.store.clone(), Handle::current());
    move || runtime.block_on(store.speed_result(job, index))?.ok_or_else(|| job_not_found(&job))
}

/// Problem of a speed that has ended without this result.
fn unavailable(point: &Point, what: &str) -> Problem {
    let message = point.message.as_deref().unwrap_or("it was not completed");
    Problem::new(Kind::ResultUnavailable, format!("speed {} has no {what}: {message}", point.index))
}
