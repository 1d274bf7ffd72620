//! Gallery of drawings: `cargo test --release -p rubmap-plot gallery -- --ignored` leaves all of them in `target/gallery` as SVG, and as
//! PNG in colour and in grey, and the figures. Where `rubmap demo` and `rubmap study` left their results in `demo` and `study` in it, those
//! are drawn.

use std::path::{Path, PathBuf};

use super::branched::{marched, over_clearance, resonance};
use super::drawings::{credentials, mm};
use super::fixtures::{contact, recorded, sector, spectra, worn};
use super::impeller::{SECTORS, impeller};
use super::passed::{many_rates, passed, stayed, through_points};
use super::pens::svg::{
    backbones, branches, campbell, campbell_fixed_frame, critical_speeds, error_over_step, force_map, haigh,
    histories, interaction_map, interference, map_sheet, run_ups, section, spectrogram, spectrum,
    speed_histories, trajectories, wear_map, work_precision,
};
use super::stresses::{of_sweep, stressed_critical, stressed_map};
use super::studies::{RUNS, first_revolutions, study};
use crate::{
    ForceQuantity, Frame, HaighColour, HistoryQuantity, LevelColour, SectionView, SpectrogramUnit,
    SurfaceView, VerticalAxis, Window, png, surface,
};
use rubmap_analysis::result::{
    Campbell, CriticalSpeeds, InteractionMap, Quantity, SectorGeometry, SpeedSpectra,
};
use rubmap_analysis::run::{Histories, WorkPrecision};
use serde::de::DeserializeOwned;

pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

fn save(folder: &Path, name: &str, drawing: &str) {
    std::fs::write(folder.join(format!("{name}.svg")), drawing).unwrap();
    let image = png(drawing, 1000).unwrap();
    std::fs::write(folder.join(format!("{name}.png")), &image).unwrap();
    let (width, height, pixels) = super::decoded(&image);
    let grey: Vec<u8> = pixels
        .chunks(4)
        .map(|p| (0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2])) as u8)
        .collect();
    let file = std::fs::File::create(folder.join(format!("{name}-grey.png"))).unwrap();
    let mut encoder = ::png::Encoder::new(file, width, height);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&grey).unwrap();
}

