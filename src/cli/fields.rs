//! `rubmap fields`: writes fields of the whole wheel at a speed, in contact.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};

use super::client::Client;
use super::field_file::{FieldFileArgs, check};
use super::session::{Session, upload};
use super::{progress, request};

/// Run of which a field is written, and which field.
#[derive(Debug, Args)]
pub(crate) struct FieldsArgs {
    /// Model package
    package: PathBuf,
    /// JSON file with the body of POST /v1/case-studies, whose `model` may be left out
    request: PathBuf,
    /// Recorded instant, from 0 [default: that of the largest displacement of a contact node]
    #[arg(long, conflicts_with = "engine_order")]
    instant: Option<u32>,
    /// Write the deflection shape of this engine order over all recorded revolutions
    #[arg(long)]
    engine_order: Option<u32>,
    /// Add displacement and stress of the centrifugal load to those of the vibration at an instant
    #[arg(long = "static", conflicts_with = "engine_order")]
    with_static: bool,
    #[command(flatten)]
    file: FieldFileArgs,
    /// File to write: .vtu, .vtp, .npz, .pvd, .svg or .png
    #[arg(long)]
    out: PathBuf,
}

/// Runs the case study, records the wheel and writes the field.
///
/// # Errors
/// A file that cannot be used, or what the service refuses.
pub(super) fn run(args: &FieldsArgs) -> anyhow::Result<ExitCode> {
    check(&args.out)?;
    let body = recording(request::read(&args.request, "/v1/case-studies")?)?;
    let folder = args.file.folder()?;
    Session::begin(folder.path())?.run(args.file.workers, async |client| play(args, client, body).await)
}

async fn play(args: &FieldsArgs, client: &Client, body: Value) -> anyhow::Result<()> {
    let model = upload(client, &args.package).await?;
    let job = client.post_job("/v1/case-studies", &request::of_model(body, &model.id)?).await?;
    let job = progress::follow(client, &job, "case").await?;
    let which = match (args.instant, args.engine_order) {
        (Some(instant), _) => format!("instant={instant}&"),
        (None, Some(order)) => format!("engine_order={order}&"),
        (None, None) => String::new(),
    };
    let fixed = if args.with_static { "static=include&" } else { "" };
    args.file.save(client, &format!("/v1/jobs/{}/fields?{which}{fixed}", job.id), &args.out).await
}

/// Request with the wheel's state as all that is recorded.
fn recording(mut body: Value) -> anyhow::Result<Value> {
    if body.get("record").is_none() {
        body["record"] = json!({});
    }
    match &mut body["record"] {
        Value::Object(record) => record.insert("quantities".to_owned(), json!(["state"])),
        _ => bail!("`record` of the request is not a JSON object"),
    };
    Ok(body)
}
