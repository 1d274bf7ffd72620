mod doubling;
mod effects;

use std::f64::consts::TAU;

use faer::{Mat, MatMut, c64};

use super::multipliers::{MOST_PRODUCTS, multipliers};
use super::periodic::{MOST_BEYOND, Search, find};
use super::response::{Sought, record, seek};
use super::stability::Stability;
use super::tangent::Tangent;
use crate::dynamics::casing::{Casing, Lobes};
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::Effects;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::integrate::{
    Detail, History, LEAST_MARCHED, Outcome, Passage, PassageError, Repeated, Repeats, Revolutions, Run,
    SensorRow, Simulation,
};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::numbers::Numbers;
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

const NODES: usize = 2;
const MODES: usize = 5;
const SPEED: f64 = 1000.0;
const STEPS: usize = 3600;
const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 3 }];

fn wheel(sectors: usize) -> ModalWheel {
    let mut numbers = Numbers(0x9E37_79B9_7F4A_7C15);
    let harmonic = |harmonic: usize| {
        let single = harmonic == 0 || 2 * harmonic == sectors;
        let omega = (0..MODES).map(|m| 2700.0 * (1 + m) as f64 + 300.0 * harmonic as f64).collect();
        let contact = Mat::from_fn(3 * NODES, MODES, |_, _| {
            let (re, im) = (numbers.next(), numbers.next());
            c64::new(50.0 * re, if single { 0.0 } else { 50.0 * im })
        });
        ModalHarmonic { harmonic, single, omega, contact, gyroscopic: None }
    };
    let harmonics = (0..=sectors / 2).map(harmonic).collect();
    ModalWheel { speed_rad_s: SPEED, sectors, repeats: 1, harmonics }
}

/// Scene that owns what a simulation borrows.
struct Scene {
    wheel: ModalWheel,
    nodes: Vec<ContactNode>,
    casing: Option<Casing>,
    damping: ModalDamping,
    scheme: Scheme,
}

impl Scene {
    fn new(sectors: usize, lobes: u32, damping: f64, scheme: Scheme) -> Self {
        let node = |k: usize| ContactNode {
            id: k as u64,
            position: [100.0, 0.03 * k as f64, 4.0 * k as f64],
            normal: [0.8, 0.0, 0.6],
            dofs: [3 * k, 3 * k + 1, 3 * k + 2],
        };
        let restriction = Lobes { count: lobes, amplitude: 0.3, width_rad: 0.3, phase_rad: 0.1 };
        Self {
            wheel: wheel(sectors),
            nodes: (0..NODES).map(node).collect(),
            casing: Some(Casing {
                clearance: vec![0.25, 0.26],
                restriction: Some(restriction.into()),
                ramp_revolutions: 2.0,
            }),
            damping: ModalDamping { modal_ratio: damping, family_ratios: Vec::new(), ranks: Vec::new() },
            scheme,
        }
    }

    fn simulation(&self) -> Simulation<'_> {
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.nodes,
            damping: Some(&self.damping),
            casing: self.casing.as_ref(),
            effects: Effects::default(),
            initial: &[],
            sensors: &[],
            scheme: self.scheme,
            steps_per_revolution: STEPS,
            samples_per_revolution: 36,
            revolutions: 5,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
    }

    /// State at the end of a march from rest.
    fn march(&self, revolutions: usize) -> Vec<InitialMode> {
        let run = Simulation { revolutions, ..self.simulation() }.run(&|_| true);
        match run.outcome {
            Outcome::Completed(history) => history.end,
            other => panic!("{other:?}"),
        }
    }
}

const SEARCH: Search = Search { tolerance: 1e-13, marched: 20, most: 4000 };

fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Rate at which motions that start beside a response leave or join it, and the number of maps over which it was measured.
fn rate_beside(passage: &mut Passage<'_>, response: &[f64], growth: f64) -> (f64, usize) {
    let start = if growth < 1.0 { 1e-3 } else { 1e-9 };
    let mut numbers = Numbers(3);
    let aside: Vec<f64> = response.iter().map(|_| numbers.next()).collect();
    let share = start * length(response) / length(&aside);
    let mut state: Vec<f64> = response.iter().zip(&aside).map(|(x, aside)| x + share * aside).collect();
    let mut sizes = Vec::new();
    // From where the leading one is alone to where round-off or the next set of nodes begins.
    let (from, to) = if growth < 1.0 { (1e-6, 1e-10) } else { (1e-7, 1e-5) };
    let is_beyond = |size: f64, mark: f64| if growth < 1.0 { size < mark } else { size > mark };
    while sizes.last().is_none_or(|&last| !is_beyond(last, to)) {
        assert!(sizes.len() < 10_000, "{growth}: {:?}", sizes.last());
        state = passage.map(&state).unwrap();
        sizes.push(length(&difference(&state, response)) / length(response));
    }
    let from = sizes.iter().position(|&size| is_beyond(size, from)).unwrap();
    let last = sizes.len() - 1;
    ((sizes[last] / sizes[from]).powf(1.0 / (last - from) as f64), last - from)
}

/// Free motion: a mode comes back by e^{λT} after a map, turned by its nodal diameter where sectors change their numbers.
#[test]
fn a_wheel_in_free_motion_has_the_multipliers_of_its_modes() {
    let zeta = 0.01;
    for scheme in [Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 3 }] {
        let mut scene = Scene::new(6, 2, zeta, scheme);
        if let Some(casing) = &mut scene.casing {
            casing.clearance.fill(10.0);
        }
        let kept = scheme.integrated_modes(MODES);
        for whole in [false, true] {
            let simulation = scene.simulation();
            let mut passage = if whole {
                Passage::over_lobes(&simulation, 1).unwrap()
            } else {
                Passage::shortest(&simulation).unwrap()
            };
            passage.map(&vec![0.0; passage.size()]).unwrap();
            let duration = TAU / SPEED * passage.steps() as f64 / STEPS as f64;
            let found = multipliers(&Tangent::of(&passage), passage.size(), &vec![1.0; passage.size()]);
            assert_eq!(found.len(), passage.size());
            for modes in &scene.wheel.harmonics {
                for &omega in &modes.omega[..kept] {
                    let turn = if whole { 0.0 } else { TAU * modes.harmonic as f64 / 6.0 };
                    for sign in [1.0, -1.0] {
                        let angle = sign * omega * (1.0 - zeta * zeta).sqrt() * duration - turn;
                        let exact = c64::from_polar((-zeta * omega * duration).exp(), angle);
                        let nearest =
                            found.iter().map(|one| (one.value - exact).norm()).fold(f64::INFINITY, f64::min);
                        assert!(nearest < 1e-9, "{scheme:?} {omega} {nearest}");
                    }
                }
            }
            assert!(found.iter().all(|one| one.residual < 1e-8));
        }
    }
}

/// Derivative against differences, where contact lasts, opens and closes; of maps with and without renumbering, with odd and even N.
#[test]
fn the_tangent_is_the_limit_of_differences() {
    for scheme in SCHEMES {
        for (sectors, lobes) in [(6, 2), (5, 2), (1, 1)] {
            let scene = Scene::new(sectors, lobes, 0.02, scheme);
            let simulation = scene.simulation();
            let mut passage = Passage::shortest(&simulation).unwrap();
            let state = passage.state(&scene.march(4), &[]);
            let image = passage.map(&state).unwrap();
            let (touched, instants) = (passage.trace().sets.len(), passage.trace().instants.clone());
            assert!(touched > 0, "nothing touches");
            let mut numbers = Numbers(7);
            let direction: Vec<f64> = state.iter().map(|_| numbers.next()).collect();
            let mut moved = direction.clone();
            let rows = moved.len();
            Tangent::of(&passage).apply(MatMut::from_column_major_slice_mut(&mut moved, rows, 1));
            let epsilon = 1e-7 * length(&state) / length(&direction);
            let aside = |passage: &mut Passage<'_>, by: f64| {
                let state: Vec<f64> = state.iter().zip(&direction).map(|(x, v)| x + by * v).collect();
                let image = passage.map(&state).unwrap();
                (image, passage.trace().instants == instants)
            };
            let (ahead, same_ahead) = aside(&mut passage, epsilon);
            let (behind, same_behind) = aside(&mut passage, -epsilon);
            assert!(same_ahead && same_behind, "a set changed: another direction is needed");
            let slope: Vec<f64> = difference(&ahead, &behind).iter().map(|x| x / (2.0 * epsilon)).collect();
            let off = length(&difference(&slope, &moved)) / length(&moved);
            assert!(off < 1e-6, "{scheme:?} {sectors} {lobes}: {off:e}; {}", length(&image));
        }
    }
}

