//! Synthetic wheel that is run to measure its steps.

use std::f64::consts::TAU;
use std::time::Instant;

use faer::{Mat, c64};

use rubmap_numerics::sector_fourier::{harmonic_count, is_single};
use rubmap_wheel::dynamics::casing::{Casing, Lobes};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::integrate::{SensorRow, Simulation};
use rubmap_wheel::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap_wheel::dynamics::oscillators::ModalDamping;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::sector::ContactNode;
use rubmap_wheel::dynamics::statistics::RunStatistics;

/// Clearances over the height of the lobes: out of reach, and within reach.
const OUT_OF_REACH: f64 = 100.0;
const WITHIN_REACH: f64 = 0.6;

/// Rotational speed Ω of the measured runs, rad/s.
pub(crate) const SPEED: f64 = 1000.0;
pub(crate) const STEPS: usize = 480;
const SAMPLES: usize = 60;
/// Revolutions of the two runs: one for the set-up, and another one. Runs this short are now and then not interrupted by the other work of
/// a machine.
const REVOLUTIONS: [usize; 2] = [1, 2];
const ROUNDS: usize = 5;

/// Synthetic wheel of no particular shape.
#[derive(Clone)]
pub(crate) struct Wheel {
    modal: ModalWheel,
    contact_nodes: Vec<ContactNode>,
}

impl Wheel {
    pub(super) fn new(sectors: usize, nodes: usize, modes: usize) -> Self {
        let harmonic = |harmonic| ModalHarmonic {
            harmonic,
            single: is_single(harmonic, sectors),
            omega: (0..modes).map(|m| SPEED * (2.3 + 0.2 * harmonic as f64 + 1.5 * m as f64)).collect(),
            contact: Mat::from_fn(3 * nodes, modes, |dof, m| {
                let phase = 0.7 * ((dof + 1) * (m + 1)) as f64;
                c64::new(phase.cos(), if is_single(harmonic, sectors) { 0.0 } else { 0.3 * phase.sin() })
            }),
            gyroscopic: None,
        };
        let modal = ModalWheel {
            speed_rad_s: SPEED,
            sectors,
            repeats: 1,
            harmonics: (0..harmonic_count(sectors)).map(harmonic).collect(),
        };
        let node = |k: usize| ContactNode {
            id: k as u64,
            position: [1000.0, 0.0, k as f64],
            normal: [1.0, 0.0, 0.0],
            dofs: [3 * k, 3 * k + 1, 3 * k + 2],
        };
        Self { modal, contact_nodes: (0..nodes).map(node).collect() }
    }

    /// Wheel with arbitrary Coriolis forces added.
    pub(crate) fn turning(mut self) -> Self {
        for harmonic in &mut self.modal.harmonics {
            let modes = harmonic.omega.len();
            // Skew-symmetric.
            harmonic.gyroscopic = Some(Mat::from_fn(modes, modes, |i, j| {
                let size = 0.1 * ((i + 1) * (j + 1)) as f64;
                c64::from(size.sin() * (i as f64 - j as f64).signum() * f64::from(u8::from(i != j)))
            }));
        }
        self
    }

    pub(crate) fn modal(&self) -> &ModalWheel {
        &self.modal
    }

    pub(crate) fn contact_nodes(&self) -> &[ContactNode] {
        &self.contact_nodes
    }

    pub(super) fn unknowns(&self) -> usize {
        self.modal.unknowns()
    }

    /// Computing time of a run without spectra, s, and its statistics.
    fn run(&self, clearance: Option<f64>, effects: Effects<'_>, revolutions: usize) -> (f64, RunStatistics) {
        self.run_with(clearance, effects, revolutions, Spectra { sensors: 1, window_revolutions: 0 })
    }

    /// Computing time of a run, s, and its statistics.
    fn run_with(
        &self,
        clearance: Option<f64>,
        effects: Effects<'_>,
        revolutions: usize,
        spectra: Spectra,
    ) -> (f64, RunStatistics) {
        let casing = clearance.map(|clearance| Casing {
            clearance: vec![clearance; self.contact_nodes.len()],
            restriction: Some(
                Lobes {
                    count: 2,
                    amplitude: 1.0,
                    width_rad: 0.7 * TAU / self.modal.sectors as f64,
                    phase_rad: 0.0,
                }
                .into(),
            ),
            ramp_revolutions: 0.5,
        });
        let damping = ModalDamping { modal_ratio: 0.05, family_ratios: Vec::new(), ranks: Vec::new() };
        let sensor = SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 0 };
        let sensors = vec![sensor; spectra.sensors];
        let simulation = Simulation {
            wheel: &self.modal,
            contact_nodes: &self.contact_nodes,
            damping: Some(&damping),
            casing: casing.as_ref(),
            effects,
            initial: &[],
            scheme: Scheme::ExactModal,
            sensors: &sensors,
            steps_per_revolution: STEPS,
            samples_per_revolution: SAMPLES,
            revolutions,
            window_revolutions: spectra.window_revolutions,
            repeats: None,
            detail: None,
            states: None,
        };
        let start = Instant::now();
        let run = simulation.run(&|_| true);
        (start.elapsed().as_secs_f64(), run.statistics)
    }
}

