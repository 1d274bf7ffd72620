//! Campaigns: many designs of a scene, and the result of them all.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, Parameters};
use super::forms::{Forms, READ_MEMORY};
use super::problem::{Problem, excerpt};
use super::results::{find, resolved};
use super::state::AppState;
use crate::analysis::kinds::campaign::CAMPAIGN;
use crate::analysis::resolved::ResolvedCampaign;
use crate::analysis::result::Campaign;
use crate::analysis::run;
use crate::kinds::JobKind;
use crate::plot;
use crate::tokens::Principal;

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
    let (asked, facts) = resolved::<ResolvedCampaign>(&job, JobKind(&CAMPAIGN))?;
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
    Forms::drawn_by(move |campaign: &Campaign| plot::campaign(campaign, parameter))
        .answer(&state, download, lasting(&job), READ_MEMORY * job.stored_bytes, read)
        .await
}
