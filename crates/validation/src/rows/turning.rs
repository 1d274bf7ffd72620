//! Coriolis forces and spin softening of a mass seen from a frame that turns, in both frames of packages.

use std::f64::consts::TAU;

use rubmap_analysis::monitor::Unwatched;
use rubmap_analysis::run::{ModelFacts, modal_analysis, prepare, resolve_modal_analysis};
use rubmap_model::package::raw::{
    Axis, Frame, Manifest, ManifestContact, RawDof, RawMatrix, RawNode, RawPackage,
};
use rubmap_model::package::to_sector;
use rubmap_wheel::dynamics::reduction::NoCheckpoints;
use rubmap_wheel::dynamics::sector::Units;
use serde_json::json;

use super::blade::relative;
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "rotating-mass",
    covers: &[
        Subject::Effect("coriolis"),
        Subject::Effect("centrifugal_stiffening"),
        Subject::Kind("modal_analysis"),
    ],
    claim: "Waves seen from the wheel are shifted by its speed, whatever frame a package is in.",
    reference: "closed form: m(ẍ − 2Ωẏ − Ω²x) + kx = 0 and y alike, ω = |ω0 ∓ Ω|",
    quantity: "largest relative error of the frequencies of two masses at three speeds, in Cartesian and cylindrical components",
    check: Check::Computed(Computed {
        error: rotating_mass,
        wrong: "gyroscopic matrix",
        limit: 1e-11,
        reason: "round-off of an eigenproblem",
    }),
}];

/// Masses, and squares ω0² of each in x, y and z.
const MASSES: [(f64, [f64; 3]); 2] = [(2e-6, [4e6, 4e6, 1.21e6]), (3e-6, [9e6, 9e6, 4.41e6])];

fn two_masses(frame: Frame, wrong: f64) -> RawPackage {
    let matrix = |of: &dyn Fn(usize, usize) -> f64| RawMatrix {
        size: 6,
        entries: (0..6u32).map(|row| (row, row, of(row as usize / 3, row as usize % 3))).collect(),
    };
    let stiffness = |speed: f64| {
        let softening = |axis| if axis == 2 { 0.0 } else { speed * speed };
        matrix(&|node, axis| MASSES[node].0 * (MASSES[node].1[axis] - softening(axis)))
    };
    let speeds = [0.0, 500.0, 1000.0];
    // The cross product with the axis is the same in x, y as in r, θ.
    let turning = |node: usize| (3 * node as u32 + 1, 3 * node as u32, wrong * 2.0 * MASSES[node].0);
    RawPackage {
        manifest: Manifest {
            name: "two masses".into(),
            sectors: 1,
            units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
            axis: Axis { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] },
            speeds_rad_s: speeds.to_vec(),
            frame,
            mass: "m.mtx".into(),
            stiffness: vec!["k0.mtx".into(), "k1.mtx".into(), "k2.mtx".into()],
            gyroscopic: Some("g.mtx".into()),
            nodes: "nodes.csv".into(),
            dofs: "dofs.csv".into(),
            cyclic: Vec::new(),
            contact: vec![ManifestContact { node: 1, normal: [0.0, 0.0, 1.0] }],
            mesh: None,
        },
        nodes: vec![
            RawNode { id: 1, position: [30.0, 40.0, 0.0] },
            RawNode { id: 2, position: [-10.0, 25.0, 5.0] },
        ],
        dofs: (1..=2).flat_map(|node| (1..=3).map(move |component| RawDof { node, component })).collect(),
        mass: matrix(&|node, _| MASSES[node].0),
        stiffness: speeds.map(stiffness).to_vec(),
        gyroscopic: Some(RawMatrix { size: 6, entries: vec![turning(0), turning(1)] }),
        elements: None,
    }
}

fn rotating_mass(wrong: f64) -> anyhow::Result<f64> {
    let speeds = [100.0, 400.0, 1000.0];
    let request = json!({"model": "m", "modes_per_speed": 3, "families": 6, "coriolis": true,
        "speeds": {"values": speeds, "unit": "rad_s"}});
    let mut most = 0.0f64;
    for frame in [Frame::Cartesian, Frame::Cylindrical] {
        let sector = to_sector(two_masses(frame, wrong))?;
        let asked = serde_json::from_value(request.clone())?;
        let job = resolve_modal_analysis(asked, &ModelFacts::of(&sector))
            .map_err(|violations| anyhow::anyhow!("{violations:?}"))?;
        let reduced = prepare(&sector, 3, None, &NoCheckpoints, &Unwatched)?;
        let waves = modal_analysis(&reduced, &job, &Unwatched)?.waves;
        let found = waves.ok_or_else(|| anyhow::anyhow!("no waves"))?.forward_hz;
        for (row, speed) in found.iter().zip(speeds) {
            let shifted = |&(_, [plane, _, z]): &(f64, [f64; 3])| {
                [plane.sqrt() - speed, plane.sqrt() + speed, z.sqrt()]
            };
            let mut exact: Vec<f64> = MASSES.iter().flat_map(shifted).map(|omega| omega / TAU).collect();
            exact.sort_by(f64::total_cmp);
            most = most.max(relative(row[0].iter().copied().zip(exact)));
        }
    }
    Ok(most)
}
