//! Elastic casing: waves cos nφ and sin nφ in the fixed frame, one oscillator each.
//!
//! ```text
//! w(φ, t) = Σ_n c_n cos nφ + s_n sin nφ          radial, outwards
//! m_n (c̈ + 2ζω_n ċ + ω_n² c) = Σ_nodes n_r λ cos nφ            (sin for s_n)
//! g = … + n_r w(φ),   φ = θ_k + sα + Ωt
//! ```
//!
//! n_r is the radial component of the node's normal: the casing is a ring, the same all along the chord. Both waves of one
//! n have the same receptance, so what a force at one angle moves at another depends on their difference only, which
//! rotation does not change: the casing's part of the contact operator, Σ_n r_n cos n(φ − φ′), is one more
//! block-circulant table.
//!
//! A contact force acts along the waves as they stand at the end of its step: first order in nΩh where n > 0.
//!
//! Ring in its own plane (Love; Timoshenko, Vibration Problems in Engineering): inextensional bending for n ≥ 2,
//! breathing for n = 0. n = 1 is a rigid translation, which a free ring does not resist; a mounted casing that has it
//! is given by its modes.
//!
//! ```text
//! ω_n² = EI n²(n²−1)² / (ρA R⁴(n²+1)),  m_n = πρAR(1 + 1/n²);      ω_0² = E/(ρR²),  m_0 = 2πρAR
//! ```

use std::f64::consts::{PI, TAU};

use super::initial::SteppedWave;
use super::oscillators::{Exchange, VANISHED};
use super::schemes::Scheme;
use super::sector::ContactNode;

/// Nodal diameter of an elastic casing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CasingWave {
    /// Nodal diameter n.
    pub nodal_diameter: u32,
    /// Natural frequency ω_n, rad/s.
    pub omega: f64,
    /// Modal mass m_n for a radial amplitude of 1.
    pub modal_mass: f64,
}

/// Elastic casing.
#[derive(Debug, Clone, PartialEq)]
pub struct FlexibleCasing {
    /// Nodal diameters of the casing.
    pub waves: Vec<CasingWave>,
    /// Damping ratio ζ of all nodal diameters.
    pub damping_ratio: f64,
}

/// Thin elastic ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Radius R of the centre line, length.
    pub radius: f64,
    /// Young's modulus E, force/length².
    pub modulus: f64,
    /// Density ρ, mass/volume.
    pub density: f64,
    /// Area A of the cross-section, length².
    pub area: f64,
    /// Second moment of area I for bending in the ring's plane, length⁴.
    pub second_moment: f64,
}

impl Ring {
    /// Waves n = 0, 2, 3 … `highest` of the ring.
    pub fn waves(&self, highest: u32) -> Vec<CasingWave> {
        let Self { radius, modulus, density, area, second_moment } = *self;
        let wave = |nodal_diameter: u32| {
            let n = f64::from(nodal_diameter);
            let (omega_squared, modal_mass) = if nodal_diameter == 0 {
                (modulus / (density * radius.powi(2)), 2.0 * PI * density * area * radius)
            } else {
                let bending = modulus * second_moment * (n * (n * n - 1.0)).powi(2);
                (
                    bending / (density * area * radius.powi(4) * (n * n + 1.0)),
                    PI * density * area * radius * (1.0 + 1.0 / (n * n)),
                )
            };
            CasingWave { nodal_diameter, omega: omega_squared.sqrt(), modal_mass }
        };
        (0..=highest).filter(|&n| n != 1).map(wave).collect()
    }
}

/// Elastic casing in motion, in coordinates of modal mass 1.
#[derive(Debug)]
pub(crate) struct CasingMotion {
    waves: Vec<WaveMotion>,
    /// Angles θ_k of the contact nodes, rad.
    angles: Vec<f64>,
    radial: Vec<f64>,
    around: usize,
    largest: f64,
}

#[derive(Debug)]
struct WaveMotion {
    n: f64,
    keep: f64,
    receptance: f64,
    stiffness: f64,
    inertia: f64,
    loss: f64,
    /// Scale 1/√m of a wave.
    scale: f64,
    /// Factors n_r cos and n_r sin of n(θ_k + sα) over √m, `[sector][node]`.
    cos: Vec<f64>,
    sin: Vec<f64>,
    /// Parts of the wave: the cosine and the sine.
    parts: [Part; 2],
    /// Turn e^{jnΩt} at the last gaps.
    turn: (f64, f64),
}

/// Wave of the casing as its two parts move and open gaps, seen from the wheel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearWave<'a> {
    /// Nodal diameter n.
    pub(crate) nodal_diameter: usize,
    pub(crate) keep: f64,
    pub(crate) receptance: f64,
    /// Stiffness ω².
    pub(crate) stiffness: f64,
    /// Openings of gaps per unit of the parts along the wheel's own cos nφ and sin nφ, `[sector][node]`, nodes padded.
    pub(crate) openings: [&'a [f64]; 2],
}

