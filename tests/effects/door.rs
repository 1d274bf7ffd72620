//! Scenes with effects through the door: which run together, which are refused by name, and which must agree.

use std::sync::Arc;

use faer::{Mat, c64};
use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::{SchemeChoice, SweepRequest};
use rubmap::analysis::result::{Point, SpeedResult};
use rubmap::analysis::run::{MeshFacts, ModelFacts, ReducedSector, check, resolve_sweep, run_speed};
use rubmap::dynamics::bending::{BladeBending, EnergyForm};
use rubmap::dynamics::sector::SectorModel;
use rubmap::numerics::sector_fourier::is_single;
use serde_json::{Value, json};

use crate::fixtures::{WheelRecipe, gyroscopic, wheel};
use crate::support::{assert_sound, merge, reduced, spectral_difference};

const SPEED: f64 = 1500.0;

fn sector() -> SectorModel {
    let recipe = WheelRecipe { sectors: 6, ..WheelRecipe::default() };
    let mut sector = wheel(recipe).into_parts();
    sector.gyroscopic = Some(gyroscopic(recipe, 5));
    SectorModel::new(sector).unwrap()
}

/// Every effect of a scene, as a user names it.
fn effects() -> Vec<(&'static str, Value)> {
    vec![
        ("centrifugal_stiffening", json!({"centrifugal_stiffening": true})),
        ("coriolis", json!({"coriolis": true})),
        ("friction", json!({"friction": {"coefficient": 0.05}})),
        ("disc", json!({"friction": {"coefficient": 0.05, "law": "disc"}})),
        (
            "abradable",
            json!({"abradable": {"modulus": 2e4, "yield_stress": 20.0, "hardening": 500.0, "thickness": 2.0,
                                 "rods_around": 400}}),
        ),
        (
            "flexible_casing",
            json!({"flexible_casing": {"modes": [
                {"nodal_diameter": 0, "frequency_hz": 2000.0, "modal_mass": 1e-3},
                {"nodal_diameter": 2, "frequency_hz": 500.0, "modal_mass": 1e-3}]}}),
        ),
        ("geometric_nonlinearity", json!({"geometric_nonlinearity": {"include": "full", "coordinates": 2}})),
        ("mistuning", json!({"mistuning": {"spread": 0.03, "seed": 7}})),
        (
            "engine_order_excitation",
            json!({"engine_order_excitation": [
                {"order": 4, "contact_nodes": [0, 2], "component": "axial", "amplitude": 2.0}]}),
        ),
        ("orbit", json!({"orbit": {"radius": 0.05, "whirl_ratio": 0.4}})),
        (
            "clearance_change",
            json!({"clearance_change": {"course": [
                {"revolutions": 0.5, "change": 0.02}, {"revolutions": 1.0, "change": -0.03}]}}),
        ),
        (
            "initial",
            json!({"initial": {"nodal_diameter": 2, "family": 1, "amplitude": 0.05, "wave": "forward"}}),
        ),
        ("exact", json!({"symmetry": "exact"})),
        ("probe", json!({"symmetry": "probe"})),
    ]
}

/// Facts of a sector that is taken to have a mesh.
fn facts(sector: &SectorModel) -> ModelFacts {
    let mesh = MeshFacts { elements: 1, sets: Vec::new(), tip_thickness: None };
    ModelFacts { mesh: Some(mesh), ..ModelFacts::of(sector) }
}

