//! Contact with full Coulomb friction: at every place a normal force λ on a gap g, and a friction force τ in the contact plane.
//!
//! ```text
//! 0 ≤ λ ⊥ g = q + (Wx)_n ≥ 0                                    x = (λ, τ₁, τ₂) of every place
//! |τ| ≤ μλ,   τ |s| = μλ s,   s = free − (Wx)_t                    it sticks (s = 0), or slides against τ in any direction
//! ```
//!
//! s is the sliding of a place within a step, `free` its sliding without forces. Among the places that may close, Newton's method solves the
//! projections λ = (λ − r g)₊ and τ = Π(τ + ρs) onto the disc of radius μλ (Alart and Curnier, Computer Methods in Applied Mechanics and
//! Engineering 92, 1991). It begins with the forces of the last solution and keeps a matrix as long as it is good enough: at a place that sticks
//! all three forces are unknown; at one that slides λ, acting along the normal and against the sliding, and the force that turns this direction.
//! Where Newton's method does not end, sweeps over the places (Jourdan, Alart and Jean, ibid. 155, 1998), each solved alone and exactly, give it
//! another start. Forces are a solution if every place meets its projections within a tolerance and the round-off of its gap and its sliding.
//!
//! W being positive definite, there is one solution as long as the coefficient is small. With a larger coefficient, a place has several
//! where friction presses it in by more than λ lifts it off. Solutions at which the determinant of Newton's matrix is not positive are
//! never returned ([`ComplementarityError::NotPMatrix`] if nothing else is found): pieces of a map that is one to one are all oriented
//! alike (Scholtes, Introduction to Piecewise Differentiable Equations, 2012).

mod place;
#[cfg(test)]
mod tests;

use super::active_set::PivotStatistics;
use super::factor::{Factor, Lu};
use super::{ComplementarityError, any_below};
pub use place::{Block, Forces};
use place::{State, alone, dot, meet};

/// Contact operator W, given by its blocks.
pub trait DiscOperator {
    /// Block of W: displacements at place `i` by unit forces at place `j`.
    fn block(&self, i: usize, j: usize) -> Block;

    /// Writes `gap` = q + (Wx)_n, x given at the `active` places and zero elsewhere. Entries that are positive whatever the signs of W's
    /// entries may keep the value of q instead: the solver needs to know no more of them.
    fn gaps(&self, active: &[usize], forces: &[Forces], q: &[f64], gap: &mut [f64]);
}

/// Solver with its workspace and the last forces.
#[derive(Debug, Clone)]
pub struct DiscSolver {
    /// Places that may close, ascending; `blocks` is W among the places `gathered`, row by row.
    places: Vec<usize>,
    gathered: Vec<usize>,
    blocks: Vec<Block>,
    /// Values (q, −free) of each of the places; `x` are their forces, `y` their (g, −s).
    known: Vec<Forces>,
    x: Vec<Forces>,
    y: Vec<Forces>,
    states: Vec<State>,
    /// Largest round-off of (g, −s) over the places, length.
    noise: f64,
    unknowns: Vec<Unknown>,
    numbers: Vec<usize>,
    /// Names of the unknowns that `factor` was made for.
    factored: Vec<usize>,
    right: Vec<f64>,
    factor: Lu,
    active: Vec<usize>,
    lambda: Vec<f64>,
    forces: Vec<Forces>,
    sliding: Vec<[f64; 2]>,
    sticks: Vec<bool>,
    /// Forces of every place.
    last: Vec<Forces>,
    gap: Vec<f64>,
    statistics: PivotStatistics,
}

/// Unknown of Newton's method, `value·trial` being its part in the forces of a place, and its equation: own·value + testᵀ(known + Wx) = 0.
#[derive(Debug, Clone, Copy)]
struct Unknown {
    place: usize,
    /// Name of the unknown, by its place and its kind.
    name: usize,
    /// Value before the step.
    value: f64,
    trial: Forces,
    test: Forces,
    own: f64,
}

/// Places whose blocks and unknowns are reserved beforehand; more of them at once make them grow, once.
const RESERVED: usize = 64;

