//! The production step beside the literal dense step (Eqs 8–10, two dense products), in one run: the paper's five
//! sizes, in free flight and with contact in about nine steps of ten.
//!
//! `cargo bench --bench step` prints criterion's estimates and, at the end, one table with their ratios.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput};
use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::casing::{Casing, Restriction};
use rubmap::dynamics::integrate::{SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::ModalWheel;
use rubmap::dynamics::oscillators::{Direction, ModalDamping};
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::central_differences::smallest_stable_steps;

#[path = "../tests/oracle/mod.rs"]
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod oracle;

use oracle::{DenseScheme, DenseWheel, free_gaps};

/// The paper's sizes N(n_b + 3k) with N = 10, n_b = 30: modes 3k per nodal diameter.
const SIZES: [(usize, usize); 5] = [(330, 3), (540, 24), (900, 60), (1140, 84), (1560, 126)];
const SPEED: f64 = 2500.0;
const DAMPING: f64 = 0.005;
/// The first is the ramp, in which hardly anything touches: seven of eight and a bit make nine steps of ten.
const REVOLUTIONS: usize = 8;

/// A wheel, a scene and its step.
struct Case {
    reduced: ReducedWheel,
    modal: ModalWheel,
    casing: Casing,
    steps: usize,
}

impl Case {
    fn new(reduced: &ReducedWheel, clearance: f64) -> Self {
        let modal = ModalWheel::at(reduced, SPEED, false).expect("the default impeller is sound");
        let smallest = smallest_stable_steps(modal.largest_frequency(), SPEED);
        let lobes = Restriction { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.0 };
        Self {
            casing: Casing {
                clearance: vec![clearance; reduced.contact.len()],
                restriction: Some(lobes),
                ramp_revolutions: 1.0,
            },
            steps: (smallest as f64 * 1.25) as usize / 100 * 100 + 100,
            reduced: reduced.clone(),
            modal,
        }
    }

    /// Time and contact share of `steps` production steps, in whole runs of eight revolutions with their set-up.
    fn production(&self, steps: u64) -> (Duration, f64) {
        let damping = ModalDamping { modal_ratio: DAMPING, family_ratios: Vec::new() };
        let sensor = SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 0 };
        let simulation = Simulation {
            wheel: &self.modal,
            contact_nodes: &self.reduced.contact,
            damping: Some(&damping),
            casing: Some(&self.casing),
            initial: &[],
            scheme: Scheme::CentralDifferences,
            sensors: &[sensor],
            steps_per_revolution: self.steps,
            samples_per_revolution: self.steps / 10,
            revolutions: REVOLUTIONS,
            window_revolutions: 1,
        };
        let per_run = (self.steps * REVOLUTIONS) as u64;
        let runs = steps.div_ceil(per_run);
        let start = Instant::now();
        let mut share = 0.0;
        for _ in 0..runs {
            share = simulation.run(&|_| true).statistics.contact_share();
        }
        (start.elapsed().mul_f64(steps as f64 / (runs * per_run) as f64), share)
    }

    /// The literal scheme with the casing tabulated beforehand, brought past the ramp.
    fn literal(&self) -> Literal {
        let wheel = DenseWheel::new(&self.reduced, SPEED, false);
        let h = TAU / (SPEED * self.steps as f64);
        let gaps = |first: f64| {
            let at = |q: usize| free_gaps(&self.casing, &self.reduced, first + q as f64 / self.steps as f64);
            (1..=self.steps).map(at).collect()
        };
        let mut literal = Literal {
            scheme: DenseScheme::new(&wheel, &wheel.modal_damping(DAMPING), &self.reduced, h),
            gaps: gaps(0.0),
            next: 0,
        };
        literal.advance(self.steps as u64);
        literal.gaps = gaps(1.0);
        literal.scheme.contact_steps = 0;
        literal
    }
}

struct Literal {
    scheme: DenseScheme,
    gaps: Vec<Vec<f64>>,
    next: usize,
}

