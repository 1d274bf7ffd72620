//! Derivative of the return map, a [`Passage`].
//!
//! Within one sequence of sets of nodes that touch, a step is affine in the state. With mass at the contact,
//!
//! ```text
//! δd = keep·δd − pull·δz,  δz += δd,   δλ_A = W_AA⁻¹ A δz,   δz −= R Aᵀ δλ_A,  δd alike
//! ```
//!
//! A being the normal displacement of the nodes that touch per unit of every mode, R the receptances; without mass, δλ acts on the step
//! after. With friction the forces act along other rows than A, B = A + μ…, so that it is Bᵀ δλ_A that pushes, and W_AA is not symmetric;
//! mistuning and Coriolis forces are in `coupling`. Waves of an elastic casing are taken as the wheel sees them: they open gaps, and are
//! pressed, by rows of A that stay, and turn back by nΩh after each step. The derivative is exact as long as no state nearby lets another
//! set touch; where one does, the derivative jumps, and this is the one on the side that was traced. Sets change at steps, so that for the
//! motion in continuous time the derivative is of first order in the step, where the response itself is of second.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par, c64};

use super::coupling::Coupling;
use crate::dynamics::contact::flexibility::outward_normals;
use crate::dynamics::direction::Direction;
use crate::dynamics::flexible_casing::{CasingMotion, LinearWave};
use crate::dynamics::integrate::{Passage, Touching, Trace, Unknown};
use crate::dynamics::schemes::{ModeStep, Scheme};

/// Derivative of the map at a state that was mapped.
#[derive(Debug)]
pub struct Tangent<'a> {
    passage: &'a Passage<'a>,
    /// Keep, pull and receptance of every unknown, those of the casing last.
    keep: Vec<f64>,
    pull: Vec<f64>,
    receptance: Vec<f64>,
    /// Rows A of all contact nodes, `unknowns × (sector, node)`.
    rows: Mat<f64>,
    /// Rows B of all contact nodes, `unknowns × (sector, node)`; absent without friction.
    sliding: Option<Mat<f64>>,
    coupling: Coupling,
    nodes: usize,
    massless: bool,
}

impl<'a> Tangent<'a> {
    /// Derivative at the last state that `passage` mapped.
    pub fn of(passage: &'a Passage<'a>) -> Self {
        let simulation = passage.simulation();
        let (wheel, touching) = (simulation.wheel, simulation.casing.is_some());
        let step = passage.step_s();
        let mode_step = |unknown: &Unknown| {
            let omega = wheel.harmonics[unknown.harmonic].omega[unknown.family];
            let zeta =
                simulation.damping.map_or(0.0, |damping| damping.ratio(unknown.harmonic, unknown.family));
            (omega, simulation.scheme.mode_step(omega, zeta, step, touching))
        };
        let mut steps: Vec<_> = passage.unknowns().iter().map(mode_step).collect();
        let waves: Vec<_> =
            passage.flexible_casing().into_iter().flat_map(CasingMotion::linear_waves).collect();
        steps.extend(passage.casing_unknowns().iter().map(|unknown| {
            let LinearWave { keep, receptance, stiffness, .. } = waves[unknown.wave];
            (stiffness.sqrt(), ModeStep { keep, receptance })
        }));
        let normals = outward_normals(simulation.contact_nodes);
        let rows = |directions: &[Direction]| rows(passage, directions, &waves);
        let friction = simulation.effects.friction.filter(|_| touching);
        let receptance: Vec<f64> = steps.iter().map(|(_, step)| step.receptance).collect();
        Self {
            passage,
            keep: steps.iter().map(|(_, step)| step.keep).collect(),
            pull: steps.iter().map(|(omega, step)| omega * omega * step.receptance).collect(),
            rows: rows(if touching { &normals } else { &[] }),
            sliding: friction.map(|friction| rows(friction.directions)),
            coupling: Coupling::of(passage, &receptance),
            receptance,
            nodes: normals.len(),
            massless: matches!(simulation.scheme, Scheme::MasslessBoundary { .. }),
        }
    }

    /// Number of rows and columns.
    pub fn size(&self) -> usize {
        self.passage.size()
    }