/// Round-off of a gap or a sliding relative to the magnitude of its terms, including what solving leaves.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// Error after a step, relative to the error before it, below which the next step may use an earlier matrix.
const ENOUGH: f64 = 0.03;

/// Kinds of unknowns that a place may have: three where it sticks, two where it slides.
const KINDS: usize = 5;

/// Change of a force, relative to the forces of its place, that is left to the next step to correct.
const NEGLIGIBLE: f64 = 1e-6;

/// Steps of Newton's method before sweeps, sweeps before its next attempt, and attempts.
const NEWTON_STEPS: u64 = 30;
const SWEEPS: usize = 300;
const ATTEMPTS: usize = 5;

impl DiscSolver {
    /// A solver for problems of `size` places.
    pub fn new(size: usize) -> Self {
        Self {
            places: Vec::with_capacity(size),
            gathered: Vec::with_capacity(size),
            blocks: Vec::with_capacity(RESERVED * RESERVED),
            known: Vec::with_capacity(size),
            x: Vec::with_capacity(size),
            y: Vec::with_capacity(size),
            states: Vec::with_capacity(size),
            noise: 0.0,
            unknowns: Vec::with_capacity(3 * size),
            numbers: (0..3 * size).collect(),
            factored: Vec::with_capacity(3 * size),
            right: Vec::with_capacity(3 * size),
            factor: Lu::default(),
            active: Vec::with_capacity(size),
            lambda: Vec::with_capacity(size),
            forces: Vec::with_capacity(size),
            sliding: Vec::with_capacity(size),
            sticks: Vec::with_capacity(size),
            last: vec![[0.0; 3]; size],
            gap: vec![0.0; size],
            statistics: PivotStatistics::default(),
        }
    }

    /// Solves for the coefficient μ, `q` (entries of +∞ never touch) and `free`, asked for once of every place that may close. Gaps
    /// and sliding are met within `tolerance` and their round-off; forces are never negative, and never outside the disc.
    #[inline(always)]
    pub fn solve<W: DiscOperator>(
        &mut self,
        w: &W,
        coefficient: f64,
        q: &[f64],
        mut free: impl FnMut(usize) -> [f64; 2],
        tolerance: f64,
    ) -> Result<(), ComplementarityError> {
        self.places.clear();
        self.known.clear();
        self.x.clear();
        if any_below(q, 0.0) {
            self.statistics.problems += 1;
            for (i, (&gap, &last)) in q.iter().zip(&self.last).enumerate() {
                if gap < 0.0 || last[0] > 0.0 {
                    self.places.push(i);
                    self.known.push(known(gap, free(i)));
                    self.x.push(last);
                }
            }
        }
        loop {
            self.gather(w);
            self.solve_places(coefficient, tolerance)?;
            self.keep(coefficient);
            w.gaps(&self.active, &self.forces, q, &mut self.gap);
            let limit = -(tolerance + self.noise);
            let places = self.places.len();
            if places == 0 || !any_below(&self.gap, limit) {
                return Ok(());
            }
            for (i, &gap) in self.gap.iter().enumerate() {
                if gap < limit
                    && let Err(at) = self.places.binary_search(&i)
                {
                    self.places.insert(at, i);
                    self.known.insert(at, known(q[i], free(i)));
                    self.x.insert(at, [0.0; 3]);
                }
            }
            if self.places.len() == places {
                return Ok(());
            }
        }
    }

    /// Places with a force, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// Normal forces λ of the active places, in their order.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Forces λ and τ of the active places, in their order.
    pub fn forces(&self) -> &[Forces] {
        &self.forces
    }

    /// Whether each of the active places sticks.
    pub fn sticks(&self) -> &[bool] {
        &self.sticks
    }

    /// Gaps g of every place that the forces could have brought near zero, q of the others.
    pub fn gap(&self) -> &[f64] {
        &self.gap
    }

    /// Sliding s of the active places, in their order.
    pub fn sliding(&self) -> &[[f64; 2]] {
        &self.sliding
    }

    /// Work done so far: the candidates are steps of Newton's method.
    pub fn statistics(&self) -> PivotStatistics {
        self.statistics
    }

