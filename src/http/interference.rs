//! Interference diagrams of modal analyses.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::Problem;
use super::results::{find, resolved};
use super::state::AppState;
use crate::analysis::kinds::modal_analysis::{CAMPBELL, MODAL_ANALYSIS};
use crate::analysis::request::{ModalAnalysisRequest, SpeedUnit};
use crate::analysis::resolved::ResolvedModalAnalysis;
use crate::analysis::result::{AskedInterference, Campbell, Interference};
use crate::kinds::JobKind;
use crate::plot;
use crate::tokens::Principal;

/// Largest numbers of lobes and of engine orders, as in requests.
const MOST: [u32; 2] = [100, 1000];

/// Speed, casing and operating range of an interference diagram.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct InterferenceQuery {
    /// Speed, within those of the analysis; default its highest.
    speed: Option<f64>,
    /// First speed of an operating range.
    from: Option<f64>,
    /// Last speed of the operating range.
    to: Option<f64>,
    /// Unit of these speeds; default `rad_s`.
    #[param(inline)]
    unit: Option<SpeedUnit>,
    /// Number of lobes of the casing; default that of the analysis.
    #[param(minimum = 1, maximum = 100)]
    lobes: Option<u32>,
    /// Highest engine order; default that of the analysis.
    #[param(minimum = 1, maximum = 1000)]
    max_engine_order: Option<u32>,
}

impl InterferenceQuery {
    /// Question of the query; parameters that are missing are those of the analysis.
    fn asked(&self, request: &ResolvedModalAnalysis) -> Result<AskedInterference, Problem> {
        let unit = self.unit.unwrap_or(SpeedUnit::RadS).rad_s();
        let request = ModalAnalysisRequest::from(request.clone());
        let number = |name: &str, asked: Option<u32>, own: u32, most: u32| match asked.unwrap_or(own) {
            number if (1..=most).contains(&number) => Ok(number),
            _ => Err(Problem::parameter(name, format!("a number from 1 to {most}"))),
        };
        let range_rad_s = match (self.from, self.to) {
            (None, None) => None,
            (Some(from), Some(to)) if 0.0 <= from && from < to && to.is_finite() => {
                Some([from * unit, to * unit])
            }
            (Some(_), Some(_)) => return Err(Problem::parameter("to", "a speed above `from`")),
            (Some(_), None) => {
                return Err(Problem::parameter("to", "give both ends of the range, or neither"));
            }
            (None, Some(_)) => {
                return Err(Problem::parameter("from", "give both ends of the range, or neither"));
            }
        };
        Ok(AskedInterference {
            speed_rad_s: self.speed.map_or(f64::INFINITY, |speed| speed * unit),
            lobes: number("lobes", self.lobes, request.lobes, MOST[0])?,
            max_engine_order: number(
                "max_engine_order",
                self.max_engine_order,
                request.max_engine_order,
                MOST[1],
            )?,
            range_rad_s,
        })
    }
}

/// Download the interference diagram of a modal analysis at one speed: modes over the nodal diameter, and engine orders folded onto the nodal
/// diameters that they drive.
///
/// Made on reading; between speeds of the analysis frequencies are interpolated. In csv a line is a mode.
#[utoipa::path(get, path = "/v1/jobs/{id}/interference", operation_id = "get_interference", tag = "results",
    params(("id" = String, Path, description = "Id of a modal analysis."), InterferenceQuery, DownloadQuery),
    responses(
        (status = 200, description = "The diagram.", body = Interference),
        (status = 409, description = "The job is not a modal analysis, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_interference(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<InterferenceQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, facts) = resolved::<ResolvedModalAnalysis>(&job, JobKind(&MODAL_ANALYSIS))?;
    let (asked, sectors) = (query.asked(request)?, facts.sectors);
    let unit = query.unit.unwrap_or(SpeedUnit::RadS).rad_s();
    let made = move |campbell: Campbell| {
        let speeds = &campbell.speeds_rad_s;
        let (lowest, highest) = (speeds.first().copied(), speeds.last().copied());
        let (lowest, highest) = (lowest.unwrap_or(0.0), highest.unwrap_or(0.0));
        let speed_rad_s = if asked.speed_rad_s == f64::INFINITY { highest } else { asked.speed_rad_s };
        let asked = AskedInterference { speed_rad_s, ..asked };
        Interference::of(&campbell, sectors, asked).ok_or_else(|| {
            let (lowest, highest) = (lowest / unit, highest / unit);
            Problem::parameter("speed", format!("the analysis has speeds from {lowest} to {highest}"))
        })
    };
    Forms::drawn_by(plot::interference).made_of(&state, download, &job, CAMPBELL, made).await
}