    /// Sums of `of` over the numbers of a state, for every nodal diameter.
    pub(super) fn shares(&self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        let n = self.keep.len();
        let mut shares = vec![0.0; self.passage.simulation().wheel.harmonics.len()];
        for (i, unknown) in self.passage.unknowns().iter().enumerate() {
            shares[unknown.harmonic] += of(i) + of(n + i);
        }
        // A wave of the casing counts as the nodal diameter that can follow it.
        let wheel = self.passage.simulation().wheel;
        for (i, unknown) in (self.passage.unknowns().len()..).zip(self.passage.casing_unknowns()) {
            let alias = unknown.nodal_diameter % wheel.around();
            shares[alias.min(wheel.around() - alias) / wheel.repeats] += of(i) + of(n + i);
        }
        shares
    }

    /// Applies the derivative to `states`, one a column, in the unknowns of the map.
    pub fn apply(&self, mut states: MatMut<'_, f64>) {
        self.passage.take(states.ncols());
        let (n, wheel) = (self.keep.len(), self.passage.unknowns().len());
        let (step, h) = (self.passage.step_s(), 1.0 / self.passage.simulation().steps_per_revolution as f64);
        self.scale(states.rb_mut(), |scale| 1.0 / scale, step);
        let (mut z, mut d) = states.rb_mut().split_at_row_mut(n);
        let Trace { sets, instants } = self.passage.trace();
        // A and B of the set that touches, gathered when it changes: of all of them at once it may take gigabytes.
        let (mut read, mut pushing, mut gathered) = (Mat::zeros(n, 0), None, None);
        let mut moved = |z: MatRef<'_, f64>, set: usize| {
            if gathered != Some(set) {
                read = self.of_set(&self.rows, &sets[set]);
                pushing = self.sliding.as_ref().map(|sliding| self.of_set(sliding, &sets[set]));
                gathered = Some(set);
            }
            let mut force = &sets[set].stiffness * (read.transpose() * z);
            force *= faer::Scale(-1.0);
            let mut moved = Mat::zeros(n, z.ncols());
            let pushing = pushing.as_ref().unwrap_or(&read);
            matmul(moved.as_mut(), Accum::Replace, pushing.as_ref(), force.as_ref(), 1.0, Par::Seq);
            self.move_by(moved.as_mut());
            moved
        };
        let mut instants = instants.iter().copied().peekable();
        let mut pushed = instants.next_if(|&(step, _)| step == 0).map(|(_, set)| moved(z.rb(), set));
        for step in 1..=self.passage.steps() {
            if self.massless
                && let Some(moved) = &pushed
            {
                push(z.rb_mut(), d.rb_mut(), moved.as_ref(), wheel..n);
            }
            if self.coupling.is_none() {
                self.advance(z.rb_mut(), d.rb_mut());
            } else {
                self.advance_coupled(z.rb_mut(), d.rb_mut());
            }
            if wheel < n {
                self.turn_casing(z.rb_mut(), h);
                self.turn_casing(d.rb_mut(), h);
            }
            if let Some(moved) = pushed.take() {
                push(z.rb_mut(), d.rb_mut(), moved.as_ref(), 0..wheel);
            }
            if let Some((_, set)) = instants.next_if(|&(instant, _)| instant == step) {
                let moved = moved(z.rb(), set);
                if self.massless {
                    pushed = Some(moved);
                } else {
                    push(z.rb_mut(), d.rb_mut(), moved.as_ref(), 0..n);
                }
            }
        }
        // In the fixed frame again.
        let passed = -h * self.passage.steps() as f64;
        self.turn_casing(states.rb_mut().subrows_mut(0, n), passed);
        self.turn_casing(states.rb_mut().subrows_mut(n, n), passed);
        self.scale(states.rb_mut(), |scale| scale, 1.0 / step);
        for column in states.col_iter_mut() {
            if let Some(column) = column.try_as_col_major_mut() {
                self.passage.renumber(column.as_slice_mut());
            }
        }
    }

    /// Applies the derivative to one state.
    pub fn follow(&self, state: &mut [f64]) {
        let rows = state.len();
        self.apply(MatMut::from_column_major_slice_mut(state, rows, 1));
    }

    /// Takes a free step of modes that are not coupled.
    fn advance(&self, mut z: MatMut<'_, f64>, mut d: MatMut<'_, f64>) {
        for column in 0..z.ncols() {
            let z = z.rb_mut().col_mut(column).try_as_col_major_mut().map(|z| z.as_slice_mut());
            let d = d.rb_mut().col_mut(column).try_as_col_major_mut().map(|d| d.as_slice_mut());
            let (Some(z), Some(d)) = (z, d) else { unreachable!("states are kept column by column") };
            for i in 0..self.keep.len() {
                d[i] = self.keep[i] * d[i] - self.pull[i] * z[i];
                z[i] += d[i];
            }
        }
    }

    /// Takes a free step of modes that are coupled.
    fn advance_coupled(&self, mut z: MatMut<'_, f64>, mut d: MatMut<'_, f64>) {
        let swing = |i: usize, column: usize| {
            let (z, d) = (z[(i, column)], d[(i, column)]);
            self.keep[i] * d - self.pull[i] * z + d
        };
        let mut swing = Mat::from_fn(z.nrows(), z.ncols(), swing);
        self.coupling.pull(z.rb(), swing.as_mut());
        self.coupling.turn(swing.as_mut());
        for column in 0..z.ncols() {
            for i in 0..z.nrows() {
                d[(i, column)] = swing[(i, column)] - d[(i, column)];
                z[(i, column)] += d[(i, column)];
            }
        }
    }

    /// Transforms the casing's part of z or d to a wheel that has turned by `revolutions` more.
    fn turn_casing(&self, mut half: MatMut<'_, f64>, revolutions: f64) {
        for column in half.rb_mut().col_iter_mut() {
            if let Some(column) = column.try_as_col_major_mut() {
                self.passage.turn_casing(column.as_slice_mut(), |n| n as f64 * revolutions);
            }
        }
    }

    /// Entries of `rows` for a set, `unknowns × nodes`.
    fn of_set(&self, rows: &Mat<f64>, set: &Touching) -> Mat<f64> {
        let place = |&(sector, node): &(usize, usize)| sector * self.nodes + node;
        Mat::from_fn(self.keep.len(), set.places.len(), |i, j| rows[(i, place(&set.places[j]))])
    }

    /// Replaces modal forces by their displacements within a step.
    fn move_by(&self, mut force: MatMut<'_, f64>) {
        for column in 0..force.ncols() {
            for (i, receptance) in self.receptance.iter().enumerate() {
                force[(i, column)] *= receptance;
            }
        }
        self.coupling.turn(force);
    }

    fn scale(&self, mut states: MatMut<'_, f64>, of: impl Fn(f64) -> f64, increments: f64) {
        let n = self.keep.len();
        for column in 0..states.ncols() {
            for (i, scale) in self.passage.scales().enumerate() {
                states[(i, column)] *= of(scale);
                states[(n + i, column)] *= increments;
            }
        }
    }
}

