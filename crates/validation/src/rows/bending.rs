//! Blades that bend far.

use std::f64::consts::{FRAC_PI_2, PI};

use faer::{Mat, c64};
use rubmap_wheel::dynamics::bending::EnergyForm;
use rubmap_wheel::dynamics::bending::backbone::{FreeMode, FreeModes, FreeWheel};

use super::blade::relative;
use crate::claim::{Check, Claim, Computed, Subject};

pub(crate) const ROWS: &[Claim] = &[Claim {
    name: "backbone-of-a-hardening-blade",
    covers: &[Subject::Effect("geometric_nonlinearity"), Subject::Kind("modal_analysis")],
    claim: "The frequency of a blade that bends far follows its backbone curve.",
    reference: "closed form: ẍ + ω0²x + 2Ax³ = 0 has the solution X cn(σt; k), σ² = ω0² + 2AX², k² = AX²/σ² (elliptic integrals by the arithmetic-geometric mean)",
    quantity: "largest relative error of the frequency at the same amplitude of the first harmonic, up to 1.6 times the linear frequency",
    check: Check::Computed(Computed {
        error: duffing,
        wrong: "quartic energy",
        limit: 1e-6,
        reason: "the curve takes harmonics until twice as many change it by 1e-6",
    }),
}];

/// Arithmetic-geometric mean.
fn mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

/// Amplitude of the first harmonic and frequency of the motion of amplitude X.
fn elliptic(linear: f64, quartic: f64, amplitude: f64) -> (f64, f64) {
    let sigma2 = linear * linear + 2.0 * quartic * amplitude * amplitude;
    let k2 = quartic * amplitude * amplitude / sigma2;
    // K and K' are π/2 over the means of 1 and k', and of 1 and k.
    let (whole, other) = (FRAC_PI_2 / mean(1.0, (1.0 - k2).sqrt()), FRAC_PI_2 / mean(1.0, k2.sqrt()));
    let nome = (-PI * other / whole).exp();
    let first = amplitude * 2.0 * PI / (k2.sqrt() * whole) * nome.sqrt() / (1.0 + nome);
    (first, FRAC_PI_2 * sigma2.sqrt() / whole)
}

fn duffing(wrong: f64) -> anyhow::Result<f64> {
    let (linear, quartic) = (100.0, 1e4);
    let one = |value: f64| Mat::from_fn(1, 1, |_, _| value);
    let complex = || Mat::from_fn(1, 1, |_, _| c64::ONE);
    let potential = EnergyForm::new(&one(0.0), &one(wrong * quartic));
    let inertia = EnergyForm::zero(1);
    let modes = FreeModes { omega: vec![linear], rows: complex(), contact: complex() };
    let wheel = FreeWheel { sectors: 1, modes: vec![modes], potential: &potential, inertia: &inertia };
    let curve = wheel.backbone(FreeMode { nodal_diameter: 0, rank: 0 }, 1.0);
    let exact = |first: f64| {
        // The first harmonic grows with the amplitude, of which it is nine tenths and more.
        let (mut low, mut high) = (first, 1.2 * first);
        while high - low > 1e-15 * high {
            let middle = 0.5 * (low + high);
            if middle == low || middle == high {
                break;
            }
            if elliptic(linear, quartic, middle).0 > first { high = middle } else { low = middle }
        }
        elliptic(linear, quartic, 0.5 * (low + high)).1
    };
    let points = curve.points.iter().filter(|point| point.amplitude > 0.0);
    anyhow::ensure!(curve.points.last().is_some_and(|last| last.amplitude > 0.99), "the curve ends early");
    Ok(relative(points.map(|point| (point.omega, exact(point.amplitude)))))
}