#[test]
#[ignore = "leaves files to be looked at"]
fn gallery() {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/gallery"));
    std::fs::create_dir_all(&folder).unwrap();
    let demo = folder.join("demo");
    let map: InteractionMap = read(&demo.join("interaction-map.json")).unwrap_or_else(super::map);
    let critical: CriticalSpeeds = read(&demo.join("critical-speeds.json")).unwrap_or_else(super::critical);
    let modes: Campbell = read(&demo.join("campbell.json")).unwrap_or_else(super::modes);
    for (name, axis) in [("map", VerticalAxis::EngineOrder), ("map-frequency", VerticalAxis::Frequency)] {
        let drawing =
            interaction_map(&map, Some(&critical), Some(&modes), axis, Window::default(), LevelColour::Plain);
        save(&folder, name, &drawing);
    }
    let window = Window { speeds_rpm: Some((18_000.0, 26_000.0)), engine_orders: Some((3.0, 9.0)) };
    for (name, by) in [("map-validity", LevelColour::Plain), ("map-utilisation", LevelColour::Utilisation)] {
        let (map, critical, axis) = (stressed_map(), stressed_critical(), VerticalAxis::EngineOrder);
        save(&folder, name, &interaction_map(&map, Some(&critical), None, axis, Window::default(), by));
    }
    save(&folder, "campaign", &super::pens::svg::campaign(&super::campaigns::designs(), 0));
    save(&folder, "critical-speeds-validity", &critical_speeds(&stressed_critical()));
    let zoomed = interaction_map(
        &map,
        Some(&critical),
        Some(&modes),
        VerticalAxis::EngineOrder,
        window,
        LevelColour::Plain,
    );
    save(&folder, "map-window", &zoomed);
    save(&folder, "campbell", &campbell(&modes));
    save(&folder, "interference", &interference(&super::interference::of(&super::modes(), 4)));
    save(&folder, "backbones", &backbones(&super::backbones()));
    save(&folder, "interference-waves", &interference(&super::interference::of(&super::waves(), 5)));
    save(&folder, "campbell-fixed-frame", &campbell_fixed_frame(&modes));
    save(&folder, "critical-speeds", &critical_speeds(&critical));

    save(&folder, "branches", &branches(&resonance(true), 0, &marched()));
    save(&folder, "branches-growing", &branches(&resonance(false), 0, &[]));
    save(&folder, "branches-clearance", &branches(&over_clearance(), 0, &[]));

    for (name, of) in [("", passed(&[5.0, 50.0, 400.0], true)), ("-many", passed(&many_rates(), true))] {
        save(&folder, &format!("run-ups{name}"), &run_ups(&of, 0, &stayed()));
    }
    save(&folder, "run-downs", &run_ups(&passed(&[20.0], false), 1, &[]));
    for (name, unit) in [("", SpectrogramUnit::Order), ("-hz", SpectrogramUnit::Hz)] {
        let (up, through) = (passed(&[50.0], true), through_points());
        save(&folder, &format!("spectrogram{name}"), &spectrogram(&up, 0, 0, unit));
        save(&folder, &format!("spectrogram-points{name}"), &spectrogram(&through, 0, 0, unit));
    }
    save(&folder, "run-through-points", &run_ups(&through_points(), 0, &[]));

    let zoom = Window { speeds_rpm: Some((18_000.0, 26_000.0)), engine_orders: Some((1.0, 12.0)) };
    let maps: Option<Vec<InteractionMap>> =
        (0..6).map(|i| read(&demo.join(format!("map-{i}.json")))).collect();
    save(
        &folder,
        "map-sheet",
        &map_sheet(&maps.unwrap_or_else(|| vec![super::map(); 3]), zoom, LevelColour::Plain),
    );
    let answer: Option<serde_json::Value> = read(&demo.join("spectra-33.json"));
    let found: Option<SpeedSpectra> =
        answer.and_then(|answer| serde_json::from_value(answer.get("spectra")?.clone()).ok());
    let found = found.unwrap_or_else(|| spectra(6));
    for (name, frame) in [("spectrum", Frame::Rotating), ("spectrum-fixed-frame", Frame::Fixed)] {
        save(&folder, name, &spectrum(&found, &credentials(), &mm(), 0, frame));
    }

    let (short, long) = (recorded([0, 4], 720), recorded([10, 50], 512));
    for (name, what) in [
        ("displacement", HistoryQuantity::Displacement),
        ("velocity", HistoryQuantity::Velocity),
        ("force", HistoryQuantity::Force),
        ("contact", HistoryQuantity::Contact),
        ("energy", HistoryQuantity::Energy),
    ] {
        save(&folder, &format!("history-{name}"), &speed_histories(&short, what, 0));
        save(&folder, &format!("history-long-{name}"), &speed_histories(&long, what, 0));
    }
    save(&folder, "trajectories", &trajectories(&short));
    for (name, quantity) in [
        ("peak", ForceQuantity::Peak),
        ("impulse", ForceQuantity::Impulse),
        ("share", ForceQuantity::Share),
        ("consumption", ForceQuantity::Consumption),
    ] {
        save(&folder, &format!("forces-{name}"), &force_map(&contact(10), quantity));
    }
    save(&folder, "wear", &wear_map(&worn(2000, 10), &credentials(), &mm()));
    let geometry: SectorGeometry = read(&demo.join("geometry.json")).unwrap_or_else(|| sector(9));
    for (name, view) in [("section", SectionView::Meridional), ("section-cyclic", SectionView::Cyclic)] {
        save(&folder, name, &section(&geometry, view));
    }

    for (name, view) in
        [("front", SurfaceView::Front), ("rear", SurfaceView::Rear), ("meridional", SurfaceView::Meridional)]
    {
        save(&folder, &format!("surface-{name}"), &surface(&impeller(0..SECTORS, 12, 2.0), view));
        save(&folder, &format!("surface-sector-{name}"), &surface(&impeller(0..1, 12, 2.0), view));
    }

    for (name, by) in [("haigh", HaighColour::Speed), ("haigh-utilisation", HaighColour::Utilisation)] {
        save(&folder, name, &haigh(&of_sweep(&stressed_map()), by));
    }

    let found: WorkPrecision =
        read(&folder.join("study/work-precision.json")).unwrap_or_else(|| study(&RUNS, false));
    for quantity in Quantity::ALL {
        save(&folder, &format!("work-precision-{}", quantity.as_str()), &work_precision(&found, 0, quantity));
        save(
            &folder,
            &format!("error-over-step-{}", quantity.as_str()),
            &error_over_step(&found, 0, quantity),
        );
    }
    let lines: Histories =
        read(&folder.join("study/histories.json")).unwrap_or_else(|| first_revolutions(&[1, 2, 4], 20, 9));
    save(&folder, "histories", &histories(&lines, 0));
}
