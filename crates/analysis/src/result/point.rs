//! One speed of a sweep: credentials, summary, spectra.

use serde::{Deserialize, Serialize};

use crate::effects::abradable::result::{WearMap, WearReport};
use crate::end_state::EndState;
use crate::request::{SchemeChoice, Sensor};
use crate::result::contact::{ContactForces, ContactSummary};
use crate::result::reduction::StiffeningVerdict;
use crate::result::steady::{MarchReport, SteadyReport};
use crate::result::stress::PointStress;
use crate::result::tip::TipResponse;
use crate::result::validity::{Validity, ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::energy::{EffectWork, EnergyAudit};
use rubmap_wheel::response::settling::Settling;
use rubmap_wheel::response::side_bands::SideBands;
use rubmap_wheel::response::symmetry_breaking::SymmetryBreaking;

/// How one speed of a sweep ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum PointStatus {
    /// Run integrated to the end; its numbers are valid within the credentials.
    Completed,
    /// Run stopped because the response grew beyond any physical bound; no amplitudes.
    Diverged,
    /// Speed that could not be integrated; `message` says why; no amplitudes.
    Failed,
}

/// Steady response of one sensor, as single numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorResponse {
    /// Sensor that was recorded.
    pub sensor: Sensor,
    /// Mean displacement over the window.
    pub mean: f64,
    /// Root mean square of the displacement about its mean over the window.
    pub rms: f64,
    /// Half the peak-to-peak displacement over the window.
    pub half_peak_to_peak: f64,
    /// Non-zero engine order of the largest spectral amplitude; absent where no line stands above the round-off of the
    /// displacements of all sensors, such as where nothing ever touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_engine_order: Option<f64>,
    /// Nodal diameter that carries the dominant engine order; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_nodal_diameter: Option<u32>,
    /// Pairs of spectral lines k ± δ about integer engine orders, the strongest ones by ascending order; only where they
    /// stand clear of the floor of the spectrum.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub side_bands: Vec<SideBands>,
}

/// The scheme of a run, and why it was taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SchemeReport {
    /// The scheme; never `auto`.
    pub name: SchemeChoice,
    /// Reason for this scheme and this step.
    pub reason: String,
    /// Modes integrated per nodal diameter (fewer where a nodal diameter has fewer); absent if all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_modes: Option<u32>,
    /// Number of modes over all nodal diameters (a pair counts twice) that respond quasi-statically because a step does not resolve them.
    pub following_modes: u32,
    /// Frequency up to which modes of every nodal diameter are integrated, Hz.
    pub reach_hz: f64,
}

/// Both sides of the energy identity over the whole run, in force·length; effects that the scene does not name are absent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct EnergyReport {
    /// Mechanical energy at the start, of wheel and elastic casing.
    pub initial: f64,
    /// Mechanical energy at the end, of wheel and elastic casing: `initial` and all works less all losses.
    #[serde(rename = "final")]
    pub last: f64,
    /// Work of the contact forces on the wheel.
    pub contact_work: f64,
    /// Energy lost to modal damping, and to modes that respond quasi-statically.
    pub damping_loss: f64,
    /// Work of the forces at engine orders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excitation_work: Option<f64>,
    /// Work of mistuning: minus the change of the energy that the stiffness deviations store.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistuning_work: Option<f64>,
    /// Work of blades that stiffen as they bend: minus the change of their energy beyond the quadratic one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_work: Option<f64>,
    /// Largest difference between that work and energy over the largest mechanical energy; of second order in the step where nothing touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_residual: Option<f64>,
    /// Work of the contact forces on the elastic casing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_work: Option<f64>,
    /// Energy lost in the casing's damping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_loss: Option<f64>,
    /// Heat of friction; its work on the vibration is part of the work of contact. By the law `sliding`, what the shaft supplies against the rotation
    /// alone; by the law `disc`, friction times all sliding, never negative in any step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_heat: Option<f64>,
}

impl EnergyReport {
    /// Reads the energies of a run on one of the `parts` of a wheel, without the works of effects, which add theirs; none if a number is not finite.
    pub(crate) fn of(audit: &EnergyAudit, parts: f64) -> Option<Self> {
        let (initial, last) = audit.ends();
        let EffectWork { excitation, mistuning, stiffening, casing, casing_loss, friction_heat } =
            audit.effects();
        let of_effects = [excitation, mistuning, stiffening, casing, casing_loss, friction_heat];
        let mut all = [initial, last, audit.work(), audit.loss()].into_iter().chain(of_effects);
        all.all(f64::is_finite).then(|| Self {
            initial: parts * initial,
            last: parts * last,
            contact_work: parts * audit.work(),
            damping_loss: parts * audit.loss(),
            excitation_work: None,
            mistuning_work: None,
            bending_work: None,
            bending_residual: None,
            casing_work: None,
            casing_loss: None,
            friction_heat: None,
        })
    }
}

