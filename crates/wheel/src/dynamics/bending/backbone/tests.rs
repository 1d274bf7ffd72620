//! Backbone curves against closed forms, quadrature, and the wheel integrated in time.

use std::f64::consts::{FRAC_PI_2, TAU};

use faer::{Mat, c64};

use super::*;
use crate::dynamics::bending::tests::{COORDINATES, MODES, NODES, inertia, nodes, wheel_of};
use crate::dynamics::bending::{Bending, BladeBending, EnergyForm, products};
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::Effects;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::integrate::{Outcome, SensorRow, Simulation};
use crate::dynamics::modal_wheel::ModalWheel;
use crate::dynamics::numbers::Numbers;
use crate::dynamics::schemes::Scheme;

const LINEAR: f64 = 100.0;

/// Energies B p³ + ½ A p⁴, or 2 B pṗ² + 2 A p²ṗ², of one coordinate.
fn form(cubic: f64, quartic: f64) -> EnergyForm {
    EnergyForm::new(&Mat::from_fn(1, 1, |_, _| cubic), &Mat::from_fn(1, 1, |_, _| quartic))
}

/// One blade with one mode, whose coordinate is `row` times its modal coordinate and its contact node's displacement twice the coordinate.
fn oscillator<'a>([potential, inertia]: [&'a EnergyForm; 2], row: f64) -> FreeWheel<'a> {
    let one = |value: f64| Mat::from_fn(1, 1, |_, _| c64::new(value, 0.0));
    let modes = FreeModes { omega: vec![LINEAR], rows: one(row), contact: one(2.0 * row) };
    FreeWheel { sectors: 1, modes: vec![modes], potential, inertia }
}

const FIRST: FreeMode = FreeMode { nodal_diameter: 0, rank: 0 };

/// Motion of a mode at the modal amplitude a, and its frequency.
fn motion<'a>(wheel: &'a FreeWheel<'a>, mode: FreeMode, amplitude: f64) -> (Follower<'a>, f64) {
    let mut follower = Follower::new(wheel, mode);
    let mut omega = 0.0;
    let end = follower.march(amplitude, |_, found| omega = found.omega);
    assert_eq!(end, BackboneEnd::LargestAmplitude);
    (follower, omega)
}

#[test]
fn a_duffing_oscillator_has_its_exact_period() {
    // (1 + 4Γ r⁴ z²) ż²/2 + ω₀²z²/2 + A r⁴ z⁴/2 is constant: hardening by a third and softening by an eighth without inertia, softening with it.
    let row = 0.7;
    for (quartic, inertia, amplitude) in
        [(LINEAR * LINEAR, 0.0, 1.0), (-LINEAR * LINEAR, 0.0, 0.55), (LINEAR * LINEAR, 1.5, 1.0)]
    {
        let (potential, kinetic) = (form(0.0, quartic), form(0.0, inertia));
        let wheel = oscillator([&potential, &kinetic], row);
        let (follower, omega) = motion(&wheel, FIRST, amplitude / row);
        let peak: f64 = follower.last.at(0.0)[0][0] / row;
        // (1 + 4Γ r⁴ z²) ż² = (X² − z²)(ω₀² + A r⁴ (X² + z²)); the rule is exact to round-off for a periodic integrand.
        let points = 400;
        let time = |k: usize| {
            let sine = (FRAC_PI_2 * (k as f64 + 0.5) / points as f64).sin();
            let stiffness = quartic * row.powi(4) * peak * peak * (1.0 + sine * sine);
            let mass = 1.0 + 4.0 * inertia * row.powi(4) * (peak * sine).powi(2);
            (mass / (LINEAR * LINEAR + stiffness)).sqrt()
        };
        let quarter = (0..points).map(time).sum::<f64>() * FRAC_PI_2 / points as f64;
        let expected = FRAC_PI_2 / quarter;
        assert!((omega / expected - 1.0).abs() < 1e-6, "{quartic}: {omega} {expected}");
        assert!((omega / LINEAR - 1.0).abs() > 0.1, "{omega}");
    }
}

