//! Fixtures for drawings: results that look like real ones.

use std::f64::consts::TAU;

use rubmap_analysis::result::{ForceMap, SectorGeometry, SpeedHistories, SpeedSpectra, WearMap};
use serde_json::{Value, json};

use super::{SPEEDS_RPM, map, point, rad_s, units};

/// Height of the lobes of the scene of `map()` at an angle.
fn lobe(angle: f64) -> f64 {
    let wrapped = |centre: f64| (angle - centre) - TAU * ((angle - centre) / TAU).round();
    [0.0, 0.5 * TAU].map(|centre| 0.4 * (-(wrapped(centre) / 0.3f64).powi(2)).exp()).iter().sum()
}

/// Histories of two tips and another sensor over some revolutions: pushed by two lobes and ringing after them.
pub(super) fn recorded(revolutions: [u32; 2], samples: u32) -> SpeedHistories {
    let count = (revolutions[1] - revolutions[0]) * samples;
    let turned = |j: u32| TAU * f64::from(j + 1) / f64::from(samples);
    let moved = |angle: f64, clearance: f64| {
        (clearance - lobe(angle)).min(0.0) + 0.03 * (8.0 * angle).sin() + 0.012 * (17.3 * angle).cos()
    };
    let tip = |node: u32, angle: f64, clearance: f64| {
        let displacement: Vec<f64> = (0..count).map(|j| moved(turned(j) + angle, clearance)).collect();
        let velocity: Vec<f64> = displacement.windows(2).map(|pair| 1e4 * (pair[1] - pair[0])).collect();
        json!({"sensor": {"contact_node": node, "sector": 0, "component": "radial"},
            "tip": {"angle_rad": angle, "clearance": clearance}, "displacement": displacement, "velocity": velocity})
    };
    let pressed = |blade: u32, node: u32, j: u32| {
        let angle = turned(j) + 0.1 * TAU * f64::from(blade) - 0.05 * f64::from(node);
        (900.0 * (lobe(angle) - 0.3 + 0.004 * f64::from(node))).max(0.0)
    };
    let force: Vec<Vec<Vec<f64>>> = (0..5)
        .map(|blade| (0..3).map(|node| (0..count).map(|j| pressed(blade, node, j)).collect()).collect())
        .collect();
    let touching = |j: u32| {
        let touches = |blade: u32| (0..3).filter(|node| pressed(blade, *node, j) > 0.0).count() as f64;
        2.0 * (0..5).map(touches).sum::<f64>()
    };
    let touching: Vec<f64> = (0..count).map(touching).collect();
    let length: Vec<f64> = touching.iter().map(|nodes| 5.2 * nodes).collect();
    let over = |scale: f64, swing: f64| -> Vec<f64> {
        let at = |j: u32| f64::from(revolutions[0]) + f64::from(j + 1) / f64::from(samples);
        (0..count).map(|j| scale * at(j) + swing * (2.0 * turned(j)).sin()).collect()
    };
    serde_json::from_value(json!({
        "index": 2, "speed_rad_s": rad_s(12_000.0), "samples_per_revolution": samples, "revolutions": revolutions,
        "sensors": [tip(0, 0.0, 0.3), tip(2, -0.4, 0.2),
            {"sensor": {"contact_node": 1, "sector": 3, "component": "axial"}, "displacement": over(0.0, 0.02)}],
        "contact": {"force": force, "nodes_in_contact": touching, "contact_length": length},
        "energy": {"initial": 0.0, "mechanical": over(2.0, 3.0), "contact_work": over(9.0, 3.0), "damping_loss": over(7.0, 0.4)},
        "point": point(1, "completed"), "units": units(), "settings": map().settings, "version": "0",
    }))
    .unwrap()
}