/// Response that is called stable: a long march ends there, and it attracts motions that start a thousandth away as fast as its largest
/// multiplier predicts; one that is called unstable repels them so. The map over whole lobes agrees.
#[test]
fn what_starts_near_a_response_leaves_or_joins_it_as_its_multipliers_say() {
    let (mut stable, mut unstable) = (0, 0);
    for scheme in SCHEMES {
        for (sectors, lobes) in [(6, 2), (5, 2)] {
            let scene = Scene::new(sectors, lobes, 0.1, scheme);
            let simulation = scene.simulation();
            let mut passage = Passage::shortest(&simulation).unwrap();
            let rest = vec![0.0; passage.size()];
            let found = find(&mut passage, &rest, &SEARCH, &|| true).unwrap();
            passage.map(&found.state).unwrap();
            let growth = multipliers(&Tangent::of(&passage), 4, &rest)[0].value.norm();

            let (rate, _) = rate_beside(&mut passage, &found.state, growth);
            assert!((rate / growth - 1.0).abs() < 0.05, "{scheme:?} {sectors}: {rate} for {growth}");

            let marched = passage.state(&scene.march(60), &[]);
            let off = length(&difference(&marched, &found.state)) / length(&found.state);
            if growth < 1.0 {
                stable += 1;
                assert!(off < 1e-8, "{scheme:?} {sectors}: {off:e}");
            } else {
                unstable += 1;
                assert!(off > 1e-3, "{scheme:?} {sectors}: {off:e}");
            }

            let mut whole = Passage::over_lobes(&simulation, lobes as usize).unwrap();
            let image = whole.map(&found.state).unwrap();
            assert!(length(&difference(&image, &found.state)) < 1e-8 * length(&found.state));
            let again = multipliers(&Tangent::of(&whole), 1, &rest)[0].value.norm();
            let passages = whole.steps() as f64 / passage.steps() as f64;
            assert!((again / growth.powf(passages) - 1.0).abs() < 1e-6, "{again} {growth}");
        }
    }
    assert!(stable > 2 && unstable > 0, "{stable} stable and {unstable} unstable responses");
}

/// Wheel of seven sectors, which would need a fourteenth of a revolution.
#[test]
fn a_passage_takes_whole_steps() {
    let scene = Scene::new(7, 2, 0.01, Scheme::ExactModal);
    assert_eq!(Passage::shortest(&scene.simulation()).unwrap().steps(), STEPS / 2);
    let unlike = Simulation { steps_per_revolution: STEPS + 1, ..scene.simulation() };
    assert_eq!(Passage::over_lobes(&unlike, 1).unwrap().steps(), STEPS + 1);
}

