//! The scene: which effects a simulation has. What a scene does not name does not exist in the run.

use serde::{Deserialize, Serialize};

use crate::request::omit::is_false;
use crate::request::sensor::Component;

/// Effects of one simulation.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Use K(Ω) through the package's three stiffness matrices (Eq. 3); otherwise the stiffness at rest.
    #[serde(default)]
    pub centrifugal_stiffening: bool,
    /// Modal damping; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Damping>,
    /// The casing around the wheel; absent: the wheel spins freely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing: Option<Casing>,
    /// Unilateral contact between blade tips and casing; absent: tips pass through it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// Coriolis forces through the package's gyroscopic matrix: forward and backward waves split. Spin softening, their
    /// companion, is part of `centrifugal_stiffening`: name both.
    #[serde(default, skip_serializing_if = "is_false")]
    pub coriolis: bool,
    /// Coulomb friction at the contact; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Abradable coating of the casing; absent: blades touch the metal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub abradable: Option<Abradable>,
    /// Elastic casing; absent: rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flexible_casing: Option<FlexibleCasing>,
    /// Stiffness deviations of the sectors; absent: a tuned wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistuning: Option<Mistuning>,
    /// Harmonic forces at engine orders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub engine_order_excitation: Vec<EngineOrderExcitation>,
    /// Eccentric casing or whirling shaft; absent: the wheel turns about the casing's axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<Orbit>,
    /// State that the wheel starts from; absent: rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<Initial>,
    /// Which part of the wheel is simulated.
    #[serde(default, skip_serializing_if = "Symmetry::is_full")]
    pub symmetry: Symmetry,
    /// The asymmetry that `symmetry: probe` starts from; absent: its defaults.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probe: Option<Probe>,
}

/// Modal damping of the reduced wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Ratio ζ of every mode not listed in `family_ratios`; 0 ≤ ζ < 1.
    pub modal_ratio: f64,
    /// Ratios of the first modal families, the same in every nodal diameter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 100))]
    pub family_ratios: Vec<f64>,
}

/// Casing of revolution with an optional static restriction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Casing {
    /// Clearance at rest along the chord.
    pub clearance: Clearance,
    /// Lobes of the restriction; absent: the casing is circular.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobes: Option<Lobes>,
}

/// Clearance in the model's unit of length: `leading` and `trailing` (linear in the arc length through the contact
/// nodes), or `values`, one per contact node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Clearance {
    /// At the leading edge (contact node 0).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leading: Option<f64>,
    /// At the trailing edge (last contact node).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trailing: Option<f64>,
    /// One value per contact node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub values: Option<Vec<f64>>,
}

/// Equal Gaussian lobes, evenly spaced in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Lobes {
    /// Number of lobes, at least 1.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub count: u32,
    /// Height A of a lobe, in the model's unit of length; at most a tenth of the radius at which the tips lie.
    pub amplitude: f64,
    /// Half-width w in exp(−(φ/w)²), rad; at most √2π/`count`, from where there is no valley between two lobes.
    pub width_rad: f64,
    /// Angle of the first lobe from the package's x axis, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

/// Unilateral contact, exact complementarity at every step (Eqs 9, 10).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Contact {}

/// Coulomb friction of tips that always slide forwards: their speed is far above that of their vibration. The force on a
/// blade is −λ(n + μt), t being the direction of rotation along the casing.
///
/// Friction may also make the vibration itself unstable (flutter, or a tip that is dragged in slowly); such a response grows and
/// is reported as diverged. Refused at a speed where the wheel would jam within a step, that is where friction presses tips that lean forwards into the casing more
/// than the contact force lifts them off: the message names the contact node and the largest coefficient that passes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient μ, 0 to 1. Metal sliding on metal at tip speed is reported between 0.1 and 0.3; 0 is no friction.
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 1))]
    pub coefficient: f64,
}

/// Coating of elasto-plastic rods that stand on the casing and are worn by the blades (Legrand, Batailly, Pierre, J. Comput.
/// Nonlinear Dyn. 7, 2012); stresses in the model's units. The clearance is that to the unworn coating.
///
/// A rod of area A resists with Aσ, σ = E(ε − ε_p) up to the yield stress σ_Y + Kε_p; plastic strain ε_p stays and is worn off: the
/// worn depth is ε_p times the thickness. All blades press the same coating, new at the start of every speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Abradable {
    /// Young's modulus E of the coating, force/length². Thermally sprayed aluminium-polyester: some GPa.
    pub modulus: f64,
    /// Yield stress σ_Y, force/length², from 0 to below the modulus. What a blade must overcome to wear anything at all: some 10
    /// MPa for coatings made to be rubbed.
    pub yield_stress: f64,
    /// Plastic modulus K of linear hardening, force/length²: how much more a rod resists the deeper it is worn. At least a
    /// millionth of the modulus; usually fitted to a rub test, well below the modulus.
    pub hardening: f64,
    /// Thickness, length. Behind it is metal, which a blade meets once it has worn through.
    pub thickness: f64,
    /// Rods around the circumference, one row for every contact node along the chord; at least four for every sector, so that
    /// blades share none, and no more than there are steps per revolution, so that no step jumps one.
    ///
    /// A tip presses one rod at a time: the width 2πr/`rods_around` is that of the contact across the tip, and forces are
    /// proportional to it. 2000 of them are 0.3 mm wide at a radius of 100 mm; choose the number that makes a rod as wide as your
    /// tips are thick.
    #[serde(default = "default_rods_around")]
    #[cfg_attr(feature = "schema", schema(minimum = 4))]
    pub rods_around: u32,
}

