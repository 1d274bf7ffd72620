//! `rubmap plan`: prints what a request would do and cost.

use std::fmt::Write;

use clap::Args;
use serde_json::{Value, from_value};

use super::kind::kind;
use super::submit::RequestArgs;
use crate::analysis::kinds::branches::BRANCHES;
use crate::analysis::kinds::campaign::CAMPAIGN;
use crate::analysis::kinds::case_study::CASE_STUDY;
use crate::analysis::kinds::modal_analysis::MODAL_ANALYSIS;
use crate::analysis::kinds::run_up::RUN_UP;
use crate::analysis::kinds::study::STUDY;
use crate::analysis::kinds::sweep::SWEEP;
use crate::analysis::result::{
    BranchesPlan, CampaignPlan, Estimate, Machine, ModalAnalysisPlan, PlannedEffect, ReductionState,
    RunUpPlan, StudyPlan, SweepPlan,
};
use crate::cli::client::{Client, ServerArgs};
use crate::cli::size::size;
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;
use crate::duration::in_words;
use crate::impeller::GenerationPlan;
use crate::kinds::JobKind;
use crate::kinds::generation::MODEL_GENERATION;

/// Request to plan.
#[derive(Debug, Args)]
pub(in crate::cli) struct PlanArgs {
    #[command(flatten)]
    request: RequestArgs,
    /// Kind of the job that would be computed
    #[arg(long, default_value = "sweep", value_parser = kind())]
    kind: JobKind,
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
        let plan: Value = client.post(&format!("{}/plan", self.kind.route), &body).await?;
        match IN_WORDS.iter().find(|(name, _)| *name == self.kind.name) {
            Some((_, words)) if !self.json => print(words(plan)?.trim_end()),
            _ => print_json(&plan),
        }
    }
}

/// Plan of one kind of job in words.
type InWords = fn(Value) -> serde_json::Result<String>;

/// Kinds of jobs whose plans are printed in words; those of others are printed as JSON.
static IN_WORDS: [(&str, InWords); 8] = [
    (SWEEP.name, |plan| from_value(plan).map(|plan| sweep(&plan))),
    (CASE_STUDY.name, |plan| from_value(plan).map(|plan| sweep(&plan))),
    (MODAL_ANALYSIS.name, |plan| from_value(plan).map(|plan| modal_analysis(&plan))),
    (BRANCHES.name, |plan| from_value(plan).map(|plan| branches(&plan))),
    (RUN_UP.name, |plan| from_value(plan).map(|plan| run_ups(&plan))),
    (CAMPAIGN.name, |plan| from_value(plan).map(|plan| campaign(&plan))),
    (STUDY.name, |plan| from_value(plan).map(|plan| study(&plan))),
    (MODEL_GENERATION.name, |plan| from_value(plan).map(|plan| generation(&plan))),
];

fn sweep(plan: &SweepPlan) -> String {
    let mut words = effects(&plan.effects);
    // Writing to a string cannot fail, here and below.
    let more = match plan.added_speeds_at_most {
        Some(most) => format!(", at most {most} more about peaks (`refine`)"),
        None => String::new(),
    };
    let _ = writeln!(words, "speeds      {}{more}, {} side by side", plan.speeds, plan.workers);
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
    if plan.validity_speeds_at_most > 0 {
        let _ = writeln!(
            words,
            "afterwards  validity of linear theory measured where it is in doubt: at most {} speeds simulated again",
            plan.validity_speeds_at_most
        );
    }
    let inside = plan.points.iter().filter_map(|point| point.interference).reduce(f64::max);
    if let Some(inside) = inside {
        let _ = writeln!(
            words,
            "casing      reaches up to {inside:.3} past the tips at rest, in the model's unit of length"
        );
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
            "run         {rate}{:.4} s, {:.1} revolutions in {} segments of one speed",
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
        let _ = writeln!(words, "measured on {name}: {processors} processors, {processor}");
    }
}

/// Adds time and memory to the plan; `[least, most]` say what else the bounds of the time belong to.
fn cost(words: &mut String, estimate: &Estimate, [least, most]: [&str; 2]) {
    let (free, contact) = (in_words(estimate.wall_time_s.free), in_words(estimate.wall_time_s.contact));
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
        let _ = writeln!(words, "time        {}", in_words(seconds));
    }
    if let Some(seconds) = plan.backbones_time_s {
        let _ = writeln!(words, "backbones   {}", in_words(seconds));
    }
    warnings(words, &plan.warnings)
}

fn study(plan: &StudyPlan) -> String {
    let mut words = effects(&plan.effects);
    let _ = writeln!(words, "runs        {} at {} speeds", plan.simulations, plan.speeds);
    let _ = writeln!(words, "steps       {:.3} million", plan.steps as f64 / 1e6);
    let modes: Vec<String> = plan.reductions.iter().map(ToString::to_string).collect();
    let _ = writeln!(words, "reductions  of {} modes per speed", modes.join(", "));
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
        ReductionState::Stored => writeln!(words, "reduction   stored, {unknowns} unknowns"),
        ReductionState::ToBeComputed => writeln!(
            words,
            "reduction   to be computed first, at most {unknowns} unknowns; the time of the rest is known after that"
        ),
    };
}

fn warnings(mut words: String, warnings: &[String]) -> String {
    for warning in warnings {
        let _ = writeln!(words, "warning     {warning}");
    }
    words
}
