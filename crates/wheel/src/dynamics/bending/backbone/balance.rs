//! Balance of the harmonics of a free motion, by Newton's method.

use std::f64::consts::TAU;

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

use super::free_wheel::{FreeMode, FreeModes, FreeWheel};
use crate::dynamics::bending::{Derivatives, Motion};

/// Step of Newton's method, relative, at which a motion is found: its error is of the order of the square.
const CONVERGED: f64 = 1e-9;

/// Number of steps after which Newton's method is given up: from a neighbour it takes three or four.
const ITERATIONS: usize = 12;

/// Distance of a motion from the extrapolated one, over the linear motion, above which it belongs to another branch: a quarter of the 1/√27 with
/// which a mode takes part amid a resonance with the third harmonic.
const STRAY_MOTION: f64 = 0.05;

/// Truncation, relative, above which a curve ends.
pub(super) const UNRESOLVED: f64 = 1e-3;

/// Distance of a frequency from the extrapolated one, over the linear one, above which its motion belongs to another branch: the largest truncation
/// of a curve.
const STRAY_FREQUENCY: f64 = UNRESOLVED;

/// Motion of a sector: harmonics P_h of its coordinates, and ω².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// P_h, `[harmonic][coordinate]`, h from 0 on.
    pub(super) harmonics: Vec<Vec<c64>>,
    /// Square of the angular frequency.
    pub(super) omega_squared: f64,
}

impl Series {
    /// Motion with harmonics up to `count`: cut, or zero above.
    pub(super) fn of(&self, count: usize) -> Self {
        let mut harmonics = self.harmonics.clone();
        let coordinates = harmonics[0].len();
        harmonics.resize(count + 1, vec![c64::ZERO; coordinates]);
        Self { harmonics, ..*self }
    }

    /// Motion `by` times as large, of the same frequency.
    pub(super) fn scaled(&self, by: f64) -> Self {
        let harmonics = self.harmonics.iter().map(|harmonic| harmonic.iter().map(|p| p * by).collect());
        Self { harmonics: harmonics.collect(), ..*self }
    }

    /// Motion that lies `share` of the way from `before` to here beyond this one, its ω² `share_of_frequency`.
    pub(super) fn extrapolated(&self, before: &Self, share: f64, share_of_frequency: f64) -> Self {
        let mut next = self.clone();
        for (harmonic, before) in next.harmonics.iter_mut().zip(&before.harmonics) {
            harmonic.iter_mut().zip(before).for_each(|(p, b)| *p += (*p - *b) * share);
        }
        next.omega_squared += share_of_frequency * (self.omega_squared - before.omega_squared);
        next
    }

    /// Coordinates at the phase ωt, their velocities and accelerations.
    pub(super) fn at(&self, phase: f64) -> [Vec<f64>; 3] {
        let omega = self.omega_squared.max(0.0).sqrt();
        let mut derivatives = [(); 3].map(|()| vec![0.0; self.harmonics[0].len()]);
        for (h, harmonic) in self.harmonics.iter().enumerate() {
            let mut turn = turn(h as f64 * phase);
            for of in &mut derivatives {
                of.iter_mut().zip(harmonic).for_each(|(of, part)| *of += (part * turn).re);
                turn *= c64::new(0.0, h as f64 * omega);
            }
        }
        derivatives
    }
}

fn turn(angle: f64) -> c64 {
    c64::new(angle.cos(), angle.sin())
}

/// Equations of a free motion that begins with a mode.
#[derive(Debug)]
pub(super) struct Balance<'a> {
    pub(super) wheel: &'a FreeWheel<'a>,
    mode: FreeMode,
    /// Column R_t of the mode.
    pub(super) column: Vec<c64>,
    /// ω_t².
    linear: f64,
}

/// Modes that a harmonic moves.
pub(super) struct Moved<'a> {
    pub(super) nodal_diameter: usize,
    pub(super) modes: &'a FreeModes,
    pub(super) conjugate: bool,
    /// Mode whose amplitude is given.
    pub(super) left_out: Option<usize>,
}

