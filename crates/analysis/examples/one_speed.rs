//! Physics without the service: a wheel, a scene, one speed, its spectrum. `cargo run --release --example one_speed`

use anyhow::{Context, Result, anyhow};
use rubmap_analysis::monitor::Unwatched;
use rubmap_analysis::run::{ModelFacts, check, prepare, resolve_sweep, run_speed};
use rubmap_model::impeller::{Preset, generate};
use rubmap_model::package::to_sector;
use rubmap_wheel::dynamics::reduction::NoCheckpoints;
use serde_json::json;

fn main() -> Result<()> {
    // A wheel: ten sectors of the generated impeller; `package::read` takes one from a file.
    let sector = to_sector(generate(&Preset::Small.parameters())?)?;
    let reduced = prepare(&sector, 20, None, &NoCheckpoints, &Unwatched)?;

    // A scene and a speed, in the words of `POST /v1/sweeps`.
    let request = json!({
        "model": "",
        "speeds": {"values": [24_000.0], "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        }
    });
    let request = resolve_sweep(serde_json::from_value(request)?, &ModelFacts::of(&sector))
        .map_err(|violations| anyhow!("{violations:?}"))?;
    check(&reduced, &request, &Unwatched)?;

    let result = run_speed(&reduced, &request, 0, None, &Unwatched)?;
    println!("{:?} after {} steps", result.point.status, result.point.steps);
    let spectra = result.spectra.context(result.point.message.unwrap_or_default())?;
    let lines = spectra.engine_orders.iter().zip(&spectra.sensors[0].amplitude);
    for (order, amplitude) in lines.filter(|(order, _)| order.fract() == 0.0) {
        println!("engine order {order:2}: {amplitude:.3e} {}", reduced.units.length);
    }
    Ok(())
}
