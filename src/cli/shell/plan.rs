//! `rubmap plan`: prints what a request would do and cost.

use std::fmt::Write;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::kind::Kind;
use super::submit::RequestArgs;
use crate::analysis::result::{
    BranchesPlan, CampaignPlan, Estimate, Machine, ModalAnalysisPlan, PlannedEffect, ReductionState,
    RunUpPlan, SweepPlan,
};
use crate::cli::client::{Client, ServerArgs};
use crate::cli::size::size;
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;
use crate::impeller::GenerationPlan;

/// Request to plan.
#[derive(Debug, Args)]
pub(in crate::cli) struct PlanArgs {
    #[command(flatten)]
    request: RequestArgs,
    /// Kind of the job that would be computed
    #[arg(long, default_value = "sweep", value_parser =
        PossibleValuesParser::new(["sweep", "modal-analysis", "branches", "run-up", "campaign", "model-generation"]).try_map(|kind| Kind::from_str(&kind, false)))]
    kind: Kind,
    /// Print the plan as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for PlanArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let body = self.request.body(client, self.kind).await?;
        let path = format!("{}/plan", self.kind.route());
        if self.json {
            return print_json(&client.post(&path, &body).await?);
        }
        let words = match self.kind {
            Kind::ModalAnalysis => modal_analysis(&client.post(&path, &body).await?),
            Kind::Branches => branches(&client.post(&path, &body).await?),
            Kind::RunUp => run_ups(&client.post(&path, &body).await?),
            Kind::Campaign => campaign(&client.post(&path, &body).await?),
            Kind::ModelGeneration => generation(&client.post(&path, &body).await?),
            _ => sweep(&client.post(&path, &body).await?),
        };
        print(words.trim_end())
    }
}

fn sweep(plan: &SweepPlan) -> String {
    let mut words = effects(&plan.effects);
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(words, "speeds      {}, {} side by side", plan.speeds, plan.workers);
    times_of(&mut words, plan.machine.as_ref());
    reduction(&mut words, plan.reduction, plan.reduced_unknowns_at_most);
    if let Some(estimate) = &plan.estimate {
        let all = plan.settings.integration.takes_all();
        let (soon, late) = if all { ("", "") } else { (" and motions repeat soon", " and none repeats") };
        cost(&mut words, estimate, [soon, late]);
        let most = if all { "" } else { "at most " };
        let _ = writeln!(words, "steps       {most}{:.3} million", estimate.steps as f64 / 1e6);
    }
    for point in &plan.points {
        if let Some(message) = &point.message {
            let _ = writeln!(words, "not         {:.2} rad/s: {message}", point.speed_rad_s);
        }
    }
    for sensor in &plan.placed_sensors {
        let _ = writeln!(words, "sensor {:<4} node {} at {:?}", sensor.sensor, sensor.node, sensor.position);
    }
    warnings(words, &plan.warnings)
}

fn branches(plan: &BranchesPlan) -> String {
    let mut words = effects(&plan.effects);
    let _ = writeln!(
        words,
        "points      at least {}, at most {} and those of doubled branches",
        plan.points_at_least, plan.points_at_most
    );
    times_of(&mut words, plan.machine.as_ref());
    reduction(&mut words, plan.reduction, plan.reduced_unknowns_at_most);
    if let Some(estimate) = &plan.estimate {
        cost(&mut words, estimate, ["", "; both for the fewest points"]);
    }
    if let Some(message) = plan.point.as_ref().and_then(|point| point.message.as_ref()) {
        let _ = writeln!(words, "not         {message}");
    }
    warnings(words, &plan.warnings)
}

fn run_ups(plan: &RunUpPlan) -> String {
    let mut words = effects(&plan.effects);
    for run in &plan.runs {
        let rate = run.rate_rad_s2.map_or_else(String::new, |rate| format!("{rate:.4} rad/s²: "));
        let _ = writeln!(
            words,
            "run         {rate}{:.4} s, {:.1} revolutions in {} pieces of one speed",
            run.duration_s, run.revolutions, run.segments
        );
        if let Some(message) = &run.message {
            let _ = writeln!(words, "not         {message}");
        }
    }
    times_of(&mut words, plan.machine.as_ref());
    reduction(&mut words, plan.reduction, plan.reduced_unknowns_at_most);
    if let Some(estimate) = &plan.estimate {
        cost(&mut words, estimate, ["", ""]);
        let _ = writeln!(words, "steps       {:.3} million", estimate.steps as f64 / 1e6);
    }
    warnings(words, &plan.warnings)
}