/// Scenes drawn at random: every response that is called stable, and reached by a march, is where a long march ends; sensors agree.
#[test]
fn what_is_stable_and_reached_is_where_long_marches_end() {
    let mut numbers = Numbers(11);
    let mut aside = Numbers(5);
    let mut within = |low: f64, high: f64| low + 0.5 * (numbers.next() + 1.0) * (high - low);
    let (mut reached, mut others) = (0, 0);
    for case in 0..24 {
        let scheme = SCHEMES[case % 3];
        let (sectors, lobes) = [(6, 2), (5, 2), (8, 4), (1, 1)][case % 4];
        let mut scene = Scene::new(sectors, lobes, within(0.02, 0.2), scheme);
        scene.wheel.speed_rad_s = within(600.0, 2000.0);
        if let Some(casing) = &mut scene.casing {
            casing.clearance = vec![within(0.2, 0.3), within(0.2, 0.3)];
        }
        let normal = Direction { node: 0, components: [0.8, 0.0, 0.6] };
        let sensors = [SensorRow { direction: normal, sector: 0 }];
        let simulation = Simulation { sensors: &sensors, samples_per_revolution: 360, ..scene.simulation() };
        let sought = seek(&simulation, 60, true, &|| true);
        let Ok(response) = sought.response else {
            others += 1;
            continue;
        };
        assert!(sought.revolutions > 3.0);
        if response.floquet.stability == Stability::Stable {
            let mut passage = Passage::over_lobes(&simulation, 1).unwrap();
            let orbit = passage.state_of(&response.start);
            let aside: Vec<f64> = orbit.iter().map(|_| aside.next()).collect();
            let share = 1e-3 * length(&orbit) / length(&aside);
            let mut state: Vec<f64> = orbit.iter().zip(&aside).map(|(x, aside)| x + share * aside).collect();
            for _ in 0..400 * lobes {
                state = passage.map(&state).unwrap();
            }
            let off = length(&difference(&state, &orbit)) / length(&orbit);
            assert!(off < 1e-6, "{case} {scheme:?} {sectors} {lobes}: {off:e}");
        }
        if response.arrives != Some(true) {
            others += 1;
            continue;
        }
        reached += 1;
        assert_eq!(response.floquet.stability, Stability::Stable);
        let ends = |run: Run| match run.outcome {
            Outcome::Completed(history) => history,
            other => panic!("{other:?}"),
        };
        let long = ends(Simulation { revolutions: 400, ..simulation }.run(&|_| true));
        let recorded = ends(record(&simulation, &response, &|_| true));
        assert_eq!(recorded.displacement[0].len(), 5 * 360);
        assert_eq!(recorded.window[0].len(), 360);
        let largest = long.window[0].iter().fold(0.0f64, |most, x| most.max(x.abs()));
        for (from, to) in [(&long.displacement, &recorded.displacement), (&long.window, &recorded.window)] {
            let last = |line: &[f64]| line[line.len() - 360..].to_vec();
            let off = difference(&last(&from[0]), &last(&to[0]));
            let off = off.into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
            assert!(off < 1e-6 * largest, "{case} {scheme:?} {sectors} {lobes}: {off:e} of {largest:e}");
        }
    }
    assert!(reached >= 8 && others > 0, "{reached} reached, {others} not");
}

