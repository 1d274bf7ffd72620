//! Frame of a report: one file that contains its style.

use crate::drawing::Drawing;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::head::Head;

/// Style sheet: narrow enough for A4 with its margins; drawings shrink to the width of the paper.
const STYLE: &str = "
@page { size: A4; margin: 15mm }
body { font: 14px/1.45 Helvetica, Arial, 'DejaVu Sans', sans-serif; color: #1c1c1c; max-width: 1180px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.6em; margin-bottom: .2em }
h2 { font-size: 1.2em; margin: 1.6em 0 .5em; border-bottom: 1px solid #ccc; break-after: avoid }
table { border-collapse: collapse; margin: .5em 0; width: 100% }
th, td { text-align: left; padding: .2em .6em .2em 0; border-bottom: 1px solid #e4e4e4; vertical-align: top }
table.numbers td, table.numbers th { text-align: right; font-variant-numeric: tabular-nums }
table.numbers td { white-space: nowrap }
table.facts th { width: 16em; font-weight: normal; color: #555 }
tr, figure { break-inside: avoid } h2 + p { break-after: avoid }
figure { margin: .5em 0 } figure svg { max-width: 100%; height: auto }
.warnings { border-left: 4px solid #b01f20; padding-left: 1em } .small { color: #555; font-size: .9em }
p.verdict { border-left: 6px solid; padding: .4em .8em; background: #f4f4f4; font-size: 1.1em }
p.act { border-color: #b01f20 } p.undecided { border-color: #6b6b6b } p.watch { border-color: #c07800 } p.clear { border-color: #17693c }
pre { white-space: pre-wrap; overflow-wrap: break-word; font-size: .8em } .notes { white-space: pre-wrap }
.sheet table { margin: .3em 0 } .sheet th, .sheet td { padding: .1em .6em .1em 0 } .sheet table.facts th { width: 11em }
table.worst td, table.worst th { white-space: nowrap } table.worst td.words { white-space: normal; min-width: 14em } table.worst td.standing { white-space: normal }
@media print {
  body { font-size: 9.5pt; margin: 0; padding: 0; max-width: none } pre { font-size: 7pt } table.numbers { font-size: 7pt }
  h1 { font-size: 13pt; margin: 0 } .sheet { font-size: 8pt; line-height: 1.3; break-after: page } .sheet figure { margin: 0 } .sheet svg { width: 100%; max-height: 100mm }
}
";

/// Renders a page around its `body`; `first` comes before everything but the title.
pub(super) fn page(head: &Head, first: &Markup, body: &Markup) -> String {
    let Head { title, facts, notes } = head;
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                (first)
                @if let Some(notes) = notes { p class="notes" { (notes) } }
                (facts_table(facts.iter().map(|(name, value)| (*name, value.clone()))))
                (body)
            }
        }
    }
    .into_string()
}

/// Renders a table of names and values.
pub(super) fn facts_table(facts: impl IntoIterator<Item = (impl maud::Render, String)>) -> Markup {
    html! {
        table class="facts" {
            @for (name, value) in facts { tr { th scope="row" { (name) } td { (value) } } }
        }
    }
}

/// Embeds a drawing of this crate.
pub(super) fn drawing(drawing: &Drawing<'_>) -> Markup {
    picture(&drawing.svg())
}

/// Embeds an SVG of this crate, whose texts are escaped where they are drawn.
pub(super) fn picture(svg: &str) -> Markup {
    // An XML declaration belongs to a file of its own only.
    let element = svg.find("<svg").map_or("", |start| &svg[start..]);
    html! { figure { (PreEscaped(element)) } }
}