impl Moved<'_> {
    pub(super) fn row(&self, coordinate: usize, mode: usize) -> c64 {
        let row = self.modes.rows[(coordinate, mode)];
        if self.conjugate { row.conj() } else { row }
    }

    /// Modal force r_mᴴ F.
    pub(super) fn force(&self, mode: usize, force: &[c64]) -> c64 {
        force.iter().enumerate().map(|(j, f)| self.row(j, mode).conj() * f).sum()
    }

    /// Modes that follow the forces.
    pub(super) fn following(&self) -> impl Iterator<Item = usize> {
        (0..self.modes.omega.len()).filter(|&mode| Some(mode) != self.left_out)
    }

    /// R (Λ − h²λ)⁻¹ Rᴴ and its derivative by λ = ω².
    fn compliance(&self, h: usize, lambda: f64) -> [Mat<c64>; 2] {
        let m = self.modes.rows.nrows();
        let squared = (h * h) as f64;
        let mut both = [Mat::zeros(m, m), Mat::zeros(m, m)];
        for mode in self.following() {
            let gain = 1.0 / (self.modes.omega[mode].powi(2) - squared * lambda);
            for (of, gain) in both.iter_mut().zip([gain, squared * gain * gain]) {
                for k in 0..m {
                    let right = self.row(k, mode).conj() * gain;
                    (0..m).for_each(|j| of[(j, k)] += self.row(j, mode) * right);
                }
            }
        }
        both
    }
}

/// Harmonics of the forces and of their derivatives.
pub(super) struct Forces {
    /// F_h.
    pub(super) force: Vec<Vec<c64>>,
    /// Part of F_h by inertia, proportional to ω².
    inertia: Vec<Vec<c64>>,
    /// Derivatives −∂f/∂p = Σ_c K_c e^{jcωt}, −∂f/∂ṗ and −∂f/∂p̈ likewise, c from 0 to twice the harmonics; K_−c is the conjugate.
    derivatives: Vec<[Mat<c64>; 3]>,
}

impl Forces {
    /// Derivative −∂f_row/∂p_column of harmonic c by harmonic l of a motion with the frequency ω: K + jlω D − l²ω² M.
    pub(super) fn derivative(&self, c: isize, l: isize, omega: f64, row: usize, column: usize) -> c64 {
        let [k, d, m] = self.derivatives[c.unsigned_abs()].each_ref().map(|of| {
            let value = of[(row, column)];
            if c < 0 { value.conj() } else { value }
        });
        let rate = l as f64 * omega;
        k + c64::new(0.0, rate) * d - m * (rate * rate)
    }
}

impl<'a> Balance<'a> {
    pub(super) fn new(wheel: &'a FreeWheel<'a>, mode: FreeMode) -> Self {
        let modes = &wheel.modes[mode.nodal_diameter];
        let column = modes.rows.col(mode.rank).iter().copied().collect();
        Self { wheel, mode, column, linear: modes.omega[mode.rank].powi(2) }
    }

    /// Linear motion of amplitude a.
    pub(super) fn linear(&self, harmonics: usize, amplitude: f64) -> Series {
        let mut motion = vec![vec![c64::ZERO; self.column.len()]; harmonics + 1];
        motion[1] = self.column.iter().map(|&row| row * amplitude).collect();
        Series { harmonics: motion, omega_squared: self.linear }
    }

    /// Size of the linear motion of amplitude a.
    fn scale(&self, amplitude: f64) -> f64 {
        amplitude * self.column.iter().map(|row| row.norm_sqr()).sum::<f64>().sqrt()
    }

