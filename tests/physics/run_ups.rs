//! Wheels whose speed changes: against a literal integration under K(Ω(t)), against the steady speeds of a sweep as the rate goes to zero,
//! in both directions at folds.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::request::{RunUpRequest, SweepRequest};
use rubmap::analysis::result::{PointStatus, RunUpFrame, RunUps};
use rubmap::analysis::run::{ModelFacts, ReducedSector, prepare, resolve_run_ups, resolve_sweep, run_speed};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::sector::SectorModel;
use serde_json::{Value, json};

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::to_the_end::to_the_end;

/// Driven wheel, and the speed at which an engine order meets the lowest mode of its nodal diameter.
struct Driven {
    sector: SectorModel,
    reduced: ReducedSector,
    resonance: f64,
}

const ORDER: u32 = 3;

impl Driven {
    fn new(sectors: usize) -> Self {
        let sector = wheel(WheelRecipe { sectors, ..WheelRecipe::default() });
        let reduced = prepare(&sector, 6, None, &NoCheckpoints, &Unwatched).unwrap();
        let lowest = |speed: f64| {
            let modal = ModalWheel::at(&reduced.wheel, speed, RotationEffects::stiffening(true)).unwrap();
            modal.harmonics[ORDER as usize % sectors].omega[0]
        };
        let (mut low, mut high) = (0.0, TOP_SPEED);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if f64::from(ORDER) * middle < lowest(middle) { low = middle } else { high = middle }
        }
        assert!(low > 0.1 * TOP_SPEED && low < 0.9 * TOP_SPEED, "{low}");
        Self { sector, reduced, resonance: low }
    }

    fn sensed(&self) -> usize {
        self.sector.sectors.min(3) - 1
    }

    fn scene(&self, force: f64, damping: f64) -> Value {
        json!({
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": damping},
            "engine_order_excitation": [{"order": ORDER, "amplitude": force, "contact_nodes": [0], "component": "radial"}],
        })
    }

    fn run_ups(&self, speed: Value, changes: &Value) -> RunUps {
        let mut request = json!({
            "model": "test wheel", "modes_per_speed": 6, "speed": speed, "max_engine_order": 12,
            "sensors": [{"contact_node": 1, "sector": self.sensed(), "component": "radial"}],
        });
        for (field, value) in changes.as_object().unwrap() {
            request[field] = value.clone();
        }
        let request: RunUpRequest = serde_json::from_value(request).unwrap();
        let facts = ModelFacts::of(&self.sector);
        to_the_end(&self.reduced, &resolve_run_ups(request, &facts).unwrap(), &facts)
    }

    /// Half peak-to-peak at steady speeds, each from where the one before ended.
    fn swept(&self, speeds: &[f64], direction: &str, changes: &Value) -> Vec<f64> {
        let mut request = json!({
            "model": "test wheel", "modes_per_speed": 6, "max_engine_order": 12, "sweep": direction,
            "speeds": {"values": speeds, "unit": "rad_s"},
            "sensors": [{"contact_node": 1, "sector": self.sensed(), "component": "radial"}],
            "integration": {"revolutions": 200, "window_revolutions": 8},
        });
        request["scene"] = changes["scene"].clone();
        let request: SweepRequest = serde_json::from_value(request).unwrap();
        let asked = resolve_sweep(request, &ModelFacts::of(&self.sector)).unwrap();
        let chain: Vec<u32> = asked.chain().unwrap_or_else(|| (0..speeds.len() as u32).collect());
        let (mut found, mut state) = (vec![0.0; speeds.len()], None);
        for index in chain {
            let result =
                run_speed(&self.reduced, &asked, index as usize, state.as_ref(), &Unwatched).unwrap();
            assert_eq!(result.point.status, PointStatus::Completed, "{:?}", result.point.message);
            found[index as usize] = result.point.responses[0].half_peak_to_peak;
            state = result.end_state;
        }
        found
    }
}

