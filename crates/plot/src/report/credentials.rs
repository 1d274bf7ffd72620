//! Credentials of a report: how far its numbers can be trusted.

use std::collections::BTreeSet;

use maud::{Markup, html};
use rubmap_analysis::result::{
    Campbell, CriticalSpeeds, InteractionMap, Point, PointStatus, ReductionReport, Verdict,
};

use super::page::facts_table;
use super::tables::verdict as verdict_words;

pub(super) fn sweep(map: &InteractionMap, critical: &[CriticalSpeeds]) -> Markup {
    let completed: Vec<&Point> =
        map.points.iter().filter(|point| point.status == PointStatus::Completed).collect();
    let largest = |value: fn(&Point) -> Option<f64>| {
        completed.iter().filter_map(|point| value(point)).fold(0.0, f64::max)
    };
    let touching: Vec<f64> =
        completed.iter().map(|point| point.contact_share).filter(|share| *share > 0.0).collect();
    let contact = match (touching.iter().copied().reduce(f64::min), touching.iter().copied().reduce(f64::max))
    {
        (Some(least), Some(most)) => format!(
            "at {} speeds, in {:.1} to {:.1} % of the steps; penetration left at most {:.0e} {}",
            touching.len(),
            100.0 * least,
            100.0 * most,
            largest(|point| point.largest_penetration),
            map.units.length
        ),
        _ => "at no speed".to_owned(),
    };
    let schemes: BTreeSet<String> = completed
        .iter()
        .filter_map(|point| point.scheme.as_ref())
        .map(|scheme| crate::scheme::words(scheme.name))
        .collect();
    let steps = completed.iter().map(|point| point.steps_per_revolution);
    let mut facts = vec![
        ("speeds computed", format!("{} of {}", completed.len(), map.speeds_rad_s.len())),
        ("steady states", verdicts(&completed)),
        ("contact", contact),
        (
            "energy identity",
            format!("kept to {:.0e} of the largest energy", largest(|point| point.energy_residual)),
        ),
    ];
    let of_bending = |point: &Point| point.energy.as_ref()?.bending_residual;
    if completed.iter().any(|point| of_bending(point).is_some()) {
        let residual = format!("differ by {:.0e} of the largest energy", largest(of_bending));
        facts.push(("work and energy of stiffening blades", residual));
    }
    if let (Some(least), Some(most)) = (steps.clone().min(), steps.max()) {
        let schemes = schemes.into_iter().collect::<Vec<_>>().join(", ");
        facts.push(("time stepping", format!("{schemes}; {least} to {most} steps a revolution")));
    }
    facts.push(match map.errors.as_ref() {
        Some(errors) => ("estimated error", errors.message.clone()),
        None => ("estimated error", "not estimated: there were no control runs".to_owned()),
    });
    if let Some(table) = critical.first() {
        facts.extend(reduction(&table.reduction));
    }
    section(facts)
}

pub(super) fn modal_analysis(campbell: &Campbell) -> Markup {
    section(reduction(&campbell.reduction))
}

fn section(facts: Vec<(&'static str, String)>) -> Markup {
    html! {
        h2 { "Credentials" }
        (facts_table(facts))
    }
}

fn reduction(report: &ReductionReport) -> Vec<(&'static str, String)> {
    let differences = report.full_model.iter().filter_map(|line| line.largest.as_ref());
    let largest = differences.fold(0.0, |largest: f64, difference| largest.max(difference.relative));
    vec![
        (
            "reduction",
            format!(
                "{} unknowns, {} modes per speed; {} of {} modes proven to be the lowest",
                report.wheel_unknowns, report.modes_per_speed, report.counted_modes, report.modes
            ),
        ),
        (
            "reduced against full sector",
            format!("the ten lowest frequencies of any nodal diameter differ by at most {largest:.1e}"),
        ),
        ("K(Ω)", report.stiffening.message.clone()),
    ]
}

fn verdicts(points: &[&Point]) -> String {
    let all = [Verdict::Periodic, Verdict::Subharmonic, Verdict::Aperiodic, Verdict::NotSettled];
    let count = |verdict: Verdict| {
        let found = points.iter().filter_map(|point| point.settling.as_ref());
        found.filter(|settling| settling.verdict == verdict).count()
    };
    let counts = all.into_iter().map(|verdict| (count(verdict), verdict_words(verdict)));
    let counts = counts.filter(|(count, _)| *count > 0).map(|(count, words)| format!("{count} {words}"));
    counts.collect::<Vec<_>>().join(", ")
}
