//! Steps that see the shape of a casing.

use std::f64::consts::TAU;

use super::shape::Shape;
use crate::effects::effect::WantedSteps;
use crate::resolved::Scene;

/// Number of steps over the half-width of a lobe that `"auto"` takes.
const AUTO_STEPS_PER_WIDTH: f64 = 10.0;

/// Smallest number of steps over the half-width of a lobe: fewer would pass it by.
const LEAST_STEPS_PER_WIDTH: f64 = 2.0;

pub(super) fn wanted_steps(scene: &Scene) -> WantedSteps {
    (
        steps(scene, AUTO_STEPS_PER_WIDTH),
        "ten steps fall on the half-width of a lobe, of a wave or of the sharpest bend of measured heights",
    )
}

/// Smallest number of steps per revolution that resolves the lobes of a scene.
pub(super) fn least_steps(scene: &Scene) -> f64 {
    steps(scene, LEAST_STEPS_PER_WIDTH)
}

/// Steps per revolution that put `per_width` of them on the narrowest lobe, wave or measured point that may be touched.
fn steps(scene: &Scene, per_width: f64) -> f64 {
    let narrowest = scene.touched_shape().and_then(Shape::narrowest_rad);
    narrowest.map_or(0.0, |width| (per_width * TAU / width).ceil())
}
