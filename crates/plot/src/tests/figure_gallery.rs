//! Gallery of figures: `cargo test --release -p rubmap-plot gallery_of_figures -- --ignored` leaves one of every kind in `target/gallery`,
//! and, where `rubmap demo` left its results in `demo` in it, figures of those.

use std::path::{Path, PathBuf};

use super::branched::{marched, over_clearance, resonance};
use super::drawings::{credentials, mm};
use super::fixtures::{contact, recorded, sector, spectra, worn};
use super::gallery::read;
use super::passed::{passed, stayed, through_points};
use super::pens::figure;
use super::stresses::{of_sweep, stressed_critical, stressed_map};
use super::studies::{RUNS, first_revolutions, study};
use super::{critical, map, modes, waves};
use crate::Figure;
use crate::{
    ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, SectionView, SpectrogramUnit,
    VerticalAxis, Window,
};
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap, Quantity};

/// Figures of each kind, and of special cases, with their names.
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
    all.push(("interference".to_owned(), figure::interference(&super::interference::of(&modes(), 4))));
    all.push(("backbones".to_owned(), figure::backbones(&super::backbones())));
    all.push(("campbell-waves".to_owned(), figure::campbell(&waves())));
    all.push(("critical-speeds".to_owned(), figure::critical_speeds(&critical())));
    all.push(("critical-speeds-validity".to_owned(), figure::critical_speeds(&stressed_critical())));
    all.push(("branches".to_owned(), figure::branches(&resonance(true), 0, &marched())));
    all.push(("campaign".to_owned(), figure::campaign(&super::campaigns::designs(), 0)));
    all.push(("branches-clearance".to_owned(), figure::branches(&over_clearance(), 0, &[])));
    all.push(("run-ups".to_owned(), figure::run_ups(&passed(&[5.0, 50.0, 400.0], true), 0, &stayed())));
    for (name, unit) in [("", SpectrogramUnit::Order), ("-hz", SpectrogramUnit::Hz)] {
        let (up, through) = (passed(&[50.0], true), through_points());
        all.push((format!("spectrogram{name}"), figure::spectrogram(&up, 0, 0, unit)));
        all.push((format!("spectrogram-points{name}"), figure::spectrogram(&through, 0, 0, unit)));
    }
    for (name, frame) in [("spectrum", Frame::Rotating), ("spectrum-fixed-frame", Frame::Fixed)] {
        let figure = figure::spectrum(&spectra(6), &credentials(), &mm(), 0, frame);
        all.push((name.to_owned(), figure));
    }
    let sheet = figure::map_sheet(&vec![map(); 5], whole, LevelColour::Plain);
    all.push(("map-sheet".to_owned(), sheet));
    let sheet = figure::map_sheet(&vec![stressed_map(); 2], whole, LevelColour::Utilisation);
    all.push(("map-sheet-utilisation".to_owned(), sheet));
    all.push(("campbell-fixed-frame".to_owned(), figure::campbell_fixed_frame(&modes())));
    for (name, what) in [
        ("displacement", HistoryQuantity::Displacement),
        ("velocity", HistoryQuantity::Velocity),
        ("force", HistoryQuantity::Force),
        ("contact", HistoryQuantity::Contact),
        ("energy", HistoryQuantity::Energy),
    ] {
        let figure = figure::speed_histories(&recorded([10, 50], 512), what, 0);
        all.push((format!("history-{name}"), figure));
    }
    all.push(("trajectories".to_owned(), figure::trajectories(&recorded([0, 4], 720))));
    for (name, quantity) in [
        ("peak", ForceQuantity::Peak),
        ("impulse", ForceQuantity::Impulse),
        ("share", ForceQuantity::Share),
        ("consumption", ForceQuantity::Consumption),
    ] {
        all.push((format!("forces-{name}"), figure::force_map(&contact(10), quantity)));
    }
    all.push(("wear".to_owned(), figure::wear_map(&worn(2000, 10), &credentials(), &mm())));
    for (name, view) in [("section", SectionView::Meridional), ("section-cyclic", SectionView::Cyclic)] {
        all.push((name.to_owned(), figure::section(&sector(9), view)));
    }
    all.push(("around".to_owned(), figure::around(&sector(9))));
    for (name, by) in [("haigh", HaighColour::Speed), ("haigh-utilisation", HaighColour::Utilisation)] {
        all.push((name.to_owned(), figure::haigh(&of_sweep(&stressed_map()), by)));
    }
    let found = study(&RUNS, false);
    for quantity in Quantity::ALL {
        let name = quantity.as_str();
        all.push((format!("work-precision-{name}"), figure::work_precision(&found, 0, quantity)));
        all.push((format!("error-over-step-{name}"), figure::error_over_step(&found, 0, quantity)));
    }
    all.push(("histories".to_owned(), figure::histories(&first_revolutions(&[1, 2, 4], 20, 9), 0)));
    all
}

/// Figures of the results of `rubmap demo`, if there are any.
fn demo(folder: &Path) -> Vec<(String, Figure)> {
    let (Some(map), Some(critical), Some(modes)) = (
        read::<InteractionMap>(&folder.join("interaction-map.json")),
        read::<CriticalSpeeds>(&folder.join("critical-speeds.json")),
        read::<Campbell>(&folder.join("campbell.json")),
    ) else {
        return Vec::new();
    };
    let show = |axis| {
        let (critical, whole) = (Some(&critical), Window::default());
        figure::interaction_map(&map, critical, Some(&modes), axis, whole, LevelColour::Plain)
    };
    vec![
        ("demo-map".to_owned(), show(VerticalAxis::EngineOrder)),
        ("demo-map-frequency".to_owned(), show(VerticalAxis::Frequency)),
        ("demo-critical-speeds".to_owned(), figure::critical_speeds(&critical)),
        ("demo-campbell".to_owned(), figure::campbell(&modes)),
        ("demo-campbell-fixed-frame".to_owned(), figure::campbell_fixed_frame(&modes)),
    ]
}

#[test]
#[ignore = "leaves files to be looked at"]
fn gallery_of_figures() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/gallery");
    std::fs::create_dir_all(folder).unwrap();
    for (name, figure) in all().into_iter().chain(demo(&PathBuf::from(folder).join("demo"))) {
        std::fs::write(format!("{folder}/{name}.plotly.json"), serde_json::to_vec(&figure).unwrap()).unwrap();
    }
}
