//! Results and drawings of a modal analysis and a sweep, in a folder.

use std::path::Path;

use crate::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use crate::cli::client::{Client, Job};
use crate::cli::session::save;
use crate::cli::verdict::ShownVerdict;
use crate::plot::{self, LevelColour, VerticalAxis, Window};

/// Results of a modal analysis and a sweep.
pub(super) struct Results {
    pub(super) map: InteractionMap,
    pub(super) critical: CriticalSpeeds,
    pub(super) verdict: ShownVerdict,
}

/// Downloads results and drawings into the folder.
pub(super) async fn download(
    client: &Client,
    modal_analysis: &Job,
    sweep: &Job,
    out: &Path,
) -> anyhow::Result<Results> {
    let campbell: Campbell =
        client.download(modal_analysis.link("campbell")?, &out.join("campbell.json")).await?;
    let map: InteractionMap =
        client.download(sweep.link("interaction-map")?, &out.join("interaction-map.json")).await?;
    let critical: CriticalSpeeds =
        client.download(sweep.link("critical-speeds")?, &out.join("critical-speeds.json")).await?;
    let verdict = client.download(sweep.link("verdict")?, &out.join("verdict.json")).await?;
    client.save(sweep.link("report")?, &out.join("report.html")).await?;
    client.save(&format!("{}?format=svg", sweep.link("level")?), &out.join("level.svg")).await?;
    let draw = |axis| {
        plot::interaction_map(
            &map,
            Some(&critical),
            Some(&campbell),
            axis,
            Window::default(),
            LevelColour::Plain,
        )
    };
    save(&out.join("interaction-map.svg"), &draw(VerticalAxis::EngineOrder).svg())?;
    save(&out.join("interaction-map-frequency.svg"), &draw(VerticalAxis::Frequency).svg())?;
    save(&out.join("campbell.svg"), &plot::campbell(&campbell).svg())?;
    Ok(Results { map, critical, verdict })
}
