//! Steady states under effects whose state is that of the oscillators.

use super::*;
use crate::dynamics::contact::coating::{Coating, CoatingMaterial};
use crate::dynamics::contact::friction::sliding_directions;
use crate::dynamics::effects::{Friction, FrictionLaw};
use crate::dynamics::excitation::EngineOrderExcitation;
use crate::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use crate::dynamics::integrate::revolutions_over_lobe;
use crate::dynamics::orbit::Orbit;

/// Effects of a scene.
#[derive(Debug, Clone, Copy, Default)]
struct Which {
    mistuning: bool,
    excitation: bool,
    coriolis: bool,
    friction: bool,
    /// Whirl ratio κ.
    orbit: Option<f64>,
    casing: bool,
}

const NONE: Which = Which {
    mistuning: false,
    excitation: false,
    coriolis: false,
    friction: false,
    orbit: None,
    casing: false,
};

const CASES: [Which; 9] = [
    Which { mistuning: true, ..NONE },
    Which { excitation: true, ..NONE },
    Which { coriolis: true, ..NONE },
    Which { friction: true, ..NONE },
    Which { orbit: Some(0.0), ..NONE },
    Which { orbit: Some(0.5), ..NONE },
    Which {
        mistuning: true,
        excitation: true,
        coriolis: true,
        friction: true,
        orbit: Some(-1.0),
        casing: false,
    },
    Which { casing: true, ..NONE },
    Which {
        mistuning: true,
        excitation: true,
        coriolis: true,
        friction: true,
        orbit: Some(-1.0),
        casing: true,
    },
];

/// Scene that owns its effects, too.
struct Affected {
    scene: Scene,
    deviations: Option<Vec<f64>>,
    excitation: Vec<EngineOrderExcitation>,
    sliding: Option<Vec<Direction>>,
    orbit: Option<Orbit>,
    casing: Option<FlexibleCasing>,
}

/// Waves of a casing: breathing, bending that meets both lobes alike, bending that does not, and waves that the sectors cannot tell from another.
const WAVES: [CasingWave; 4] = [
    CasingWave { nodal_diameter: 0, omega: 9000.0, modal_mass: 1e-3 },
    CasingWave { nodal_diameter: 2, omega: 3100.0, modal_mass: 2e-3 },
    CasingWave { nodal_diameter: 3, omega: 4700.0, modal_mass: 2e-3 },
    CasingWave { nodal_diameter: 8, omega: 11000.0, modal_mass: 1e-3 },
];

const FRICTION: f64 = 0.1;

impl Affected {
    fn new(which: Which, sectors: usize, damping: f64, scheme: Scheme) -> Self {
        let mut scene = Scene::new(sectors, 2, damping, scheme);
        let mut numbers = Numbers(17);
        if which.coriolis {
            add_coriolis(&mut scene.wheel);
        }
        let excitation = EngineOrderExcitation {
            order: 3,
            directions: vec![Direction { node: 1, components: [0.3, 0.9, 0.1] }],
            amplitude: 60.0,
            phase_rad: 0.4,
            // Grows for longer than the casing.
            ramp_revolutions: 2.5,
        };
        Self {
            deviations: which.mistuning.then(|| (0..sectors).map(|_| 0.05 * numbers.next()).collect()),
            excitation: if which.excitation { vec![excitation] } else { Vec::new() },
            sliding: which.friction.then(|| sliding_directions(&scene.nodes, FRICTION).unwrap()),
            orbit: which.orbit.map(|whirl_ratio| Orbit { radius: 0.04, whirl_ratio, phase_rad: 0.7 }),
            casing: which.casing.then(|| FlexibleCasing { waves: WAVES.to_vec(), damping_ratio: damping }),
            scene,
        }
    }

    fn simulation(&self) -> Simulation<'_> {
        let friction = |directions| Friction { coefficient: FRICTION, law: FrictionLaw::Sliding, directions };
        let effects = Effects {
            mistuning: self.deviations.as_deref(),
            excitation: &self.excitation,
            friction: self.sliding.as_deref().map(friction),
            orbit: self.orbit,
            flexible_casing: self.casing.as_ref(),
            ..Effects::default()
        };
        Simulation { effects, ..self.scene.simulation() }
    }

    /// State after a march from rest.
    fn march(&self, revolutions: usize, passage: &mut Passage<'_>) -> Vec<f64> {
        let history = ends(Simulation { revolutions, ..self.simulation() }.run(&|_| true));
        passage.state(&history.end, &history.casing_end)
    }
}

