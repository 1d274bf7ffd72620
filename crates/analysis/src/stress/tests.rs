//! Search compared with every instant of every blade at every place, on operators and paths drawn at random.

use faer::{Mat, c64};
use rubmap_solid::material::{FatigueStrength, GivenStrengths, Material};
use rubmap_solid::mesh::ElementSet;
use rubmap_wheel::dynamics::centrifugal::StiffnessPolynomial;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::reduction::{ReducedHarmonic, StaticSpan};
use rubmap_wheel::dynamics::states::{HarmonicStates, WheelStates};

use super::bounds::bounds;
use super::cycle::{Cycle, weights};
use super::error::StressError;
use super::look::{Look, turn};
use super::make::lower;
use super::measure::{Stress, von_mises};
use super::places::Place;
use super::reduced::{HarmonicStress, ReducedStress, StaticStress};
use super::search::{Course, stress_of};
use super::trajectory::paths;

/// Random numbers in (−1, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn complex(&mut self, single: bool) -> c64 {
        c64::new(self.next(), if single { 0.0 } else { self.next() })
    }
}

const SECTORS: usize = 6;
const PLACES: usize = 90;
const UNKNOWNS: usize = 7;
const INSTANTS: usize = 60;
const SPEED: f64 = 3.0;

struct Case {
    stress: ReducedStress,
    harmonics: Vec<ReducedHarmonic>,
    states: WheelStates,
    wheel: ModalWheel,
}

fn set(name: &str, strengths: Option<(f64, f64)>) -> ElementSet {
    let fatigue_strength =
        strengths.map(|(amplitude, _)| FatigueStrength { amplitude, source: "drawn".into() });
    let material = Material {
        youngs_modulus: 1.0,
        poissons_ratio: 0.3,
        density: 1.0,
        yield_strength: strengths.map(|(_, ultimate)| 0.8 * ultimate),
        ultimate_strength: strengths.map(|(_, ultimate)| ultimate),
        fatigue_strength,
    };
    ElementSet { name: name.into(), material }
}

/// Waves of a few engine orders and some that belong to no order; `repeats` parts of the wheel move alike.
fn case(seed: u64, repeats: usize, steady: f64) -> Case {
    let mut numbers = Numbers(seed);
    let moving: Vec<usize> = (0..=SECTORS / 2).filter(|harmonic| harmonic % repeats == 0).collect();
    let single = |harmonic: usize| harmonic == 0 || 2 * harmonic == SECTORS;
    let mut harmonics = Vec::new();
    let mut operators = Vec::new();
    for harmonic in 0..=SECTORS / 2 {
        let half = Mat::from_fn(UNKNOWNS, UNKNOWNS, |_, _| numbers.complex(single(harmonic)));
        let unit = Mat::<c64>::identity(UNKNOWNS, UNKNOWNS);
        harmonics.push(ReducedHarmonic {
            harmonic,
            mass: unit.clone(),
            stiffness: StiffnessPolynomial { coefficients: vec![&half * half.adjoint() + unit] },
            gyroscopic: None,
            certificates: Vec::new(),
        });
        let scale: Vec<f64> = (0..PLACES).map(|_| numbers.next().powi(2)).collect();
        let real = single(harmonic);
        operators.push(HarmonicStress::new(Mat::from_fn(2 * UNKNOWNS, 6 * PLACES, |row, column| {
            let value = scale[column / 6] * numbers.next();
            if real && row % 2 == 1 { 0.0 } else { value as f32 }
        })));
    }
    let states = moving.iter().map(|&harmonic| {
        let shapes: Vec<Vec<c64>> =
            (0..4).map(|_| (0..UNKNOWNS).map(|_| numbers.complex(single(harmonic))).collect()).collect();
        let coordinates = Mat::from_fn(UNKNOWNS, INSTANTS, |unknown, t| {
            let angle = std::f64::consts::TAU * t as f64 / INSTANTS as f64;
            let wave = |(k, shape): (usize, &Vec<c64>)| {
                let phase = angle * (k as f64 * 1.3);
                let turn = c64::new(phase.cos(), if single(harmonic) { 0.0 } else { phase.sin() });
                shape[unknown] * turn * 0.3f64.powi(k as i32)
            };
            shapes.iter().enumerate().map(wave).sum()
        });
        HarmonicStates { harmonic, coordinates }
    });
    let states = WheelStates {
        harmonics: states.collect(),
        revolutions: (0..INSTANTS).map(|t| 9.0 + t as f64 / INSTANTS as f64).collect(),
    };
    let sets = vec![set("blade", Some((30.0, 90.0))), set("disk", Some((20.0, 100.0)))];
    let place = |node: usize| Place {
        node: 100 + node as u64,
        position: [node as f64, 0.0, 0.0],
        sets: vec![node % 2],
        from_contact: 1.0,
    };
    let fixed = StaticStress {
        stress: (0..6 * PLACES).map(|_| steady * numbers.next()).collect(),
        span: StaticSpan::at_rest(),
    };
    let stress = ReducedStress {
        places: (0..PLACES).map(place).collect(),
        sets,
        excluded_radius: 0.5,
        excluded_nodes: 3,
        harmonics: operators,
        fixed,
    };
    let wheel = ModalWheel { speed_rad_s: SPEED, sectors: SECTORS / repeats, repeats, harmonics: Vec::new() };
    Case { stress, harmonics, states, wheel }
}