    pub(super) fn moved(&self, h: usize) -> Moved<'_> {
        let sectors = self.wheel.sectors;
        let turns = h * self.mode.nodal_diameter % sectors;
        let conjugate = 2 * turns > sectors;
        let nodal_diameter = if conjugate { sectors - turns } else { turns };
        let left_out = (h == 1).then_some(self.mode.rank);
        Moved { nodal_diameter, modes: &self.wheel.modes[nodal_diameter], conjugate, left_out }
    }

    /// Forces of a motion. They are of third order in it, so that 4H + 1 instants alias no harmonic.
    pub(super) fn forces(&self, motion: &Series) -> Forces {
        let (m, most) = (self.column.len(), motion.harmonics.len() - 1);
        let instants = 4 * most + 1;
        let [mut force, mut inertia] = [(); 2].map(|()| vec![vec![c64::ZERO; m]; most + 1]);
        let mut derivatives = vec![[(); 3].map(|()| Mat::<c64>::zeros(m, m)); 2 * most + 1];
        for instant in 0..instants {
            let angle = |h: usize| TAU * ((h * instant) % instants) as f64 / instants as f64;
            let [p, velocity, acceleration] = motion.at(angle(1));
            let now = Motion { p: &p, velocity: &velocity, acceleration: &acceleration };
            let FreeWheel { potential, inertia: kinetic, .. } = self.wheel;
            let (elastic, of_inertia) = (potential.force(&p), kinetic.inertia_force(now));
            let Derivatives { by_acceleration, by_velocity, by_coordinates } =
                kinetic.inertia_derivatives(now);
            let of_now = [by_coordinates + potential.stiffness(&p), by_velocity, by_acceleration];
            for h in 0..=most {
                let weight = turn(-angle(h)) * (if h == 0 { 1.0 } else { 2.0 } / instants as f64);
                for j in 0..m {
                    force[h][j] += weight * (elastic[j] + of_inertia[j]);
                    inertia[h][j] += weight * of_inertia[j];
                }
            }
            for (c, of) in derivatives.iter_mut().enumerate() {
                let weight = turn(-angle(c)) * (1.0 / instants as f64);
                for (of, now) in of.iter_mut().zip(&of_now) {
                    for column in 0..m {
                        (0..m).for_each(|row| of[(row, column)] += weight * now[(row, column)]);
                    }
                }
            }
        }
        Forces { force, inertia, derivatives }
    }

    /// Motion of amplitude a near `guess`, if Newton's method finds one.
    pub(super) fn solve(&self, guess: Series, amplitude: f64) -> Option<Series> {
        let (m, most) = (self.column.len(), guess.harmonics.len() - 1);
        let scale = self.scale(amplitude);
        let mut motion = guess;
        for _ in 0..ITERATIONS {
            let (tangent, residual) = self.equations(&motion, amplitude, scale);
            let step = tangent.partial_piv_lu().solve(&residual);
            // A tangent that is singular, exactly at a resonance.
            if !step.is_all_finite() {
                return None;
            }
            let mut size = 0.0f64;
            for (h, harmonic) in motion.harmonics.iter_mut().enumerate() {
                for (j, p) in harmonic.iter_mut().enumerate() {
                    let [re, im] = place(m, h, j).map(|at| at.map_or(0.0, |at| step[(at, 0)]));
                    *p -= c64::new(re, im) * scale;
                    size = size.max(re.abs()).max(im.abs());
                }
            }
            let change = step[(m * (2 * most + 1), 0)];
            motion.omega_squared -= change * self.linear;
            size = size.max(change.abs());
            if size < CONVERGED {
                return Some(motion);
            }
        }
        None
    }

    /// Tangent and residual: P_h over `scale`, h = 0 real, and ω² over ω_t² are the unknowns.
    fn equations(&self, motion: &Series, amplitude: f64, scale: f64) -> (Mat<f64>, Mat<f64>) {
        let (m, most) = (self.column.len(), motion.harmonics.len() - 1);
        let size = m * (2 * most + 1) + 1;
        let of_omega = size - 1;
        let forces = self.forces(motion);
        let omega = motion.omega_squared.max(0.0).sqrt();
        let mut tangent = Mat::<f64>::identity(size, size);
        let mut residual = Mat::<f64>::zeros(size, 1);
        // Adds to the tangent the derivatives of −`unit`·`by`·F_h by all harmonics.
        let subtract_force =
            |tangent: &mut Mat<f64>, h: usize, by: &[c64], rows: [Option<usize>; 2], unit: f64| {
                for l in 0..=most {
                    let (h, l_signed) = (h as isize, l as isize);
                    for column in 0..m {
                        let sum = |c: isize, l: isize| -> c64 {
                            let of = by.iter().enumerate();
                            of.map(|(k, by)| by * forces.derivative(c, l, omega, k, column)).sum::<c64>()
                                * unit
                        };
                        let [re, im] = place(m, l, column);
                        // δF_h = −K_{h−l} δP_l − K_{h+l} conj δP_l, half of it for h = 0; −2 K_h δP_0.
                        let half = if h == 0 { 0.5 } else { 1.0 };
                        let (first, second) = match l {
                            0 => (sum(h, 0) * (2.0 * half), c64::ZERO),
                            _ => (sum(h - l_signed, l_signed) * half, sum(h + l_signed, -l_signed) * half),
                        };
                        let (plus, minus) = (first + second, first - second);
                        for (row, parts) in rows.iter().zip([[plus.re, -minus.im], [plus.im, minus.re]]) {
                            let Some(row) = *row else { continue };
                            for (column, part) in [re, im].iter().zip(parts) {
                                if let Some(column) = *column {
                                    tangent[(row, column)] += part;
                                }
                            }
                        }
                    }
                }
            };
        for (h, of_h) in forces.force.iter().enumerate() {
            let [compliance, slope] = self.moved(h).compliance(h, motion.omega_squared);
            for j in 0..m {
                let by: Vec<c64> = (0..m).map(|k| compliance[(j, k)]).collect();
                let response: c64 = by.iter().zip(of_h).map(|(by, f)| by * f).sum();
                let inertia = &forces.inertia[h];
                let faster: c64 = (0..m)
                    .map(|k| {
                        slope[(j, k)] * of_h[k]
                            + compliance[(j, k)] * inertia[k] * (1.0 / motion.omega_squared)
                    })
                    .sum();
                let given = if h == 1 { self.column[j] * amplitude } else { c64::ZERO };
                let off = (motion.harmonics[h][j] - response - given) * (1.0 / scale);
                let rows = place(m, h, j);
                for ((row, off), faster) in rows.iter().zip([off.re, off.im]).zip([faster.re, faster.im]) {
                    let Some(row) = *row else { continue };
                    residual[(row, 0)] = off;
                    tangent[(row, of_omega)] = -faster * self.linear / scale;
                }
                subtract_force(&mut tangent, h, &by, rows, 1.0);
            }
        }
        // ω² − ω_t² + Re(R_tᴴ F_1)/a, over ω_t².
        let column: Vec<c64> = self.column.iter().map(|row| row.conj()).collect();
        let [modal, of_inertia] = [&forces.force[1], &forces.inertia[1]]
            .map(|force| column.iter().zip(force).map(|(by, f)| by * f).sum::<c64>().re / amplitude);
        residual[(of_omega, 0)] = (motion.omega_squared + modal) / self.linear - 1.0;
        tangent[(of_omega, of_omega)] += of_inertia / motion.omega_squared;
        // F_1 enters with plus here, with minus in the rows of P_h: a negative unit.
        subtract_force(&mut tangent, 1, &column, [Some(of_omega), None], -scale / (amplitude * self.linear));
        (tangent, residual)
    }

    /// Whether a motion of amplitude a lies so far from the extrapolated one that it belongs to another branch.
    pub(super) fn strays(&self, found: &Series, extrapolated: &Series, amplitude: f64) -> bool {
        let extrapolated = extrapolated.of(found.harmonics.len() - 1);
        let both = found.harmonics.iter().flatten().zip(extrapolated.harmonics.iter().flatten());
        let off = both.map(|(p, e)| (p - e).norm_sqr()).sum::<f64>().sqrt();
        let change = (found.omega_squared - extrapolated.omega_squared).abs();
        off > STRAY_MOTION * self.scale(amplitude) || change > 2.0 * STRAY_FREQUENCY * self.linear
    }
}

/// Places of the real and the imaginary part of an unknown: that of harmonic 0 is real.
fn place(coordinates: usize, h: usize, coordinate: usize) -> [Option<usize>; 2] {
    match h {
        0 => [Some(coordinate), None],
        _ => {
            let first = coordinates * (2 * h - 1) + coordinate;
            [Some(first), Some(first + coordinates)]
        }
    }
}
