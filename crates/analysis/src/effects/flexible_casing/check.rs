//! Checks of an elastic casing.

use super::convert::flexible_casing;
use super::request::{CasingMode, Ring};
use super::resolved::{FlexibleCasing, WavesOf};
use crate::model::ModelFacts;
use crate::request::SchemeChoice;
use crate::resolve::findings::{Findings, between};
use crate::resolve::limits;
use crate::resolved::ResolvedSweep;

const MOST_WAVES: u32 = 50;
/// Range of natural frequencies, rad/s.
const OMEGA: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

pub(super) fn check(found: &mut Findings, request: &ResolvedSweep, _: &ModelFacts) {
    const AT: &str = "/scene/flexible_casing";
    let Some(casing) = &request.scene.flexible_casing else { return };
    let FlexibleCasing { waves, damping_ratio } = casing;
    found.require(
        (0.0..1.0).contains(damping_ratio),
        &format!("{AT}/damping_ratio"),
        "a damping ratio lies in [0, 1)",
    );
    let mut bounded = true;
    match waves {
        WavesOf::Ring(ring) => {
            check_ring(found, ring);
            // A ring of as many waves as a number can say would fill the memory before it is refused.
            bounded = ring.n_max <= MOST_WAVES;
        }
        WavesOf::Modes(modes) => check_modes(found, modes),
    }
    if bounded {
        found.require(
            flexible_casing(casing).waves.iter().all(|wave| OMEGA.contains(&wave.omega)),
            AT,
            format!(
                "natural frequencies of a casing lie {} rad/s: check its numbers and units",
                between(&OMEGA)
            ),
        );
    }
    found.require(
        request.integration.scheme != SchemeChoice::MasslessBoundary,
        AT,
        "an elastic casing has mass where it is touched, which massless_boundary leaves no room for: take the scheme \
         exact_modal, central_differences or auto",
    );
}

fn check_ring(found: &mut Findings, ring: &Ring) {
    const AT: &str = "/scene/flexible_casing/ring";
    let Ring { radius, modulus, density, area, second_moment, n_max } = *ring;
    let numbers = [
        ("radius", radius),
        ("modulus", modulus),
        ("density", density),
        ("area", area),
        ("second_moment", second_moment),
    ];
    for (field, value) in numbers {
        found.require(
            limits::LENGTH.contains(&value),
            &format!("{AT}/{field}"),
            format!("this lies {}, unlike {value}", between(&limits::LENGTH)),
        );
    }
    found.require(
        n_max <= MOST_WAVES,
        &format!("{AT}/n_max"),
        format!("at most {} nodal diameters of the casing", MOST_WAVES),
    );
}

fn check_modes(found: &mut Findings, modes: &[CasingMode]) {
    const AT: &str = "/scene/flexible_casing/modes";
    for (index, mode) in modes.iter().enumerate().take(2 * MOST_WAVES as usize) {
        let CasingMode { nodal_diameter, frequency_hz, modal_mass } = mode;
        found.require(
            limits::LENGTH.contains(frequency_hz),
            &format!("{AT}/{index}/frequency_hz"),
            format!("a natural frequency lies {}", between(&limits::LENGTH)),
        );
        found.require(
            limits::LENGTH.contains(modal_mass),
            &format!("{AT}/{index}/modal_mass"),
            format!("a modal mass lies {}", between(&limits::LENGTH)),
        );
        found.require(
            *nodal_diameter <= MOST_WAVES,
            &format!("{AT}/{index}/nodal_diameter"),
            format!("at most {}", MOST_WAVES),
        );
    }
    found.require(
        (1..=MOST_WAVES as usize).contains(&modes.len()),
        AT,
        format!("between 1 and {} modes", MOST_WAVES),
    );
}
