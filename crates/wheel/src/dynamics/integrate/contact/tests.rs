use faer::{Mat, c64};

use super::super::super::casing::Lobes;
use super::super::super::initial::InitialMode;
use super::super::super::modal_wheel::{ModalHarmonic, ModalWheel};
use super::super::super::numbers::Numbers;
use super::super::super::schemes::Scheme;
use super::super::super::sector::ContactNode;
use super::*;

const SECTORS: usize = 21;
const NODES: usize = 9;
const MODES: usize = 4;
const STEPS: usize = 360;

/// Wheel whose mode shapes of each nodal diameter have the size that `largest` gives.
fn wheel(numbers: &mut Numbers, largest: impl Fn(usize) -> f64) -> ModalWheel {
    let harmonic = |harmonic: usize| {
        let single = harmonic == 0 || 2 * harmonic == SECTORS;
        let omega = (0..MODES).map(|m| 3000.0 * (1 + m) as f64).collect();
        let contact = Mat::from_fn(3 * NODES, MODES, |_, _| {
            let (re, im) = (numbers.next(), numbers.next());
            largest(harmonic) * c64::new(re, if single { 0.0 } else { im })
        });
        ModalHarmonic { harmonic, single, omega, contact, gyroscopic: None }
    };
    let harmonics = (0..=SECTORS / 2).map(harmonic).collect();
    ModalWheel { speed_rad_s: 1000.0, sectors: SECTORS, repeats: 1, harmonics }
}

fn nodes() -> Vec<ContactNode> {
    let node = |k: usize| ContactNode {
        id: k as u64,
        position: [100.0, 0.03 * k as f64, 4.0 * k as f64],
        normal: [1.0, 0.0, 0.0],
        dofs: [3 * k, 3 * k + 1, 3 * k + 2],
    };
    (0..NODES).map(node).collect()
}

fn simulation<'a>(wheel: &'a ModalWheel, nodes: &'a [ContactNode], casing: &'a Casing) -> Simulation<'a> {
    Simulation {
        wheel,
        contact_nodes: nodes,
        damping: None,
        casing: Some(casing),
        effects: Effects::default(),
        initial: &[],
        sensors: &[],
        scheme: Scheme::ExactModal,
        steps_per_revolution: STEPS,
        samples_per_revolution: STEPS,
        revolutions: 1,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: None,
    }
}

/// Contact of a simulation with its oscillators and Fourier basis.
fn contact(simulation: &Simulation<'_>, initial: &[InitialMode]) -> (Contact, Oscillators, SectorFourier) {
    let fourier = SectorFourier::new(SECTORS);
    let (scheme, step) = (simulation.scheme, simulation.step_s());
    let oscillators = Oscillators::new(simulation.wheel, scheme, step, None, true, true, initial);
    let casing = simulation.casing.expect("all have one");
    let contact = Contact::new(simulation, casing, &oscillators, &fourier);
    (contact, oscillators, fourier)
}

/// Gap c − p − nᵀu of a contact node, term by term.
fn gap(contact: &Contact, fourier: &SectorFourier, step: usize, sector: usize, node: usize) -> f64 {
    let stride = contact.rows.stride;
    let columns = contact.gaps.harmonic.chunks_exact(stride);
    let u: f64 = fourier.row(sector).iter().zip(columns).map(|(f, column)| f * column[node]).sum();
    let table = contact.gaps.restriction.as_ref().expect("there are lobes");
    contact.gaps.clearance[node] - table.at(step, sector)[node] - u
}