/// Adds random g to every nodal diameter, skew-Hermitian, a few tenths of the frequencies over Ω.
fn add_coriolis(wheel: &mut ModalWheel) {
    let mut numbers = Numbers(29);
    for harmonic in &mut wheel.harmonics {
        let single = harmonic.single;
        let full = Mat::from_fn(MODES, MODES, |_, _| {
            let (re, im) = (numbers.next(), numbers.next());
            c64::new(re, if single { 0.0 } else { im })
        });
        harmonic.gyroscopic = Some(Mat::from_fn(MODES, MODES, |i, j| full[(i, j)] - full[(j, i)].conj()));
    }
}

fn ends(run: Run) -> History {
    match run.outcome {
        Outcome::Completed(history) => history,
        other => panic!("{other:?}"),
    }
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    length(&difference(a, b)) / length(b)
}

/// Recurrences found by hand: the scene is the same after these steps of 3600, with the number of every sector moved by so many.
#[test]
fn passages_are_the_shortest_that_the_whole_scene_allows() {
    let of = |which, change: &dyn Fn(&mut Affected)| {
        let mut affected = Affected::new(which, 6, 0.1, Scheme::ExactModal);
        change(&mut affected);
        let simulation = affected.simulation();
        let shortest = Passage::shortest(&simulation).unwrap();
        let lobe = Passage::over_lobes(&simulation, 1).unwrap().steps();
        let orders = affected.excitation.iter().map(|excitation| excitation.order);
        let planned = revolutions_over_lobe(Some(2), orders, which.orbit);
        assert_eq!(lobe, (planned * STEPS as f64) as usize);
        (shortest.steps(), lobe, shortest.whole())
    };
    let as_it_is = |which| of(which, &|_| {});
    assert_eq!(as_it_is(NONE), (600, 1800, 3600));
    assert_eq!(as_it_is(Which { friction: true, coriolis: true, ..NONE }), (600, 1800, 3600));
    assert_eq!(as_it_is(Which { mistuning: true, ..NONE }), (1800, 1800, 3600));
    let repeated = |affected: &mut Affected| affected.deviations = Some([0.01, -0.02].repeat(3));
    assert_eq!(of(Which { mistuning: true, ..NONE }, &repeated), (600, 1800, 3600));
    // Order 3 tells two lobes apart, order 4 does not.
    assert_eq!(as_it_is(Which { excitation: true, ..NONE }), (600, 3600, 3600));
    let fourth = |affected: &mut Affected| affected.excitation[0].order = 4;
    assert_eq!(of(Which { excitation: true, ..NONE }, &fourth), (600, 1800, 3600));
    assert_eq!(as_it_is(Which { excitation: true, mistuning: true, ..NONE }), (3600, 3600, 3600));
    // A bump at rest; one that turns with the wheel; one that stands opposite after a revolution; one that is back after three.
    assert_eq!(as_it_is(Which { orbit: Some(0.0), ..NONE }), (600, 3600, 3600));
    assert_eq!(as_it_is(Which { orbit: Some(1.0), ..NONE }), (1800, 1800, 3600));
    assert_eq!(as_it_is(Which { orbit: Some(0.5), ..NONE }), (3600, 7200, 7200));
    assert_eq!(as_it_is(Which { orbit: Some(1.0 / 3.0), ..NONE }), (5400, 10800, 10800));
}

