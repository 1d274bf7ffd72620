//! Single-sided amplitude spectrum of a window.

use std::cell::RefCell;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

thread_local! {
    /// Last plan, reused: making one takes longer than using it, and the windows of a run are equally long.
    static PLAN: RefCell<Option<Arc<dyn Fft<f64>>>> = const { RefCell::new(None) };
}

/// Physical amplitudes of the first `bins` frequencies of `samples`: bin 0 is the magnitude of the mean, bin m a
/// sinusoid with m whole periods in the window; a sine of amplitude a reads a.
///
/// # Panics
/// If `bins` reaches beyond the Nyquist bin.
pub fn amplitudes(samples: &[f64], bins: usize) -> Vec<f64> {
    let n = samples.len();
    assert!(bins <= n / 2 + 1, "{bins} bins of {n} samples");
    let mut line: Vec<_> = samples.iter().map(|&x| Complex::new(x, 0.0)).collect();
    let plan = PLAN.with_borrow_mut(|last| match last {
        Some(plan) if plan.len() == n => Arc::clone(plan),
        _ => Arc::clone(last.insert(FftPlanner::new().plan_fft_forward(n))),
    });
    plan.process(&mut line);
    let single = |m: usize| m == 0 || 2 * m == n;
    (0..bins).map(|m| line[m].norm() * if single(m) { 1.0 } else { 2.0 } / n as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn reads_physical_amplitudes() {
        let n = 120;
        let wave = |t: f64| 0.5 - 2.0 * (3.0 * t + 0.4).cos() + 0.25 * (60.0 * t).cos();
        let samples: Vec<_> = (0..n).map(|i| wave(TAU * i as f64 / n as f64)).collect();
        let a = amplitudes(&samples, 61);
        for (m, expected) in [(0, 0.5), (1, 0.0), (3, 2.0), (59, 0.0), (60, 0.25)] {
            assert!((a[m] - expected).abs() < 1e-14, "bin {m}: {}", a[m]);
        }
    }
}