/// One speed of a sweep with its credentials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Point {
    /// Index of the speed in the request.
    pub index: u32,
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// How the run ended.
    pub status: PointStatus,
    /// Reason, for `diverged` and `failed`; reason for which stress that was asked for is absent; note that a speed of a sweep up or down had to
    /// start from rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Verdict on the K(Ω) that the numbers rest on: how far it can be trusted between the speeds at which the stiffness is given, as the reduction
    /// found. Absent where the scene has no centrifugal stiffening, and for speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
    /// Steady-state verdict; absent without a complete run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling: Option<Settling>,
    /// Length of the march, and whether its motion repeats; absent unless the request's `integration.revolutions` is `auto`, and where nothing was
    /// marched to its end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub march: Option<MarchReport>,
    /// Periodic response; absent unless the request's `integration.steady` asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadyReport>,
    /// Time-stepping scheme; absent where nothing was integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Steps per revolution used; 0 if none was taken.
    pub steps_per_revolution: u32,
    /// Smallest stable number of steps per revolution at this speed; 1 for a scheme without a limit.
    pub smallest_stable_steps_per_revolution: u32,
    /// Steps taken, those of the search for a periodic response among them.
    pub steps: u64,
    /// Share of the steps with a contact force.
    pub contact_share: f64,
    /// Tip that moves most over the window; absent unless `completed`, and for speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<TipResponse>,
    /// Running clearance of every contact node over the window, where the scene gives clearances cold: less the growth of the tips, and with what a
    /// `clearance_change` has left; negative where the casing is pressed into the tips. Empty where nothing was integrated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub running_clearance: Vec<f64>,
    /// Contact over the window; absent unless `completed`, and for scenes without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactSummary>,
    /// Contact impulse: sum over contact nodes and steps of λ·h, in force·time of the model's units. Absent where nothing was integrated or the run
    /// overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_impulse: Option<f64>,
    /// Largest penetration left after a step's contact solution, and of the state itself at every sample, in the model's unit of length. Absent where
    /// nothing was integrated or the run overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_penetration: Option<f64>,
    /// Smallest multiplier λ of an active node, in the model's unit of force; absent without contact, and where nothing was integrated or the run
    /// overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_multiplier: Option<f64>,
    /// Largest violation of the energy identity, relative to the largest energy seen (docs/method.md, Energy). Absent where nothing was integrated or
    /// the run overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_residual: Option<f64>,
    /// Energy balance: where the energy came from and went; absent where nothing was integrated or the run overflowed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyReport>,
    /// Largest mechanical energy seen, in force·length; absent where nothing was integrated or the run overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_energy: Option<f64>,
    /// Largest radial amplitude of any wave of an elastic casing, in the model's unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_amplitude: Option<f64>,
    /// Share of the contact forces, counted by nodes and steps, under which the tip stuck to the casing instead of sliding; absent without
    /// friction of the law `disc`, and where nothing touched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sticking_share: Option<f64>,
    /// Wear of an abradable coating at the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wear: Option<WearReport>,
    /// Outcome of the probe: whether a tiny asymmetry grew; with `symmetry: probe`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetry_breaking: Option<SymmetryBreaking>,
    /// Stress and margin; for a sweep that records stress, if the speed was `completed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<PointStress>,
    /// Whether linear theory holds; absent unless `completed`, and for speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validity: Option<Validity>,
    /// Steady response per sensor; empty unless `completed`.
    pub responses: Vec<SensorResponse>,
    /// Wall time of this speed, s.
    pub wall_time_s: f64,
    /// Version of the code that computed the speed.
    pub version: String,
    /// Kind of vector instructions of the processor that computed the speed: another kind may round differently. Absent for speeds that an earlier
    /// version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vectors: Option<String>,
}

impl Point {
    /// Whether the numbers of the speed are those of a periodic response that was solved for.
    pub(crate) fn is_solved(&self) -> bool {
        self.steady.as_ref().is_some_and(|steady| steady.taken)
    }

    /// Largest utilisation at the speed; none without stress or strengths.
    pub fn utilisation(&self) -> Option<f64> {
        self.stress.as_ref()?.utilisation()
    }

    /// Whether linear theory holds at the speed, as far as it is known.
    pub fn validity_verdict(&self) -> Option<ValidityVerdict> {
        Some(self.validity.as_ref()?.verdict)
    }

    /// Measures that matter for linear theory and could not be checked at the speed.
    pub fn validity_lacking(&self) -> Vec<ValidityMeasure> {
        self.validity.as_ref().map(Validity::measures_lacking).unwrap_or_default()
    }
}

/// Spectra of one sensor at one speed, over the engine orders of [`SpeedSpectra`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorSpectrum {
    /// Sensor that was recorded.
    pub sensor: Sensor,
    /// Single-sided physical amplitude per engine order, in the model's unit of length.
    pub amplitude: Vec<f64>,
    /// Amplitude of the wheel's component in each nodal diameter, `[nodal diameter][engine order]`, in the real orthonormal Fourier basis over the
    /// sectors (cosine and sine joined by root sum of squares).
    pub nodal_diameters: Vec<Vec<f64>>,
}

/// Spectra of all sensors at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedSpectra {
    /// Engine orders of the bins: multiples of 1/`window_revolutions` from 0 to `max_engine_order`.
    pub engine_orders: Vec<f64>,
    /// Spectra of the sensors, in the order of the request.
    pub sensors: Vec<SensorSpectrum>,
}

/// All results of one speed of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpeedResult {
    /// Credentials and summary.
    pub point: Point,
    /// Spectra; absent unless `point.status` is `completed`.
    pub spectra: Option<SpeedSpectra>,
    /// State of the wheel at the end of a completed run of a sweep up or down, otherwise absent.
    pub end_state: Option<EndState>,
    /// Wear map of an abradable coating, where the scene has one.
    pub wear: Option<WearMap>,
    /// Contact forces of a completed run with contact.
    pub contact: Option<ContactForces>,
}