#[test]
fn what_never_repeats_is_refused_and_says_why() {
    let refused = |whirl_ratio: f64| {
        let affected = Affected::new(Which { orbit: Some(whirl_ratio), ..NONE }, 6, 0.1, Scheme::ExactModal);
        Passage::shortest(&affected.simulation()).unwrap_err().to_string()
    };
    assert!(refused(0.47).contains("whirl ratio 0.47 does not come round within 8 revolutions"));
    let scene = Scene::new(6, 2, 0.1, Scheme::ExactModal);
    let material = CoatingMaterial { modulus: 100.0, yield_stress: 1.0, hardening: 10.0 };
    let coating = Coating::new(material, 0.1, 500, &scene.nodes, 6).unwrap();
    let effects = Effects { coating: Some(&coating), ..Effects::default() };
    let refused = Passage::over_lobes(&Simulation { effects, ..scene.simulation() }, 1).unwrap_err();
    assert_eq!(refused, PassageError::Coating);
}

/// Map against a run: over all revolutions after which the scene is the same again, in one piece and in pieces that renumber the sectors.
#[test]
fn passages_go_where_runs_go() {
    for scheme in SCHEMES {
        for which in CASES {
            let affected = Affected::new(which, 6, 0.1, scheme);
            let simulation = affected.simulation();
            let mut short = Passage::shortest(&simulation).unwrap();
            let (pieces, period) = (short.whole() / short.steps(), short.whole() / STEPS);
            let begin = short.grown() + period;
            let [before, after] =
                [begin, begin + period].map(|revolutions| affected.march(revolutions, &mut short));
            let mut image = before.clone();
            for _ in 0..pieces {
                image = short.map(&image).unwrap();
            }
            assert!(!short.trace().instants.is_empty(), "nothing touches");
            if which.casing {
                let own = &after[short.unknowns().len()..after.len() / 2];
                assert!(length(own) > 1e-2 * length(&after), "the casing rests: {own:?}");
            }
            let mut whole = Passage::over_lobes(&simulation, short.lobes()).unwrap();
            let at_once = whole.map(&before).unwrap();
            // Round-off of the velocities that a march ends with, 1e-16/ωh of them, and of some thousand steps.
            assert!(off(&image, &after) < 1e-10, "{scheme:?} {which:?}: {:e}", off(&image, &after));
            assert!(off(&at_once, &after) < 1e-10, "{scheme:?} {which:?}: {:e}", off(&at_once, &after));
        }
    }
}

/// Derivative within a sequence of sets that touch, where it is exact: up to round-off of differences, 1e-16/1e-7, and of the map.
#[test]
fn tangents_under_effects_are_the_limit_of_differences() {
    for scheme in SCHEMES {
        for which in CASES {
            for sectors in [6, 5] {
                let affected = Affected::new(which, sectors, 0.02, scheme);
                let simulation = affected.simulation();
                let mut passage = Passage::shortest(&simulation).unwrap();
                let state = affected.march(4, &mut passage);
                passage.map(&state).unwrap();
                let instants = passage.trace().instants.clone();
                assert!(!instants.is_empty(), "nothing touches");
                let mut numbers = Numbers(7);
                let direction: Vec<f64> = state.iter().map(|_| numbers.next()).collect();
                let mut moved = direction.clone();
                Tangent::of(&passage).follow(&mut moved);
                let epsilon = 1e-7 * length(&state) / length(&direction);
                let mut aside = |by: f64| {
                    let state: Vec<f64> = state.iter().zip(&direction).map(|(x, v)| x + by * v).collect();
                    let image = passage.map(&state).unwrap();
                    assert!(passage.trace().instants == instants, "a set changed: take another direction");
                    image
                };
                let slope: Vec<f64> = difference(&aside(epsilon), &aside(-epsilon))
                    .iter()
                    .map(|x| x / (2.0 * epsilon))
                    .collect();
                assert!(
                    off(&slope, &moved) < 1e-6,
                    "{scheme:?} {which:?} {sectors}: {:e}",
                    off(&slope, &moved)
                );
            }
        }
    }
}

