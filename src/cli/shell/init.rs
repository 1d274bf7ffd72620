//! `rubmap init`: prints a request to start from.

use clap::Args;

use super::kind::kind;
use crate::analysis::kinds::sweep::SWEEP;
use crate::cli::stdout::print;
use crate::kinds::JobKind;

/// Starter of a sweep, with its options.
const SWEEP_STARTER: &str = include_str!("starters/sweep.yaml");

/// Field that `--model` fills in.
const MODEL: &str = "model";

/// Kind of the request.
#[derive(Debug, Args)]
pub(in crate::cli) struct InitArgs {
    /// Kind of the job that the request asks for
    #[arg(value_parser = kind())]
    kind: JobKind,
}

/// Prints a request to start from, in YAML and without a model.
///
/// # Errors
/// An output that cannot be written.
pub(in crate::cli) fn init(args: &InitArgs) -> anyhow::Result<()> {
    print(starter(args.kind)?.trim_end())
}

fn starter(kind: JobKind) -> anyhow::Result<String> {
    if kind.name == SWEEP.name {
        return Ok(SWEEP_STARTER.to_owned());
    }
    // JSON is YAML; read as YAML it keeps the order of its fields.
    let mut request: yaml_serde::Mapping = yaml_serde::from_str(kind.example)?;
    let of_model = if request.shift_remove(MODEL).is_some() { " --model MODEL" } else { "" };
    let (word, about) = (kind.name.replace('_', "-"), kind.about);
    let fields = yaml_serde::to_string(&request)?;
    Ok(format!(
        "# {about}. All fields: openapi.yaml, POST {route}.\n#   rubmap plan --kind {word} REQUEST{of_model}\n\
         #   rubmap submit --kind {word} REQUEST{of_model} --wait\n{fields}",
        route = kind.route
    ))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn every_kind_has_a_starter_that_it_reads() {
        for kind in crate::kinds::all() {
            let starter = starter(kind).unwrap();
            let mut body: Value = yaml_serde::from_str(&starter).unwrap();
            let example: Value = serde_json::from_str(kind.example).unwrap();
            if example.get(MODEL).is_some() {
                assert!(body.get(MODEL).is_none(), "{starter}");
                body[MODEL] = json!("a");
            }
            if kind.name != SWEEP.name {
                assert_eq!(body.as_object().unwrap().len(), example.as_object().unwrap().len(), "{starter}");
            }
            assert!((kind.read)(&body.to_string()).is_ok(), "{starter}");
        }
    }

    /// Uncomments every option of the starter, which must be a field that a sweep has.
    #[test]
    fn options_of_a_sweep_are_fields() {
        let (mut options, mut text) = (0, "model: a\n".to_owned());
        for line in SWEEP_STARTER.lines() {
            let option = line.trim_start().strip_prefix("# ").filter(|option| {
                let name = option.split(':').next().unwrap_or_default();
                option.trim_start().starts_with("- {")
                    || (option.contains(':')
                        && name.bytes().all(|byte| byte == b'_' || byte.is_ascii_lowercase()))
            });
            options += u32::from(option.is_some());
            let indent = &line[..line.len() - line.trim_start().len()];
            text += &option.map_or_else(|| line.to_owned(), |option| format!("{indent}{option}"));
            text.push('\n');
        }
        assert_eq!(options, 12, "{text}");
        let body: Value = yaml_serde::from_str(&text).unwrap();
        (SWEEP.read)(&body.to_string()).map(drop).unwrap();
    }
}