fn campaign(plan: &CampaignPlan) -> String {
    let mut words = effects(&plan.scene.effects);
    let more = match plan.designs_at_most - plan.designs {
        0 => String::new(),
        _ => format!(", at most {}", plan.designs_at_most),
    };
    let _ = writeln!(
        words,
        "designs     {}{more}, {} speeds each{}: {} simulations",
        plan.designs,
        plan.scene.speeds,
        if plan.compared.is_some() { " with two models" } else { "" },
        plan.simulations
    );
    times_of(&mut words, plan.scene.machine.as_ref());
    let scenes = || std::iter::once(&plan.scene).chain(&plan.compared);
    for scene in scenes() {
        reduction(&mut words, scene.reduction, scene.reduced_unknowns_at_most);
    }
    if let Some(estimate) = &plan.estimate {
        cost(&mut words, estimate, ["", ""]);
        let _ = writeln!(words, "steps       {:.3} million", estimate.steps as f64 / 1e6);
    }
    let told: Vec<String> = scenes().flat_map(|scene| scene.warnings.iter().cloned()).collect();
    warnings(words, &told)
}

fn times_of(words: &mut String, machine: Option<&Machine>) {
    if let Some(Machine { name, processor, processors, .. }) = machine {
        let _ = writeln!(words, "times of    {name}: {processors} processors, {processor}");
    }
}

/// Adds time and memory to the plan; `[least, most]` say what else the bounds of the time belong to.
fn cost(words: &mut String, estimate: &Estimate, [least, most]: [&str; 2]) {
    let (free, contact) = (time(estimate.wall_time_s.free), time(estimate.wall_time_s.contact));
    let _ = writeln!(
        words,
        "time        {free} if nothing touches{least}, {contact} if something always does{most}"
    );
    let _ = writeln!(words, "memory      {}", size(estimate.memory_bytes));
}

fn modal_analysis(plan: &ModalAnalysisPlan) -> String {
    let mut words = effects(&plan.effects);
    let _ = writeln!(words, "speeds      {}, {} nodal diameters each", plan.speeds, plan.nodal_diameters);
    reduction(&mut words, plan.reduction, plan.reduced_unknowns_at_most);
    if let Some(seconds) = plan.computing_time_s {
        let _ = writeln!(words, "time        {}", time(seconds));
    }
    warnings(words, &plan.warnings)
}

fn generation(plan: &GenerationPlan) -> String {
    format!("nodes       {}\nunknowns    {}\nmemory      {}", plan.nodes, plan.dofs, size(plan.memory_bytes))
}

fn effects(effects: &[PlannedEffect]) -> String {
    let mut words = String::new();
    for effect in effects.iter().filter(|effect| effect.on) {
        let adds = effect.adds.as_deref().map(|adds| format!(": {adds}")).unwrap_or_default();
        let _ = writeln!(words, "on          {}{adds}", effect.name);
    }
    let off: Vec<&str> =
        effects.iter().filter(|effect| !effect.on).map(|effect| effect.name.as_str()).collect();
    let _ =
        writeln!(words, "off         {}", if off.is_empty() { "none".to_owned() } else { off.join(", ") });
    words
}

fn reduction(words: &mut String, state: ReductionState, unknowns: u64) {
    let _ = match state {
        ReductionState::Stored => writeln!(words, "reduction   there is one, of {unknowns} unknowns"),
        ReductionState::ToBeComputed => writeln!(
            words,
            "reduction   to be computed first, at most {unknowns} unknowns; what the rest takes can be told afterwards"
        ),
    };
}

fn warnings(mut words: String, warnings: &[String]) -> String {
    for warning in warnings {
        let _ = writeln!(words, "warning     {warning}");
    }
    words
}

/// Time in the unit that people would use.
fn time(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 99.5 => format!("{seconds:.0} s"),
        seconds if seconds < 99.5 * 60.0 => format!("{:.0} min", seconds / 60.0),
        seconds => format!("{:.0} h", seconds / 3600.0),
    }
}