/// Displacements of `directions` at all sectors per unit of every unknown, `unknowns × (sector, direction)`; of a casing that moves along
/// its normals.
fn rows(passage: &Passage<'_>, directions: &[Direction], waves: &[LinearWave<'_>]) -> Mat<f64> {
    let wheel = passage.simulation().wheel;
    let (unknowns, casing, sectors) = (passage.unknowns(), passage.casing_unknowns(), wheel.sectors);
    Mat::from_fn(unknowns.len() + casing.len(), sectors * directions.len(), |i, place| {
        let Some(unknown) = unknowns.get(i) else {
            let of = casing[i - unknowns.len()];
            let openings = waves[of.wave].openings[usize::from(of.sine)];
            let stride = openings.len() / sectors;
            return -openings[place / directions.len() * stride + place % directions.len()];
        };
        let harmonic = &wheel.harmonics[unknown.harmonic];
        let weight = if harmonic.single { 1.0 } else { 2.0 } / sectors as f64;
        let (sector, direction) = (place / directions.len(), place % directions.len());
        let turns = (unknown.harmonic * sector) % sectors;
        let angle = TAU * turns as f64 / sectors as f64;
        let shape = directions[direction].of(harmonic.contact.as_ref(), unknown.family);
        let shape = shape * c64::new(angle.cos(), angle.sin()) * weight.sqrt();
        if unknown.imaginary { -shape.im } else { shape.re }
    })
}

fn push(mut z: MatMut<'_, f64>, mut d: MatMut<'_, f64>, moved: MatRef<'_, f64>, unknowns: Range<usize>) {
    for column in 0..z.ncols() {
        for i in unknowns.clone() {
            z[(i, column)] += moved[(i, column)];
            d[(i, column)] += moved[(i, column)];
        }
    }
}