impl Literal {
    fn advance(&mut self, steps: u64) {
        for _ in 0..steps {
            self.scheme.step(&self.gaps[self.next], active_set);
            self.next = (self.next + 1) % self.gaps.len();
        }
    }
}

/// Eq. 10 on the penetrating nodes, then exchanges until the problem is complementary: a fair contact solver for the
/// baseline, as Gauss–Seidel would slow it down.
fn active_set(w: &DMatrix<f64>, gap: &DVector<f64>, lambda: &mut DVector<f64>) {
    let mut active: Vec<usize> = (0..gap.len()).filter(|&i| gap[i] < 0.0).collect();
    for _ in 0..100 {
        let block = w.select_columns(&active).select_rows(&active);
        let rhs = DVector::from_iterator(active.len(), active.iter().map(|&i| -gap[i]));
        let solved = block.cholesky().expect("W is positive definite").solve(&rhs);
        lambda.fill(0.0);
        for (&i, &l) in active.iter().zip(&solved) {
            lambda[i] = l;
        }
        let after = gap + w * &*lambda;
        let keep = |i: &usize| if lambda[*i] != 0.0 { lambda[*i] > 0.0 } else { after[*i] < -1e-12 };
        let next: Vec<usize> = (0..gap.len()).filter(keep).collect();
        if next == active {
            return;
        }
        active = next;
    }
}

fn reduced_wheel(modes: usize) -> ReducedWheel {
    let package = rubmap::impeller::generate(&Default::default()).expect("the defaults are valid");
    let mut sector = rubmap::package::to_sector(package).expect("the generator makes valid packages");
    // One stiffness and 3k modes give the paper's sizes exactly; a step costs the same.
    sector.stiffness.truncate(1);
    sector.speeds_rad_s.truncate(1);
    reduce(&sector, &ReductionOptions::new(modes), &NoCheckpoints, &|_, _| true)
        .expect("the default impeller is sound")
}

fn main() {
    let mut criterion = Criterion::default()
        .configure_from_args()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2))
        .sample_size(10);
    let mut table = Vec::new();
    for (unknowns, modes) in SIZES {
        let reduced = reduced_wheel(modes);
        for (motion, clearance) in [("free flight", 2.0), ("contact", 0.30)] {
            let case = Case::new(&reduced, clearance);
            assert_eq!(case.modal.unknowns(), unknowns);
            let mut group = criterion.benchmark_group(format!("step, {motion}"));
            group.throughput(Throughput::Elements(1));
            let mut production = Vec::new();
            let mut share = 0.0;
            group.bench_function(BenchmarkId::new("production", unknowns), |b| {
                b.iter_custom(|steps| {
                    let (time, contact) = case.production(steps);
                    share = contact;
                    production.push(time.as_secs_f64() / steps as f64);
                    time
                });
            });
            let mut literal = case.literal();
            let mut dense = Vec::new();
            let mut taken = 0;
            group.bench_function(BenchmarkId::new("literal dense", unknowns), |b| {
                b.iter_custom(|steps| {
                    let start = Instant::now();
                    literal.advance(steps);
                    let time = start.elapsed();
                    taken += steps;
                    dense.push(time.as_secs_f64() / steps as f64);
                    time
                });
            });
            group.finish();
            let touching = if motion == "contact" { 0.85..0.97 } else { 0.0..1e-9 };
            assert!(
                touching.contains(&share),
                "contact in {share:.2} of the steps is not the motion measured"
            );
            let dense_share = literal.scheme.contact_steps as f64 / taken.max(1) as f64;
            table.push((unknowns, motion, median(production), median(dense), share, dense_share));
        }
    }
    println!(
        "\n| unknowns | motion | contact share (production / dense) | production, µs/step | literal dense, µs/step | ratio |"
    );
    println!("|---|---|---|---|---|---|");
    for (unknowns, motion, production, dense, share, dense_share) in table {
        println!(
            "| {unknowns} | {motion} | {share:.2} / {dense_share:.2} | {:.2} | {:.0} | {:.0} |",
            1e6 * production,
            1e6 * dense,
            dense / production
        );
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