#[test]
fn far_sectors_have_bounds_of_their_gaps_and_all_others_their_gaps() {
    let mut numbers = Numbers(7);
    let (nodes, wheel) = (nodes(), wheel(&mut numbers, |_| 100.0));
    let restriction = Lobes { count: 2, amplitude: 0.5, width_rad: 0.3, phase_rad: 0.1 };
    let casing = Casing {
        clearance: (0..NODES).map(|k| 0.4 + 0.02 * k as f64).collect(),
        restriction: Some(restriction.into()),
        ramp_revolutions: 0.0,
    };
    let simulation = simulation(&wheel, &nodes, &casing);
    let (mut far, mut near) = (0, 0);
    for turn in 0..40 {
        let size = 2e-4 * numbers.next();
        let mode = |harmonic: usize, family: usize, numbers: &mut Numbers| InitialMode {
            harmonic,
            family,
            displacement: size
                * c64::new(
                    numbers.next(),
                    if wheel.harmonics[harmonic].single { 0.0 } else { numbers.next() },
                ),
            velocity: c64::new(0.0, 0.0),
        };
        let initial: Vec<_> =
            (0..=SECTORS / 2).flat_map(|h| [mode(h, 0, &mut numbers), mode(h, 3, &mut numbers)]).collect();
        let (mut contact, oscillators, fourier) = contact(&simulation, &initial);
        let now = Instant::new(3, 1 + 8 * turn, STEPS);
        let open = contact.look(pulp::Scalar, &oscillators, &fourier, now);
        let mut gaps = (0..SECTORS * NODES).map(|i| gap(&contact, &fourier, now.step, i / NODES, i % NODES));
        assert_eq!(open, gaps.all(|gap| gap >= 0.0));
        let holds = |contact: &Contact, exactly: bool| {
            for (sector, gaps) in contact.gaps.predicted.chunks_exact(contact.rows.stride).enumerate() {
                for (node, &kept) in gaps[..NODES].iter().enumerate() {
                    let gap = gap(contact, &fourier, now.step, sector, node);
                    if contact.gaps.is_far[sector] {
                        assert!(!exactly && 0.0 <= kept && kept <= gap + 1e-14, "{turn}: {kept} {gap}");
                    } else {
                        assert!((kept - gap).abs() < 1e-14, "{turn}: {kept} {gap}");
                    }
                }
            }
        };
        holds(&contact, false);
        let these = contact.gaps.is_far.iter().filter(|far| **far).count();
        (far, near) = (far + these, near + SECTORS - these);
        contact.gaps.complete(&fourier, now);
        holds(&contact, true);
    }
    assert!(far > 200 && near > 50, "{far} {near}");
}

/// Wheel of which one nodal diameter moves nearly alone: pushed in by a lobe, it comes out on the other side, where nothing seemed near.
#[test]
fn forces_that_close_a_far_gap_are_those_of_all_gaps() {
    let mut numbers = Numbers(3);
    let (nodes, wheel) = (nodes(), wheel(&mut numbers, |harmonic| if harmonic == 1 { 100.0 } else { 1.0 }));
    let clearance = 0.2;
    let restriction = Lobes { count: 1, amplitude: 2.5 * clearance, width_rad: 0.3, phase_rad: 0.03 };
    let casing = Casing {
        clearance: vec![clearance; NODES],
        restriction: Some(restriction.into()),
        ramp_revolutions: 0.0,
    };
    let simulation = simulation(&wheel, &nodes, &casing);
    // What moves makes bounds of the gaps of far sectors.
    let mode = |harmonic: usize| InitialMode {
        harmonic,
        family: 0,
        displacement: c64::new(4e-4, 3e-4),
        velocity: c64::new(0.0, 0.0),
    };
    let (mut contact, oscillators, fourier) = contact(&simulation, &[mode(1), mode(4)]);
    let now = Instant::beginning(1);
    assert!(!contact.look(pulp::Scalar, &oscillators, &fourier, now));
    let was_far = contact.gaps.is_far.clone();
    let mut q = vec![f64::INFINITY; contact.gaps.predicted.len()];
    for sector in 0..SECTORS {
        for node in 0..NODES {
            q[sector * contact.rows.stride + node] = gap(&contact, &fourier, now.step, sector, node);
        }
    }
    let bounds = contact.gaps.predicted.clone();
    let (mut statistics, mut work) = (RunStatistics::default(), EffectWork::default());
    contact
        .solve(&fourier, now, |_: &Rows, _: &mut [f64]| (), &mut statistics, &mut work)
        .expect("W is positive definite");
    let (active, lambda) = (contact.law.solution().active, contact.law.solution().lambda);
    let sector = |index: usize| contact.delassus.place(index).0;
    let was_bound = |&&index: &&usize| was_far[sector(index)] && bounds[index] < q[index] - 0.01 * clearance;
    assert!(active.iter().filter(was_bound).count() > 2, "{active:?} {was_far:?}");
    assert!(!contact.gaps.is_far.contains(&true));
    for (i, q) in q.iter().enumerate().filter(|(_, q)| q.is_finite()) {
        let moved: f64 = active.iter().zip(lambda).map(|(&j, f)| contact.delassus.entry(i, j) * f).sum();
        match active.iter().position(|&index| index == i) {
            Some(at) => assert!(lambda[at] > 0.0 && (q + moved).abs() < 1e-9, "{i}: {}", q + moved),
            None => assert!(q + moved > -1e-9, "{i}: {}", q + moved),
        }
    }
}
