//! Verdicts of sweeps on a terminal.

use std::f64::consts::TAU;
use std::fmt;

use clap::ValueEnum;
use serde::Deserialize;

use super::client::Client;
use super::ending::Gated;
use crate::analysis::result::{JudgedSpeed, JudgedValue, OpenQuestion, Position, VerdictWord};
use crate::dynamics::sector::Units;

/// Verdict from which on a command fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FailOn {
    /// A limit is passed
    Act,
    /// A limit is passed, or something is open behind which one may hide
    Undecided,
    /// Any verdict but clear
    Watch,
}

impl FailOn {
    /// Fails if the verdict on a job is as bad as this.
    ///
    /// # Errors
    /// [`Gated`].
    pub(super) fn check(self, id: &str, verdict: &ShownVerdict) -> Result<(), Gated> {
        let least = match self {
            Self::Act => VerdictWord::Act,
            Self::Undecided => VerdictWord::Undecided,
            Self::Watch => VerdictWord::Watch,
        };
        if verdict.verdict < least {
            return Ok(());
        }
        Err(Gated { id: id.to_owned(), verdict: verdict.verdict })
    }
}

/// Verdict of a service, as far as it is shown.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct ShownVerdict {
    /// Verdict in one word.
    pub(super) verdict: VerdictWord,
    /// Verdict in words.
    pub(super) sentence: String,
    worst: Vec<JudgedSpeed>,
    would_decide: Vec<OpenQuestion>,
    units: Units,
}

/// Reads the verdict on a sweep.
///
/// # Errors
/// Errors of the client: a service that cannot be reached, a job of another kind.
pub(super) async fn read(client: &Client, id: &str) -> anyhow::Result<ShownVerdict> {
    client.get(&format!("/v1/jobs/{id}/verdict")).await
}

impl fmt::Display for ShownVerdict {
    /// Sentence, table of the worst speeds, and what would decide an open verdict.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.sentence)?;
        let mut lines: Vec<[String; 4]> = self.worst.iter().flat_map(|speed| self.lines(speed)).collect();
        if !lines.is_empty() {
            lines.insert(0, ["worst (rpm)", "where", "value", "against its limit"].map(str::to_owned));
        }
        for [speed, place, value, limit] in lines {
            write!(f, "\n{}", format!("{speed:>12}  {place:<28}  {value:<56}  {limit}").trim_end())?;
        }
        for open in self.would_decide.iter().filter(|_| self.verdict == VerdictWord::Undecided) {
            write!(f, "\nto decide: {} ({})", open.remedy, open.finding)?;
        }
        Ok(())
    }
}

impl ShownVerdict {
    /// Lines of a speed in the table: one per limit.
    fn lines(&self, speed: &JudgedSpeed) -> Vec<[String; 4]> {
        let rpm = format!("{:.0}", speed.speed_rad_s * 60.0 / TAU);
        let near = speed.ranges.iter().find(|place| place.position != Position::Outside);
        let place = match near.or(speed.ranges.first()) {
            None => String::new(),
            Some(place) => {
                let position = match place.position {
                    Position::Inside => "in",
                    Position::WithinSeparation => "near",
                    Position::Outside => "outside",
                };
                format!("{position} {}, {:+.1} %", place.range, place.distance_percent)
            }
        };
        if speed.limits.is_empty() {
            let motion = |tip: f64| format!("tip motion {} {}", number(tip), self.units.length);
            let value = speed.tip.map_or_else(String::new, |tip| motion(tip.peak_motion()));
            return vec![[rpm, place, value, "no limit".to_owned()]];
        }
        let line = |(nth, judged): (usize, &JudgedValue)| {
            let (rpm, place) = if nth == 0 { (rpm.clone(), place.clone()) } else { Default::default() };
            let (words, unit) = (judged.limit.words(), judged.limit.unit(&self.units));
            let value = format!("{words} {} of {} {unit}", judged.known_words(), number(judged.allowed));
            [rpm, place, value.trim_end().to_owned(), judged.standing_words()]
        };
        speed.limits.iter().enumerate().map(line).collect()
    }
}

/// Number with three significant digits.
pub(super) fn number(value: f64) -> String {
    format!("{value:.2e}").parse::<f64>().unwrap_or(value).to_string()
}
