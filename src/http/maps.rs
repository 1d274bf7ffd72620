//! Interaction maps: amplitude over speed and engine order.

use std::collections::BTreeSet;
use std::io;

use axum::extract::State;
use axum::response::Response;
use tokio::runtime::Handle;

use super::download::{Answer, Download, DownloadQuery, Next, lasting};
use super::extract::{JobPath, Parameters};
use super::form::Form;
use super::map_body::{self, MapBody};
use super::map_part::{self, MapAxis, MapColour, MapQuery, Part};
use super::problem::Problem;
use super::results::{find, sweep};
use super::spectra::ROW_MEMORY;
use super::state::AppState;
use super::stream;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::CRITICAL_SPEEDS;
use crate::analysis::result::{CriticalSpeeds, InteractionMap};
use crate::export::maps::Maps;
use crate::plot::{self, Drawing, Frame, LevelColour, VerticalAxis, Window};
use crate::store::jobs::Job;
use crate::tokens::Principal;

/// Memory of a map that is drawn, in multiples of its amplitudes.
const DRAWN_MEMORY: u64 = 3;

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
    if answer.form.is_shown() {
        let axis = match query.axis {
            Some(MapAxis::Frequency) => VerticalAxis::Frequency,
            Some(MapAxis::EngineOrder) | None => VerticalAxis::EngineOrder,
        };
        let colour = match query.colour {
            Some(MapColour::Utilisation) => LevelColour::Utilisation,
            Some(MapColour::Plain) | None => LevelColour::Plain,
        };
        return draw(&state, job, part, axis, colour, answer).await;
    }
    if part.sheet {
        return Err(Problem::parameter(
            "nodal_diameters",
            "a sheet is a drawing: ask for svg, png or plotly",
        ));
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

/// Answers with a drawing or a figure of one map, or with a sheet of one map per nodal diameter.
async fn draw(
    state: &AppState,
    job: Job,
    mut part: Part,
    axis: VerticalAxis,
    colour: LevelColour,
    answer: Answer,
) -> Result<Response, Problem> {
    let (request, _) = sweep(&job)?;
    let window = part.window(request)?;
    let (sheet, frame) = (part.sheet, part.frame);
    (part.speeds, part.columns) = map_part::whole(request);
    let amplitudes =
        (part.diameters.len() * part.speeds.len() * part.seen(&job)?.len() * size_of::<f64>()) as u64;
    let bytes = ROW_MEMORY * state.store.largest_spectra(job.id).await? + DRAWN_MEMORY * amplitudes;
    let leave = state.answers.leave(&state.jobs, bytes + answer.bytes()).await;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let read = move || {
        let [(sensor, _)] = part.sensors[..] else {
            return Err(Problem::parameter("sensors", "a drawing is of one sensor"));
        };
        let maps = part.maps(&job, &store, &runtime)?;
        let critical = runtime.block_on(store.document(job.id, Document::part(CRITICAL_SPEEDS, sensor)))?;
        let critical: Option<CriticalSpeeds> =
            critical.map(|critical| serde_json::from_str(&critical)).transpose()?;
        Ok::<_, Problem>((maps, critical))
    };
    let seen = Seen { axis, colour, frame, is_sheet: sheet, window };
    if answer.form == Form::Plotly {
        let read = move || Ok::<_, Problem>((read()?, leave));
        let ((maps, critical), leave) = stream::blocking(read).await??;
        return Ok(answer.figure(leave, move || drawing(&maps, critical.as_ref(), seen).figure()));
    }
    let draw = move || {
        let (maps, critical) = read()?;
        Ok(drawing(&maps, critical.as_ref(), seen).svg())
    };
    answer.drawn(state, leave, draw).await
}

/// Choices of a reader about the drawing of a map.
#[derive(Debug, Clone, Copy)]
struct Seen {
    axis: VerticalAxis,
    colour: LevelColour,
    frame: Frame,
    /// Whether all maps are drawn on one sheet.
    is_sheet: bool,
    window: Window,
}

/// Drawing of one map, or of a sheet of one map per nodal diameter.
fn drawing<'a>(maps: &'a [InteractionMap], critical: Option<&CriticalSpeeds>, seen: Seen) -> Drawing<'a> {
    let Seen { axis, colour, frame, is_sheet, window } = seen;
    match (maps, frame) {
        ([map], Frame::Fixed) => plot::fixed_frame_map(map, critical, axis, window, colour),
        ([map], Frame::Rotating) if !is_sheet => {
            plot::interaction_map(map, critical, None, axis, window, colour)
        }
        (maps, _) => plot::map_sheet(maps, window, colour),
    }
}
