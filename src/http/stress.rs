//! Stress and margin of a sweep over speed.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::{Kind, Problem};
use super::results::{find, sweep};
use super::spectra::check_index;
use super::state::AppState;
use crate::analysis::result::{Point, SweepStress};
use crate::analysis::run;
use crate::plot::{self, HaighColour};
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Memory of a speed's point with its cycles, bytes: its text, its numbers, and what is made of them.
const SPEED_MEMORY: u64 = 32 * 1024;

/// Stress to download, and its drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct StressQuery {
    /// Index, in the request, of the one speed to download; default all speeds.
    speed: Option<u32>,
    /// Quantity by which the dots of a drawing are coloured; default `speed`.
    #[param(inline)]
    colour: Option<Colour>,
}

/// Quantity by which the dots of a Haigh diagram are coloured.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
enum Colour {
    /// Rotational speed.
    Speed,
    /// Utilisation of the material.
    Utilisation,
}

/// Download stress and margin over speed: the largest stress, and the cycles of the most utilised places with the strengths of their materials.
///
/// While the job runs, the result has the speeds finished so far. In csv a line is a cycle; npz has the same columns, and the
/// largest values as a number per speed. The drawing is a Haigh diagram.
#[utoipa::path(get, path = "/v1/jobs/{id}/stress", operation_id = "get_stress", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), StressQuery, DownloadQuery),
    responses(
        (status = 200, description = "Stress of all speeds that have any.", body = SweepStress),
        (status = 404, description = "There is no such job or speed, or no stress was recorded.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep, or no speed with stress is finished yet.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_stress(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<StressQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    sweep(&job)?;
    let speed = query.speed.map(|speed| check_index(&job, Some(speed))).transpose()?;
    let bytes = SPEED_MEMORY * u64::from(job.speeds.total);
    let by = match query.colour.unwrap_or(Colour::Speed) {
        Colour::Speed => HaighColour::Speed,
        Colour::Utilisation => HaighColour::Utilisation,
    };
    let (store, runtime, lasting) = (state.store.clone(), Handle::current(), lasting(&job));
    let read = move || {
        let (request, facts) = sweep(&job)?;
        let points = runtime.block_on(store.points(id))?;
        let of_speed = |point: &&Point| speed.is_none_or(|speed| point.index == speed);
        let reason = points.iter().filter(of_speed).find_map(|point| point.message.clone());
        let reason = reason.filter(|_| request.stress_outside().is_some());
        recorded(run::sweep_stress(request, facts, &points), speed, job.status, reason)
    };
    Forms::drawn_by(move |stress: &SweepStress| plot::haigh(stress, by))
        .answer(&state, download, lasting, bytes, read)
        .await
}

/// Selects the speed that is asked for, or all; if nothing was recorded, fails with `reason` or, if that is not known, with what it takes.
fn recorded(
    mut stress: SweepStress,
    speed: Option<u32>,
    status: JobStatus,
    reason: Option<String>,
) -> Result<SweepStress, Problem> {
    if let Some(speed) = speed {
        stress.speeds.retain(|of| of.index == speed);
    }
    if !stress.speeds.is_empty() {
        return Ok(stress);
    }
    let of = speed.map_or_else(|| "any finished speed".to_owned(), |speed| format!("speed {speed}"));
    Err(if status.is_final() {
        let needs =
            "it takes a model with a mesh, a sweep that asks for stress, and a speed that was completed";
        let reason = reason.as_deref().unwrap_or(needs);
        Problem::new(Kind::StressNotRecorded, format!("there is no stress of {of}: {reason}"))
    } else {
        Problem::new(Kind::ResultNotReady, format!("there is no stress of {of} yet"))
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Stress of speeds 1 and 3 of a sweep.
    fn stress() -> SweepStress {
        let speed = |index: u32| {
            json!({"index": index, "speed_rad_s": 1.0, "stress": {
                "largest": {"von_mises": 1.0, "node": 1, "position": [0.0, 0.0, 0.0], "sector": 0, "revolution": 1.0},
                "largest_static": 1.0, "cycles": [], "excluded_radius": 1.0, "excluded_nodes": 0, "followed_nodes": 0,
            }})
        };
        serde_json::from_value(json!({
            "speeds": [speed(1), speed(3)], "strengths": [],
            "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
            "settings": {"model": "m", "speeds": {"values": [1.0], "unit": "rpm"}, "scene": {}}, "version": "0",
        }))
        .unwrap()
    }

    #[test]
    fn one_speed_can_be_asked_for() {
        let indices = |speed| {
            let found = recorded(stress(), speed, JobStatus::Running, None).unwrap();
            found.speeds.iter().map(|speed| speed.index).collect::<Vec<_>>()
        };
        assert_eq!(indices(None), [1, 3]);
        assert_eq!(indices(Some(3)), [3]);
    }

    #[test]
    fn what_was_not_recorded_is_said_so() {
        let mut nothing = stress();
        nothing.speeds.clear();
        for (stress, speed, status, expected, words) in [
            (
                stress(),
                Some(2),
                JobStatus::Successful,
                404,
                "no stress of speed 2: it takes a model with a mesh",
            ),
            (stress(), Some(2), JobStatus::Running, 409, "no stress of speed 2 yet"),
            (nothing.clone(), None, JobStatus::Dismissed, 404, "no stress of any finished speed: it takes"),
            (nothing.clone(), None, JobStatus::Accepted, 409, "no stress of any finished speed yet"),
        ] {
            let problem = recorded(stress, speed, status, None).unwrap_err();
            assert_eq!(problem.status, expected);
            assert!(problem.detail.contains(words), "{}", problem.detail);
        }
        let reason = "stress is not known: every node lies within 1000 of a contact node";
        let problem = recorded(nothing, None, JobStatus::Successful, Some(reason.to_owned())).unwrap_err();
        assert_eq!(problem.detail, format!("there is no stress of any finished speed: {reason}"));
    }
}
