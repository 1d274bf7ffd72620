//! Price of forces at engine orders: no more than that of other effects that act on the modes.

use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;

/// Force whose cost is measured.
pub(crate) fn sample() -> Vec<EngineOrderExcitation> {
    vec![EngineOrderExcitation {
        order: 4,
        directions: vec![Direction { node: 0, components: [0.0, 0.0, 1.0] }],
        amplitude: 1.0,
        phase_rad: 0.0,
        ramp_revolutions: 0.5,
    }]
}