/// Contact of this number of nodes at the speeds of `map()`; the third has no result.
pub(super) fn contact(nodes: usize) -> ForceMap {
    let row = |speed: usize| {
        let along = |scale: f64| -> Vec<f64> {
            let at =
                |node: usize| scale * (1.0 + speed as f64) * (1.0 + (0.6 * node as f64 + speed as f64).sin());
            (0..nodes).map(at).collect()
        };
        let share: Vec<f64> = along(0.08);
        json!({
            "summary": {"mean_force": 2000.0 * (1 + speed) as f64, "peak_force": 4000.0 * (1 + speed) as f64, "peak_node_force": 700.0,
                "peak_contact_node": 0, "peak_sector": 1, "worst_sector": 1, "closings_per_revolution": 20.0,
                "clearance_consumption": 0.9, "clearance_contact_node": 0,
                "linear_clearance_consumption": 0.3 * (1 + speed) as f64, "samples_per_revolution": 512},
            "peak_force": along(700.0), "impulse_per_revolution": along(0.4), "worst_sector": vec![Some(1); nodes],
            "contact_share": share, "closings_per_revolution": along(2.0), "clearance_consumption": along(0.13),
        })
    };
    let rows: Vec<Value> = (0..5).map(|speed| if speed == 2 { Value::Null } else { row(speed) }).collect();
    serde_json::from_value(json!({
        "speeds_rad_s": SPEEDS_RPM.map(rad_s), "rows": rows, "units": units(), "settings": map().settings, "version": "0",
    }))
    .unwrap()
}

/// Wear of two lobes on this number of rods before this number of nodes.
pub(super) fn worn(rods: usize, nodes: usize) -> WearMap {
    let depth = |rod: usize, node: usize| {
        let angle = TAU * (rod as f64 + 0.5) / rods as f64;
        (lobe(angle) - 0.25 - 0.01 * node as f64).max(0.0)
    };
    WearMap { depths: (0..rods).map(|rod| (0..nodes).map(|node| depth(rod, node)).collect()).collect() }
}

/// Spectra to engine order 12 in bins of a quarter: engine order 4 on nodal diameter 2, 6 on 1, and some noise.
pub(super) fn spectra(nodal_diameters: usize) -> SpeedSpectra {
    let orders: Vec<f64> = (0..=48).map(|bin| 0.25 * f64::from(bin)).collect();
    let row = |n: usize| -> Vec<f64> {
        let at = |order: &f64| match (n, *order) {
            (2, 4.0) => 0.3,
            (1, 6.0) => 0.08,
            (0, 10.0) => 0.01,
            _ => 1e-4 / (1.0 + order + n as f64),
        };
        orders.iter().map(at).collect()
    };
    let rows: Vec<Vec<f64>> = (0..nodal_diameters).map(row).collect();
    let amplitude: Vec<f64> =
        (0..orders.len()).map(|bin| rows.iter().map(|row| 0.6 * row[bin]).fold(0.0, f64::max)).collect();
    serde_json::from_value(json!({
        "engine_orders": orders,
        "sensors": [{"sensor": super::sensor(), "amplitude": amplitude, "nodal_diameters": rows}],
    }))
    .unwrap()
}

/// Sector with a blade on a disk: faces at ±0.3 rad, clamped at the bore, `tips` contact nodes.
pub(super) fn sector(tips: usize) -> SectorGeometry {
    let mut nodes = Vec::new();
    for ring in 0..8 {
        for step in 0..=6 {
            let kind = match (ring, step) {
                (0, _) => "clamped",
                (_, 0) => "low",
                (_, 6) => "high",
                _ => "internal",
            };
            let angle = -0.3 + 0.1 * f64::from(step);
            let position = [20.0 + 10.0 * f64::from(ring), angle, 40.0 - 4.0 * f64::from(ring)];
            nodes.push(json!({"id": nodes.len() + 1, "kind": kind, "position": position}));
        }
    }
    let mut contact = Vec::new();
    for tip in 0..tips {
        let share = if tips > 1 { tip as f64 / (tips - 1) as f64 } else { 0.0 };
        let position = [50.0 + 45.0 * share * share, 0.1 * share, 62.0 * (1.0 - 0.7 * share)];
        let normal = [(1.0 - share).sqrt(), 0.0, share.sqrt()];
        nodes.push(json!({"id": 1000 + tip, "kind": "contact", "position": position}));
        contact.push(
            json!({"id": 1000 + tip, "position": position, "normal": normal, "clearance": 0.3 - 0.1 * share}),
        );
    }
    serde_json::from_value(json!({
        "name": "a disk <and> a blade", "sectors": 10, "units": units(), "nodes": nodes, "contact": contact,
    }))
    .unwrap()
}
