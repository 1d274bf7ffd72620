//! Response of the wheel to a steady load at nodal diameter 0, contact DOF free, at every given speed.

use faer::{Mat, c64};
use serde::{Deserialize, Serialize};

use super::options::{ReductionError, Watch};
use super::sector_factor::{SectorFactor, join, split};
use super::untied::UntiedSector;
use crate::dynamics::error::ModelError;
use crate::dynamics::sector::{CyclicMatrix, SectorModel};
use rubmap_numerics::dense::Dense;

/// Solutions of K̂(0) w = f at the given speeds.
#[derive(Debug, Clone)]
pub struct StaticResponse {
    /// Solutions W, `own DOF × speeds`: a column for each speed, the same in every sector.
    pub solutions: Mat<f64>,
    /// Span of the solutions, from which solutions between the speeds follow.
    pub span: StaticSpan,
}

/// Stiffness K(Ω) and load f on the span of the solutions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticSpan {
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Matrix WᵀK W for the stiffness at each speed, of one sector, row by row.
    stiffness: Vec<Vec<f64>>,
    /// Vector Wᵀf of one sector.
    load: Vec<f64>,
}

/// Computes the response to `load` on every sector of the wheel, a number for each own DOF; by the factors that a reduction makes.
///
/// # Errors
/// Cancellation, and a stiffness that is not positive definite.
pub fn static_response(
    sector: &SectorModel,
    load: &[f64],
    watch: Watch<'_>,
) -> Result<StaticResponse, ReductionError> {
    let matrices: Vec<_> = sector.stiffness.iter().collect();
    let untied = UntiedSector::new(sector, &matrices);
    let tie = untied.tie(0);
    let size = untied.internal() + untied.contact();
    let mut tied_load = Mat::<c64>::zeros(size, 1);
    for (dof, &force) in load.iter().enumerate() {
        let (row, factor) = untied.tied_row(&tie, dof);
        tied_load[(row, 0)] += factor.conj() * force;
    }
    let speeds = &sector.speeds_rad_s;
    let mut solutions = Mat::zeros(size, speeds.len());
    for (index, &speed_rad_s) in speeds.iter().enumerate() {
        if !watch(
            index as f64 / speeds.len() as f64,
            &format!("static response to rotation at {speed_rad_s} rad/s"),
        ) {
            return Err(ReductionError::Cancelled);
        }
        let indefinite = || ModelError::StiffnessNotPositiveDefinite {
            nodal_diameter: 0,
            speed_rad_s,
            hint: "the sector would give way to its own centrifugal load",
        };
        let stiffness = untied.assemble(&[(1.0, &sector.stiffness[index])]);
        let factor = SectorFactor::new(&untied, &stiffness).map_err(|_| indefinite())?;
        let tied = factor.tie(&stiffness, 0).map_err(|_| indefinite())?;
        tied.free.map_err(|_| indefinite())?;
        let solve = |right: &Mat<c64>| {
            let mut loads = split(&tied, right.as_ref());
            factor.solve(&mut loads);
            join(&loads)
        };
        let mut solution = solve(&tied_load);
        // One step of refinement takes the round-off of the factor away.
        let residual = &tied_load - untied.product(&stiffness, &tie, solution.as_ref());
        solution += solve(&residual);
        for row in 0..size {
            solutions[(row, index)] = solution[(row, 0)].re;
        }
    }
    let complex = Mat::from_fn(size, speeds.len(), |i, j| c64::new(solutions[(i, j)], 0.0));
    let on_span = |matrix: &CyclicMatrix| {
        let image = untied.product(&untied.assemble(&[(1.0, matrix)]), &tie, complex.as_ref());
        let full = complex.adjoint() * image;
        let entry = |i: usize, j: usize| 0.5 * (full[(i, j)].re + full[(j, i)].re);
        (0..speeds.len())
            .flat_map(|i| (0..speeds.len()).map(move |j| (i, j)))
            .map(|(i, j)| entry(i, j))
            .collect()
    };
    let work = |index: usize| (0..size).map(|row| tied_load[(row, 0)].re * solutions[(row, index)]).sum();
    let span = StaticSpan {
        speeds_rad_s: speeds.clone(),
        stiffness: sector.stiffness.iter().map(on_span).collect(),
        load: (0..speeds.len()).map(work).collect(),
    };
    let own = |dof: usize, index: usize| {
        let (row, factor) = untied.tied_row(&tie, dof);
        solutions[(row, index)] * factor.re
    };
    Ok(StaticResponse { solutions: Mat::from_fn(load.len(), speeds.len(), own), span })
}

impl StaticSpan {
    /// Span for a stiffness at rest alone.
    pub fn at_rest() -> Self {
        Self { speeds_rad_s: vec![0.0], stiffness: vec![vec![1.0]], load: vec![1.0] }
    }

    /// Coordinates of the response to Ω² f on the columns of [`StaticResponse::solutions`], with K(Ω) through the given matrices: the
    /// solution itself at the given speeds, the best of their span in energy between them. Without `stiffening` K(0) is taken.
    pub fn at(&self, speed_rad_s: f64, stiffening: bool) -> Vec<f64> {
        let square = speed_rad_s * speed_rad_s;
        let count = self.speeds_rad_s.len();
        let mut coordinates = vec![0.0; count];
        if count == 1 || !stiffening {
            coordinates[0] = square;
            return coordinates;
        }
        if let Some(given) = self.speeds_rad_s.iter().position(|&given| given == speed_rad_s) {
            coordinates[given] = square;
            return coordinates;
        }
        let x: Vec<f64> = self.speeds_rad_s.iter().map(|speed| speed * speed).collect();
        let weight = |i: usize| {
            (0..count).filter(|&j| j != i).map(|j| (square - x[j]) / (x[i] - x[j])).product::<f64>()
        };
        let mut stiffness = Mat::<f64>::zeros(count, count);
        for (i, matrix) in self.stiffness.iter().enumerate() {
            let weight = weight(i);
            stiffness += Mat::from_fn(count, count, |row, column| weight * matrix[count * row + column]);
        }
        // Where a wheel hardly stiffens its solutions are nearly one: eigenvectors that round-off has made are left out.
        let Ok(eigen) = Dense::eigenpairs(stiffness.as_ref()) else {
            coordinates[0] = square;
            return coordinates;
        };
        let largest = eigen.values.last().copied().unwrap_or(0.0);
        for (mode, &value) in
            eigen.values.iter().enumerate().filter(|&(_, &value)| value > ROUND_OFF * largest)
        {
            let vector = eigen.vectors.col(mode);
            let share: f64 = vector.iter().zip(&self.load).map(|(v, f)| v * f).sum();
            for (coordinate, v) in coordinates.iter_mut().zip(vector.iter()) {
                *coordinate += square * share / value * v;
            }
        }
        coordinates
    }
}

/// Share of the largest eigenvalue below which an eigenvalue of the stiffness on the span of the solutions is round-off.
const ROUND_OFF: f64 = 1e-13;
