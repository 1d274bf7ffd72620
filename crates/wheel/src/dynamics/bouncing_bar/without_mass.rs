//! Bouncing bar with a boundary without mass.

use super::super::schemes::{Scheme, massless_boundary};
use super::{Bar, PERIOD, TIP, bar_modes, courant_step};

/// Massless boundary (docs/method.md, A boundary without mass), computed apart: with 15 modes and 5333 steps a period it ends ten periods
/// with an error of 2.4e-2 and an energy drift of 5e-4, where a mass at the contact node has lost nearly all.
#[test]
fn a_boundary_without_mass_keeps_the_energy_of_ten_bounces() {
    let bar = Bar::drop(200, Scheme::MasslessBoundary { kept_modes: 15 }, PERIOD / 5333.0, 10);
    assert!(bar.tip_error(4) < 0.04, "{}", bar.tip_error(4));
    assert!(bar.tip_error(10) < 0.06, "{}", bar.tip_error(10));
    for period in [1, 4, 10] {
        assert!(bar.energy_change(period).abs() < 1e-3, "{period}: {}", bar.energy_change(period));
    }
    assert!(bar.run.energy.residual() < 1e-9, "{:e}", bar.run.energy.residual());
    assert!(bar.run.statistics.largest_penetration < 1e-11);
}

/// Drops a bar with as many modes kept as are stable at `share` of the number of steps, at Courant number 0.9.
fn carried(elements: usize, share: f64, periods: usize) -> Bar {
    let step = courant_step(elements, 0.9);
    let steps = (periods as f64 * PERIOD / step).ceil();
    let wheel = bar_modes(elements, steps * step);
    let kept_modes = massless_boundary::most_kept_modes(&wheel, &TIP, (share * steps) as u64).unwrap();
    Bar::drop(elements, Scheme::MasslessBoundary { kept_modes }, step, periods)
}

/// Rows of docs/method.md (What it is held against) for a contact node whose mass was taken away, another model of the same idea:
/// (elements, energy change and tip error of the first period).
#[test]
fn a_boundary_without_mass_is_of_the_size_of_a_massless_node() {
    for (elements, energy, error) in [(25, -0.0010, 0.036), (100, -0.0018, 0.0094), (400, -0.0003, 0.0028)] {
        let bar = carried(elements, 0.6, 1);
        let (lost, tip) = (bar.energy_change(1) / energy, bar.tip_error(1) / error);
        assert!(lost.abs() < 3.0 && tip < 2.0, "{elements}: {lost} {tip}");
    }
}

/// Energy grows at 1.8 times the longest step that is accepted: each state of the contact is still stable, bouncing between them is not.
#[test]
fn a_boundary_without_mass_gains_energy_beyond_its_step() {
    let [longest, close] = [1.0, 1.8].map(|share| carried(100, share, 1).energy_change(1));
    assert!(longest.abs() < 5e-3, "{longest}");
    assert!(close > 1.0, "{close}");
}
