//! Responses of the other modes to a motion, and their resonances.

use faer::c64;

use super::balance::{Balance, Series};
use super::end::Resonance;

/// Amplitude of a mode over that of the curve above which its resonance may end the curve.
const TAKES_PART: f64 = 1e-3;

/// Distance of a harmonic from the frequency of a mode, relative, within which they are said to be in resonance.
const NEAR: f64 = 0.05;

/// Amplitude of a mode over that of the curve, times the distance from its resonance, above which a passage is reported: the mode takes part over
/// 1e-4 of the frequency, as much as blades are damped.
const STRENGTH: f64 = 1e-4 * TAKES_PART;

/// Response of a mode to a harmonic of the forces.
struct Response {
    resonance: Resonance,
    /// Amplitude over that of the curve.
    share: f64,
    /// Distance of the frequency of the mode, as the motion changes it, from that of the harmonic, relative.
    distance: f64,
}

impl Response {
    /// Share times distance, which hardly changes as a resonance is passed.
    fn strength(&self) -> f64 {
        self.share * self.distance.abs()
    }
}

impl Balance<'_> {
    /// Responses of all modes but that of the curve.
    fn responses(&self, motion: &Series, amplitude: f64) -> Vec<Response> {
        let forces = self.forces(motion);
        let omega = motion.omega_squared.sqrt();
        let mut found = Vec::new();
        for (h, of_h) in forces.force.iter().enumerate().skip(1) {
            let moved = self.moved(h);
            let order = h as isize;
            for rank in moved.following() {
                let force = moved.force(rank, of_h);
                let size = force.norm();
                let unit = if size > 0.0 { force * (1.0 / size) } else { c64::ONE };
                let p: Vec<c64> = (0..self.column.len()).map(|j| moved.row(j, rank) * unit).collect();
                let linear = moved.modes.omega[rank].powi(2);
                let mut stiffness = linear;
                for (j, row) in p.iter().enumerate() {
                    for (k, column) in p.iter().enumerate() {
                        let same = forces.derivative(0, order, omega, j, k) * column;
                        let conjugate = forces.derivative(2 * order, -order, omega, j, k) * column.conj();
                        stiffness += (row.conj() * (same + conjugate)).re;
                    }
                }
                let share = size / (linear - (h * h) as f64 * motion.omega_squared).abs() / amplitude;
                found.push(Response {
                    resonance: Resonance { harmonic: h, nodal_diameter: moved.nodal_diameter, rank },
                    share: if amplitude > 0.0 { share } else { 0.0 },
                    distance: stiffness.max(0.0).sqrt() / (h as f64 * omega) - 1.0,
                });
            }
        }
        found
    }

    /// Resonance near a motion, if there is one: that of the mode with the largest amplitude.
    pub(super) fn nearest(&self, motion: &Series, amplitude: f64) -> Option<Resonance> {
        let responses = self.responses(motion, amplitude).into_iter();
        let near = responses.filter(|mode| mode.share > TAKES_PART && mode.distance.abs() < NEAR);
        near.max_by(|a, b| a.share.total_cmp(&b.share)).map(|mode| mode.resonance)
    }

    /// Resonances that lie between two motions, strong enough to be reported.
    pub(super) fn passed(&self, before: (&Series, f64), after: (&Series, f64)) -> Vec<Resonance> {
        let harmonics = after.0.harmonics.len() - 1;
        let [before, after] = [before, after].map(|(motion, a)| self.responses(&motion.of(harmonics), a));
        let both = before.iter().zip(&after).filter(|(before, after)| {
            before.distance * after.distance < 0.0 && before.strength().max(after.strength()) > STRENGTH
        });
        both.map(|(_, after)| after.resonance).collect()
    }
}
