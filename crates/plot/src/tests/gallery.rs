//! Drawings to be looked at: `RUBMAP_GALLERY=folder cargo test --release -p rubmap-plot gallery -- --ignored` leaves all of them in
//! the folder as SVG, and as PNG in colour and in grey. Where `rubmap demo` left its results in `folder/demo`, those are drawn.

use std::path::{Path, PathBuf};

use crate::{VerticalAxis, Window, campbell, interaction_map, png};
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use serde::de::DeserializeOwned;

fn read<T: DeserializeOwned>(path: &Path) -> Option<T> {
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
    let folder = PathBuf::from(std::env::var("RUBMAP_GALLERY").expect("a folder in RUBMAP_GALLERY"));
    let demo = folder.join("demo");
    let map: InteractionMap = read(&demo.join("interaction-map.json")).unwrap_or_else(super::map);
    let critical: CriticalSpeeds = read(&demo.join("critical-speeds.json")).unwrap_or_else(super::critical);
    let modes: Campbell = read(&demo.join("campbell.json")).unwrap_or_else(super::modes);
    for (name, axis) in [("map", VerticalAxis::EngineOrder), ("map-frequency", VerticalAxis::Frequency)] {
        let drawing = interaction_map(&map, Some(&critical), Some(&modes), axis, Window::default());
        save(&folder, name, &drawing);
    }
    let window = Window { speeds_rpm: Some((18_000.0, 26_000.0)), engine_orders: Some((3.0, 9.0)) };
    let zoomed = interaction_map(&map, Some(&critical), Some(&modes), VerticalAxis::EngineOrder, window);
    save(&folder, "map-window", &zoomed);
    save(&folder, "campbell", &campbell(&modes));
}