/// Motion of one part of a wave: z, z − z⁻, z⁺ − z⁻ not yet counted, and force.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    z: f64,
    d: f64,
    swing: f64,
    force: f64,
}

impl CasingMotion {
    /// Casing at rest, seen by `sectors` of the `around` on the circumference, nodes padded to `stride`.
    ///
    /// Where these sectors are one of several parts that the wheel repeats, the forces of all parts cancel but on waves that repeat with
    /// them, of which each part moves its share.
    pub(crate) fn new(
        casing: &FlexibleCasing,
        scheme: Scheme,
        step: f64,
        contact_nodes: &[ContactNode],
        sectors: usize,
        around: usize,
        stride: usize,
    ) -> Self {
        let repeats = around / sectors;
        let wave = |wave: &CasingWave| {
            let mode = scheme.mode_step(wave.omega, casing.damping_ratio, step, true);
            let (n, scale) = (f64::from(wave.nodal_diameter), (repeats as f64 / wave.modal_mass).sqrt());
            let mut cos = vec![0.0; sectors * stride];
            let mut sin = cos.clone();
            for sector in 0..sectors {
                for (k, node) in contact_nodes.iter().enumerate() {
                    let angle = n * (node.position[1] + TAU * sector as f64 / around as f64);
                    cos[sector * stride + k] = node.normal[0] * scale * angle.cos();
                    sin[sector * stride + k] = node.normal[0] * scale * angle.sin();
                }
            }
            WaveMotion {
                n,
                keep: mode.keep,
                receptance: mode.receptance,
                stiffness: wave.omega.powi(2),
                inertia: mode.inertia(),
                loss: 0.5 * mode.dissipation() * mode.inertia(),
                scale,
                cos,
                sin,
                parts: [Part::default(); 2],
                turn: (1.0, 0.0),
            }
        };
        Self {
            waves: (casing.waves.iter())
                .filter(|wave| (wave.nodal_diameter as usize).is_multiple_of(repeats))
                .map(wave)
                .collect(),
            angles: contact_nodes.iter().map(|node| node.position[1]).collect(),
            radial: contact_nodes.iter().map(|node| node.normal[0]).collect(),
            around,
            largest: 0.0,
        }
    }

    /// Opening at node `to`, `distance` sectors ahead, by a unit force at node `from` within a step.
    pub(crate) fn operator(&self, distance: usize, to: usize, from: usize) -> f64 {
        let angle = self.angles[to] - self.angles[from] + TAU * distance as f64 / self.around as f64;
        let wave = |wave: &WaveMotion| wave.receptance * wave.scale.powi(2) * (wave.n * angle).cos();
        self.radial[to] * self.radial[from] * self.waves.iter().map(wave).sum::<f64>()
    }

    /// Completes the last step by the forces pressed since, and clears them.
    pub(crate) fn complete(&mut self) -> Exchange {
        let (mut twice_work, mut loss) = (0.0, 0.0);
        for wave in &mut self.waves {
            for part in &mut wave.parts {
                let moved = wave.receptance * part.force;
                part.z += moved;
                part.d += moved;
                let swing = part.swing + moved;
                twice_work += part.force * swing;
                loss += wave.loss * swing * swing;
                (part.force, part.swing) = (0.0, 0.0);
            }
            let radial = wave.scale * wave.parts[0].z.hypot(wave.parts[1].z);
            self.largest = self.largest.max(radial);
        }
        Exchange { work: 0.5 * twice_work, loss }
    }

    /// Brings waves to rest that have decayed to nothing (see [`super::oscillators`]).
    pub(crate) fn quench(&mut self) {
        for part in self.waves.iter_mut().flat_map(|wave| &mut wave.parts) {
            for value in [&mut part.z, &mut part.d] {
                *value = if value.abs() < VANISHED { 0.0 } else { *value };
            }
        }
    }

    /// Takes one step free of forces.
    pub(crate) fn predict(&mut self) {
        for wave in &mut self.waves {
            // The sine wave of n = 0 is never forced and stays at rest.
            for part in &mut wave.parts {
                let next = wave.keep * part.d - wave.stiffness * wave.receptance * part.z;
                part.swing = next + part.d;
                part.d = next;
                part.z += next;
            }
        }
    }

    /// Adds the casing's displacement to the gaps after `revolutions`.
    pub(crate) fn add(&mut self, revolutions: f64, gaps: &mut [f64]) {
        let turned = revolutions.fract();
        for wave in &mut self.waves {
            let (sin, cos) = (TAU * (wave.n * turned).fract()).sin_cos();
            wave.turn = (cos, sin);
            let [c, s] = wave.parts.map(|part| part.z);
            let (along, across) = (c * cos + s * sin, s * cos - c * sin);
            for (gap, (a, b)) in gaps.iter_mut().zip(wave.cos.iter().zip(&wave.sin)) {
                *gap += a * along + b * across;
            }
        }
    }