/// Literal integration of M q̈ + K(Ω(t)) q = f e^{jkθ(t)} of one nodal diameter, by the classical Runge–Kutta method; displacements of a
/// contact row of a sector at the samples of the angle.
fn literal(driven: &Driven, (start, rate): (f64, f64), samples: u64, per_revolution: usize) -> Vec<f64> {
    let harmonic = &driven.reduced.wheel.harmonics[ORDER as usize];
    let size = harmonic.mass.nrows();
    let inverse = {
        use faer::linalg::solvers::Solve;
        harmonic.mass.full_piv_lu().solve(Mat::<c64>::identity(size, size))
    };
    let sectors = driven.reduced.wheel.sectors as f64;
    let (k, force) = (f64::from(ORDER), (0.5 * sectors).sqrt());
    let mut load = Mat::<c64>::zeros(size, 1);
    load[(0, 0)] = c64::from(force);
    let load = &inverse * load;
    let time_at = |sample: u64| {
        let angle = TAU * sample as f64 / per_revolution as f64;
        2.0 * angle / (start + (start * start + 2.0 * rate * angle).sqrt())
    };
    let matrices: Vec<Mat<c64>> = harmonic.stiffness.coefficients.iter().map(|of| &inverse * of).collect();
    let acceleration = |t: f64, q: &Mat<c64>| {
        let omega = start + rate * t;
        let (x, angle) = (omega * omega, start * t + 0.5 * rate * t * t);
        let revolutions = angle / TAU;
        let growth =
            if revolutions < 1.0 { revolutions * revolutions * (3.0 - 2.0 * revolutions) } else { 1.0 };
        let turn = c64::new((k * angle).cos(), (k * angle).sin()) * growth;
        let pull = &matrices[0] * q
            + (&matrices[1] * q) * faer::Scale(c64::from(x))
            + (&matrices[2] * q) * faer::Scale(c64::from(x * x));
        &load * faer::Scale(turn) - pull
    };
    let add = |a: &Mat<c64>, b: &Mat<c64>, share: f64| a + b * faer::Scale(c64::from(share));
    let (mut q, mut v) = (Mat::<c64>::zeros(size, 1), Mat::<c64>::zeros(size, 1));
    let mut found = Vec::new();
    let alpha = TAU / sectors;
    let phase = c64::new((k * 2.0 * alpha).cos(), (k * 2.0 * alpha).sin()) * (2.0 / sectors).sqrt();
    let substeps = 12;
    for sample in 1..=samples {
        let (from, to) = (time_at(sample - 1), time_at(sample));
        let h = (to - from) / f64::from(substeps);
        for step in 0..substeps {
            let t = from + f64::from(step) * h;
            let (k1, l1) = (v.clone(), acceleration(t, &q));
            let (k2, l2) = (add(&v, &l1, 0.5 * h), acceleration(t + 0.5 * h, &add(&q, &k1, 0.5 * h)));
            let (k3, l3) = (add(&v, &l2, 0.5 * h), acceleration(t + 0.5 * h, &add(&q, &k2, 0.5 * h)));
            let (k4, l4) = (add(&v, &l3, h), acceleration(t + h, &add(&q, &k3, h)));
            for i in 0..size {
                let sum = |a: &Mat<c64>, b: &Mat<c64>, c: &Mat<c64>, d: &Mat<c64>| {
                    (a[(i, 0)] + (b[(i, 0)] + c[(i, 0)]) * 2.0 + d[(i, 0)]) * (h / 6.0)
                };
                q[(i, 0)] += sum(&k1, &k2, &k3, &k4);
                v[(i, 0)] += sum(&l1, &l2, &l3, &l4);
            }
        }
        // Contact node 1, radial, of sector 2.
        found.push((phase * q[(3, 0)]).re);
    }
    found
}