    #[inline(never)]
    fn gather<W: DiscOperator>(&mut self, w: &W) {
        if self.gathered == self.places {
            return;
        }
        self.blocks.clear();
        for &i in &self.places {
            self.blocks.extend(self.places.iter().map(|&j| w.block(i, j)));
        }
        self.gathered.clear();
        self.gathered.extend_from_slice(&self.places);
    }

    /// Solves for the forces among the places, in `x`.
    #[inline(never)]
    fn solve_places(&mut self, coefficient: f64, tolerance: f64) -> Result<(), ComplementarityError> {
        let before = self.statistics.candidates;
        let mut why = None;
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                self.sweep(coefficient, tolerance);
            }
            let mut last = f64::INFINITY;
            for _ in 0..NEWTON_STEPS {
                let off = self.look(coefficient, tolerance);
                if off <= 1.0 {
                    return Ok(());
                }
                self.statistics.candidates += 1;
                why = self.step(coefficient, off < ENOUGH * last).err();
                if why.is_some() {
                    break;
                }
                last = off;
            }
        }
        let steps = (self.statistics.candidates - before) as usize;
        Err(why.unwrap_or(ComplementarityError::NotSolved { pivots: steps }))
    }

    /// Computes (g, −s) and state of every place under `x`; returns the largest error of the projections over what is allowed.
    fn look(&mut self, coefficient: f64, tolerance: f64) -> f64 {
        let count = self.places.len();
        self.y.clear();
        self.states.clear();
        self.noise = 0.0;
        let mut most = 0.0;
        for place in 0..count {
            let row = &self.blocks[place * count..][..count];
            let mut y = self.known[place];
            let mut terms = y.map(f64::abs);
            for (block, x) in row.iter().zip(&self.x) {
                for a in 0..3 {
                    for b in 0..3 {
                        let moved = block[a][b] * x[b];
                        y[a] += moved;
                        terms[a] += moved.abs();
                    }
                }
            }
            let (state, off) = meet(&row[place], &self.x[place], &y, coefficient);
            let noise = ROUND_OFF * terms[0].max(terms[1]).max(terms[2]);
            let off = off / (tolerance + noise);
            // Once no number, none for good.
            most = if off <= most { most } else { off + 0.0 * most };
            self.noise = self.noise.max(noise);
            self.y.push(y);
            self.states.push(state);
        }
        most
    }

    /// Takes a step of Newton's method; with the matrix of an earlier one, if it `may` and has the same unknowns.
    fn step(&mut self, coefficient: f64, may: bool) -> Result<(), ComplementarityError> {
        self.list_unknowns(coefficient);
        let count = self.places.len();
        let Self { unknowns, blocks, factored, factor, .. } = self;
        if !may || !unknowns.iter().map(|unknown| unknown.name).eq(factored.iter().copied()) {
            factored.clear();
            let entry = |row: usize, column: usize| {
                let (of, by) = (&unknowns[row], &unknowns[column]);
                let block = &blocks[of.place * count + by.place];
                let moved = |a: usize| dot(block[a], by.trial);
                let own = if row == column { of.own } else { 0.0 };
                own + dot(of.test, [moved(0), moved(1), moved(2)])
            };
            self.statistics.factorisations += 1;
            factor.factorise(entry, &self.numbers[..unknowns.len()])?;
            factored.extend(unknowns.iter().map(|unknown| unknown.name));
        }
        self.right.clear();
        let residual =
            |unknown: &Unknown| unknown.own * unknown.value + dot(unknown.test, self.y[unknown.place]);
        self.right.extend(unknowns.iter().map(|unknown| -residual(unknown)));
        factor.solve(&mut self.right);
        self.x.fill([0.0; 3]);
        for (unknown, more) in unknowns.iter().zip(&self.right) {
            for (x, along) in self.x[unknown.place].iter_mut().zip(unknown.trial) {
                *x += along * (unknown.value + more);
            }
        }
        Ok(())
    }

    /// Lists the unknowns of the states with their values before the step. Forces that the states do not have are taken off (g, −s).
    fn list_unknowns(&mut self, coefficient: f64) {
        self.unknowns.clear();
        for place in 0..self.places.len() {
            let x = self.x[place];
            let name = KINDS * self.places[place];
            let begun = match self.states[place] {
                State::Open => [0.0; 3],
                State::Sticks => {
                    for a in 0..3 {
                        let mut unit = [0.0; 3];
                        unit[a] = 1.0;
                        let name = name + a;
                        self.unknowns.push(Unknown {
                            place,
                            name,
                            value: x[a],
                            trial: unit,
                            test: unit,
                            own: 0.0,
                        });
                    }
                    x
                }
                State::Slides { direction: [c, s], share, scale } => {
                    let (trial, test) = ([1.0, coefficient * c, coefficient * s], [1.0, 0.0, 0.0]);
                    let name = name + 3;
                    self.unknowns.push(Unknown { place, name, value: x[0], trial, test, own: 0.0 });
                    let (turned, value) = (share * scale, x[2] * c - x[1] * s);
                    let (trial, test) = ([0.0, -s, c], [0.0, -s * turned, c * turned]);
                    let name = name + 1;
                    self.unknowns.push(Unknown { place, name, value, trial, test, own: 1.0 - share });
                    let along = coefficient * x[0];
                    [x[0], along * c - value * s, along * s + value * c]
                }
            };
            let off = [0, 1, 2].map(|a| begun[a] - x[a]);
            // Turning a force by little changes its length by the square of that.
            let most = NEGLIGIBLE * (x[0].abs() + x[1].abs() + x[2].abs());
            if off.iter().any(|off| off.abs() > most) {
                let count = self.places.len();
                for (row, y) in self.y.iter_mut().enumerate() {
                    let block = &self.blocks[row * count + place];
                    for (y, of) in y.iter_mut().zip(block) {
                        *y += dot(*of, off);
                    }
                }
            }
        }
    }

    /// Solves one place after the other while the others stay, until none changes or [`SWEEPS`] times.
    fn sweep(&mut self, coefficient: f64, tolerance: f64) {
        let count = self.places.len();
        // What a step of Newton's method left may be anything.
        self.x.iter_mut().filter(|x| !x.iter().all(|x| x.is_finite())).for_each(|x| *x = [0.0; 3]);
        for _ in 0..SWEEPS {
            let mut most = 0.0f64;
            for place in 0..count {
                let row = &self.blocks[place * count..][..count];
                let mut by_others = self.known[place];
                for (other, (block, x)) in row.iter().zip(&self.x).enumerate() {
                    if other != place {
                        for (sum, of) in by_others.iter_mut().zip(block) {
                            *sum += dot(*of, *x);
                        }
                    }
                }
                let Some(alone) = alone(&row[place], &by_others, coefficient) else { continue };
                for a in 0..3 {
                    let moved = row[place][a][a] * (alone[a] - self.x[place][a]);
                    most = most.max(moved.abs());
                }
                self.x[place] = alone;
            }
            if most <= tolerance {
                return;
            }
        }
    }

    /// Stores the forces that were found.
    fn keep(&mut self, coefficient: f64) {
        for &i in &self.active {
            self.last[i] = [0.0; 3];
        }
        self.active.clear();
        self.lambda.clear();
        self.forces.clear();
        self.sliding.clear();
        self.sticks.clear();
        for (place, state) in self.states.iter().enumerate() {
            let (i, [lambda, a, b]) = (self.places[place], self.x[place]);
            if *state == State::Open || lambda <= 0.0 {
                continue;
            }
            let (size, most) = (a.hypot(b), coefficient * lambda);
            let share = if size > most { most / size } else { 1.0 };
            let forces = [lambda, share * a, share * b];
            self.active.push(i);
            self.lambda.push(lambda);
            self.forces.push(forces);
            self.sliding.push([-self.y[place][1], -self.y[place][2]]);
            self.sticks.push(*state == State::Sticks);
            self.last[i] = forces;
        }
    }
}

fn known(gap: f64, free: [f64; 2]) -> Forces {
    [gap, -free[0], -free[1]]
}
