//! Check whether a wheel can slide along its casing with the friction asked for.

use std::f64::consts::TAU;

use super::request::FrictionLaw;
use crate::effects::damping::convert::ratios;
use crate::effects::effect::AboutToRun;
use crate::not_runnable::NotRunnable;
use rubmap_wheel::dynamics::contact::disc::DiscFlexibility;
use rubmap_wheel::dynamics::contact::flexibility::{flexibility, outward_normals, ridge};
use rubmap_wheel::dynamics::contact::friction::SlidingFlexibility;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::schemes::massless_boundary::residual_flexibility;

/// Checks the contact operator of a scheme and its step (docs/method.md, Contact and Friction) before it runs, without the shares of an elastic
/// casing and of Coriolis forces, which only help or are small; a scene without friction passes.
pub(super) fn check(run: &AboutToRun<'_>) -> Result<(), NotRunnable> {
    let AboutToRun { request, wheel, contact_nodes, scheme, steps_per_revolution } = *run;
    let Some(friction) = &request.scene.friction else { return Ok(()) };
    let step = TAU / (wheel.speed_rad_s * steps_per_revolution as f64);
    // Which family has which ratio changes the operator by the order of ζωh.
    let damping = ratios(&request.scene);
    let normals = outward_normals(contact_nodes);
    let blocks = |from: &[_]| match scheme {
        Scheme::MasslessBoundary { kept_modes } => residual_flexibility(wheel, kept_modes, &normals, from),
        Scheme::CentralDifferences | Scheme::ExactModal => {
            flexibility(wheel, &normals, from, |harmonic, mode| {
                let omega = wheel.harmonics[harmonic].omega[mode];
                let zeta = damping.as_ref().map_or(0.0, |damping| damping.ratio(harmonic, mode));
                scheme.mode_step(omega, zeta, step, true).receptance
            })
        }
    };
    match friction.law {
        FrictionLaw::Sliding => {
            let flexibility = SlidingFlexibility::new(contact_nodes, blocks)?;
            let ridge = ridge(&flexibility.normal, wheel.sectors);
            flexibility.check(wheel.sectors, ridge, friction.coefficient)?;
        }
        FrictionLaw::Disc => {
            let flexibility = DiscFlexibility::new(contact_nodes, blocks)?;
            let ridge = ridge(flexibility.normal(), wheel.sectors);
            flexibility.check(wheel.sectors, ridge, friction.coefficient)?;
        }
    }
    Ok(())
}
