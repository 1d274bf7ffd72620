//! Words about a study in the terminal.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use crate::analysis::request::SchemeChoice;
use crate::analysis::request::auto_or::AutoOr;
use crate::analysis::result::Quantity;
use crate::analysis::result::{SpeedStudy, StudyRun};

pub(super) fn rpm(speed_rad_s: f64) -> f64 {
    speed_rad_s * 60.0 / TAU
}

/// Table of the runs on the Pareto front of the amplitude, in ascending time, and of the reference, with errors and times.
pub(super) fn front(speed: &SpeedStudy) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(
        out,
        "Work and precision at {:.0} rpm: the Pareto front of the steady amplitude, and the reference\n",
        rpm(speed.speed_rad_s)
    );
    out.push_str(
        "modes/    un-                         steps/  ---------------- error, % ----------------    set-up    ms per\n",
    );
    out.push_str(
        "speed  knowns  scheme                    rev    history       amplitude    orders   impulse       s      rev.\n",
    );
    let mut front: Vec<&StudyRun> =
        speed.runs.iter().filter(|run| run.pareto.contains(&Quantity::Amplitude)).collect();
    front.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    for run in front.into_iter().chain([&speed.reference]) {
        let _ = writeln!(
            out,
            "{:>5}  {:>6}  {:<22} {:>6}  {}  {:>8.3}  {:>8.2}",
            run.setting.modes_per_speed,
            run.unknowns,
            scheme(run.setting.scheme, run.setting.kept_modes),
            run.setting.steps_per_revolution,
            errors(run),
            run.cost.set_up_s,
            1e3 * run.cost.per_revolution_s,
        );
    }
    if speed.runs.iter().all(|run| run.errors.is_none()) {
        let message = speed.runs.iter().find_map(|run| run.message.as_deref());
        let _ = writeln!(out, "\nno run could be compared: {}", message.unwrap_or("see the message below"));
    }
    out
}

fn scheme(scheme: SchemeChoice, kept_modes: AutoOr) -> String {
    match kept_modes {
        AutoOr::Auto => scheme.as_str().to_owned(),
        AutoOr::Fixed(kept) => format!("{} ({kept})", scheme.as_str()),
    }
}

/// Four columns of a run's errors; the amplitude with its standard error where it has one.
fn errors(run: &StudyRun) -> String {
    let Some(errors) = &run.errors else { return format!("{:<46}", "    -") };
    let percent = |quantity| errors.of(quantity).map_or_else(|| "-".to_owned(), percent);
    let spread = errors.amplitude_spread.map(|spread| format!(" ±{}", self::percent(spread)));
    format!(
        "{:>9}  {:>14}  {:>8}  {:>8} ",
        percent(Quantity::History),
        percent(Quantity::Amplitude) + &spread.unwrap_or_default(),
        percent(Quantity::EngineOrders),
        percent(Quantity::Impulse),
    )
}

/// Share in per cent.
fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0".to_owned(),
        percent if percent < 0.01 => format!("{percent:.0e}"),
        percent => format!("{percent:.2}"),
    }
}

/// List of the observed orders of every size and scheme.
pub(super) fn orders(speed: &SpeedStudy) -> String {
    let mut out = "Observed orders in the time step, from the first revolutions\n\n".to_owned();
    let observed: Vec<_> = speed.orders.iter().filter(|order| !order.orders.is_empty()).collect();
    if observed.is_empty() {
        out.push_str("none: an order takes completed runs at three steps per revolution\n");
        return out;
    }
    out.push_str("modes/speed  scheme                  orders, towards fine steps\n");
    for order in observed {
        let orders: Vec<String> = order
            .orders
            .iter()
            .map(|order| order.map_or_else(|| format!("{:>6}", "-"), |order| format!("{order:>6.2}")))
            .collect();
        let _ = writeln!(
            out,
            "{:>11}  {:<22}{}",
            order.modes_per_speed,
            scheme(order.scheme, order.kept_modes),
            orders.concat()
        );
    }
    out
}

/// List of the files that a study left.
pub(super) fn places(out: &Path, speed: &str) -> String {
    let folder = out.display();
    format!(
        "Look at   {folder}/work-precision{speed}-amplitude.svg  error over computing time; also of history, engine-orders, impulse
          {folder}/histories{speed}.svg                 displacement over the first revolutions, per size
Read      {folder}/work-precision.csv, work-precision.json\n"
    )
}