/// Reduction whose blades bend far in two coordinates, of no particular shape.
fn bending(reduced: ReducedSector) -> ReducedSector {
    let number = |seed: usize| (12.9898 * (seed + 1) as f64).sin();
    let rows = reduced.wheel.harmonics.iter().map(|harmonic| {
        Mat::from_fn(2, harmonic.mass.ncols(), |j, unknown| {
            let imaginary = if is_single(harmonic.harmonic, reduced.wheel.sectors) { 0.0 } else { 0.3 };
            let seed = 40 * harmonic.harmonic + 2 * unknown + j;
            c64::new(0.2 * number(seed), 0.2 * imaginary * number(seed + 500))
        })
    });
    let nodes = reduced.wheel.contact.len();
    let blade = BladeBending {
        asked: 2,
        rows: rows.collect(),
        potential: EnergyForm::new(
            &Mat::from_fn(2, 3, |j, a| number(j + 2 * a)),
            &Mat::from_fn(3, 3, |a, b| 20.0 * f64::from(u8::from(a == b))),
        ),
        inertia: EnergyForm::new(
            &Mat::from_fn(2, 3, |j, a| 1e-8 * number(j + 2 * a)),
            &Mat::from_fn(3, 3, |a, b| 2e-7 * f64::from(u8::from(a == b))),
        ),
        linear: Mat::from_fn(3 * nodes, 2, |row, j| 0.1 * number(row + 60 * j)),
        second_order: Mat::from_fn(3 * nodes, 3, |row, a| 0.05 * number(row + 30 * a)),
    };
    ReducedSector { bending: Some(Arc::new(blade)), ..reduced }
}

/// Length of gaps, as [`assert_sound`] takes it. Blades that bend far close them to second order in what the forces move in a step.
fn length(named: &[&str]) -> f64 {
    if named.contains(&"geometric_nonlinearity") { 1e4 } else { 0.8 }
}

