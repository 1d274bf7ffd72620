//! Euler force on a disk clamped at its bore, against the closed form: pure shear, exact at any thickness.

use std::sync::{Arc, Mutex};

use faer::c64;
use rubmap::analysis::euler_load::EulerLoad;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::result::PointStatus;
use rubmap::analysis::run::{MeshFacts, ModelFacts, ReducedSector, prepare, resolve_run_ups};
use rubmap::dynamics::euler::modal_load;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::{BasisRows, Checkpoints};
use rubmap::impeller::{AnnulusParameters, annulus};
use rubmap::package::{self, Limits};
use serde_json::json;

use crate::to_the_end::to_the_end;

/// Checkpoints that keep the rows of nodal diameter 0.
#[derive(Default)]
struct OfZero(Mutex<Vec<Vec<f64>>>);

impl Checkpoints for OfZero {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        if rows.harmonic() == 0 {
            *self.0.lock().unwrap() = (0..rows.dofs()).map(|dof| rows.row(dof).collect()).collect();
        }
    }
}

/// Displacement of the rim by `(r²τ)′ = ρΩ̇r³` with no shear at the rim b, τ = G r (u/r)′ and no displacement at the
/// bore a: `u = ρΩ̇r/(8G) · (r² − a² + b⁴/r² − b⁴/a²)`, against the sense of Ω̇.
fn rim_displacement(p: &AnnulusParameters, rate: f64) -> f64 {
    let (a2, b2) = (p.inner_radius.powi(2), p.outer_radius.powi(2));
    let shear_modulus = p.material.youngs_modulus / (2.0 * (1.0 + p.material.poissons_ratio));
    p.material.density * rate * p.outer_radius / (8.0 * shear_modulus) * (b2 - a2 + b2 - b2 * b2 / a2)
}

/// Disk, with its facts, its reduction and its Euler force.
struct Disk {
    p: AnnulusParameters,
    facts: ModelFacts,
    reduced: ReducedSector,
    load: EulerLoad,
}

fn disk(elements: [usize; 3]) -> Disk {
    let p = AnnulusParameters { sectors: 7, elements, ..AnnulusParameters::default() };
    let file = tempfile::NamedTempFile::new().unwrap();
    package::write(&annulus(&p).unwrap(), &file).unwrap();
    let limits = Limits::default();
    let sector = package::read(file.path(), &limits).unwrap().sector;
    let mesh = package::read_mesh(file.path(), &limits).unwrap().unwrap();
    let nodes = package::read_nodes(file.path(), &limits).unwrap();
    let rows = OfZero::default();
    let reduced = prepare(&sector, 6, None, &rows, &Unwatched).unwrap();
    let rows = rows.0.into_inner().unwrap();
    let project = |load: &[f64]| {
        let mut projected = vec![c64::ZERO; rows[0].len() / 2];
        for (row, force) in rows.iter().zip(load) {
            projected.iter_mut().zip(row.chunks_exact(2)).for_each(|(sum, row)| *sum += row[0] * force);
        }
        Ok::<_, std::convert::Infallible>(projected)
    };
    let Ok(load) = EulerLoad::of(&mesh, &nodes, rows.len(), project);
    Disk {
        p,
        facts: ModelFacts { mesh: Some(MeshFacts::of(&mesh, &sector)), ..ModelFacts::of(&sector) },
        reduced,
        load,
    }
}

/// Static sum over all modes, which has the sign: of fourth order in the mesh.
#[test]
fn a_disk_lags_where_its_speed_rises() {
    let rate = 300.0;
    let [coarse, fine] = [[10, 2, 1], [20, 4, 1]].map(|elements| {
        let Disk { p, reduced, load, .. } = disk(elements);
        let still = RotationEffects::stiffening(false);
        let (modal, shapes) = ModalWheel::with_shapes(&reduced.wheel, 100.0, still).unwrap();
        let force = modal_load(load.of_unknowns(), shapes[0].as_ref(), modal.sectors);
        let modes = &modal.harmonics[0];
        let of = |mode: usize| modes.contact[(1, mode)].re * rate * force[mode] / modes.omega[mode].powi(2);
        let found = (0..modes.omega.len()).map(of).sum::<f64>() / (modal.sectors as f64).sqrt();
        let expected = rim_displacement(&p, rate);
        assert!(expected < 0.0 && found < 0.0, "{found:e} {expected:e}");
        (found / expected - 1.0).abs()
    });
    assert!(fine < 1e-5 && coarse > 10.0 * fine, "{coarse:e} {fine:e}");
}

/// Euler force in time, up and down, once what begins with the run has died away.
#[test]
fn run_ups_have_the_euler_force_where_it_is_named() {
    let rate = 300.0;
    let Disk { p, facts, mut reduced, load } = disk([10, 2, 1]);
    let expected = rim_displacement(&p, rate);
    reduced.euler_load = Some(Arc::new(load));
    let largest = |changes: &[(&str, serde_json::Value)]| {
        let mut request = json!({
            "model": "disk", "modes_per_speed": 6, "euler_force": true, "frame_revolutions": 1,
            "speed": {"unit": "rad_s", "from": 100, "to": 400, "rates": [rate]},
            "scene": {"damping": {"modal_ratio": 0.2}},
            "sensors": [{"contact_node": 0, "sector": 3, "component": "tangential"}],
        });
        changes.iter().for_each(|(field, value)| request[*field] = value.clone());
        last_largest(&reduced, &facts, request)
    };
    let speed = |unit, from, to| json!({"unit": unit, "from": from, "to": to, "rates": [rate]});
    for changes in [
        vec![],
        vec![("speed", speed("rad_s", 400, 100))],
        vec![("integration", json!({"scheme": "massless_boundary"}))],
        vec![("integration", json!({"scheme": "central_differences"}))],
    ] {
        let found = largest(&changes);
        assert!((found / -expected - 1.0).abs() < 1e-3, "{changes:?}: {found:e} {expected:e}");
    }
    assert_eq!(largest(&[("euler_force", json!(false))]), 0.0);
}

/// Largest displacement of the last whole frame of the only run.
fn last_largest(reduced: &ReducedSector, facts: &ModelFacts, request: serde_json::Value) -> f64 {
    let asked = resolve_run_ups(serde_json::from_value(request).unwrap(), facts).unwrap();
    let told = to_the_end(reduced, &asked, facts);
    let run = &told.runs[0];
    let end = run.end.as_ref().unwrap();
    assert!(end.status == PointStatus::Completed && end.energy_residual < 1e-9, "{end:?}");
    run.frames[run.frames.len() - 2].largest[0]
}
