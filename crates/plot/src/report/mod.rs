//! Report of a job as one self-contained page: the request, how far the numbers can be trusted, and the results. For a browser, and for
//! paper (A4).

mod asked;
mod credentials;
mod head;
mod page;
mod stress;
mod summary;
mod tables;
mod verdict;
mod warnings;

use crate::SurfaceView;
use maud::{Markup, html};
use rubmap_analysis::result::{
    Backbones, Campbell, CriticalSpeeds, FieldSurface, ForceMap, InteractionMap, SpeedHistories, Strengths,
    SweepLevel,
};
use serde_json::Value;

use super::{ForceQuantity, HistoryQuantity, LevelColour, VerticalAxis, Window, cells};
use page::{drawing, page};

pub use head::Head;

/// Results of a sweep.
#[derive(Debug, Clone, Copy)]
pub struct Sweep<'a> {
    /// Level of the wheel over speed, with the verdict on the sweep.
    pub level: &'a SweepLevel,
    /// Interaction map at one sensor.
    pub map: &'a InteractionMap,
    /// Critical speeds at every sensor.
    pub critical: &'a [CriticalSpeeds],
    /// Contact over speed; none for a scene without contact.
    pub forces: Option<&'a ForceMap>,
    /// Histories that were recorded.
    pub histories: &'a [SpeedHistories],
    /// Natural frequencies of the same model, if there are any.
    pub campbell: Option<&'a Campbell>,
    /// Strengths of the materials, as far as they are known.
    pub strengths: &'a [Strengths],
    /// Surfaces to be shown, each from this view and in the meridional view.
    pub surfaces: &'a [(FieldSurface, SurfaceView)],
}

/// Renders the report of a sweep, as HTML. All texts of users are escaped.
pub fn sweep(head: &Head, sweep: &Sweep) -> String {
    let Sweep { level, map, critical, forces, histories, campbell, strengths, surfaces } = *sweep;
    let of_sensor = critical.iter().find(|table| table.sensor == map.sensor);
    let body = html! {
        (asked::sweep(map))
        (warnings::section(&warnings::sweep(map, critical)))
        (credentials::sweep(map, critical))
        h2 { "Interaction map" }
        (drawing(&super::interaction_map(map, of_sensor, campbell, VerticalAxis::EngineOrder, Window::default(), LevelColour::Plain)))
        h2 { "Critical speeds" }
        (tables::critical_speeds(level, critical))
        h2 { "Largest responses" }
        (tables::largest_responses(map))
        (stress::section(map, strengths))
        (stress::validity_section(map))
        (stress::pictures(surfaces))
        @if let Some(forces) = forces {
            h2 { "Contact" }
            (drawing(&super::force_map(forces, ForceQuantity::Peak)))
            (drawing(&super::force_map(forces, ForceQuantity::Consumption)))
        }
        @for found in histories {
            h2 { "What happened at " (format!("{:.0}", cells::rpm(found.speed_rad_s))) " rpm" }
            (drawing(&super::speed_histories(found, HistoryQuantity::Displacement, 0)))
            @if found.contact.is_some() {
                (drawing(&super::speed_histories(found, HistoryQuantity::Force, 0)))
            }
        }
        @if let Some(campbell) = campbell {
            h2 { "Natural frequencies" }
            (drawing(&super::campbell(campbell)))
        }
        (settings(serde_json::to_value(&map.settings).unwrap_or_default()))
    };
    page(head, &summary::sheet(head, level, map), &body)
}

/// Renders the report of a modal analysis, as HTML. All texts of users are escaped.
pub fn modal_analysis(head: &Head, campbell: &Campbell, backbones: Option<&Backbones>) -> String {
    let body = html! {
        (asked::modal_analysis(&campbell.settings))
        (warnings::section(&warnings::reduction(&campbell.reduction)))
        (credentials::modal_analysis(campbell))
        h2 { "Natural frequencies" }
        (drawing(&super::campbell(campbell)))
        h2 { "Crossings that the lobes can drive" }
        (tables::driven_crossings(&campbell.driven_crossings))
        @if let Some(found) = backbones.filter(|found| !found.curves.is_empty()) {
            h2 { "Backbone curves" }
            (drawing(&super::backbones(found)))
            (tables::backbones(found))
        }
        (settings(serde_json::to_value(&campbell.settings).unwrap_or_default()))
    };
    page(head, &html! {}, &body)
}

/// Renders all settings of a request; posting them repeats the request.
fn settings(settings: Value) -> Markup {
    html! {
        h2 { "Settings" }
        p { "The whole request with every default filled in, as it can be posted again." }
        pre { (compact(&settings, 0)) }
    }
}

/// Writes JSON over lines of its own for objects, with lists of numbers and words in one line, so that nothing breaks inside a number.
fn compact(value: &Value, depth: usize) -> String {
    let indent = |depth: usize| "  ".repeat(depth);
    match value {
        Value::Object(fields) if !fields.is_empty() => {
            let line = |(name, value): (&String, &Value)| {
                format!("{}{}: {}", indent(depth + 1), Value::from(name.as_str()), compact(value, depth + 1))
            };
            let lines: Vec<String> = fields.iter().map(line).collect();
            format!("{{\n{}\n{}}}", lines.join(",\n"), indent(depth))
        }
        Value::Array(list) => {
            let parts: Vec<String> = list.iter().map(|part| compact(part, depth)).collect();
            format!("[{}]", parts.join(", "))
        }
        value => value.to_string(),
    }
}
