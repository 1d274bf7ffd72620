//! Relaxation of a linear field under Green–Lagrange strain, the coordinates of its motion held.
//!
//! ```text
//! minimise  V(u + v, β)     over v = 0 on the faces, Ψᵀ K v = 0
//! z = K⁻¹ g − Ψ Ψᵀ g,  z_β = K_αα⁻¹ g_β          g = ∂V/∂v,  ΨᵀKΨ = 1
//! ```
//!
//! by conjugate gradients (Polak and Ribière) with this preconditioner, an exact minimum of the quartic on every line. Ψ are the lowest modes
//! with held faces and what the loads K u of the linear field deform besides, so that K u = K Ψ Ψᵀ K u does no work on v: a motion whose energy
//! is quadratic does not relax at all.

use faer::{ColRef, Mat, MatMut};
use nalgebra::Vector3;

use super::modes::lowest_modes;
use super::quartic::first_minimum;
use super::sector::HeldSector;
use rubmap_numerics::hermitian::EigenError;
use rubmap_numerics::sparse_cholesky::{NotPositiveDefinite, SparseCholesky};
use rubmap_solid::green_lagrange::BUBBLES;

/// Number of held modes: a dozen carry the motion of a blade.
const MODES: usize = 12;

/// Share of the linear energy that the preconditioned gradient may still promise, of which about half would be won: far below the smallest
/// excess that is judged, 2 %, also along directions that are ten times as soft as the stiffness says.
const PROMISED: f64 = 1e-5;

/// Share of the energy below which the rest of a field is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Largest number of steps; fields that are in doubt take ten to a hundred.
const MOST_STEPS: usize = 400;

/// Relaxation of the fields of one sector.
#[derive(Debug)]
pub(crate) struct Relaxation<'a> {
    sector: &'a HeldSector,
    factor: SparseCholesky<'a, f64>,
    /// Modes Φ with ΦᵀKΦ = 1.
    modes: Mat<f64>,
}

/// Energy and second-order motion of a field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Relaxed {
    /// Energy of the linear strain.
    pub(crate) linear: f64,
    /// Energy of the linear field under Green–Lagrange strain.
    pub(crate) raw: f64,
    /// Energy of the relaxed field.
    pub(crate) relaxed: f64,
    /// Second-order motion v of the contact nodes, in r, θ, z.
    pub(crate) second_order: Vec<[f64; 3]>,
    /// Second-order change of radius and height of the contact nodes: v, and what a tangential motion adds to the radius.
    pub(crate) to_casing: Vec<[f64; 2]>,
    /// Number of steps.
    pub(crate) steps: usize,
}

/// Reason why a field cannot be relaxed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum NotRelaxed {
    /// Field without a motion.
    #[error("the field has no motion")]
    Still,
    /// Search that reached no minimum.
    #[error("no minimum of the bent blade's energy was found within {MOST_STEPS} steps")]
    Steps,
    /// Sector that can move as a rigid body, or in which nothing is free.
    #[error("the sector's stiffness is not positive definite: is anything clamped?")]
    CanMove,
    /// Modes that cannot be computed.
    #[error("the modes of the sector cannot be computed: {0}")]
    Modes(#[from] EigenError),
}

impl From<NotPositiveDefinite> for NotRelaxed {
    fn from(_: NotPositiveDefinite) -> Self {
        Self::CanMove
    }
}

/// Iterate: displacements of all nodes, and β of every element.
#[derive(Clone)]
struct State {
    field: Vec<Vector3<f64>>,
    beta: Vec<[Vector3<f64>; BUBBLES]>,
}

/// Gradient, step or direction: components of the free displacements, and of β of every element.
#[derive(Clone)]
struct Slope {
    free: Vec<f64>,
    beta: Vec<[Vector3<f64>; BUBBLES]>,
}

impl<'a> Relaxation<'a> {
    /// Factors the stiffness and computes the held modes.
    ///
    /// # Errors
    /// A sector without a factor or modes.
    pub(crate) fn new(sector: &'a HeldSector) -> Result<Self, NotRelaxed> {
        let factor = SparseCholesky::new(&sector.symbolic, &sector.stiffness)?;
        let modes = lowest_modes(&factor, &sector.mass, MODES)?;
        Ok(Self { sector, factor, modes })
    }