/// Sensors and window of the spectra of a run.
#[derive(Clone, Copy)]
struct Spectra {
    sensors: usize,
    window_revolutions: usize,
}

/// Computing time that the spectra of a sensor add to a step of the window, s per unknown.
pub(super) fn measure_spectra(wheel: &Wheel) -> f64 {
    const SENSORS: usize = 4;
    const WINDOW: usize = 2;
    let mut best = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for (window_revolutions, best) in [0, WINDOW].into_iter().zip(&mut best) {
            let spectra = Spectra { sensors: SENSORS, window_revolutions };
            let (seconds, _) = wheel.run_with(None, Effects::default(), WINDOW, spectra);
            *best = best.min(seconds);
        }
    }
    let [without, with] = best;
    (with - without).max(0.0) / (WINDOW * STEPS * SENSORS * wheel.unknowns()) as f64
}

/// Wheel and effects of which a step is measured.
#[derive(Clone, Copy)]
pub(super) struct Case<'a> {
    pub(super) wheel: &'a Wheel,
    pub(super) effects: Effects<'a>,
}

impl<'a> Case<'a> {
    pub(super) fn of(wheel: &'a Wheel, effects: Effects<'a>) -> Self {
        Self { wheel, effects }
    }
}

/// Computing times of a step, s.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepSeconds {
    /// Step with nothing around the wheel.
    pub(super) without: f64,
    /// Step in front of two lobes that always face a blade, out of reach.
    pub(super) free: f64,
    /// Step in front of two lobes within reach, as if every step had a contact.
    pub(super) contact: f64,
}

/// Runs all cases in turns, so that other work of the machine affects them alike, and takes the best time of each.
pub(super) fn measure(cases: &[Case<'_>]) -> Vec<StepSeconds> {
    const CLEARANCES: [Option<f64>; 3] = [None, Some(OUT_OF_REACH), Some(WITHIN_REACH)];
    let mut best = vec![[Best::default(); CLEARANCES.len()]; cases.len()];
    for _ in 0..ROUNDS {
        for (case, best) in cases.iter().zip(&mut best) {
            for (&clearance, best) in CLEARANCES.iter().zip(best) {
                for (revolutions, (seconds, statistics)) in
                    REVOLUTIONS.into_iter().zip(best.seconds.iter_mut().zip(&mut best.statistics))
                {
                    let (time, counted) = case.wheel.run(clearance, case.effects, revolutions);
                    (*seconds, *statistics) = (seconds.min(time), counted);
                }
            }
        }
    }
    let seconds = |[without, free, contact]: &[Best; CLEARANCES.len()]| {
        let ((without, _), (free, _), (touching, share)) = (without.step(), free.step(), contact.step());
        StepSeconds { without, free, contact: free + (touching - free).max(0.0) / share.max(0.1) }
    };
    best.iter().map(seconds).collect()
}

/// Fastest run of each length, and its statistics.
#[derive(Clone, Copy)]
struct Best {
    seconds: [f64; 2],
    statistics: [RunStatistics; 2],
}

impl Default for Best {
    fn default() -> Self {
        Self { seconds: [f64::INFINITY; 2], statistics: [RunStatistics::default(); 2] }
    }
}

impl Best {
    /// Computing time of a step beyond the set-up, s, and the share of steps with contact.
    fn step(&self) -> (f64, f64) {
        let ([set_up, whole], [first, all]) = (self.seconds, self.statistics);
        let steps = (all.steps - first.steps).max(1) as f64;
        let share = (all.contact_steps - first.contact_steps) as f64 / steps;
        // Interrupted throughout: then with the set-up.
        let beyond = if whole > set_up { (whole - set_up) / steps } else { whole / all.steps.max(1) as f64 };
        (beyond.max(1e-9), share)
    }
}

#[cfg(test)]
impl Wheel {
    /// Asserts contact in most steps within reach and none out of reach, and that both runs reach the end.
    pub(super) fn assert_rubbing(&self, effects: Effects<'_>, what: &str) {
        for (clearance, least, most) in [(OUT_OF_REACH, 0.0, 0.0), (WITHIN_REACH, 0.3, 1.0)] {
            let (_, statistics) = self.run(Some(clearance), effects, 3);
            let share = statistics.contact_share();
            assert_eq!(statistics.steps, 3 * STEPS as u64, "{what}: it did not run to the end");
            assert!((least..=most).contains(&share), "{what}: {share} of the steps touch");
        }
    }
}