/// Details recorded of chosen revolutions are those that a march records once it repeats.
#[test]
fn details_of_a_response_are_those_of_its_march() {
    for scheme in SCHEMES {
        let scene = Scene::new(6, 2, 0.1, scheme);
        let sensors =
            [SensorRow { direction: Direction { node: 1, components: [1.0, 0.0, 0.0] }, sector: 2 }];
        let detail = |revolutions| {
            Some(Detail { revolutions, velocity: true, contact: true, forces: true, energy: false })
        };
        let base = Simulation { sensors: &sensors, samples_per_revolution: 360, ..scene.simulation() };
        let of = |revolutions: usize| Simulation {
            revolutions,
            detail: detail(Revolutions::Last(2)),
            states: Some(Revolutions::Last(2)),
            ..base
        };
        let Ok(response) = seek(&base, 60, true, &|| true).response else {
            panic!("{scheme:?}: no response")
        };
        assert_eq!(response.arrives, Some(true), "{scheme:?}");
        let (marched, solved) = (of(200).run(&|_| true), record(&of(40), &response, &|_| true));
        let (Outcome::Completed(marched), Outcome::Completed(solved)) = (marched.outcome, solved.outcome)
        else {
            panic!("not completed")
        };
        let (Some(a), Some(b)) = (marched.detail, solved.detail) else { panic!("no detail") };
        let close = |a: &[f64], b: &[f64], what: &str| {
            assert_eq!(a.len(), b.len());
            // A mean force begins and ends within a step: it follows the state by the stiffness of what touches.
            let largest = a.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            let off = difference(a, b).iter().fold(0.0f64, |most, x| most.max(x.abs()));
            assert!(off <= 1e-5 * largest, "{scheme:?} {what}: {off:e} of {largest:e}");
        };
        close(&a.velocity[0], &b.velocity[0], "velocity");
        close(&a.nodes_in_contact, &b.nodes_in_contact, "nodes");
        for (a, b) in a.force.iter().zip(&b.force) {
            close(a, b, "force");
        }
        let (Some(a), Some(b)) = (marched.states, solved.states) else { panic!("no states") };
        assert_eq!(b.revolutions.first().map(|first| first.floor()), Some(38.0));
        assert_eq!(a.harmonics[2].ncols(), b.harmonics[2].ncols());
        assert!((&a.harmonics[2] - &b.harmonics[2]).norm_max() < 1e-6 * a.harmonics[2].norm_max());
    }
}

/// Marches of random scenes that end because they repeat, against 400 more revolutions, on the bits of a march of given length. All begin
/// away from any symmetry they have.
#[test]
fn a_march_that_ends_has_come_as_close_as_it_says() {
    let mut numbers = Numbers(23);
    let mut within = |low: f64, high: f64| low + 0.5 * (numbers.next() + 1.0) * (high - low);
    let (mut ended, mut several, mut others) = (0, 0, 0);
    for case in 0..120 {
        let scheme = SCHEMES[case % 3];
        let (sectors, lobes) = [(6, 2), (5, 2), (8, 4), (1, 1)][case % 4];
        let mut scene = Scene::new(sectors, lobes, within(0.005, 0.1), scheme);
        scene.wheel.speed_rad_s = within(600.0, 2000.0);
        if let Some(casing) = &mut scene.casing {
            casing.clearance = vec![within(0.2, 0.3), within(0.2, 0.3)];
        }
        let normal = Direction { node: 0, components: [0.8, 0.0, 0.6] };
        let sensors = [SensorRow { direction: normal, sector: 0 }];
        let share = [1e-3, 1e-5][case % 2];
        let symmetry = if sectors % lobes as usize == 0 { lobes as usize } else { 1 };
        let initial: Vec<InitialMode> = (0..=sectors / 2)
            .map(|harmonic| InitialMode {
                harmonic,
                family: 0,
                displacement: c64::new(1e-9, 0.0),
                velocity: c64::new(0.0, 0.0),
            })
            .collect();
        let fixed = |revolutions: usize, window_revolutions: usize| {
            let simulation = Simulation {
                sensors: &sensors,
                samples_per_revolution: 360,
                revolutions,
                window_revolutions,
                initial: &initial,
                ..scene.simulation()
            };
            match simulation.run(&|_| true).outcome {
                Outcome::Completed(history) => history,
                other => panic!("{other:?}"),
            }
        };
        let simulation = Simulation {
            sensors: &sensors,
            samples_per_revolution: 360,
            revolutions: 120,
            window_revolutions: 12,
            repeats: Some(Repeats { share, least: 0, symmetry }),
            initial: &initial,
            states: Some(Revolutions::Last(1)),
            ..scene.simulation()
        };
        let run = simulation.run(&|_| true);
        let Outcome::Completed(march) = run.outcome else { panic!("not completed") };
        let Some(Repeated { after, period, remaining }) = march.repeated else {
            assert_eq!(run.statistics.steps, 120 * STEPS as u64);
            others += 1;
            continue;
        };
        ended += 1;
        several += usize::from(period > 1);
        let taken = after + period;
        assert!(remaining <= share && taken as u64 >= 2 + LEAST_MARCHED && 12 % period == 0);
        assert_eq!(run.statistics.steps, (taken * STEPS) as u64);
        let told = fixed(taken, period);
        assert_eq!(told.displacement[0], march.displacement[0][..360 * taken]);
        assert_eq!((&told.end, march.displacement[0].len()), (&march.end, 360 * (after + 12)));
        assert_eq!(told.window[0].repeat(12 / period), march.window[0]);
        assert_eq!(march.states.unwrap().revolutions.last(), Some(&(taken as f64)));
        let mut passage = Passage::over_lobes(&simulation, lobes as usize).unwrap();
        let early = passage.state(&march.end, &[]);
        let mut late = early.clone();
        for _ in 0..400 / period * period {
            late = passage.map(&late).unwrap();
        }
        let off = length(&difference(&late, &early)) / length(&late);
        assert!(
            off < 10.0 * share,
            "{case} {scheme:?} {sectors} {lobes}: {after} {period} {remaining:e} {off:e}"
        );
    }
    assert!(ended >= 24 && several > 0 && others > 0, "{ended} ended, {several} after several, {others} not");
}