    /// Relaxes a linear `field`, the displacements of all nodes in x, y, z.
    ///
    /// # Errors
    /// A field that does not move or finds no minimum.
    pub(crate) fn relax(&self, field: &[Vector3<f64>]) -> Result<Relaxed, NotRelaxed> {
        let sector = self.sector;
        let still = vec![[Vector3::zeros(); BUBBLES]; sector.elements.len()];
        let mut now = State { field: field.to_vec(), beta: still.clone() };
        let [linear] = sector.sum(|_, nodes, element| {
            [element.linear_energy(&element.values(&HeldSector::at(nodes, field), &still[0]))]
        });
        if !(linear > 0.0 && linear.is_finite()) {
            return Err(NotRelaxed::Still);
        }
        let raw = self.energy(&now);
        let held = self.held(&sector.linear_force(field));
        let mut free = vec![0.0; sector.rows.len()];
        let (mut direction, mut before): (Option<Slope>, Option<(Slope, f64)>) = (None, None);
        for steps in 0..=MOST_STEPS {
            let (gradient, beta) = sector.force(&now.field, &now.beta);
            let gradient = Slope { free: gradient, beta };
            let step = self.preconditioned(&gradient, &held);
            let promised = dot(&gradient, &step);
            if promised <= PROMISED * linear {
                return Ok(self.outcome([linear, raw], (&now, &free, field), steps));
            }
            let keep =
                before.as_ref().map_or(0.0, |(old, was)| ((promised - dot(old, &step)) / was).max(0.0));
            let mut along = minus(&step, direction.as_ref(), keep);
            if dot(&gradient, &along) >= 0.0 {
                along = minus(&step, None, 0.0);
            }
            let spread = sector.spread(&along.free);
            let line = sector.sum(|index, nodes, element| {
                let values = element.values(&HeldSector::at(nodes, &now.field), &now.beta[index]);
                element.line(&values, &element.values(&HeldSector::at(nodes, &spread), &along.beta[index]))
            });
            let length = first_minimum(line).ok_or(NotRelaxed::Steps)?;
            now.field.iter_mut().zip(&spread).for_each(|(u, d)| *u += d * length);
            free.iter_mut().zip(&along.free).for_each(|(v, d)| *v += d * length);
            for (beta, along) in now.beta.iter_mut().zip(&along.beta) {
                beta.iter_mut().zip(along).for_each(|(beta, along)| *beta += along * length);
            }
            before = Some((gradient, promised));
            direction = Some(along);
        }
        Err(NotRelaxed::Steps)
    }

    fn energy(&self, state: &State) -> f64 {
        let [energy] = self.sector.sum(|index, nodes, element| {
            [element.energy(&element.values(&HeldSector::at(nodes, &state.field), &state.beta[index]))]
        });
        energy
    }

    /// Coordinates of the motion of a field with these `load`s K u, as vectors that are orthonormal in K: the modes, and what the loads
    /// deform besides.
    pub(super) fn held(&self, load: &[f64]) -> Mat<f64> {
        let coordinates = self.modes.transpose() * ColRef::from_slice(load);
        let (size, modes) = (load.len(), self.modes.ncols());
        let mut rest = load.to_vec();
        self.factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut rest, size, 1));
        let of_modes = &self.modes * &coordinates;
        rest.iter_mut().zip(of_modes.iter()).for_each(|(rest, u)| *rest -= u);
        let energy: f64 = rest.iter().zip(load).map(|(u, f)| u * f).sum();
        let whole = usize::from(energy > ROUND_OFF * coordinates.squared_norm_l2());
        Mat::from_fn(size, modes + whole, |row, at| {
            if at < modes { self.modes[(row, at)] } else { rest[row] / energy.sqrt() }
        })
    }

    /// Steepest step K⁻¹ g − Φ Φᵀ g of a gradient, and K_αα⁻¹ g_β.
    fn preconditioned(&self, gradient: &Slope, held: &Mat<f64>) -> Slope {
        let size = gradient.free.len();
        let mut free = gradient.free.clone();
        self.factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut free, size, 1));
        let held = held * (held.transpose() * ColRef::from_slice(&gradient.free));
        free.iter_mut().zip(held.iter()).for_each(|(free, held)| *free -= held);
        let beta = (self.sector.elements.iter().zip(&gradient.beta))
            .map(|((_, element), force)| element.solve_bubbles(force))
            .collect();
        Slope { free, beta }
    }

    fn outcome(
        &self,
        [linear, raw]: [f64; 2],
        (now, free, field): (&State, &[f64], &[Vector3<f64>]),
        steps: usize,
    ) -> Relaxed {
        let moved = self.sector.spread(free);
        let local = |of: &[Vector3<f64>]| -> Vec<[f64; 3]> {
            let places = self.sector.contact.iter();
            places.map(|at| at.directions.map(|along| along.dot(&of[at.node as usize]))).collect()
        };
        let second_order = local(&moved);
        let to_casing = (self.sector.contact.iter().zip(&second_order).zip(local(field)))
            .map(|((at, v), u)| {
                let radius = (at.radius + u[0] + v[0]).hypot(u[1] + v[1]);
                [radius - at.radius - u[0], v[2]]
            })
            .collect();
        Relaxed { linear, raw, relaxed: self.energy(now), second_order, to_casing, steps }
    }

    /// Factor of the stiffness.
    #[cfg(test)]
    pub(super) fn factor(&self) -> &SparseCholesky<'a, f64> {
        &self.factor
    }

    /// Held modes over the free displacements.
    #[cfg(test)]
    pub(super) fn modes(&self) -> &Mat<f64> {
        &self.modes
    }
}

fn dot(a: &Slope, b: &Slope) -> f64 {
    let free: f64 = a.free.iter().zip(&b.free).map(|(a, b)| a * b).sum();
    let of_element = |(a, b): (&[Vector3<f64>; BUBBLES], &[Vector3<f64>; BUBBLES])| {
        a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>()
    };
    free + a.beta.iter().zip(&b.beta).map(of_element).sum::<f64>()
}

/// Direction −step + keep · direction.
fn minus(step: &Slope, direction: Option<&Slope>, keep: f64) -> Slope {
    let mut along = step.clone();
    along.free.iter_mut().for_each(|value| *value = -*value);
    along.beta.iter_mut().flatten().for_each(|value| *value = -*value);
    if let Some(direction) = direction.filter(|_| keep > 0.0) {
        along.free.iter_mut().zip(&direction.free).for_each(|(sum, old)| *sum += keep * old);
        for (sum, old) in along.beta.iter_mut().zip(&direction.beta) {
            sum.iter_mut().zip(old).for_each(|(sum, old)| *sum += old * keep);
        }
    }
    along
}