/// Run-up through a resonance of an undamped wheel that stiffens on the way: angles, K(Ω), and the state that is handed on from basis to
/// basis. The error falls with the tolerance of the angle.
#[test]
fn a_run_up_is_that_of_a_literal_integration_under_the_stiffness_of_the_moment() {
    let driven = Driven::new(10);
    let (from, to) = (0.96 * driven.resonance, 1.04 * driven.resonance);
    for rate in [0.25 * driven.resonance, -0.6 * driven.resonance] {
        let (first, last) = if rate > 0.0 { (from, to) } else { (to, from) };
        let speed = json!({"unit": "rad_s", "from": first, "to": last, "rates": [rate.abs()]});
        let mut errors = Vec::new();
        for tolerance in [4e-3, 1e-3] {
            let told = json!({"scene": driven.scene(1.0, 0.0), "angle_tolerance_rad": tolerance, "frame_revolutions": 4});
            let found = driven.run_ups(speed.clone(), &told);
            let run = &found.runs[0];
            let end = run.end.as_ref().unwrap();
            assert!(end.is_complete() && end.largest_angle_error_rad <= 4.0 * tolerance, "{end:?}");
            assert!(end.energy_residual < 1e-9 && end.transfer_loss < 1e-12, "{end:?}");
            let per_revolution = 520;
            let exact = literal(
                &driven,
                (first, rate),
                (end.revolutions * per_revolution as f64).round() as u64,
                per_revolution as usize,
            );
            let frames = exact.chunks(4 * per_revolution as usize);
            assert_eq!(frames.len(), run.frames.len());
            let scale = exact.iter().fold(0.0f64, |most, u| most.max(u.abs()));
            let off = frames.zip(&run.frames).map(|(exact, frame)| {
                let (low, high) =
                    exact.iter().fold((f64::MAX, f64::MIN), |(low, high), u| (low.min(*u), high.max(*u)));
                (frame.half_peak_to_peak[0] - 0.5 * (high - low)).abs() / scale
            });
            errors.push(off.fold(0.0, f64::max));
        }
        assert!(errors[1] < 2e-3 && errors[1] < 0.6 * errors[0], "{errors:?}");
    }
}

/// Slow run-ups of one blade whose tip rattles against a casing: its resonance leans over, and two motions last at the speeds beyond it. As
/// the rate goes to zero the envelope is that of the steady speeds of a sweep in the same direction: the large motion upwards, the small one
/// downwards.
#[test]
fn slow_run_ups_meet_the_steady_map_in_their_direction() {
    let driven = Driven::new(1);
    let mut scene = driven.scene(10.0, 0.02);
    scene["casing"] = json!({"clearance": {"values": [0.1, 1.0, 1.0]}});
    scene["contact"] = json!({});
    let changes = json!({"scene": scene});
    let r = driven.resonance;
    let path: Vec<f64> = (0..=10).map(|i| r * (1.02 + 0.02 * f64::from(i))).collect();
    let speeds = [0, 3, 5, 6, 8].map(|place| path[place]);
    let steady = |direction: &str| {
        let found = driven.swept(&path, direction, &changes);
        [0, 3, 5, 6, 8].map(|place: usize| found[place])
    };
    let (up, down) = (steady("up"), steady("down"));
    let slowly = |from: f64, to: f64, rate: f64| {
        let speed = json!({"unit": "rad_s", "from": from * r, "to": to * r, "rates": [rate], "hold_s": 0.3});
        let found = driven.run_ups(speed, &changes);
        let run = &found.runs[0];
        assert!(run.end.as_ref().unwrap().is_complete());
        speeds.map(|speed| {
            let within = |frame: &&RunUpFrame| {
                let [a, b] = frame.speeds_rad_s;
                (a.min(b)..=a.max(b)).contains(&speed)
            };
            run.frames.iter().rfind(within).unwrap().half_peak_to_peak[0]
        })
    };
    let off = |found: [f64; 5], steady: [f64; 5]| {
        found.iter().zip(steady).map(|(found, steady)| (found / steady - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!((2..4).all(|place| up[place] > 2.0 * down[place]), "{up:?} {down:?}");
    let errors = [400.0, 25.0].map(|rate| {
        let (rising, falling) = (slowly(1.0, 1.22, rate), slowly(1.22, 1.0, rate));
        [off(rising, up), off(falling, down)]
    });
    assert!(errors[1].iter().zip(errors[0]).all(|(slow, fast)| *slow < 0.025 && fast > 0.2), "{errors:?}");
}
