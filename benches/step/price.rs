//! Price list: cost of a step with each effect of a scene, beside the scene without.

use rubmap::dynamics::bending::{Bending, BladeBending};
use rubmap::dynamics::clearance_change::ClearanceChange;
use rubmap::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap::dynamics::contact::disc::disc_directions;
use rubmap::dynamics::contact::friction::sliding_directions;
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::{Effects, Friction, FrictionLaw};
use rubmap::dynamics::euler::{EulerForce, SpeedRate, StraightRate};
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::flexible_casing::{FlexibleCasing, Ring};
use rubmap::dynamics::integrate::{Outcome, Simulation};
use rubmap::dynamics::mistuning::normal_deviations;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::orbit::Orbit;

use crate::scene::{SPEED, Scene, Stepping, TOUCHING, name, radial};
use crate::timing::{Contender, medians, timed};

const ROUNDS: usize = 7;
const REVOLUTIONS: usize = 6;
/// Modes per speed: 900 unknowns with one stiffness matrix.
const MODES: usize = 60;

pub(crate) fn measure() {
    let scene = Scene::gyroscopic(MODES, 1);
    let contact = &scene.reduced.wheel.contact;
    let sectors = scene.modal.sectors;
    let turning = ModalWheel::at(
        &scene.reduced.wheel,
        SPEED,
        RotationEffects { stiffening: scene.stiffening, coriolis: true },
    )
    .expect("the default impeller is sound");
    let sliding = sliding_directions(contact, 0.1).expect("its tips can slide");
    let planes = disc_directions(contact).expect("its tips can slide");
    let material = CoatingMaterial { modulus: 2000.0, yield_stress: 5.0, hardening: 200.0 };
    let coating = Coating::new(material, 2.0, 2000, contact, sectors).expect("a coating");
    let radius = contact.iter().map(|node| node.position[0]).fold(0.0, f64::max);
    let ring = Ring { radius, modulus: 2.1e5, density: 7.8e-9, area: 400.0, second_moment: 13_000.0 };
    let casing = FlexibleCasing { waves: ring.waves(8), damping_ratio: 0.01 };
    let deviations = normal_deviations(0.02, 1, sectors);
    let excitation = [EngineOrderExcitation {
        order: 4,
        directions: vec![Direction { node: 0, components: [0.0, 0.0, 1.0] }],
        amplitude: 1.0,
        phase_rad: 0.0,
        ramp_revolutions: 1.0,
    }];
    let friction = Some(Friction { coefficient: 0.1, law: FrictionLaw::Sliding, directions: &sliding });
    let disc = Some(Friction { coefficient: 0.1, law: FrictionLaw::Disc, directions: &planes });
    let orbit = Some(Orbit { radius: 0.02, whirl_ratio: 0.4, phase_rad: 0.0 });
    let change = ClearanceChange { course: vec![(1.0, 0.01), (2.0, -0.01)], along_chord: None };
    let clearance_change = Some(&change);
    let euler = EulerForce {
        rate: SpeedRate(vec![StraightRate { revolutions: [0.0, REVOLUTIONS as f64], rad_s2: [100.0; 2] }]),
        load: vec![1.0; scene.modal.harmonics[0].omega.len()],
    };
    let euler_force = Some(&euler);
    // Coordinates are the displacements of the first contact nodes.
    let blade = BladeBending::alike(4, contact.len(), Vec::new(), 1e-5);
    let [kinematics, full] =
        [false, true].map(|stiffens| Some(Bending { blade: &blade, first: 0, stiffens }));
    let none = Effects::default();
    let all = Effects {
        friction,
        coating: Some(&coating),
        flexible_casing: Some(&casing),
        orbit,
        clearance_change,
        clearance_drift: None,
        mistuning: Some(&deviations),
        bending: None,
        excitation: &excitation,
        euler_force,
        energies: false,
    };
    let [central, exact, massless] = scene.schemes();
    let entries = [
        ("no effect", exact, &scene.modal, none),
        ("no effect", central, &scene.modal, none),
        ("no effect", massless, &scene.modal, none),
        ("friction", exact, &scene.modal, Effects { friction, ..none }),
        ("friction, disc", exact, &scene.modal, Effects { friction: disc, ..none }),
        ("abradable", exact, &scene.modal, Effects { coating: Some(&coating), ..none }),
        ("flexible_casing", exact, &scene.modal, Effects { flexible_casing: Some(&casing), ..none }),
        ("orbit", exact, &scene.modal, Effects { orbit, ..none }),
        ("clearance_change", exact, &scene.modal, Effects { clearance_change, ..none }),
        ("mistuning", exact, &scene.modal, Effects { mistuning: Some(&deviations), ..none }),
        ("geometric_nonlinearity, kinematics", exact, &scene.modal, Effects { bending: kinematics, ..none }),
        ("geometric_nonlinearity, full", exact, &scene.modal, Effects { bending: full, ..none }),
        ("engine_order_excitation", exact, &scene.modal, Effects { excitation: &excitation, ..none }),
        ("euler_force", exact, &scene.modal, Effects { euler_force, ..none }),
        ("coriolis", exact, &turning, none),
        ("coriolis, euler_force", exact, &turning, Effects { euler_force, ..none }),
        ("all together", exact, &turning, all),
    ];
    // These entries are no effects of the scene: they record spectra of it.
    let spectra = [("spectra of one sensor, in the window", 1), ("spectra of four", 4)];
    let mut shares = vec![0.0; entries.len()];
    let mut contenders: Vec<Contender<'_>> = Vec::new();
    for ((_, stepping, wheel, effects), share) in entries.iter().zip(&mut shares) {
        let scene = &scene;
        contenders.push(Box::new(move || {
            let (seconds, contact_share) = run(scene, *stepping, wheel, *effects, None);
            *share = contact_share;
            seconds
        }));
    }
    for (_, sensors) in spectra {
        let scene = &scene;
        contenders.push(Box::new(move || run(scene, exact, &scene.modal, none, Some(sensors)).0));
    }
    let times = medians(ROUNDS, &mut contenders);
    drop(contenders);
    println!(
        "\nPrice list: {} unknowns, {sectors} × {} contact nodes, two lobes, {REVOLUTIONS} revolutions with their set-up. \
         `centrifugal_stiffening`, `initial` and `symmetry: probe` cost nothing in a step; `symmetry: exact` leaves a fraction of the \
         unknowns.\n",
        scene.modal.unknowns(),
        contact.len()
    );
    println!("| effect | scheme | steps/rev | contact | ns/step | over none |");
    println!("|---|---|---|---|---|---|");
    for (((label, stepping, ..), share), time) in entries.iter().zip(&shares).zip(&times) {
        println!(
            "| {label} | {} | {} | {share:.2} | {:.0} | {:.2} |",
            name(stepping.scheme),
            stepping.steps,
            1e9 * time,
            time / times[0]
        );
    }
    for ((label, _), time) in spectra.iter().zip(&times[entries.len()..]) {
        println!(
            "| {label} | {} | {} | | {:.0} | {:.2} |",
            name(exact.scheme),
            exact.steps,
            1e9 * time,
            time / times[0]
        );
    }
}

/// Seconds per step of a whole run, with spectra of so many sensors over all of it, and the share of steps with contact.
fn run(
    scene: &Scene,
    stepping: Stepping,
    wheel: &ModalWheel,
    effects: Effects<'_>,
    spectra: Option<usize>,
) -> (f64, f64) {
    let casing = scene.casing(TOUCHING);
    let sensors = vec![radial(0, 0); spectra.unwrap_or(1)];
    let simulation = Simulation {
        wheel,
        effects,
        revolutions: REVOLUTIONS,
        window_revolutions: spectra.map_or(0, |_| REVOLUTIONS),
        ..scene.simulation(stepping, &casing, &sensors)
    };
    let (run, time) = timed(|| simulation.run(&|_| true));
    assert!(matches!(run.outcome, Outcome::Completed(_)), "{:?}", run.outcome);
    (time / run.statistics.steps as f64, run.statistics.contact_share())
}
