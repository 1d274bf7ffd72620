//! `rubmap import casing`: a measured casing from a table.

use std::fmt::{self, Write};
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use crate::analysis::result::MeasuredCasing;
use crate::casing_table;
use crate::cli::stdout;

/// Table of a measured casing.
#[derive(Debug, Args)]
pub(in crate::cli) struct CasingArgs {
    /// Table of heights inward of the casing of revolution: angle_deg (or angle_rad) and a column for every place along the chord from 0
    /// to 1 or contact node (node0, node1, …); or angle_deg, chord (or node), height
    table: PathBuf,
    /// JSON file to write [default: the output]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Findings of a kind that are printed one by one, at most.
const MOST_SAID: usize = 10;

/// Reads the table, prints what stands out in it, and writes it as requests take it.
pub(super) fn import(args: &CasingArgs) -> anyhow::Result<()> {
    let name = args.table.display();
    let text = std::fs::read(&args.table).with_context(|| format!("cannot read {name}"))?;
    let found = casing_table::read(&text).map_err(|errors| {
        let said: Vec<_> = errors.iter().map(|error| format!("{name}: {error}")).collect();
        anyhow::anyhow!(said.join("\n"))
    })?;
    eprint!("{}", surveyed(&found)?);
    let json = serde_json::to_string(&found.measured)?;
    match &args.out {
        Some(path) => std::fs::write(path, json).with_context(|| format!("cannot write {}", path.display())),
        None => stdout::print(&json),
    }
}

/// Description of a table of a measured casing.
fn surveyed(found: &MeasuredCasing) -> Result<String, fmt::Error> {
    let MeasuredCasing { measured, survey, filled, filled_count } = found;
    let place = |line: u32| match &measured.chord {
        Some(chord) => format!("{} of the chord", chord[line as usize]),
        None => format!("contact node {line}"),
    };
    let mut text = String::new();
    writeln!(
        text,
        "{} angles, {} lines; {}",
        measured.angles_rad.len(),
        measured.heights.len(),
        survey.interpolation
    )?;
    let heights = || measured.heights.iter().flatten();
    let (low, high) =
        heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &h| (low.min(h), high.max(h)));
    writeln!(text, "heights from {low} to {high}")?;
    for outlier in survey.outliers.iter().take(MOST_SAID) {
        let (angle, expected) = (outlier.angle_rad.to_degrees(), outlier.expected);
        let place = place(outlier.line);
        writeln!(
            text,
            "stands alone: {} at {angle:.3}°, {place}; its neighbours expect {expected:.6}",
            outlier.height
        )?;
    }
    for gap in survey.gaps.iter().take(MOST_SAID) {
        writeln!(
            text,
            "no points from {:.3}° to {:.3}°",
            gap.from_rad.to_degrees(),
            gap.to_rad.to_degrees()
        )?;
    }
    for height in filled.iter().take(MOST_SAID) {
        let angle = height.angle_rad.to_degrees();
        writeln!(
            text,
            "missing at {angle:.3}°, {}: the curve says {:.6}",
            place(height.line),
            height.height
        )?;
    }
    let counts = [survey.outlier_count, survey.gap_count, *filled_count];
    if counts.iter().any(|&count| count as usize > MOST_SAID) {
        writeln!(text, "in all: {} stand alone, {} gaps, {} missing", counts[0], counts[1], counts[2])?;
    }
    if let Some(over) = &survey.overshoot {
        let angle = over.angle_rad.to_degrees();
        writeln!(
            text,
            "the curve goes {:.6} beyond all points at {angle:.3}°, {}",
            over.by,
            place(over.line)
        )?;
    }
    Ok(text)
}
