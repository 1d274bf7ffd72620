//! Work and precision as a table.

use std::fmt::Write;

use crate::request::AutoOr;
use crate::result::{PointStatus, StudyRun, WorkPrecision};

const HEADER: &str = "speed_rad_s,modes_per_speed,scheme,kept_modes,steps_per_revolution,unknowns,status,history_error,\
amplitude_error,amplitude_spread,engine_orders_error,impulse_error,set_up_s,per_revolution_s,time_s,repetitions,spread,pareto\n";

impl WorkPrecision {
    /// All runs as comma-separated values, a line each; what is not there is empty. `pareto` has words separated by spaces.
    pub fn csv(&self) -> String {
        let mut out = HEADER.to_owned();
        for speed in &self.speeds {
            for run in speed.runs.iter().chain([&speed.reference]) {
                line(&mut out, speed.speed_rad_s, run);
            }
        }
        out
    }
}

fn line(out: &mut String, speed_rad_s: f64, run: &StudyRun) {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:e}"));
    let errors = run.errors.as_ref();
    let pareto: Vec<&str> = run.pareto.iter().map(|quantity| quantity.as_str()).collect();
    let kept = match run.setting.kept_modes {
        AutoOr::Auto => "auto".to_owned(),
        AutoOr::Fixed(kept) => kept.to_string(),
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "{speed_rad_s},{},{},{kept},{},{},{},{},{},{},{},{},{:e},{:e},{:e},{},{},{}",
        run.setting.modes_per_speed,
        run.setting.scheme.as_str(),
        run.setting.steps_per_revolution,
        run.unknowns,
        match run.status {
            PointStatus::Completed => "completed",
            PointStatus::Diverged => "diverged",
            PointStatus::Failed => "failed",
        },
        number(errors.and_then(|errors| errors.history)),
        number(errors.map(|errors| errors.amplitude)),
        number(errors.and_then(|errors| errors.amplitude_spread)),
        number(errors.and_then(|errors| errors.engine_orders)),
        number(errors.and_then(|errors| errors.impulse)),
        run.cost.set_up_s,
        run.cost.per_revolution_s,
        run.time_s,
        run.cost.repetitions,
        number(run.cost.spread),
        pareto.join(" "),
    );
}
