//! Directions of travel of waves, the engine orders that drive them, and the frequencies of either direction.
//!
//! In the rotating frame a field that stands still in the fixed frame and has k periods passes sector s as
//! cos(k(sα + Ωt)). Where k = i + a·N that is the wave isα + kΩt of nodal diameter i, whose crests move against the rotation; where
//! k = a·N − i it is isα − kΩt, which moves with it.

use serde::{Deserialize, Serialize};

/// Direction in which a wave travels in the rotating frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Wave {
    /// Wave that travels with the rotation.
    Forward,
    /// Wave that travels against the rotation.
    Backward,
}

/// Nodal diameter that engine order `order` drives on `sectors` sectors: |k − N·round(k/N)| (aliasing).
pub fn fold(order: u32, sectors: u32) -> u32 {
    let rest = order % sectors;
    rest.min(sectors - rest)
}

/// Wave that engine order `order` drives on `sectors` sectors; none where the nodal diameter is single and stands.
pub fn driven_wave(order: u32, sectors: u32) -> Option<Wave> {
    let rest = order % sectors;
    match (2 * rest).cmp(&sectors) {
        _ if rest == 0 => None,
        std::cmp::Ordering::Less => Some(Wave::Backward),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(Wave::Forward),
    }
}

/// Natural frequencies over speed.
pub trait Frequencies {
    /// Frequencies in Hz of nodal diameter `nodal_diameter` at `speed_rad_s`, ascending; none at a speed at which the
    /// model has no modes (K(Ω) not positive definite).
    fn at(&self, speed_rad_s: f64, nodal_diameter: u32) -> Option<Vec<f64>>;
}

/// Frequencies in Hz over a grid of speeds, `[grid point][nodal diameter][family]`.
pub type Table = Vec<Vec<Vec<f64>>>;

/// Frequencies on a grid of speeds, and between its points.
#[derive(Debug, Clone, Copy)]
pub struct Branch<'a, F> {
    /// Frequencies on the grid.
    pub table: &'a Table,
    /// Frequencies at any speed.
    pub frequencies: &'a F,
}

/// Frequencies of both directions of travel.
#[derive(Debug, Clone, Copy)]
pub enum Waves<'a, F> {
    /// Equal frequencies in both directions, without Coriolis forces.
    Alike(Branch<'a, F>),
    /// Frequencies split by Coriolis forces.
    Split {
        /// Frequencies of waves that travel with the rotation.
        forward: Branch<'a, F>,
        /// Frequencies of waves that travel against the rotation.
        backward: Branch<'a, F>,
    },
}

impl<'a, F> Waves<'a, F> {
    /// Frequencies of waves that travel in direction `wave`; a standing wave, which is in both, has them of either.
    pub fn of(&self, wave: Wave) -> &Branch<'a, F> {
        match (self, wave) {
            (Self::Alike(branch), _)
            | (Self::Split { forward: branch, .. }, Wave::Forward)
            | (Self::Split { backward: branch, .. }, Wave::Backward) => branch,
        }
    }

    /// Whether Coriolis forces split the frequencies.
    pub fn are_split(&self) -> bool {
        matches!(self, Self::Split { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engine_orders_alias_onto_nodal_diameters() {
        assert_eq!([0, 2, 5, 6, 8, 10, 14].map(|k| fold(k, 10)), [0, 2, 5, 4, 2, 0, 4]);
        assert_eq!([3, 4, 7].map(|k| fold(k, 7)), [3, 3, 0]);
        assert_eq!(fold(5, 1), 0);
    }

    /// The crest of cos(k(sα + Ωt)) over the sectors, followed for a short time, moves as `driven_wave` says.
    #[test]
    fn engine_orders_drive_the_wave_whose_crest_moves_their_way() {
        use std::f64::consts::TAU;
        for sectors in [1u32, 2, 3, 7, 10] {
            for order in 1..30 {
                let nodal_diameter = fold(order, sectors);
                // Phase of the nodal diameter's Fourier coefficient over the sectors at Ωt = `turn`.
                let phase = |turn: f64| {
                    let (mut cosine, mut sine) = (0.0, 0.0);
                    for s in 0..sectors {
                        let angle = TAU * f64::from(s) / f64::from(sectors);
                        let value = (f64::from(order) * (angle + turn)).cos();
                        cosine += value * (f64::from(nodal_diameter) * angle).cos();
                        sine += value * (f64::from(nodal_diameter) * angle).sin();
                    }
                    f64::atan2(sine, cosine)
                };
                let expected = if 2 * nodal_diameter == sectors || nodal_diameter == 0 {
                    None
                } else if phase(1e-3) > phase(0.0) {
                    // The crest, at iθ = phase, goes towards +θ.
                    Some(Wave::Forward)
                } else {
                    Some(Wave::Backward)
                };
                assert_eq!(driven_wave(order, sectors), expected, "order {order} of {sectors}");
            }
        }
    }
}