impl Case {
    /// Stress of a place and blade at all instants, by the sum that defines it.
    fn literal(&self, place: usize, blade: usize) -> Vec<Stress> {
        let fixed = &self.stress.fixed(SPEED, false)[place];
        let mut found = vec![*fixed; INSTANTS];
        for state in &self.states.harmonics {
            let energy = lower(&self.harmonics[state.harmonic]).unwrap().adjoint() * &state.coordinates;
            let wave = self.stress.harmonics[state.harmonic].matrix(place) * energy;
            for (t, stress) in found.iter_mut().enumerate() {
                for (component, stress) in stress.iter_mut().enumerate() {
                    *stress += (turn(state.harmonic, blade, SECTORS) * wave[(component, t)]).re;
                }
            }
        }
        found
    }

    fn cycles(&self, place: usize) -> Vec<Cycle> {
        (0..self.wheel.sectors).map(|blade| Cycle::of(self.literal(place, blade).into_iter())).collect()
    }

    fn course(&self) -> Course<'_> {
        let Self { harmonics, wheel, states, .. } = self;
        Course { harmonics, wheel, states, stiffening: false }
    }
}

fn cases() -> impl Iterator<Item = Case> {
    (1..13u64).map(|seed| case(seed, [1, 2, 3][seed as usize % 3], [0.0, 0.3, 4.0, 40.0][seed as usize % 4]))
}

#[test]
fn the_search_finds_what_looking_everywhere_finds() {
    let mut followed = 0;
    for case in cases() {
        let found = stress_of(&case.stress, &case.course(), |_| None).unwrap().unwrap();
        let cycles: Vec<Vec<Cycle>> = (0..PLACES).map(|place| case.cycles(place)).collect();
        let all = || cycles.iter().flatten();
        let close = |a: f64, b: f64| (a - b).abs() <= 2e-6 * b.abs() + 1e-12;
        let largest = all().map(|cycle| cycle.peak.0).fold(0.0, f64::max);
        assert!(close(found.largest.von_mises, largest), "{} {largest}", found.largest.von_mises);
        let peak = found.largest;
        let here = &cycles[peak.node as usize - 100][peak.sector as usize];
        assert!(close(here.peak.0, largest));
        assert_eq!(peak.revolution, case.states.revolutions[here.peak.1]);
        let (weights, lacking) = weights(&case.stress.sets);
        assert_eq!(lacking, None);
        let measure = |place: usize, cycle: &Cycle| {
            weights[case.stress.places[place].sets[0]].unwrap().of(cycle.alternating, cycle.mean)
        };
        let worst =
            |place: usize| cycles[place].iter().map(|cycle| measure(place, cycle)).fold(0.0, f64::max);
        let mut expected: Vec<f64> = (0..PLACES).map(worst).collect();
        expected.sort_by(|a, b| b.total_cmp(a));
        assert_eq!(found.cycles.len(), 20);
        for (cycle, expected) in found.cycles.iter().zip(expected) {
            assert!(close(cycle.utilisation.unwrap(), expected), "{:?} {expected}", cycle.utilisation);
            let literal = &cycles[cycle.node as usize - 100][cycle.sector as usize];
            assert!(close(cycle.alternating, literal.alternating));
            assert!((cycle.principal_mean - literal.principal_mean).abs() < 1e-5 * largest);
        }
        let over_yield = (0..PLACES)
            .flat_map(|place| cycles[place].iter().map(move |cycle| (place, cycle.peak.0)))
            .map(|(place, peak)| peak / [72.0, 80.0][place % 2])
            .fold(0.0, f64::max);
        assert!(close(found.largest_over_yield.unwrap(), over_yield));
        followed += found.followed_nodes;
        assert_eq!(
            found,
            stress_of(&case.stress, &case.course(), |_| None).unwrap().unwrap(),
            "the same bits again"
        );
    }
    // Places of 12 wheels; at least 20 places of each are reported.
    assert!(followed < 12 * PLACES as u32, "{followed} of {}", 12 * PLACES);
}

