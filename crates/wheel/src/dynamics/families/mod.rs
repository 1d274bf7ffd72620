//! Modal families of one nodal diameter, followed over speed by their shapes.
//!
//! At every speed the modes Φ of a nodal diameter are a basis that is orthonormal in the reduced mass M_r, which no speed changes. The modal assurance
//!
//! ```text
//! MAC = |φ_aᴴ M_r φ_b|²,   Σ_b MAC = 1 over all modes of one speed
//! ```
//!
//! is therefore the share of one shape in another. Families are named at rest, by rank. From there they are followed over a grid of speeds that the
//! model sets, [`GRID`] to its highest given speed: which speeds are asked for, and in which order, changes no name. On the grid a family takes on the
//! shape of its mode where [`CERTAIN`] of it is the shape before; through the middle of a veering, and at a crossing, where modes are a mixture of
//! both, it keeps the shape from before and is found again behind. So a family passes a veering that lies within a step of the grid on to the other
//! branch, as it passes a crossing, and stays on its branch where the shapes turn slowly.

use faer::{Mat, c64};

use super::error::ModelError;
use super::modal_wheel::mode_pairs;
use super::reduction::ReducedWheel;

pub mod assignment;
#[cfg(test)]
mod tests;

use assignment::assign;

/// Steps of the grid from rest to the highest speed of the model's matrices; it goes on to twice that speed.
pub const GRID: usize = 24;

/// Least modal assurance at which a family takes on the shape of its mode: shapes that turn by less than 30° in a step are followed on their branch.
pub const CERTAIN: f64 = 0.75;

/// Modes of the families of one nodal diameter at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilyModes {
    /// Natural frequencies ω, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Rank among them, from 0, of the mode of every family.
    pub ranks: Vec<usize>,
    /// Modal assurance of the mode of every family with the shape that was followed.
    pub assurance: Vec<f64>,
}

impl FamilyModes {
    /// Family, from 0, whose mode has this rank.
    pub fn family(&self, rank: usize) -> Option<usize> {
        self.ranks.iter().position(|&found| found == rank)
    }
}

/// Walk over ascending speeds that follows the families of one nodal diameter from rest.
#[derive(Debug)]
pub struct FamilyWalk<'a> {
    wheel: &'a ReducedWheel,
    nodal_diameter: usize,
    /// Distance of the grid's speeds, rad/s; none where no speed changes the modes.
    spacing: Option<f64>,
    /// Step of the grid that comes next.
    next: usize,
    /// Shapes that are followed, φᴴM_r of every family in a row.
    followed: Mat<c64>,
}

impl<'a> FamilyWalk<'a> {
    /// Walk at rest. Without `stiffening` all speeds have the same modes.
    ///
    /// # Errors
    /// Errors of the modes at rest.
    pub fn new(wheel: &'a ReducedWheel, nodal_diameter: usize, stiffening: bool) -> Result<Self, ModelError> {
        let spacing = spacing(wheel).filter(|_| stiffening);
        let shapes = mode_pairs(wheel, nodal_diameter, 0.0, stiffening)?.vectors;
        let followed = shapes.adjoint() * &wheel.harmonics[nodal_diameter].mass;
        Ok(Self { wheel, nodal_diameter, spacing, next: 1, followed })
    }

    /// Modes of the families at `speed_rad_s`, which no earlier speed exceeds.
    ///
    /// # Errors
    /// Errors of the decomposition. Where the stiffness is not positive definite modes have ω = 0.
    pub fn at(&mut self, speed_rad_s: f64) -> Result<FamilyModes, ModelError> {
        while let Some(spacing) = self.spacing.filter(|spacing| self.next as f64 * spacing < speed_rad_s) {
            if self.next > 2 * GRID {
                break;
            }
            let (modes, shapes) = self.compared(self.next as f64 * spacing)?;
            let mass = &self.wheel.harmonics[self.nodal_diameter].mass;
            for (family, &rank) in modes.ranks.iter().enumerate() {
                if modes.assurance[family] >= CERTAIN {
                    let row = shapes.col(rank).adjoint() * mass;
                    self.followed.row_mut(family).copy_from(&row);
                }
            }
            self.next += 1;
        }
        Ok(self.compared(speed_rad_s)?.0)
    }

    fn compared(&self, speed_rad_s: f64) -> Result<(FamilyModes, Mat<c64>), ModelError> {
        let pairs = mode_pairs(self.wheel, self.nodal_diameter, speed_rad_s, self.spacing.is_some())?;
        let products = &self.followed * &pairs.vectors;
        let shares = Mat::from_fn(products.nrows(), products.ncols(), |a, b| products[(a, b)].norm_sqr());
        let ranks = assign(shares.as_ref());
        let assurance = ranks.iter().enumerate().map(|(family, &rank)| shares[(family, rank)]).collect();
        let omega = pairs.values.iter().map(|lambda| lambda.max(0.0).sqrt()).collect();
        Ok((FamilyModes { omega, ranks, assurance }, pairs.vectors))
    }
}

fn spacing(wheel: &ReducedWheel) -> Option<f64> {
    let highest = wheel.speeds_rad_s.iter().copied().fold(0.0, f64::max);
    (wheel.speeds_rad_s.len() > 1 && highest > 0.0).then_some(highest / GRID as f64)
}

/// Speeds of the grid on which families are followed, from rest to two beyond `top_rad_s`; rest alone where no speed changes the modes.
pub fn grid(wheel: &ReducedWheel, stiffening: bool, top_rad_s: f64) -> Vec<f64> {
    let Some(spacing) = spacing(wheel).filter(|_| stiffening) else { return vec![0.0] };
    let last = ((top_rad_s / spacing).ceil().max(0.0) as usize).saturating_add(2).min(2 * GRID);
    (0..=last).map(|step| step as f64 * spacing).collect()
}