/// Lightly damped scenes drawn at random, where the search from the march alone stalls within 400 revolutions: some are followed from
/// heavier damping, and the response found then is one of the scene itself, which attracts or not as it is judged.
#[test]
fn light_damping_is_followed_from_heavier() {
    let mut numbers = Numbers(31);
    let mut within = |low: f64, high: f64| low + 0.5 * (numbers.next() + 1.0) * (high - low);
    let (mut followed, mut stable) = (0, 0);
    for case in 0..30 {
        let scheme = SCHEMES[case % 3];
        let (sectors, lobes) = [(6, 2), (5, 2), (8, 4), (1, 1)][case % 4];
        let mut scene = Scene::new(sectors, lobes, [0.01, 0.005, 0.0025][case / 3 % 3], scheme);
        scene.wheel.speed_rad_s = within(600.0, 2000.0);
        let clearance = vec![within(0.2, 0.3), within(0.2, 0.3)];
        scene.casing.iter_mut().for_each(|casing| casing.clearance.clone_from(&clearance));
        let simulation = scene.simulation();
        let Sought { response, revolutions } = seek(&simulation, 400, false, &|| true);
        // The ramp, two searches, a march beside, multipliers, and the last Newton steps.
        let most = 1 + 3 * 400 + MOST_PRODUCTS as u64 + 2 * MOST_BEYOND;
        assert!(revolutions <= most as f64, "{case}: {revolutions}");
        let Ok(response) = response else { continue };
        if response.followed_from.is_none() {
            continue;
        }
        followed += 1;
        let mut passage = Passage::over_lobes(&simulation, response.floquet.lobes).unwrap();
        let orbit = passage.state_of(&response.start);
        let image = passage.map(&orbit).unwrap();
        // Found to 1e-8 over half a revolution or less; a lobe that repels multiplies that.
        let growth = response.floquet.multipliers[0].value.norm().max(1.0);
        let off = length(&difference(&image, &orbit)) / length(&orbit);
        assert!(off < 1e-7 * growth, "{case} {scheme:?}: {off:e} {growth}");
        if response.floquet.stability == Stability::Stable {
            stable += 1;
            let mut state: Vec<f64> = orbit.iter().map(|x| 1.0001 * x).collect();
            for _ in 0..400 {
                state = passage.map(&state).unwrap();
            }
            let off = length(&difference(&state, &orbit)) / length(&orbit);
            assert!(off < 1e-6, "{case} {scheme:?}: {off:e}");
        }
    }
    assert!(followed > 3 && stable > 0, "{followed} followed, {stable} of them stable");
}