/// Request for a sweep over `speeds` with two lobes beyond the clearance and the fields of `scene`.
fn request(speeds: &[f64], scene: &[&Value], integration: Value) -> SweepRequest {
    let mut request = json!({
        "model": "test wheel", "modes_per_speed": 6, "max_engine_order": 8,
        "speeds": {"values": speeds, "unit": "rad_s"},
        "scene": {
            "damping": {"modal_ratio": 0.05},
            "casing": {"clearance": {"leading": 0.3, "trailing": 0.22},
                       "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
            "contact": {}
        },
        "integration": {"revolutions": 4, "window_revolutions": 2}
    });
    for fields in scene {
        merge(&mut request["scene"], (*fields).clone());
    }
    merge(&mut request["integration"], integration);
    serde_json::from_value(request).unwrap()
}

fn run(reduced: &ReducedSector, sector: &SectorModel, request: SweepRequest) -> SpeedResult {
    let request = resolve_sweep(request, &facts(sector)).unwrap();
    run_speed(reduced, &request, 0, None, &Unwatched).unwrap()
}

/// Every effect alone and every two together run with sound credentials, or are refused with the name of one of them.
#[test]
fn every_pair_of_effects_runs_or_is_refused_by_name() {
    let sector = sector();
    let (facts, reduced) = (facts(&sector), bending(reduced(&sector, 6)));
    let effects = effects();
    let mut refused = Vec::new();
    for (i, (a, fields)) in effects.iter().enumerate() {
        for (b, others) in &effects[i..] {
            if (*a, *b) == ("exact", "probe") {
                // This pair shares one field.
                continue;
            }
            match resolve_sweep(request(&[SPEED], &[fields, others], json!({})), &facts) {
                Err(violations) => {
                    let named = violations.iter().any(|v| {
                        let text = format!("{} {}", v.pointer, v.message);
                        text.contains(a) || text.contains(b) || text.contains("symmetry")
                    });
                    assert!(named, "{a} with {b}: {violations:?}");
                    refused.push((*a, *b));
                }
                Ok(request) => {
                    let result = run_speed(&reduced, &request, 0, None, &Unwatched).unwrap();
                    assert_sound(&result, length(&[a, b]));
                }
            }
        }
    }
    let expected = [
        ("friction", "geometric_nonlinearity"),
        ("disc", "abradable"),
        ("disc", "geometric_nonlinearity"),
        ("abradable", "exact"),
        ("mistuning", "exact"),
        ("mistuning", "probe"),
        ("orbit", "exact"),
        ("orbit", "probe"),
        ("initial", "probe"),
    ];
    assert_eq!(refused, expected);
}

/// Every effect changes the response: none is lost on its way from the request to the simulation.
#[test]
fn every_effect_changes_the_response() {
    let sector = sector();
    let reduced = bending(reduced(&sector, 6));
    let spectra =
        |scene: &[&Value]| run(&reduced, &sector, request(&[SPEED], scene, json!({}))).spectra.unwrap();
    let plain = spectra(&[]);
    for (name, fields) in effects() {
        // One part of the wheel gives the results of the whole.
        if name != "exact" {
            assert!(spectra(&[&fields]) != plain, "{name}");
        }
    }
}

/// Exact symmetry: one part of the wheel gives what repeats around it, so that the sub-wheel's spectra and credentials are the wheel's.
#[test]
fn exact_symmetry_says_what_the_whole_wheel_says() {
    let sector = sector();
    let reduced = bending(reduced(&sector, 6));
    let names = ["coriolis", "friction", "disc", "flexible_casing", "engine_order_excitation", "initial"];
    let all = effects();
    let alone = names.map(|name| vec![name]);
    let bent =
        [vec!["geometric_nonlinearity"], vec!["geometric_nonlinearity", "coriolis", "flexible_casing"]];
    for named in alone.iter().chain(&bent).chain([&Vec::new(), &names.to_vec()]) {
        let fields: Vec<_> = all.iter().filter(|(name, _)| named.contains(name)).map(|(_, f)| f).collect();
        let exact = json!({"symmetry": "exact"});
        let sensors = |mut request: SweepRequest| {
            request.sensors = serde_json::from_value(json!([
                {"contact_node": 0, "sector": 0, "component": "radial"},
                {"contact_node": 2, "sector": 5, "component": "axial"}]))
            .unwrap();
            request
        };
        let whole = run(&reduced, &sector, sensors(request(&[SPEED], &fields, json!({}))));
        let with_symmetry: Vec<_> = fields.iter().copied().chain([&exact]).collect();
        let part = run(&reduced, &sector, sensors(request(&[SPEED], &with_symmetry, json!({}))));
        assert_sound(&part, length(named));
        let difference = spectral_difference(&whole, &part);
        assert!(difference < 1e-9, "{named:?}: {difference:e}");
        let pairs = [
            (whole.point.contact_impulse, part.point.contact_impulse),
            (whole.point.largest_energy, part.point.largest_energy),
            (whole.point.casing_amplitude, part.point.casing_amplitude),
        ];
        for (whole, part) in pairs {
            let (whole, part) = (whole.unwrap_or(1.0), part.unwrap_or(1.0));
            assert!((part / whole - 1.0).abs() < 1e-9, "{named:?}: {whole} {part}");
        }
        let (whole, part) = (whole.spectra.unwrap(), part.spectra.unwrap());
        for (whole, part) in whole.sensors.iter().zip(&part.sensors) {
            let largest = whole.amplitude.iter().fold(0.0f64, |m, &a| m.max(a));
            assert_eq!(whole.nodal_diameters.len(), part.nodal_diameters.len());
            for (whole, part) in
                whole.nodal_diameters.iter().flatten().zip(part.nodal_diameters.iter().flatten())
            {
                assert!((whole - part).abs() < 1e-8 * largest, "{named:?}");
            }
        }
    }
}

/// Chain of speeds: a run cut in two at a whole revolution, the second half from the end of the first, is the run in one piece.
#[test]
fn a_chain_goes_on_where_its_neighbour_ended() {
    let sector = sector();
    let (facts, reduced) = (ModelFacts::of(&sector), reduced(&sector, 6));
    let damping = json!({"damping": {"modal_ratio": 0.01}});
    for scheme in ["central_differences", "exact_modal"] {
        let integration = |revolutions: u32| {
            json!({"scheme": scheme, "revolutions": revolutions, "window_revolutions": 1,
                   "steps_per_revolution": 7200})
        };
        let mut chained = request(&[SPEED, SPEED * (1.0 + 1e-12)], &[&damping], integration(3));
        chained.sweep = serde_json::from_value(json!("up")).unwrap();
        let chained = resolve_sweep(chained, &facts).unwrap();
        let first = run_speed(&reduced, &chained, 0, None, &Unwatched).unwrap();
        let state = first.end_state.unwrap();
        let second = run_speed(&reduced, &chained, 1, Some(&state), &Unwatched).unwrap();
        assert_sound(&second, 0.8);
        let whole = run(&reduced, &sector, request(&[SPEED], &[&damping], integration(6)));
        // Only contact that closes within the first step differs: a state does not have the contact that it is in.
        let difference = spectral_difference(&whole, &second);
        assert!(difference < 1e-5, "{scheme}: {difference:e}");
    }
}

/// Effects that begin anew at every speed cannot go on where the neighbour ended, so a chain with them is refused.
#[test]
fn a_chain_refuses_what_would_jump() {
    let facts = facts(&sector());
    let refused = effects().into_iter().filter_map(|(name, fields)| {
        let mut chained = request(&[SPEED, 1.01 * SPEED], &[&fields], json!({}));
        chained.sweep = serde_json::from_value(json!("down")).unwrap();
        let violations = resolve_sweep(chained, &facts).err()?;
        assert_eq!(violations[0].pointer, "/sweep");
        Some(name)
    });
    assert_eq!(
        refused.collect::<Vec<_>>(),
        ["abradable", "flexible_casing", "orbit", "clearance_change", "probe"]
    );
}

/// Numbers that would cost the memory, or mean another order, are refused at their place.
#[test]
fn what_would_mean_something_else_is_refused_at_its_place() {
    let facts = ModelFacts::of(&sector());
    let ring = json!({"flexible_casing": {"ring": {"radius": 70, "modulus": 2e5, "density": 8e-9, "area": 40,
                                                   "second_moment": 133, "n_max": 4294967295u32}}});
    let order = json!({"engine_order_excitation": [
        {"order": 9, "contact_nodes": [0], "component": "axial", "amplitude": 1.0}]});
    for (scene, pointer) in
        [(ring, "/scene/flexible_casing/ring/n_max"), (order, "/scene/engine_order_excitation/0/order")]
    {
        let violations = resolve_sweep(request(&[SPEED], &[&scene], json!({})), &facts).unwrap_err();
        assert_eq!(violations.iter().map(|v| v.pointer.as_str()).collect::<Vec<_>>(), [pointer]);
    }
}

/// Initial mode that would begin inside the casing: refused with the amplitude that fits.
#[test]
fn an_initial_mode_stays_within_the_clearance() {
    let sector = sector();
    let reduced = reduced(&sector, 6);
    let start = |amplitude: f64| {
        let scene = json!({"initial": {"nodal_diameter": 1, "family": 2, "amplitude": amplitude}});
        run(&reduced, &sector, request(&[SPEED], &[&scene], json!({}))).point
    };
    let message = start(5.0).message.unwrap();
    let (_, largest) = message.split_once("at most ").unwrap();
    let largest: f64 = largest.split(' ').next().unwrap().parse().unwrap();
    assert!(largest > 0.1 && largest < 5.0, "{message}");
    assert!(start(largest).message.is_none() && start(1.002 * largest).message.is_some());
}

/// Probe of symmetry: light damping lets a tiny asymmetry grow by the same rate whatever its size, heavy damping lets it
/// decay (docs/method.md, Symmetry).
#[test]
fn a_probe_finds_whether_symmetry_breaks() {
    let sector = wheel(WheelRecipe::default());
    let reduced = reduced(&sector, 6);
    let probe = |ratio: f64, amplitude: f64| {
        let scene = json!({"centrifugal_stiffening": true, "damping": {"modal_ratio": ratio}, "symmetry": "probe",
                           "probe": {"amplitude": amplitude}});
        let integration = json!({"revolutions": 14, "window_revolutions": 4});
        run(&reduced, &sector, request(&[SPEED], &[&scene], integration)).point.symmetry_breaking.unwrap()
    };
    for (ratio, grows) in [(0.05, false), (0.0, true)] {
        let [larger, smaller] = [1e-6, 1e-8].map(|amplitude| probe(ratio, amplitude));
        assert_eq!((larger.repeats, larger.nodal_diameters.as_slice()), (2, [1, 3, 5].as_slice()));
        assert_eq!((larger.grows, smaller.grows), (grows, grows));
        let [larger, smaller] = [larger, smaller].map(|found| found.rate_per_revolution.unwrap());
        assert!((larger / smaller - 1.0).abs() < 0.1, "{ratio}: {larger} {smaller}");
    }
}

/// Wheel that jams: too much friction for the geometry is refused before the job runs, with the coefficient that would pass.
/// Tips that a stiff strut lets move along one direction only, 60° backwards from outwards, dig in from tan 30° on.
#[test]
fn a_wheel_that_jams_is_refused_before_it_runs() {
    let recipe = WheelRecipe { sectors: 4, contact_nodes: 1, stiffening: false, ..WheelRecipe::default() };
    let mut sector = wheel(recipe).into_parts();
    let [r, theta, _] = sector.contact[0].dofs;
    let (sin, cos) = 60f64.to_radians().sin_cos();
    let strut = 1e10;
    let own = &mut sector.stiffness[0].own;
    for (row, column, value) in
        [(r, r, sin * sin), (r, theta, sin * cos), (theta, r, sin * cos), (theta, theta, cos * cos)]
    {
        *own.get_mut(row, column).unwrap() += strut * value;
    }
    let sector = SectorModel::new(sector).unwrap();
    let (facts, reduced) = (ModelFacts::of(&sector), reduced(&sector, 6));
    let try_with = |coefficient: f64, law: &str| {
        let scene = json!({"friction": {"coefficient": coefficient, "law": law}});
        let request = request(&[SPEED], &[&scene], json!({"scheme": "exact_modal"}));
        check(&reduced, &resolve_sweep(request, &facts).unwrap(), &Unwatched)
    };
    for law in ["sliding", "disc"] {
        let Err(AnalysisError::Refused(violations)) = try_with(0.7, law) else { panic!("it slides") };
        assert_eq!(violations[0].pointer, "/scene/friction/coefficient");
        let message = &violations[0].message;
        let largest: f64 = message.rsplit(' ').next().unwrap().parse().unwrap();
        assert!((largest - 30f64.to_radians().tan()).abs() < 2e-3, "{message}");
        assert!(message.contains("contact node 0") && try_with(largest, law).is_ok(), "{message}");
    }
}

/// Disc of friction: it has no tangent and needs mass at its tips, so `auto` keeps the mass, a periodic response that is asked for
/// is marched to, and the result says so. The share of sticking is reported for a disc only.
#[test]
fn a_disc_is_marched_with_mass_and_says_so() {
    let mut parts = sector().into_parts();
    // The strut is so stiff that no step resolves its mode.
    for stiffness in &mut parts.stiffness {
        let dof = parts.contact[0].dofs[2];
        *stiffness.own.get_mut(dof, dof).unwrap() += 1e11;
    }
    let sector = SectorModel::new(parts).unwrap();
    let reduced = reduced(&sector, 6);
    let of = |law: &str, integration: Value| {
        let scene = json!({"friction": {"coefficient": 0.05, "law": law}});
        run(&reduced, &sector, request(&[SPEED], &[&scene], integration)).point
    };
    let scheme = |point: &Point| point.scheme.as_ref().unwrap().name;
    let (sliding, disc) = (of("sliding", json!({})), of("disc", json!({})));
    assert_eq!(scheme(&sliding), SchemeChoice::MasslessBoundary);
    assert_eq!(scheme(&disc), SchemeChoice::ExactModal);
    assert!(
        disc.sticking_share.is_some_and(|share| (0.0..0.5).contains(&share)),
        "{:?}",
        disc.sticking_share
    );
    assert_eq!(sliding.sticking_share, None);
    let steady = of("disc", json!({"steady": "auto"})).steady.unwrap();
    assert!(!steady.taken && steady.reason.as_ref().unwrap().contains("disc"), "{steady:?}");
}