#[test]
fn bounds_are_never_below_what_they_bound() {
    for case in cases() {
        let fixed = case.stress.fixed(SPEED, false);
        let paths = paths(&case.states, &case.harmonics, &case.stress).unwrap();
        let bounds = bounds(&case.stress, &fixed, &paths);
        let look = Look::new(&case.stress, &bounds, &fixed, &paths, (case.wheel.sectors, SECTORS), INSTANTS);
        let (weights, _) = weights(&case.stress.sets);
        for place in 0..PLACES {
            let weights = weights[case.stress.places[place].sets[0]];
            let cycles = case.cycles(place);
            let largest = cycles.iter().map(|cycle| cycle.peak.0).fold(0.0, f64::max);
            let measure = |cycle: &Cycle| weights.unwrap().of(cycle.alternating, cycle.mean);
            let most = cycles.iter().map(measure).fold(0.0, f64::max);
            let rough = &bounds[place];
            let seen = look.at(&[place], &[weights])[0];
            assert!(rough.largest >= largest && weights.unwrap().most(rough) >= most);
            assert!(seen.largest >= largest && seen.most >= most, "{seen:?} {largest} {most}");
            assert!(seen.largest_at_least <= largest && seen.most_at_least <= most);
        }
    }
}

#[test]
fn a_wheel_at_rest_has_its_static_stress() {
    let mut case = case(5, 1, 2.0);
    case.states.harmonics.iter_mut().for_each(|state| state.coordinates = Mat::zeros(UNKNOWNS, INSTANTS));
    let found = stress_of(&case.stress, &case.course(), |_| None).unwrap().unwrap();
    let expected = case.stress.fixed(SPEED, false).iter().map(von_mises).fold(0.0, f64::max);
    assert!((found.largest.von_mises - expected).abs() < 1e-12 * expected);
    assert_eq!(found.largest_static, expected);
    assert!(found.cycles.iter().all(|cycle| cycle.alternating == 0.0));
}

#[test]
fn without_strengths_the_largest_alternating_stress_leads() {
    let mut case = case(7, 1, 1.0);
    case.stress.sets = vec![set("blade", None), set("disk", None)];
    let found = stress_of(&case.stress, &case.course(), |_| None).unwrap().unwrap();
    let worst = |place: usize| case.cycles(place).iter().map(|c| c.alternating).fold(0.0, f64::max);
    let largest = (0..PLACES).map(worst).fold(0.0, f64::max);
    assert!((found.cycles[0].alternating - largest).abs() < 1e-5 * largest);
    assert!(found.cycles[0].utilisation.is_none() && found.largest_over_yield.is_none());
    assert!(found.lacking.unwrap().contains("blade, disk"));
}

#[test]
fn strengths_given_count_as_those_of_the_mesh() {
    let known = case(7, 1, 1.0);
    let mut bare = case(7, 1, 1.0);
    bare.stress.sets = vec![set("blade", None), set("disk", None)];
    let given: Vec<(String, GivenStrengths)> = (known.stress.sets.iter())
        .map(|set| {
            let Material { yield_strength, ultimate_strength, fatigue_strength, .. } = set.material.clone();
            (set.name.clone(), GivenStrengths { yield_strength, ultimate_strength, fatigue_strength })
        })
        .collect();
    let of = |set: &str| given.iter().find(|(name, _)| name == set).map(|(_, given)| given);
    let found = stress_of(&bare.stress, &bare.course(), of).unwrap().unwrap();
    assert_eq!(found, stress_of(&known.stress, &known.course(), |_| None).unwrap().unwrap());
    assert!(found.utilisation().is_some_and(|used| used > 0.0) && found.lacking.is_none());
}

#[test]
fn what_is_not_finite_is_no_stress() {
    for broken in [f64::NAN, f64::INFINITY] {
        let mut moved = case(3, 1, 1.0);
        moved.states.harmonics[0].coordinates[(2, 5)] = c64::new(broken, 0.0);
        assert_eq!(stress_of(&moved.stress, &moved.course(), |_| None), Err(StressError::NotFinite));
        let mut loaded = case(3, 1, 1.0);
        loaded.stress.fixed.stress[40] = broken;
        assert_eq!(stress_of(&loaded.stress, &loaded.course(), |_| None), Err(StressError::NotFinite));
    }
}

/// Even nodal diameters of six sectors: three blades differ, and the first of equal ones is reported.
#[test]
fn blades_that_move_alike_are_looked_at_once() {
    let mut case = case(4, 1, 0.5);
    case.states.harmonics.retain(|states| states.harmonic % 2 == 0);
    let found = stress_of(&case.stress, &case.course(), |_| None).unwrap().unwrap();
    let all = (0..PLACES).flat_map(|place| case.cycles(place));
    let largest = all.map(|cycle| cycle.peak.0).fold(0.0, f64::max);
    assert!((found.largest.von_mises - largest).abs() < 2e-6 * largest);
    assert!(found.largest.sector < 3 && found.cycles.iter().all(|cycle| cycle.sector < 3));
}
