//! Demo with a package of the user's own.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, anyhow, bail};
use serde_json::Value;

use super::args::DemoArgs;
use super::sensible::{self, Range};
use super::{report, results};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{Campbell, SweepPlan};
use crate::analysis::run::ModelFacts;
use crate::cli::client::{Answer, Client, Job};
use crate::cli::session::{Session, save, upload};
use crate::cli::stdout::narrate;
use crate::cli::{progress, request};

/// Name of the file in which the request of the sweep is left.
const REQUEST: &str = "sweep-request.json";

/// Highest speed of the Campbell diagram over that of the sweep, where the stiffness is known so far.
const BEYOND: f64 = 1.05;

/// Runs the demo with the package; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A file or folder that cannot be used, a package or request that the service refuses.
pub(super) fn run(args: &DemoArgs, package: &Path) -> anyhow::Result<ExitCode> {
    let given = match &args.request {
        Some(file) => Some(request::read(file, "/v1/sweeps")?),
        None => None,
    };
    if !package.is_file() {
        bail!("cannot read the package {}: there is no such file", package.display());
    }
    let session = Session::begin(&args.out)?;
    session.run(args.workers, async |client| play(args, client, package, given).await)
}

async fn play(args: &DemoArgs, client: &Client, package: &Path, given: Option<Value>) -> anyhow::Result<()> {
    let out = &args.out;
    let model = upload(client, package).await?;
    let facts: ModelFacts = client.get(&format!("/v1/models/{}", model.id)).await?;
    narrate(&format!(
        "package   {}: {} sectors of {} DOF, {} contact nodes",
        facts.name, facts.sectors, facts.own_dofs, facts.contact_nodes
    ))?;
    let of_model = |body: Value| request::of_model(body, &model.id);
    let body = match given {
        Some(body) => body,
        None => {
            let range = match Range::of_package(&facts) {
                Some(range) => range,
                None => Range::of_frequency(lowest_frequency(client, &model.id).await?),
            };
            let radius = facts.contact_radius.filter(|radius| *radius > 0.0);
            let radius = radius.context("the tips lie on the axis: no clearance can be chosen")?;
            let (body, words) = sensible::sweep(&facts, radius, &range, args.speeds, args.revolutions);
            narrate(&words)?;
            save(&out.join(REQUEST), &format!("{}\n", serde_json::to_string_pretty(&body)?))?;
            body
        }
    };
    let sweep = of_model(body)?;
    // The plan comes before anything is computed: an impossible request is refused at once.
    let plan: SweepPlan = client.post("/v1/sweeps/plan", &sweep).await?;
    let highest = highest_speed(plan)?;
    let known = facts.speeds_rad_s.last().copied().filter(|known| *known > 0.0).unwrap_or(f64::INFINITY);
    let modal_analysis = sensible::modal_analysis((BEYOND * highest).min(known), sensible::lobes_of(&sweep));
    let mut modal_analysis = of_model(modal_analysis)?;
    if let Some(modes) = sweep.get("modes_per_speed") {
        modal_analysis["modes_per_speed"] = modes.clone();
    }
    let modal_analysis = post(client, "/v1/modal-analyses", &modal_analysis, "modal analysis").await?;
    let plan: SweepPlan = client.post("/v1/sweeps/plan", &sweep).await?;
    tell_cost(&plan)?;
    let sweep = post(client, "/v1/sweeps", &sweep, "sweep").await?;

    let results = results::download(client, &modal_analysis, &sweep, out).await?;
    narrate(&format!(
        "\n{}\n\n{}\n{}",
        results.verdict,
        report::credentials(&results.map),
        report::critical_speeds(&results.critical)
    ))?;
    let request = args.request.clone().unwrap_or_else(|| out.join(REQUEST));
    narrate(&format!("\n{}", report::own_places(out, &request, package)))?;
    Ok(())
}

async fn post(client: &Client, path: &str, body: &Value, name: &str) -> anyhow::Result<Answer<Job>> {
    let job = client.post_job(path, body).await?;
    progress::follow(client, &job, name).await
}

/// Lowest natural frequency of the wheel at rest, Hz.
async fn lowest_frequency(client: &Client, model: &str) -> anyhow::Result<f64> {
    let body = serde_json::json!({"model": model, "families": 1, "speeds": {"values": [0], "unit": "rad_s"}});
    let job = post(client, "/v1/modal-analyses", &body, "at rest").await?;
    let found: Campbell = client.get(job.link("campbell")?).await?;
    let all = found.frequencies_hz.iter().flatten().flatten().copied();
    let lowest = all.filter(|frequency| *frequency > 0.0).reduce(f64::min);
    lowest.context("the wheel has no natural frequency")
}

/// Highest speed of a planned sweep, rad/s.
fn highest_speed(plan: SweepPlan) -> anyhow::Result<f64> {
    let refused = |_| anyhow!("the service did not understand its own plan");
    let sweep = ResolvedSweep::stored(plan.settings, 0).map_err(refused)?;
    sweep.speeds().ascending().last().copied().context("the request has no speeds")
}

/// Prints what the sweep will take, where that is known.
fn tell_cost(plan: &SweepPlan) -> anyhow::Result<()> {
    for warning in &plan.warnings {
        narrate(&format!("warning   {warning}"))?;
    }
    if let Some(estimate) = &plan.estimate {
        let (least, most) = (estimate.wall_time_s.free, estimate.wall_time_s.contact);
        let steps = estimate.steps as f64 / 1e6;
        let up_to = if plan.settings.integration.takes_all() { "" } else { "at most " };
        narrate(&format!(
            "plan      {up_to}{steps:.1} million steps, {least:.0} to {most:.0} s where nothing else runs"
        ))?;
    }
    Ok(())
}
