//! Heights of a casing, literally.

use std::f64::consts::TAU;

use rubmap::dynamics::casing::{Profile, Restriction};

/// Height p at an angle in the fixed frame and a contact node. Measured curves are those of the product, which its own tests hold
/// to the equations of a spline.
pub(crate) fn height(restriction: &Restriction, angle: f64, node: usize) -> f64 {
    let lobe = |amplitude: f64, width: f64, centre: f64| {
        let distance = (angle - centre).sin().atan2((angle - centre).cos());
        amplitude * (-(distance / width).powi(2)).exp()
    };
    let mut p = 0.0;
    for part in &restriction.parts {
        let share = part.along_chord.as_ref().map_or(1.0, |along| along[node]);
        match &part.profile {
            Profile::Lobes(lobes) => {
                for l in 0..lobes.count {
                    let centre = TAU * f64::from(l) / f64::from(lobes.count) + lobes.phase_rad;
                    p += share * lobe(lobes.amplitude, lobes.width_rad, centre);
                }
            }
            Profile::Each(lobes) => {
                for one in lobes {
                    p += share * lobe(one.amplitude, one.width_rad, one.angle_rad);
                }
            }
            Profile::Wave { order, amplitude, phase_rad } => {
                let order = f64::from(*order);
                let (cosine, sine) = ((order * phase_rad).cos(), (order * phase_rad).sin());
                p += share * amplitude * (cosine * (order * angle).cos() + sine * (order * angle).sin());
            }
            Profile::Measured(measured) => {
                let (line, next, between) = measured.nodes[node];
                let [first, second] = [line, next].map(|line| measured.curves[line].at(angle));
                p += share * ((1.0 - between) * first + between * second);
            }
        }
    }
    p
}
