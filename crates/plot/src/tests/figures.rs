//! Figures: their numbers are those of the results, and they leave to the page what is the page's.

use serde_json::{Value, json};

use super::drawings::{credentials, mm};
use super::fixtures::spectra;
use super::stresses::{stressed_critical, stressed_map};
use super::{critical, map, modes, waves};
use crate::figure::{self, Figure};
use crate::{Frame, LevelColour, VerticalAxis, Window};

/// One of each kind, and what is particular.
pub(super) fn all() -> Vec<(String, Figure)> {
    let whole = Window::default();
    let mut all = Vec::new();
    for (name, axis) in [("map", VerticalAxis::EngineOrder), ("map-frequency", VerticalAxis::Frequency)] {
        let (critical, modes) = (critical(), modes());
        let figure =
            figure::interaction_map(&map(), Some(&critical), Some(&modes), axis, whole, LevelColour::Plain);
        all.push((name.to_owned(), figure));
    }
    for (name, by) in [("map-validity", LevelColour::Plain), ("map-utilisation", LevelColour::Utilisation)] {
        let axis = VerticalAxis::EngineOrder;
        let figure =
            figure::interaction_map(&stressed_map(), Some(&stressed_critical()), None, axis, whole, by);
        all.push((name.to_owned(), figure));
    }
    all.push(("campbell".to_owned(), figure::campbell(&modes())));
    all.push(("campbell-waves".to_owned(), figure::campbell(&waves())));
    all.push(("critical-speeds".to_owned(), figure::critical_speeds(&critical())));
    all.push(("critical-speeds-validity".to_owned(), figure::critical_speeds(&stressed_critical())));
    for (name, frame) in [("spectrum", Frame::Rotating), ("spectrum-fixed-frame", Frame::Fixed)] {
        let figure = figure::spectrum(&spectra(6), &credentials(), &mm(), 0, frame);
        all.push((name.to_owned(), figure));
    }
    all
}

#[test]
#[ignore = "leaves files to be looked at"]
fn gallery_of_figures() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/gallery");
    std::fs::create_dir_all(folder).unwrap();
    for (name, figure) in all() {
        std::fs::write(format!("{folder}/{name}.plotly.json"), serde_json::to_vec(&figure).unwrap()).unwrap();
    }
}

#[test]
fn colours_of_the_page_are_left_to_the_page() {
    for (name, figure) in all() {
        let figure = json!(figure);
        let layout = figure["layout"].as_object().unwrap();
        assert!(layout["meta"]["kind"].is_string(), "{name}");
        for (attribute, value) in layout {
            assert!(
                !attribute.contains("bgcolor") && attribute != "font" && attribute != "template",
                "{name}"
            );
            if attribute.contains("axis") {
                let colours = ["color", "gridcolor", "linecolor", "zerolinecolor", "tickcolor"];
                assert!(colours.iter().all(|colour| value.get(colour).is_none_or(Value::is_null)), "{name}");
            }
        }
        assert!(layout.get("width").is_none(), "{name}");
    }
}
