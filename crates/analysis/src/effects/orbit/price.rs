//! Price of an orbit: no more than that of having an effect at all.

use rubmap_wheel::dynamics::orbit::Orbit;

/// Orbit whose cost is measured.
pub(crate) fn sample() -> Orbit {
    Orbit { radius: 0.05, whirl_ratio: 0.4, phase_rad: 0.0 }
}