fn default_rods_around() -> u32 {
    2000
}

/// Elastic casing in the fixed frame: a ring, or its modes as given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct FlexibleCasing {
    /// Ring whose in-plane bending modes are computed; else give `modes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ring: Option<Ring>,
    /// Modes as given; else give `ring`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 50))]
    pub modes: Option<Vec<CasingMode>>,
    /// Modal damping ratio of every casing mode, in [0, 1); 1 % by default, that of a bolted steel structure.
    #[serde(default = "default_casing_damping")]
    pub damping_ratio: f64,
}

fn default_casing_damping() -> f64 {
    0.01
}

/// Thin elastic ring: breathing (n = 0) and inextensional bending in its plane (n ≥ 2). A free ring resists no translation
/// (n = 1): give `modes` of the mounted casing where that matters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Radius of the centre line, length.
    pub radius: f64,
    /// Young's modulus, force/length².
    pub modulus: f64,
    /// Mass per volume.
    pub density: f64,
    /// Area of the section, length².
    pub area: f64,
    /// Second moment of area for bending in the ring's plane, length⁴.
    pub second_moment: f64,
    /// Highest nodal diameter n, at most 50. Waves of more than n_max periods count as rigid; 8 reaches what a handful of lobes
    /// and blades excites.
    #[serde(default = "default_n_max")]
    #[cfg_attr(feature = "schema", schema(maximum = 50))]
    pub n_max: u32,
}

fn default_n_max() -> u32 {
    8
}

/// One nodal diameter of the casing: two waves, cos nφ and sin nφ (one for n = 0).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CasingMode {
    /// Nodal diameter n.
    #[cfg_attr(feature = "schema", schema(maximum = 50))]
    pub nodal_diameter: u32,
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass for a radial displacement of unit amplitude.
    pub modal_mass: f64,
}

/// Relative stiffness deviations of the sectors: given as `deviations`, or drawn with `spread` and `seed`. Twice the relative
/// deviation of a blade's frequency; within each modal family (Feiner and Griffin, J. Turbomachinery 124, 2002).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Mistuning {
    /// δ of every sector, at most 0.25 either way: its stiffness is (1 + δ) times that of the tuned wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviations: Option<Vec<f64>>,
    /// Standard deviation of normally distributed δ, 0 to 0.1; machined blades scatter by 0.01 to 0.04.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
    /// Seed of the distribution; the same seed gives the same wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// Force A cos(k(φ + Ωt) + phase) on contact nodes of every sector, φ being the sector's angle: what a wheel feels that turns through
/// a steady field of k periods. It grows over `ramp_revolutions`, like the restriction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct EngineOrderExcitation {
    /// Engine order k, 1 to the request's `max_engine_order`.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub order: u32,
    /// Contact nodes, counted from the leading edge from 0; each gets the whole amplitude.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 8192))]
    pub contact_nodes: Vec<u32>,
    /// Direction of the force.
    pub component: Component,
    /// Amplitude A, force.
    pub amplitude: f64,
    /// Phase, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

/// The wheel's axis circles about the casing's: the gap at angle φ in the fixed frame shrinks by
/// radius·cos(φ − `whirl_ratio`·Ωt − phase), and by as much less as the node's normal is not radial. Grows over the ramp.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// Radius of the orbit, length: hundredths of the clearance for a machine in order, more than it in a transient.
    pub radius: f64,
    /// Whirl speed over Ω, −2 to 2: 0 is an eccentric casing, 1 synchronous forward whirl, negative backward whirl. The gaps move;
    /// the inertia forces of the moving axis on the blades are left out.
    #[serde(default)]
    pub whirl_ratio: f64,
    /// Angle of the displaced axis at the start, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

/// One mode that moves when the run starts: of the wheel without mistuning and Coriolis forces, which make several waves of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Modal family within it, counted from 1.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub family: u32,
    /// Largest displacement component of any contact node, length; within the clearances, for blades that stood inside the
    /// casing would be thrown out of it at once.
    pub amplitude: f64,
    /// Standing, or travelling with or against the rotation (pairs only).
    #[serde(default)]
    pub wave: InitialWave,
}

/// How an initial mode moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum InitialWave {
    /// Released at rest from its amplitude.
    #[default]
    Standing,
    /// Travelling with the rotation.
    Forward,
    /// Travelling against the rotation.
    Backward,
}

/// Which part of the wheel is simulated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Symmetry {
    /// All of it.
    #[default]
    Full,
    /// The sub-wheel that the scene repeats; refused where it does not repeat.
    Exact,
    /// All of it, started from a tiny asymmetry; the result says whether and how fast what the symmetry forbids grows.
    Probe,
}

impl Symmetry {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
    fn is_full(&self) -> bool {
        *self == Self::Full
    }
}

/// The asymmetry that `symmetry: probe` starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Probe {
    /// Its displacement relative to the smallest clearance, 1e-12 to 1e-3.
    pub amplitude: f64,
    /// Seed of its phases.
    pub seed: u64,
}

impl Default for Probe {
    fn default() -> Self {
        Self { amplitude: 1e-6, seed: 0 }
    }
}
