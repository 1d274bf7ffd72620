//! State from which a run starts.

use faer::c64;

use super::modal_wheel::ModalWheel;

/// Mode that moves when the run starts; all others are at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InitialMode {
    /// Index of the nodal diameter among the wheel's harmonics.
    pub harmonic: usize,
    /// Mode within the nodal diameter, counted from 0; one that the scheme integrates.
    pub family: usize,
    /// Displacement z(0); its imaginary part is ignored for a single harmonic.
    pub displacement: c64,
    /// Velocity ż(0).
    pub velocity: c64,
}

/// Mode of a motion under way, by its displacement and increment: unlike a velocity, the increment carries it on without loss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteppedMode {
    /// Index of the nodal diameter among the wheel's harmonics.
    pub harmonic: usize,
    /// Mode within the nodal diameter, counted from 0; one that the scheme integrates.
    pub family: usize,
    /// Displacement z.
    pub displacement: c64,
    /// Increment z − z⁻.
    pub increment: c64,
}

/// Wave of an elastic casing of a motion under way, its cosine and sine part, in coordinates of modal mass 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SteppedWave {
    /// Displacements z.
    pub displacement: [f64; 2],
    /// Increments z − z⁻.
    pub increment: [f64; 2],
}

/// Motion under way, from which a run goes on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stepped {
    /// Modes that move.
    pub modes: Vec<SteppedMode>,
    /// Waves of an elastic casing, all of them; empty without, or where it is at rest.
    pub casing: Vec<SteppedWave>,
}

/// Wave in which a mode moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InitialWave {
    /// Standing wave, released at rest.
    Standing,
    /// Wave that travels towards +θ, z ∝ e^{−jωt}.
    Forward,
    /// Wave that travels towards −θ, z ∝ e^{jωt}.
    Backward,
}

impl InitialMode {
    /// Mode whose largest displacement component at any contact node of any sector is `amplitude`; `phase`, of modulus 1, turns it about
    /// the axis. Modes of single harmonics stand, whatever `wave` says.
    pub fn of_amplitude(
        wheel: &ModalWheel,
        harmonic: usize,
        family: usize,
        amplitude: f64,
        phase: c64,
        wave: InitialWave,
    ) -> Self {
        let modes = &wheel.harmonics[harmonic];
        let sectors = wheel.sectors as f64;
        let weight = if modes.single { (1.0 / sectors).sqrt() } else { (2.0 / sectors).sqrt() };
        let largest =
            (0..modes.contact.nrows()).map(|row| modes.contact[(row, family)].norm()).fold(0.0, f64::max);
        let displacement = if largest > 0.0 { phase * (amplitude / (weight * largest)) } else { c64::ZERO };
        let turning = match wave {
            _ if modes.single => c64::ZERO,
            InitialWave::Standing => c64::ZERO,
            InitialWave::Forward => c64::new(0.0, -1.0),
            InitialWave::Backward => c64::new(0.0, 1.0),
        };
        Self { harmonic, family, displacement, velocity: displacement * turning * modes.omega[family] }
    }
}
