//! Campaigns: many designs of a scene, and the result of them all.

use axum::Json;
use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, JsonBody, Parameters};
use super::forms::{Forms, READ_MEMORY};
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::{Problem, excerpt};
use super::results::{find, wrong_kind};
use super::state::AppState;
use super::submit;
use crate::analysis::request::CampaignRequest;
use crate::analysis::result::{Campaign, CampaignPlan};
use crate::analysis::run;
use crate::jobs::Submission;
use crate::plot;
use crate::store::jobs::{JobKind, JobRequest};
use crate::tokens::Principal;

/// Body of a campaign: the request, and the labels of the job.
type CampaignBody = Labelled<CampaignRequest>;

/// Simulate many designs of a scene over speeds.
///
/// One job simulates all designs: `parameters` are the numbers of the scene that vary, and `design`, the design of experiments,
/// chooses their values. All designs share the reduction, and each is checked against the model before any simulation begins.
/// `GET /v1/jobs/{id}/campaign` has the result so far. With `threshold.within`, designs are added where it is undecided whether the
/// limit is met with the requested probability.
#[utoipa::path(post, path = "/v1/campaigns", operation_id = "create_campaign", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = CampaignBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "speeds": {"from": 20000.0, "to": 28000.0, "count": 41, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        },
        "parameters": [
            {"name": "clearance", "at": ["/scene/casing/clearance/leading", "/scene/casing/clearance/trailing"],
                "change": "add", "from": -0.05, "to": 0.2},
            {"name": "damping", "at": ["/scene/damping/modal_ratio"], "distribution": "log_uniform", "from": 0.002, "to": 0.01},
            {"name": "lobes", "at": ["/scene/casing/lobes/amplitude"], "change": "add",
                "distribution": "normal", "mean": 0.0, "standard_deviation": 0.02}
        ],
        "design": {"kind": "sobol", "size": 64, "seed": 1},
        "limit": 0.2,
        "threshold": {"parameter": "clearance", "probability": 0.95, "within": 0.01}
    })),
    responses(
        (status = 422, description = "A field is unknown, missing or impossible, also of a single design, the model is unknown \
            (`errors` points at each), or the idempotency key belongs to another request.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn create_campaign(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<CampaignBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::Campaign(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Plan a campaign: what it would do and cost. Starts nothing.
///
/// Takes the body of `POST /v1/campaigns` and answers at once with the values of all designs and, if the reduction is stored, the
/// expected cost of all their simulations together.
#[utoipa::path(post, path = "/v1/campaigns/plan", operation_id = "plan_campaign", tag = "jobs",
    request_body = CampaignBody,
    responses(
        (status = 200, description = "The plan.", body = CampaignPlan),
    ))]
pub(super) async fn plan_campaign(
    State(state): State<AppState>,
    whose: Principal,
    body: JsonBody<CampaignBody>,
) -> Result<Json<CampaignPlan>, Problem> {
    Ok(Json(state.jobs.plan_campaign(&whose, body.value.parts()?.0).await?))
}

/// Parameters of a drawing of a campaign.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct CampaignQuery {
    /// Name of the parameter that a drawing shows beside the speed; default: that of the threshold, or else the first.
    #[param(max_length = 64)]
    parameter: Option<String>,
}

/// Download the result of a campaign, finished or not.
///
/// While the job runs, the result covers the simulations finished so far. In csv a line is a design; npz has severities as
/// `by_speed`, `[design][speed]`.
#[utoipa::path(get, path = "/v1/jobs/{id}/campaign", operation_id = "get_campaign", tag = "results",
    params(("id" = String, Path, description = "Id of a campaign."), CampaignQuery, DownloadQuery),
    responses(
        (status = 200, description = "The campaign.", body = Campaign),
        (status = 409, description = "The job is of another kind.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_campaign(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<CampaignQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (JobRequest::Campaign(asked), Some(facts)) = (&job.request, &job.facts) else {
        return Err(wrong_kind(&job, JobKind::Campaign));
    };
    let named = query.parameter.as_deref().or(asked.threshold_parameter());
    let parameter = match named {
        None => 0,
        Some(name) => asked.parameter(name).ok_or_else(|| {
            Problem::parameter("parameter", format!("the campaign has no parameter {:?}", excerpt(name)))
        })?,
    };
    let (asked, units, plan) = (asked.clone(), facts.units.clone(), job.plan.clone());
    let (store, runtime) = (state.store.clone(), Handle::current());
    let read = move || {
        let points = runtime.block_on(store.points(id))?;
        Ok(Campaign { plan, ..run::campaign(&asked, &units, &points) })
    };
    let draw = move |campaign: &Campaign| plot::campaign(campaign, parameter);
    let figure = move |campaign: &Campaign| plot::figure::campaign(campaign, parameter);
    Forms::drawn_by(draw, figure)
        .answer(&state, download, lasting(&job), READ_MEMORY * job.stored_bytes, read)
        .await
}