#[test]
fn a_small_motion_hardens_and_softens_with_its_square() {
    // z̈ + ω₀²z + 3Bz² + 2Az³ = 0 (Nayfeh and Mook): ω ≈ ω₀ + (9·2A ω₀² − 10·9B²)/(24 ω₀³) a².
    for (cubic, quartic) in [(0.0, 4e3), (2e3, 0.0), (3e3, 5e3)] {
        let (potential, still) = (form(cubic, quartic), form(0.0, 0.0));
        let wheel = oscillator([&potential, &still], 1.0);
        let curve = wheel.backbone(FIRST, 0.02);
        assert_eq!((curve.row, curve.end, curve.points.len()), (0, BackboneEnd::LargestAmplitude, 33));
        assert_eq!((curve.points[0].amplitude, curve.points[0].omega), (0.0, LINEAR));
        let factor = (18.0 * quartic * LINEAR * LINEAR - 90.0 * cubic * cubic) / (24.0 * LINEAR.powi(3));
        for point in &curve.points[8..] {
            // The contact node moves twice as far as the coordinate.
            let expected = factor * (0.5 * point.amplitude).powi(2);
            let change = point.omega - LINEAR;
            assert!((change / expected - 1.0).abs() < 2e-3, "{cubic} {quartic}: {change} {expected}");
            assert!(point.truncation < 1e-9);
        }
        assert!((curve.points[32].amplitude / 0.02 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_curve_ends_where_nothing_draws_the_blade_back() {
    // From X² = ω₀²/2|A| on the blade does not return; there it rests at either end, and 4/π of that is its first harmonic.
    let (potential, still) = (form(0.0, -LINEAR * LINEAR), form(0.0, 0.0));
    let curve = oscillator([&potential, &still], 1.0).backbone(FIRST, 4.0);
    assert!(
        matches!(
            curve.end,
            BackboneEnd::Unresolved { .. } | BackboneEnd::NotFound | BackboneEnd::NoRestoringForce
        ),
        "{:?}",
        curve.end
    );
    let last = curve.points.last().unwrap();
    assert!(last.amplitude < 2.0 * 0.9004 && last.omega < 0.5 * LINEAR, "{last:?}");
    assert!(curve.points.iter().all(|point| point.truncation < UNRESOLVED));
}

/// Strain energy ω₀²(½ A p₁⁴ + C p₁³p₂ + ½ D p₁²p₂² + ½ E p₂⁴) of two coordinates.
fn coupled([a, c, d, e]: [f64; 4]) -> EnergyForm {
    let quartic = [[a, c, 0.0], [c, d, 0.0], [0.0, 0.0, e]];
    EnergyForm::new(&Mat::zeros(2, 3), &Mat::from_fn(3, 3, |i, j| quartic[i][j] * LINEAR * LINEAR))
}

/// One blade with two modes, one for each coordinate; the second has `second` times the frequency of the first.
fn two_modes<'a>(second: f64, potential: &'a EnergyForm, still: &'a EnergyForm) -> FreeWheel<'a> {
    let one = |value: f64| c64::new(value, 0.0);
    let modes = FreeModes {
        omega: vec![LINEAR, second * LINEAR],
        rows: Mat::from_fn(2, 2, |i, j| one(if i == j { 1.0 } else { 0.0 })),
        contact: Mat::from_fn(1, 2, |_, _| one(1.0)),
    };
    FreeWheel { sectors: 1, modes: vec![modes], potential, inertia: still }
}

fn met(harmonic: usize) -> Resonance {
    Resonance { harmonic, nodal_diameter: 0, rank: 1 }
}

#[test]
fn a_resonance_with_another_mode_is_told() {
    // The first mode reaches a third of the frequency of the second as it hardens, or as the second softens by its motion, whose frequency it
    // never reaches without motion.
    let still = EnergyForm::zero(2);
    let curve = |second: f64, energy| two_modes(second, &coupled(energy), &still).backbone(FIRST, 0.5);
    for (second, energy) in [(3.15, [1.0, 0.02, 0.1, 0.0]), (3.05, [0.0, 0.005, -8.0, 0.0])] {
        let found = curve(second, energy);
        assert_eq!(
            (found.end, &found.passed[..]),
            (BackboneEnd::LargestAmplitude, &[met(3)][..]),
            "{second}"
        );
    }
    let far = curve(8.37, [1.0, 0.2, 0.1, 0.0]);
    assert_eq!((far.end, far.passed.len()), (BackboneEnd::LargestAmplitude, 0));
}

#[test]
fn a_curve_does_not_jump_to_another_branch() {
    // Steps a twentieth as long hardly change the motion even amid the resonance: the reference is continuous.
    let still = EnergyForm::zero(2);
    for (second, energy) in [(3.3, [1.0, 0.4, 0.1, 0.0]), (3.05, [0.0, 0.4, -8.0, 0.0])] {
        let potential = coupled(energy);
        let wheel = two_modes(second, &potential, &still);
        let curve = wheel.backbone(FIRST, 0.5);
        let mut fine = Follower::new(&wheel, FIRST);
        let mut compared = 0;
        for pair in curve.points.windows(2) {
            let [from, to] = [0, 1].map(|k| pair[k].amplitude);
            let within = (1..=20).try_fold(0.0, |_, k| {
                fine.reach(from + (to - from) * f64::from(k) / 20.0).map(|found| found.omega)
            });
            let Ok(expected) = within else { break };
            let omega = pair[1].omega;
            assert!((omega / expected - 1.0).abs() < 1e-5, "{second} at {to}: {omega} {expected}");
            compared += 1;
        }
        println!("{second}: {compared} points up to {:?}, {}", curve.points.last(), curve.end);
        assert!(compared >= 20, "{second}: {compared}");
    }
}

#[test]
fn a_curve_ends_at_a_resonance_beyond_which_it_turns_back() {
    // Second mode at nearly the frequency of the first. With p₁ = a cos ωt and p₂ = b cos ωt alone:
    // ω² = ω₀² + ω₀²(3/2 A a² + 9/4 C a b + 3/4 D b²),  (ω₂² − ω²) b + ω₀²(3/4 C a³ + 3/4 D a² b + 3/2 E b³) = 0.
    let (second, [a, c, d, e]) = (1.05, [1.0, 0.02, 0.1, -5.0]);
    let off = |amplitude: f64, b: f64| {
        let squares = 1.5 * a * amplitude.powi(2) + 2.25 * c * amplitude * b + 0.75 * d * b * b;
        (second * second - 1.0 - squares) * b
            + 0.75 * (c * amplitude.powi(3) + d * amplitude.powi(2) * b)
            + 1.5 * e * b.powi(3)
    };
    // Up to the fold a small b < 0 solves this: the sign changes from b = 0 down.
    let solved = |amplitude: f64| (1..4000).any(|k| off(amplitude, -1e-5 * f64::from(k)) < 0.0);
    let (mut below, mut above) = (0.1, 0.4);
    assert!(solved(below) && !solved(above));
    for _ in 0..40 {
        let middle = 0.5 * (below + above);
        if solved(middle) { below = middle } else { above = middle }
    }
    let (potential, still) = (coupled([a, c, d, e]), EnergyForm::zero(2));
    for largest in [0.3, 0.5] {
        let curve = two_modes(second, &potential, &still).backbone(FIRST, largest);
        let last = curve.points.last().unwrap();
        println!("fold at {below}, end at {last:?}");
        assert_eq!(curve.end, BackboneEnd::AtResonance(met(1)));
        assert!((last.amplitude / below - 1.0).abs() < 5e-3, "{last:?} {below}");
    }
}

#[test]
fn a_curve_in_resonance_from_rest_on_ends_there() {
    // ω₀² p₁²p₂ with ω₂ = 2ω₀: the second mode takes part with ±1/√8 however small the motion is (Nayfeh and Mook), so that no curve begins at the
    // linear mode. A third off, one does.
    let cubic = Mat::from_fn(2, 3, |j, a| if (j, a) == (1, 0) { LINEAR * LINEAR } else { 0.0 });
    let (potential, still) = (EnergyForm::new(&cubic, &Mat::zeros(3, 3)), EnergyForm::zero(2));
    let curve = |second: f64| two_modes(second, &potential, &still).backbone(FIRST, 0.1);
    let tuned = curve(2.0);
    assert_eq!((tuned.end, tuned.points.len()), (BackboneEnd::AtResonance(met(2)), 1));
    assert_eq!(curve(2.67).end, BackboneEnd::LargestAmplitude);
}

fn blade() -> BladeBending {
    let mut numbers = Numbers(23);
    let count = products(COORDINATES).count();
    let a: Mat<f64> = Mat::from_fn(count, count, |_, _| numbers.next());
    BladeBending {
        asked: COORDINATES,
        rows: Vec::new(),
        potential: EnergyForm::new(
            &Mat::from_fn(COORDINATES, count, |_, _| 1e5 * numbers.next()),
            &(4e7 * (&a.transpose().to_owned() * &a)),
        ),
        inertia: inertia(),
        linear: Mat::zeros(3 * NODES, COORDINATES),
        second_order: Mat::zeros(3 * NODES, count),
    }
}

/// Wheel whose modes are far from resonances with each other.
fn modal_wheel(sectors: usize) -> ModalWheel {
    wheel_of(sectors, |m, harmonic| [1.0, 1.7, 4.7][m] + 0.113 * harmonic as f64)
}

fn free_wheel<'a>(wheel: &ModalWheel, blade: &'a BladeBending) -> FreeWheel<'a> {
    let modes = wheel.harmonics.iter().map(|modes| FreeModes {
        omega: modes.omega.clone(),
        rows: modes.contact.subrows(3 * NODES, COORDINATES).to_owned(),
        contact: modes.contact.subrows(0, 3 * NODES).to_owned(),
    });
    let BladeBending { potential, inertia, .. } = blade;
    FreeWheel { sectors: wheel.sectors, modes: modes.collect(), potential, inertia }
}

/// Modal coordinates and velocities of a motion at its beginning.
fn state(follower: &Follower<'_>) -> Vec<InitialMode> {
    let (motion, omega) = (&follower.last, follower.last.omega_squared.sqrt());
    let wheel = follower.balance.wheel;
    let of = |(harmonic, family): (usize, usize)| InitialMode {
        harmonic,
        family,
        displacement: c64::ZERO,
        velocity: c64::ZERO,
    };
    let mut modes: Vec<InitialMode> =
        (0..wheel.modes.len()).flat_map(|i| (0..MODES).map(move |m| of((i, m)))).collect();
    let force = follower.balance.forces(motion).force;
    for (h, force) in force.iter().enumerate() {
        let moved = follower.balance.moved(h);
        let i = moved.nodal_diameter;
        let single = i == 0 || 2 * i == wheel.sectors;
        let squared = if single { 1.0 } else { 2.0 } / wheel.sectors as f64;
        let weight = f64::sqrt(squared);
        for (m, omega_m) in moved.modes.omega.iter().enumerate() {
            let gain = 1.0 / (omega_m * omega_m - (h * h) as f64 * motion.omega_squared);
            let amplitude = match moved.left_out {
                Some(own) if own == m => c64::new(follower.amplitude, 0.0),
                _ => moved.force(m, force) * gain,
            };
            let mut z = amplitude * (1.0 / weight);
            let mut velocity = z * c64::new(0.0, h as f64 * omega);
            if moved.conjugate {
                (z, velocity) = (z.conj(), velocity.conj());
            }
            if single {
                (z, velocity) = (c64::new(z.re, 0.0), c64::new(velocity.re, 0.0));
            }
            let mode = &mut modes[i * MODES + m];
            (mode.displacement, mode.velocity) = (mode.displacement + z, mode.velocity + velocity);
        }
    }
    modes
}

/// Displacement of a sensor over three periods of a free motion, each of so many steps.
fn integrated(follower: &Follower<'_>, omega: f64, steps: usize) -> Vec<f64> {
    let (sectors, blade) = (follower.balance.wheel.sectors, blade());
    // A period is a revolution.
    let wheel = ModalWheel { speed_rad_s: omega, ..modal_wheel(sectors) };
    let bending = Bending { blade: &blade, first: NODES, stiffens: true };
    let direction = Direction { node: 1, components: [0.8, 0.1, 0.6] };
    let run = Simulation {
        wheel: &wheel,
        contact_nodes: &nodes(),
        damping: None,
        casing: None,
        effects: Effects { bending: Some(bending), ..Effects::default() },
        initial: &state(follower),
        sensors: &[SensorRow { direction, sector: sectors - 1 }],
        scheme: Scheme::ExactModal,
        steps_per_revolution: steps,
        samples_per_revolution: steps,
        revolutions: 3,
        window_revolutions: 3,
        repeats: None,
        detail: None,
        states: None,
    }
    .run(&|_| true);
    let Outcome::Completed(history) = &run.outcome else { panic!("{:?}", run.outcome) };
    history.displacement[0].clone()
}

#[test]
fn a_wheel_integrated_in_time_repeats_after_the_period() {
    for (sectors, nodal_diameter, rank) in [(3, 0, 0), (3, 1, 0), (4, 0, 1), (4, 1, 0), (4, 2, 0), (5, 2, 0)]
    {
        let (wheel, blade) = (modal_wheel(sectors), blade());
        let free = free_wheel(&wheel, &blade);
        let linear = free.modes[nodal_diameter].omega[rank];
        let (follower, omega) = motion(&free, FreeMode { nodal_diameter, rank }, 0.012);
        let change = omega / linear - 1.0;
        let error = |steps: usize| {
            let found = integrated(&follower, omega, steps);
            let size = found.iter().fold(0.0f64, |most, u| most.max(u.abs()));
            let off = (0..2 * steps).map(|k| (found[k + steps] - found[k]).abs()).fold(0.0, f64::max);
            off / size
        };
        let (coarse, fine) = (error(400), error(1600));
        println!("{sectors} {nodal_diameter} {rank}: frequency changed by {change:.3}");
        assert!(change.abs() > 5e-3, "{sectors} {nodal_diameter}: {change}");
        assert!(fine < 2e-5 && fine < 0.1 * coarse, "{sectors} {nodal_diameter}: {coarse} {fine}");
    }
}

#[test]
fn harmonics_are_those_of_the_forces_around_the_wheel() {
    // Sector s is s·i·α ahead; the coordinates of every sector by the modal coordinates are those of one by its harmonics.
    let (wheel, blade) = (modal_wheel(4), blade());
    let free = free_wheel(&wheel, &blade);
    let (follower, _) = motion(&free, FreeMode { nodal_diameter: 1, rank: 0 }, 0.01);
    let modes = state(&follower);
    for sector in 0..4 {
        let angle = TAU * sector as f64 / 4.0;
        let mut p = [0.0; COORDINATES];
        for mode in &modes {
            let single = mode.harmonic != 1;
            let weight = (if single { 1.0 } else { 2.0 } / 4.0f64).sqrt();
            let turn = c64::new(0.0, mode.harmonic as f64 * angle).exp() * weight;
            for (j, p) in p.iter_mut().enumerate() {
                *p += (turn * free.modes[mode.harmonic].rows[(j, mode.family)] * mode.displacement).re;
            }
        }
        let [expected, ..] = follower.last.at(angle);
        for (p, expected) in p.iter().zip(expected) {
            assert!((p - expected).abs() < 1e-9, "{sector}: {p} {expected}");
        }
    }
}
