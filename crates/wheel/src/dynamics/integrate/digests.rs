//! Digests of scenes without effects, on every kind of vectors of this machine: bits that an effect may never change.

use faer::{Mat, c64};
use pulp::Arch;
use sha2::{Digest, Sha256};

use super::super::casing::{Casing, Lobes};
use super::super::direction::Direction;
use super::super::effects::Effects;
use super::super::initial::InitialMode;
use super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::super::numbers::Numbers;
use super::super::oscillators::ModalDamping;
use super::super::schemes::Scheme;
use super::super::sector::ContactNode;
use super::run::Outcome;
use super::simulation::{SensorRow, Simulation};
use crate::revision::REVISION;

const SECTORS: usize = 5;
const NODES: usize = 3;
const MODES: usize = 11;

fn wheel() -> ModalWheel {
    let mut numbers = Numbers(0x9E37_79B9_7F4A_7C15);
    let harmonic = |harmonic: usize| {
        let single = harmonic == 0;
        let omega = (0..MODES).map(|m| 4000.0 * (1 + m) as f64 + 500.0 * harmonic as f64).collect();
        let contact = Mat::from_fn(3 * NODES, MODES, |_, _| {
            let (re, im) = (numbers.next(), numbers.next());
            c64::new(100.0 * re, if single { 0.0 } else { 100.0 * im })
        });
        ModalHarmonic { harmonic, single, omega, contact, gyroscopic: None }
    };
    ModalWheel {
        speed_rad_s: 1000.0,
        sectors: SECTORS,
        repeats: 1,
        harmonics: (0..=SECTORS / 2).map(harmonic).collect(),
    }
}

fn digest(arch: Arch, scheme: Scheme, damped: bool, touching: bool) -> String {
    let wheel = wheel();
    let node = |k: usize| ContactNode {
        id: k as u64,
        position: [100.0, 0.03 * k as f64, 4.0 * k as f64],
        normal: [0.8, 0.0, 0.6],
        dofs: [3 * k, 3 * k + 1, 3 * k + 2],
    };
    let contact_nodes: Vec<_> = (0..NODES).map(node).collect();
    let casing = Casing {
        clearance: vec![0.25, 0.3, 0.35],
        restriction: Some(Lobes { count: 2, amplitude: 0.5, width_rad: 0.4, phase_rad: 0.1 }.into()),
        ramp_revolutions: 0.5,
    };
    let damping = ModalDamping { modal_ratio: 0.01, family_ratios: vec![0.005], ranks: Vec::new() };
    let push = InitialMode {
        harmonic: 1,
        family: 2,
        displacement: c64::new(1e-4, -2e-4),
        velocity: c64::new(0.5, 0.25),
    };
    let sensor = |node| SensorRow { direction: Direction { node, components: [1.0, 0.25, 0.5] }, sector: 3 };
    let run = Simulation {
        wheel: &wheel,
        contact_nodes: &contact_nodes,
        damping: damped.then_some(&damping),
        casing: touching.then_some(&casing),
        effects: Effects::default(),
        initial: &[push],
        sensors: &[sensor(0), sensor(2)],
        scheme,
        steps_per_revolution: 600,
        samples_per_revolution: 120,
        revolutions: 2,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: None,
    }
    .run_on(arch, &|_| true);
    let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
    assert_eq!(run.statistics.contact_impulse > 0.0, touching);
    let mut hash = Sha256::new();
    let lines = history.displacement.iter().chain(history.harmonics.iter().flatten());
    let credentials = [
        run.statistics.contact_impulse,
        run.energy.residual(),
        run.energy.largest_energy(),
        run.energy.loss(),
    ];
    for value in lines.flatten().chain(&credentials) {
        hash.update(value.to_bits().to_le_bytes());
    }
    hash.finalize().iter().take(6).map(|byte| format!("{byte:02x}")).collect()
}

/// Digests of every scheme: free, touching, touching and damped.
fn digests(arch: Arch) -> Vec<String> {
    let schemes =
        [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 5 }];
    let cases = [(false, false), (false, true), (true, true)];
    schemes
        .into_iter()
        .flat_map(|scheme| cases.map(|(damped, touching)| digest(arch, scheme, damped, touching)))
        .collect()
}

/// Digests stored when there were no effects but the casing, contact and damping, and once more when spectra were no longer taken from
/// single steps; displacements have kept their bits. Vectors of another width add up in another order, so each kind has its own; on a
/// machine that has none of them there is nothing to compare with.
#[test]
fn scenes_without_effects_keep_their_bits() {
    let stored: [(&str, [&str; 9]); 3] = [
        (
            "Scalar",
            [
                "d1a16852c911",
                "030b94a4071a",
                "46f8133de381",
                "7f91886cb2d1",
                "48508e3af3cc",
                "8e02a3077058",
                "7f91886cb2d1",
                "8b711794fb02",
                "463e4a83a0b9",
            ],
        ),
        (
            "V3",
            [
                "7a46a044e1be",
                "4e24cd67b651",
                "bdfc746f801c",
                "0dd7e2765a14",
                "f39afd967992",
                "16b5bc1d020a",
                "0dd7e2765a14",
                "6830c5c8d85b",
                "f475aeb01979",
            ],
        ),
        (
            "V4",
            [
                "7a46a044e1be",
                "702b9e777bd1",
                "2666165716cf",
                "0dd7e2765a14",
                "9a1b12f14851",
                "1bc839e4cb7a",
                "0dd7e2765a14",
                "2c00a550584b",
                "31e169e3c719",
            ],
        ),
    ];
    let mut here = vec![Arch::Scalar];
    #[cfg(target_arch = "x86_64")]
    {
        here.extend(pulp::x86::V3::try_new().map(Arch::V3));
        here.extend(pulp::x86::V4::try_new().map(Arch::V4));
    }
    let found: Vec<_> = here.into_iter().map(digests).collect();
    for (found, (name, stored)) in found.iter().zip(&stored) {
        assert_eq!(found, stored, "{name}");
    }
}

/// Digest of all digests on scalars, by revision, to tell stored results that are computed again from those that are not. With revision 3
/// only scenes with effects got other numbers, with revision 4 reduced wheels, with revision 5 tilted casings,
/// with revision 6 damping by family and what peaks are refined, with revision 7 blades that bend far.
const REVISIONS: [(u32, &str); 7] = [
    (1, "26adde97b1eb"),
    (2, "c9e231fca210"),
    (3, "c9e231fca210"),
    (4, "c9e231fca210"),
    (5, "c9e231fca210"),
    (6, "c9e231fca210"),
    (7, "c9e231fca210"),
];

#[test]
fn other_numbers_have_another_revision() {
    let mut hash = Sha256::new();
    digests(Arch::Scalar).iter().for_each(|digest| hash.update(digest));
    let digest: String = hash.finalize().iter().take(6).map(|byte| format!("{byte:02x}")).collect();
    let (revision, known) = REVISIONS[REVISIONS.len() - 1];
    assert_eq!(digest, known, "the numbers changed: raise REVISION and add a line here");
    assert_eq!(revision, REVISION);
    assert!(REVISIONS.is_sorted_by(|a, b| a.0 < b.0));
}