/// Run that begins with a response found: it goes on in the response from its first sample on, and motions that start beside it join or
/// leave it at the rate of its largest multiplier.
#[test]
fn responses_under_effects_repeat_and_attract_as_their_multipliers_say() {
    let mut stable = 0;
    for scheme in SCHEMES {
        for which in CASES {
            let mut affected = Affected::new(which, 6, 0.15, scheme);
            let mut passage = Passage::shortest(&affected.simulation()).unwrap();
            let rest = vec![0.0; passage.size()];
            let found = find(&mut passage, &rest, &SEARCH, &|| true).unwrap();
            passage.map(&found.state).unwrap();
            let growth = multipliers(&Tangent::of(&passage), 4, &rest)[0].value.norm();
            stable += usize::from(growth < 1.0);
            let (rate, passages) = rate_beside(&mut passage, &found.state, growth);
            // Whatever turns or is not normal makes it larger or smaller by a factor, below three, that passages share: some fall by 1e-4
            // in three of them.
            let told = 0.05f64.max(3f64.ln() / passages as f64);
            assert!((rate / growth).ln().abs() < told, "{scheme:?} {which:?}: {rate} for {growth}");

            let (start, period) = (passage.stepped(&found.state), passage.whole() / STEPS);
            if let Some(casing) = &mut affected.scene.casing {
                casing.ramp_revolutions = 0.0;
            }
            affected.excitation.iter_mut().for_each(|excitation| excitation.ramp_revolutions = 0.0);
            let sensors =
                [SensorRow { direction: Direction { node: 0, components: [0.8, 0.0, 0.6] }, sector: 0 }];
            let simulation = Simulation {
                sensors: &sensors,
                samples_per_revolution: 360,
                revolutions: 2 * period,
                ..affected.simulation()
            };
            let history = ends(simulation.go_on(&start, &|_| true));
            let (first, second) = history.displacement[0].split_at(360 * period);
            // Round-off of energies is millionths of a high mode's displacement; unstable ones add up.
            assert!(off(first, second) < 1e-8, "{scheme:?} {which:?}: {:e}", off(first, second));
            let end = Passage::shortest(&simulation).unwrap().state(&history.end, &history.casing_end);
            assert!(off(&end, &found.state) < 1e-8, "{scheme:?} {which:?}: {:e}", off(&end, &found.state));
        }
    }
    assert!(stable > SCHEMES.len() * CASES.len() / 2, "{stable} stable responses");
}

/// Stable responses that are reached: a march of 400 revolutions ends there, which sensors show to 1e-8 in energies, and to what stiff
/// contact makes of it.
#[test]
fn responses_under_effects_are_where_long_marches_end() {
    let mut reached = 0;
    for scheme in SCHEMES {
        for which in CASES {
            let affected = Affected::new(which, 6, 0.15, scheme);
            let normal = Direction { node: 0, components: [0.8, 0.0, 0.6] };
            let sensors = [SensorRow { direction: normal, sector: 0 }];
            let simulation = Simulation {
                sensors: &sensors,
                samples_per_revolution: 360,
                revolutions: 7,
                window_revolutions: 2,
                ..affected.simulation()
            };
            let sought = seek(&simulation, 100, true, &|| true);
            let Ok(response) = sought.response else { panic!("{scheme:?} {which:?}: {:?}", sought.response) };
            if response.arrives != Some(true) {
                continue;
            }
            reached += 1;
            let long = ends(Simulation { revolutions: 401, ..simulation }.run(&|_| true));
            let recorded = ends(record(&simulation, &response, &|_| true));
            assert_eq!((recorded.displacement[0].len(), recorded.window[0].len()), (7 * 360, 2 * 360));
            let largest = long.window[0].iter().fold(0.0f64, |most, x| most.max(x.abs()));
            for (from, to) in [(&long.displacement, &recorded.displacement), (&long.window, &recorded.window)]
            {
                let last = |line: &[f64]| line[line.len() - 720..].to_vec();
                let off = difference(&last(&from[0]), &last(&to[0]));
                let off = off.into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
                assert!(off < 1e-6 * largest, "{scheme:?} {which:?}: {off:e} of {largest:e}");
            }
        }
    }
    assert!(reached > SCHEMES.len() * CASES.len() / 2, "{reached} reached");
}

