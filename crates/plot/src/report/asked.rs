//! Summary of the request, in a few lines.

use maud::{Markup, html};
use rubmap_analysis::request::ModalAnalysisRequest;
use rubmap_analysis::result::InteractionMap;
use serde::Serialize;
use serde_json::Value;

use super::page::facts_table;
use crate::axis::label;
use crate::cells::rpm;

pub(super) fn sweep(map: &InteractionMap) -> Markup {
    let settings = &map.settings;
    let mut facts = vec![("speeds".to_owned(), speeds(&map.speeds_rad_s))];
    if let Ok(Value::Object(scene)) = serde_json::to_value(&settings.scene) {
        facts.extend(scene.into_iter().map(|(effect, value)| (effect.replace('_', " "), plain(&value))));
    }
    facts.push(("modes per speed".to_owned(), words(&settings.modes_per_speed)));
    facts.push(("integration".to_owned(), words(&settings.integration)));
    facts.push(("highest engine order".to_owned(), settings.max_engine_order.to_string()));
    section(facts)
}

pub(super) fn modal_analysis(settings: &ModalAnalysisRequest) -> Markup {
    section(vec![
        ("speeds".to_owned(), words(&settings.speeds)),
        ("modes per speed".to_owned(), words(&settings.modes_per_speed)),
        ("families".to_owned(), settings.families.to_string()),
        ("lobes".to_owned(), settings.lobes.to_string()),
        ("superharmonics".to_owned(), words(&settings.superharmonics)),
        ("Coriolis forces".to_owned(), words(&settings.coriolis)),
    ])
}

/// Speeds of a sweep in revolutions per minute: their number and their ends.
pub(super) fn speeds(all_rad_s: &[f64]) -> String {
    let (slow, fast) = all_rad_s
        .iter()
        .fold((f64::INFINITY, 0f64), |(slow, fast), speed| (slow.min(rpm(*speed)), fast.max(rpm(*speed))));
    match all_rad_s.len() {
        0 => "none".to_owned(),
        1 => format!("1, {} rpm", label(slow, 0)),
        count => format!("{count}, {} to {} rpm", label(slow, 0), label(fast, 0)),
    }
}

fn section(facts: Vec<(String, String)>) -> Markup {
    html! {
        h2 { "What was asked" }
        (facts_table(facts))
    }
}

fn words(value: &impl Serialize) -> String {
    serde_json::to_value(value).map(|value| plain(&value)).unwrap_or_default()
}

/// Number of entries of a list that are shown; all of them are in the settings.
const SHOWN: usize = 8;

/// Words for a value of a request: without quotes and braces.
pub(super) fn plain(value: &Value) -> String {
    let joined = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Null => "–".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::String(text) => text.replace('_', " "),
        Value::Number(number) => number.to_string(),
        Value::Array(list) if list.len() > SHOWN => {
            let first = joined(list.iter().take(SHOWN).map(plain).collect());
            format!("{first} … ({} in all)", list.len())
        }
        Value::Array(list) if list.iter().any(Value::is_object) => {
            list.iter().map(plain).collect::<Vec<_>>().join("; ")
        }
        Value::Array(list) => joined(list.iter().map(plain).collect()),
        Value::Object(fields) if fields.is_empty() => "yes".to_owned(),
        Value::Object(fields) => joined(
            fields
                .iter()
                .map(|(name, value)| {
                    let inner = plain(value);
                    let inner = if value.is_object() { format!("({inner})") } else { inner };
                    format!("{} {inner}", name.replace('_', " "))
                })
                .collect(),
        ),
    }
}
