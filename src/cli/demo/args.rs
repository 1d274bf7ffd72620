//! Arguments of the demo.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;

use crate::analysis::request::AutoOr;

/// Fewest and most revolutions of a run: two of the fewest make the spectra.
const REVOLUTIONS: RangeInclusive<u32> = 5..=10_000;

/// Input of the demo, and where it leaves its results.
#[derive(Debug, Args)]
pub(in crate::cli) struct DemoArgs {
    /// Folder for package, results and drawings; made if missing. A second run writes its results over the first's
    /// and reuses the model and its reduction, which stay in the folder `data` in it.
    #[arg(long, default_value = "./rubmap-demo")]
    pub(super) out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) workers: Option<u16>,
    /// Model package of your own in place of the generated impeller: speeds and a casing are chosen from the package, printed,
    /// and left in the folder as sweep-request.json
    #[arg(long)]
    pub(super) package: Option<PathBuf>,
    /// JSON file with the body of POST /v1/sweeps for the package, whose `model` may be left out, such as an edited sweep-request.json
    #[arg(long, requires = "package", conflicts_with_all = ["speeds", "revolutions"])]
    pub(super) request: Option<PathBuf>,
    /// Speeds of the sweep, evenly spaced from 12,000 to 28,000 rpm, or over the range chosen for a package
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub(super) speeds: u32,
    /// Revolutions simulated at each speed, of which the last two fifths make the spectra; or "auto": until the motion repeats, and at
    /// most 100
    #[arg(long, default_value = "auto", value_parser = revolutions)]
    pub(super) revolutions: AutoOr,
    /// Show what accuracy costs in time, too: the convergence study that `rubmap study` makes
    #[arg(long, conflicts_with = "package")]
    pub(super) full: bool,
}

/// Reads the revolutions of a run, or "auto": that it ends by itself.
///
/// # Errors
/// A message for a text that is neither.
fn revolutions(text: &str) -> Result<AutoOr, String> {
    match text.parse() {
        _ if text == "auto" => Ok(AutoOr::Auto),
        Ok(revolutions) if REVOLUTIONS.contains(&revolutions) => Ok(AutoOr::Fixed(revolutions)),
        _ => {
            let (least, most) = (REVOLUTIONS.start(), REVOLUTIONS.end());
            Err(format!("neither \"auto\" nor a number of revolutions between {least} and {most}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn revolutions_are_a_number_or_auto() {
        let known = [("auto", AutoOr::Auto), ("5", AutoOr::Fixed(5)), ("10000", AutoOr::Fixed(10_000))];
        for (text, expected) in known {
            assert_eq!(revolutions(text), Ok(expected));
        }
        for text in ["4", "10001", "-5", "", "Auto", "5.0", "99999999999"] {
            assert!(revolutions(text).is_err(), "{text}");
        }
    }
}