/// Wheel without contact: e^{λT} of the wheel as one matrix, z̈ + (D + Ωg) ż + (ω² + M) z = 0, mistuning being written sector by sector.
/// The error of the coupling by steps is of second order in h, so that half of h leaves a quarter of it.
#[test]
fn a_free_wheel_that_is_mistuned_and_turns_has_the_multipliers_of_its_matrix() {
    for scheme in SCHEMES {
        for (mistuning, coriolis) in [(true, false), (false, true), (true, true)] {
            let which = Which { mistuning, coriolis, ..NONE };
            let affected = Affected::new(which, 6, 0.01, scheme);
            let exact = matrix_multipliers(&affected);
            let errors = [STEPS, 2 * STEPS].map(|steps_per_revolution| {
                let simulation = Simulation { casing: None, steps_per_revolution, ..affected.simulation() };
                let passage = Passage::over_lobes(&simulation, 1).unwrap();
                let start = vec![1.0; passage.size()];
                let found = multipliers(&Tangent::of(&passage), passage.size(), &start);
                assert_eq!((found.len(), exact.len()), (passage.size(), passage.size()));
                let nearest = |exact: &c64| {
                    let distances = found.iter().map(|one| (one.value - exact).norm());
                    distances.fold(f64::INFINITY, f64::min)
                };
                exact.iter().map(nearest).fold(0.0, f64::max)
            });
            let [coarse, fine] = errors;
            assert!(coarse < 2e-2, "{scheme:?} {which:?}: {coarse:e}");
            assert!((coarse / fine - 4.0).abs() < 0.4, "{scheme:?} {which:?}: {coarse:e} {fine:e}");
        }
    }
}

/// Multipliers e^{λT} of a revolution, of the modes that the scheme integrates.
fn matrix_multipliers(affected: &Affected) -> Vec<c64> {
    let Scene { wheel, damping, scheme, .. } = &affected.scene;
    let kept = scheme.integrated_modes(MODES);
    let mut unknowns: Vec<(usize, usize, c64)> = Vec::new();
    for (harmonic, modes) in wheel.harmonics.iter().enumerate() {
        let parts = if modes.single { vec![c64::ONE] } else { vec![c64::ONE, c64::new(0.0, 1.0)] };
        unknowns
            .extend((0..kept).flat_map(|m| parts.clone().into_iter().map(move |part| (harmonic, m, part))));
    }
    // a_s of family m per unit unknown.
    let last = wheel.harmonics.last().unwrap();
    let amplitude = |sector: usize, (harmonic, m, part): (usize, usize, c64)| {
        let modes = &wheel.harmonics[harmonic];
        let alike: c64 =
            (0..3 * NODES).map(|row| last.contact[(row, m)].conj() * modes.contact[(row, m)]).sum();
        let weight = if modes.single { 1.0 } else { 2.0f64.sqrt() } / (wheel.sectors as f64).sqrt();
        let angle = TAU * (harmonic * sector) as f64 / wheel.sectors as f64;
        (c64::from_polar(weight * modes.omega[m], angle) * alike / alike.norm() * part).re
    };
    let n = unknowns.len();
    let deviations = affected.deviations.clone().unwrap_or_else(|| vec![0.0; wheel.sectors]);
    let matrix = Mat::from_fn(2 * n, 2 * n, |i, j| {
        if i < n {
            return if j == i + n { 1.0 } else { 0.0 };
        }
        let ((harmonic, m, part), (other, family, from)) = (unknowns[i - n], unknowns[j % n]);
        let omega = wheel.harmonics[harmonic].omega[m];
        let same = if i - n == j % n { 1.0 } else { 0.0 };
        if j >= n {
            let g = wheel.harmonics[harmonic].gyroscopic.as_ref().filter(|_| harmonic == other);
            let force = g.map_or(0.0, |g| (part.conj() * g[(m, family)] * from).re);
            return -2.0 * damping.ratio(harmonic, m) * omega * same - SPEED * force;
        }
        let coupled = |(sector, delta): (usize, &f64)| {
            delta * amplitude(sector, unknowns[i - n]) * amplitude(sector, unknowns[j])
        };
        let stiffness: f64 = deviations.iter().enumerate().map(coupled).sum();
        -omega * omega * same - if m == family { stiffness } else { 0.0 }
    });
    matrix.eigenvalues().unwrap().into_iter().map(|lambda| (lambda * (TAU / SPEED)).exp()).collect()
}