    /// Presses with λ at place `place` of the last gaps.
    pub(crate) fn press(&mut self, place: usize, lambda: f64) {
        for wave in &mut self.waves {
            let ((cos, sin), (a, b)) = (wave.turn, (wave.cos[place], wave.sin[place]));
            wave.parts[0].force += lambda * (a * cos - b * sin);
            wave.parts[1].force += lambda * (a * sin + b * cos);
        }
    }

    /// Mechanical energy of the last step, as [`super::schemes`] has it.
    pub(crate) fn energy(&self) -> f64 {
        let of = |wave: &WaveMotion| {
            let part =
                |part: &Part| wave.inertia * part.d * part.d + wave.stiffness * (part.z - part.d) * part.z;
            wave.parts.iter().map(part).sum::<f64>()
        };
        0.5 * self.waves.iter().map(of).sum::<f64>()
    }

    /// State of the casing in numbers whose squares are energies.
    pub(crate) fn state(&self) -> impl Iterator<Item = f64> {
        self.waves.iter().flat_map(|wave| {
            let numbers = |part: &Part| [wave.stiffness.sqrt() * part.z, wave.inertia.sqrt() * part.d];
            wave.parts.iter().flat_map(numbers)
        })
    }

    /// Displacements and increments of the waves.
    pub(crate) fn stepped(&self) -> Vec<SteppedWave> {
        let of = |wave: &WaveMotion| SteppedWave {
            displacement: wave.parts.map(|part| part.z),
            increment: wave.parts.map(|part| part.d),
        };
        self.waves.iter().map(of).collect()
    }

    /// Puts the waves where another motion left them, at rest where it has none, without forces.
    pub(crate) fn go_on_from(&mut self, waves: &[SteppedWave]) {
        for (index, wave) in self.waves.iter_mut().enumerate() {
            let SteppedWave { displacement, increment } = waves.get(index).copied().unwrap_or_default();
            for (part, (z, d)) in wave.parts.iter_mut().zip(displacement.into_iter().zip(increment)) {
                *part = Part { z, d, ..Part::default() };
            }
        }
    }

    /// Waves of the casing as a linearised step has them.
    pub(crate) fn linear_waves(&self) -> impl Iterator<Item = LinearWave<'_>> {
        self.waves.iter().map(|wave| LinearWave {
            nodal_diameter: wave.n as usize,
            keep: wave.keep,
            receptance: wave.receptance,
            stiffness: wave.stiffness,
            openings: [&wave.cos, &wave.sin],
        })
    }

    /// Largest amplitude of any wave so far, length.
    pub(crate) fn largest_amplitude(&self) -> f64 {
        self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed form of a ring with R = 1, EI/(ρA) = 1: ω_2² = 36/5, ω_3² = 576/10.
    #[test]
    fn ring_has_its_closed_form() {
        let ring = Ring { radius: 1.0, modulus: 2.0, density: 4.0, area: 0.25, second_moment: 0.5 };
        let waves = ring.waves(3);
        let found: Vec<_> = waves.iter().map(|w| (w.nodal_diameter, w.omega.powi(2), w.modal_mass)).collect();
        let expected = [(0, 0.5, 2.0 * PI), (2, 7.2, PI * 1.25), (3, 57.6, PI * (1.0 + 1.0 / 9.0))];
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.0, expected.0);
            assert!((found.1 / expected.1 - 1.0).abs() < 1e-14 && (found.2 / expected.2 - 1.0).abs() < 1e-14);
        }
    }

    /// Casing under a force turning with one blade: the operator and pressing move it under every node alike.
    #[test]
    fn the_operator_is_what_pressing_does() {
        let node = |theta: f64, radial: f64| ContactNode {
            id: 0,
            position: [10.0, theta, 0.0],
            normal: [radial, 0.0, (1.0 - radial * radial).sqrt()],
            dofs: [0, 1, 2],
        };
        let nodes = [node(0.2, 0.9), node(-0.3, 0.5)];
        let wave = |nodal_diameter, omega, modal_mass| CasingWave { nodal_diameter, omega, modal_mass };
        let casing = FlexibleCasing {
            waves: vec![wave(0, 3.0, 2.0), wave(2, 5.0, 3.0), wave(3, 7.0, 4.0)],
            damping_ratio: 0.1,
        };
        let mut motion = CasingMotion::new(&casing, Scheme::ExactModal, 0.01, &nodes, 5, 5, 8);
        let mut gaps = vec![0.0; 40];
        motion.add(17.3, &mut gaps);
        motion.press(2 * 8 + 1, 6.0);
        motion.complete();
        gaps.fill(0.0);
        motion.add(17.3, &mut gaps);
        for (sector, k) in [(0, 0), (2, 1), (4, 0), (1, 1)] {
            let expected = 6.0 * motion.operator((sector + 5 - 2) % 5, k, 1);
            assert!((gaps[sector * 8 + k] - expected).abs() < 1e-16, "{sector} {k}");
        }
    }
}
