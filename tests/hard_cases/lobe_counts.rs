//! Lobe counts n that do not divide the number of sectors N.
//!
//! Codes that simulate one n-th of the wheel, or fold engine orders by a wrong rule, excite nodal diameters that the
//! symmetry forbids, or miss those it allows. Theory, with g = gcd(n, N): turning the wheel by N/g sectors turns it by
//! n/g whole lobe spacings, so from rest every N/g-th sector does the same and only nodal diameters that are multiples of g
//! move, at all times. Once the response turns with the lobes, u_s(t) = U(sα + Ωt), it has only engine orders m·n,
//! each on nodal diameter |m·n − N·round(m·n/N)|.

use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{KEPT_MODES, SCHEMES, assert_sound, reduced, run, sweep};

/// Wheels as N, n, gcd(n, N).
const WHEELS: [(usize, u32, usize); 9] = [
    (10, 3, 1),
    (10, 4, 2),
    (10, 5, 5),
    (10, 10, 10),
    (12, 8, 4),
    (9, 6, 3),
    (7, 3, 1),
    (7, 14, 7),
    (6, 4, 2),
];

/// Number of steps, a multiple of every N and n above: blades meet every lobe at the same fraction of a step, or steps would tell the lobes apart.
const STEPS: u32 = 7560;

/// Number of recorded engine orders, so high that every step is recorded: what aliases onto a line of the spectrum from
/// higher orders comes on another nodal diameter.
const ORDERS: u32 = 480;

/// Nodal diameter |k − N·round(k/N)| of an engine order k.
fn alias(order: usize, sectors: usize) -> usize {
    (order as f64 - sectors as f64 * (order as f64 / sectors as f64).round()).abs() as usize
}

#[test]
fn nodal_diameters_are_multiples_of_the_common_divisor() {
    for scheme in SCHEMES {
        for (sectors, lobes, divisor) in WHEELS {
            let sector = wheel(WheelRecipe { sectors, seed: 3, ..Default::default() });
            // From early on: transients obey the symmetry too.
            let changes = json!({
                "scene": {"damping": {"modal_ratio": 0.02}, "casing": {"lobes": {"count": lobes, "width_rad": 0.2}}},
                "integration": {"revolutions": 4, "window_revolutions": 3}
            });
            let request = sweep(&sector, scheme, &[0.6 * TOP_SPEED], changes);
            let results = run(&reduced(&sector, 6), &request);
            assert_sound(&results[0], 1.0);
            let spectrum = &results[0].spectra.as_ref().unwrap().sensors[0];
            let of = |i: usize| spectrum.nodal_diameters[i].iter().fold(0.0f64, |m, &a| m.max(a));
            let largest = (0..=sectors / 2).map(of).fold(0.0, f64::max);
            for i in 0..=sectors / 2 {
                let share = of(i) / largest;
                if i % divisor == 0 {
                    assert!(
                        share > 1e-4,
                        "{scheme} N {sectors} n {lobes}: nodal diameter {i} is still: {share:e}"
                    );
                } else {
                    assert!(
                        share < 1e-8,
                        "{scheme} N {sectors} n {lobes}: nodal diameter {i} moves: {share:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn engine_orders_are_multiples_of_the_lobe_count_on_their_alias() {
    for scheme in SCHEMES {
        for (sectors, lobes, _) in WHEELS {
            let sector = wheel(WheelRecipe { sectors, seed: 3, ..Default::default() });
            let changes = json!({
                "scene": {"damping": {"modal_ratio": 0.4}, "casing": {"lobes": {"count": lobes, "width_rad": 0.3}}},
                "integration": {"revolutions": 10, "window_revolutions": 2, "steps_per_revolution": STEPS, "kept_modes": KEPT_MODES},
                "max_engine_order": ORDERS
            });
            let request = sweep(&sector, scheme, &[0.2 * TOP_SPEED], changes);
            let results = run(&reduced(&sector, 6), &request);
            assert_sound(&results[0], 1.0);
            let spectrum = &results[0].spectra.as_ref().unwrap().sensors[0];
            let largest = spectrum.amplitude[1..].iter().fold(0.0f64, |m, &a| m.max(a));
            for (bin, &amplitude) in spectrum.amplitude.iter().enumerate() {
                // Two bins an order. Transients have decayed to 1e-9 and less.
                if bin % (2 * lobes as usize) != 0 {
                    assert!(
                        amplitude < 1e-7 * largest,
                        "{scheme} N {sectors} n {lobes}: {amplitude:e} in bin {bin}"
                    );
                    continue;
                }
                for (i, line) in spectrum.nodal_diameters.iter().enumerate() {
                    let total = amplitude * (sectors as f64).sqrt();
                    if i == alias(bin / 2, sectors) {
                        assert!(
                            (line[bin] - total).abs() < 1e-7 * largest,
                            "{sectors} {lobes} {bin} {i}: {} {total}",
                            line[bin]
                        );
                    } else {
                        assert!(line[bin] < 1e-7 * largest, "{sectors} {lobes} {bin} {i}: {:e}", line[bin]);
                    }
                }
            }
            assert!(spectrum.amplitude[2 * lobes as usize] > 1e-2 * largest);
        }
    }
}
