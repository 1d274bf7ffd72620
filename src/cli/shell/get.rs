//! `rubmap get`: downloads results, in all their forms.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::find;
use crate::cli::client::{Client, ClientError, ServerArgs, Target};
use crate::cli::size::size;
use crate::cli::stdout::print;
use crate::cli::verb::Verb;
use crate::cli::verdict;

/// Results of models; all others are of jobs.
const OF_MODELS: [&str; 3] = ["mesh", "modes", "section"];

/// Result of a job that is drawn from its scene and the section of its model.
const CASING: &str = "casing";

/// Forms of files whose names end with them.
const FORMS: [&str; 8] = ["json", "csv", "npz", "svg", "png", "vtu", "vtp", "pvd"];

/// Results that come in one form, and how the names of their files end.
const OF_ONE_FORM: [(&str, &str); 2] = [("report", "html"), ("archive", "zip")];

/// Result to download, and where it goes.
#[derive(Debug, Args)]
pub(in crate::cli) struct GetArgs {
    /// Job, or model for its mesh, modes and section: an id, the beginning of it, or a name
    #[arg(value_name = "JOB")]
    whose: String,
    /// Result, as its path ends: verdict, level, interaction-map, critical-speeds, critical-speeds/wheel, spectra/20, campbell, interference, backbones, forces, stress,
    /// histories, fields, wear/0, work-precision, casing (around the circumference), report, archive; of a model mesh, modes, section
    #[arg(value_parser = result)]
    result: String,
    /// Parameters of the result, such as sensor=1 or units=rpm; all are in openapi.yaml
    #[arg(value_name = "NAME=VALUE", value_parser = parameter)]
    parameters: Vec<(String, String)>,
    /// Form of the result: json, csv, npz, svg, png …; of a verdict also text, a table to read [default: the end of the file's name, or else the first form that the result has]
    #[arg(long, short)]
    format: Option<String>,
    /// File to write, which is there when it is whole and not before [default: the output]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for GetArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let target = match &self.out {
            Some(file) if file != Path::new("-") => Target::File(file.clone()),
            _ => Target::Stdout,
        };
        let mut query = self.parameters.clone();
        query.extend(self.form(&target)?.map(|form| ("format".to_owned(), form)));
        let of_model = OF_MODELS.contains(&self.result.as_str());
        if self.result == "verdict" && self.format.as_deref() == Some("text") {
            return self.verdict(client, &target).await;
        }
        let mut result = self.result.as_str();
        let path = if of_model {
            format!("/v1/models/{}", find::model(client, &self.whose).await?)
        } else {
            let id = find::job(client, &self.whose).await?;
            if result == CASING {
                // Drawn before the contact line of the model.
                result = "section";
                query.extend(
                    [("view", "around"), ("sweep", &id)]
                        .map(|(name, value)| (name.to_owned(), value.to_owned())),
                );
                client.job(&id).await?.link("model")?.to_owned()
            } else {
                format!("/v1/jobs/{id}")
            }
        };
        let got = client.get_to(&format!("{path}/{result}"), &query, &target).await;
        let copied = match got {
            Err(error) if !of_model && error.downcast_ref().is_some_and(ClientError::is_no_route) => {
                return Err(error).context(self.known(client, &path).await?);
            }
            got => got?,
        };
        if let Target::File(file) = &target {
            client.terminal.say(&format!("{}: {}", file.display(), size(copied.bytes)));
        }
        if copied.lines == 1 && query.iter().any(|(name, form)| (&**name, &**form) == ("format", "csv")) {
            client.terminal.say(&format!("the table has its header only: {}", self.why_empty()));
        }
        Ok(())
    }
}

impl GetArgs {
    /// Form that is asked for: by `--format`, or by the end of the file's name.
    ///
    /// # Errors
    /// File whose name ends like those of no form.
    fn form(&self, target: &Target) -> anyhow::Result<Option<String>> {
        let Target::File(file) = target else { return Ok(self.format.clone()) };
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending {
            _ if self.format.is_some() => Ok(self.format.clone()),
            _ if self.parameters.iter().any(|(name, _)| name == "format") => Ok(None),
            None => Ok(None),
            Some(ending) if OF_ONE_FORM.contains(&(&self.result, &ending)) => Ok(None),
            Some(ending) if FORMS.contains(&ending.as_str()) => Ok(Some(ending)),
            Some(ending) => {
                let (file, result) = (file.display(), &self.result);
                match OF_ONE_FORM.iter().find(|(of, _)| of == result) {
                    Some((_, form)) => {
                        bail!("{file}: {result} comes as {form}: let the name end with .{form}")
                    }
                    None => bail!(
                        "{file}: no result comes as {ending}; let the name end with .{}, or name the form with --format",
                        FORMS.join(", .")
                    ),
                }
            }
        }
    }

    /// Reason why the table of the result has no line.
    fn why_empty(&self) -> &'static str {
        match self.result.as_str() {
            "critical-speeds" => {
                "no response of this sensor peaks within the range of speeds; critical-speeds/wheel looks at all tips, sensor=1 at another sensor"
            }
            "critical-speeds/wheel" | "verdict" => {
                "no response of the wheel peaks within the range of speeds"
            }
            _ => "nothing of this is known yet, or the job found none",
        }
    }

    /// Prints a verdict as text.
    async fn verdict(&self, client: &Client, target: &Target) -> anyhow::Result<()> {
        if let Target::File(file) = target {
            bail!("a verdict as text is printed: leave -o away, or send the output to {}", file.display());
        }
        let id = find::job(client, &self.whose).await?;
        print(&verdict::read(client, &id).await?.to_string())
    }

    /// List of the results that a job or model has, for the message about one that does not exist.
    async fn known(&self, client: &Client, path: &str) -> anyhow::Result<String> {
        let job = client.job(path.trim_start_matches("/v1/jobs/")).await?;
        Ok(format!("there is no result {}; the job has {}", self.result, job.results().join(", ")))
    }
}

/// Reads the path of a result; refuses one that leads elsewhere.
fn result(text: &str) -> Result<String, String> {
    let is_name = |part: &str| {
        !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-')
    };
    if text.split('/').all(is_name) {
        Ok(text.to_owned())
    } else {
        Err("a result is called like interaction-map or spectra/20".to_owned())
    }
}

/// Reads a parameter and its value.
fn parameter(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("a parameter is like sensor=1")?;
    Ok((name.to_owned(), value.to_owned()))
}
