//! What computations return: numbers with their credentials.

use serde::{Deserialize, Serialize};

use super::accuracy::control::ErrorEstimate;
use super::end_state::EndState;
use super::plan::{Estimate, Spent};
use super::refine::Refinement;
use super::request::{SchemeChoice, Sensor};
use super::scene::Scene;
use rubmap_wheel::dynamics::energy::{EffectWork, EnergyAudit};
use rubmap_wheel::dynamics::sector::Units;

pub use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
pub use rubmap_wheel::response::coincidence::Coincidence;
pub use rubmap_wheel::response::settling::{Settling, Verdict};
pub use rubmap_wheel::response::side_bands::SideBands;
pub use rubmap_wheel::response::symmetry_breaking::SymmetryBreaking;
pub use rubmap_wheel::response::waves::{Table, Wave};

/// How one speed of a sweep ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum PointStatus {
    /// Integrated to the end; its numbers are valid within the credentials.
    Completed,
    /// Stopped because the response grew beyond any physical bound; no amplitudes.
    Diverged,
    /// Could not be integrated at this speed; `message` says why; no amplitudes.
    Failed,
}

/// Steady response of one sensor in one number each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorResponse {
    /// The sensor.
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
    /// Why this scheme and this step.
    pub reason: String,
    /// Modes integrated per nodal diameter (fewer where a nodal diameter has fewer); absent if all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_modes: Option<u32>,
    /// Modes over all nodal diameters (a pair counts twice) that follow statically because a step does not resolve them.
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
    /// The same at the end: `initial` and all works less all losses.
    #[serde(rename = "final")]
    pub last: f64,
    /// Work of the contact forces on the wheel.
    pub contact_work: f64,
    /// Lost to modal damping, and to modes that follow statically.
    pub damping_loss: f64,
    /// Work of the forces at engine orders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excitation_work: Option<f64>,
    /// Minus the change of the energy that the stiffness deviations store.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistuning_work: Option<f64>,
    /// Work of the contact forces on the elastic casing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_work: Option<f64>,
    /// Lost in the casing's damping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_loss: Option<f64>,
    /// Heat of friction, supplied by the shaft; its work on the vibration is part of the work of contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_heat: Option<f64>,
}

impl EnergyReport {
    /// Of a run on one of the `parts` of a wheel; none if a number is not finite.
    pub(super) fn of(audit: &EnergyAudit, scene: &Scene, parts: f64) -> Option<Self> {
        let effects = audit.effects();
        let named = |effect: bool, value: f64| effect.then_some(parts * value);
        let (initial, last) = audit.ends();
        let EffectWork { excitation, mistuning, casing, casing_loss, friction_heat } = effects;
        let all = [
            initial,
            last,
            audit.work(),
            audit.loss(),
            excitation,
            mistuning,
            casing,
            casing_loss,
            friction_heat,
        ];
        all.iter().all(|value| value.is_finite()).then(|| Self {
            initial: parts * initial,
            last: parts * last,
            contact_work: parts * audit.work(),
            damping_loss: parts * audit.loss(),
            excitation_work: named(!scene.engine_order_excitation.is_empty(), effects.excitation),
            mistuning_work: named(scene.mistuning.is_some(), effects.mistuning),
            casing_work: named(scene.flexible_casing.is_some(), effects.casing),
            casing_loss: named(scene.flexible_casing.is_some(), effects.casing_loss),
            friction_heat: named(scene.friction.is_some(), effects.friction_heat),
        })
    }
}

/// What the blades wore off an abradable coating.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WearReport {
    /// Volume removed, length³.
    pub removed_volume: f64,
    /// Deepest wear, length.
    pub deepest: f64,
    /// Work that went into plastic strain, force·length.
    pub plastic_work: f64,
    /// Whether a tip met the metal behind the coating.
    pub reached_metal: bool,
}

/// How deep the blades wore an abradable coating.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WearMap {
    /// `[rod][contact node]`, length: rods in the direction of rotation from the package's x axis, contact nodes from the
    /// leading edge.
    pub depths: Vec<Vec<f64>>,
}

/// One speed of a sweep with its credentials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Point {
    /// Index of the speed in the request.
    pub index: u32,
    /// Ω in rad/s.
    pub speed_rad_s: f64,
    /// How the run ended.
    pub status: PointStatus,
    /// Why, for `diverged` and `failed`; and whether a speed of a sweep up or down had to start from rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// How far the K(Ω) that its numbers rest on can be trusted between the speeds at which the stiffness is given, as the
    /// reduction found; absent where the scene has no centrifugal stiffening, and of speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
    /// Steady-state verdict; absent without a complete run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling: Option<Settling>,
    /// How time was stepped; absent where nothing was integrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<SchemeReport>,
    /// Steps per revolution used; 0 if none was taken.
    pub steps_per_revolution: u32,
    /// Smallest stable number of steps per revolution at this speed; 1 for a scheme without a limit.
    pub smallest_stable_steps_per_revolution: u32,
    /// Steps taken.
    pub steps: u64,
    /// Share of the steps with a contact force.
    pub contact_share: f64,
    /// Sum over contact nodes and steps of λ·h, in force·time of the model's units. This and the next numbers are absent
    /// where nothing was integrated or the run overflowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_impulse: Option<f64>,
    /// Largest penetration left after a step's contact solution, and of the state itself at every sample, in the model's
    /// unit of length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_penetration: Option<f64>,
    /// Smallest multiplier λ of an active node, in the model's unit of force; absent without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_multiplier: Option<f64>,
    /// Largest violation of the energy identity, relative to the largest energy seen (docs/method.md, Energy).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_residual: Option<f64>,
    /// Where that energy came from and went; absent where nothing was integrated or the run overflowed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyReport>,
    /// Largest mechanical energy seen, in force·length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_energy: Option<f64>,
    /// Largest radial amplitude of any wave of an elastic casing, in the model's unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing_amplitude: Option<f64>,
    /// Wear of an abradable coating at the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wear: Option<WearReport>,
    /// What became of a tiny asymmetry; with `symmetry: probe`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetry_breaking: Option<SymmetryBreaking>,
    /// Steady response per sensor; empty unless `completed`.
    pub responses: Vec<SensorResponse>,
    /// Wall time of this speed, s.
    pub wall_time_s: f64,
    /// Version of the code that computed it.
    pub version: String,
}

/// Spectra of one sensor at one speed, over the engine orders of [`SpeedSpectra`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorSpectrum {
    /// The sensor.
    pub sensor: Sensor,
    /// Single-sided physical amplitude per engine order, in the model's unit of length.
    pub amplitude: Vec<f64>,
    /// `[nodal diameter][engine order]`: amplitude of the wheel's component in that nodal diameter, in the real
    /// orthonormal Fourier basis over the sectors (cosine and sine joined by root sum of squares).
    pub nodal_diameters: Vec<Vec<f64>>,
}

/// Spectra of all sensors at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedSpectra {
    /// Engine orders of the bins: multiples of 1/`window_revolutions` from 0 to `max_engine_order`.
    pub engine_orders: Vec<f64>,
    /// One per sensor, in the order of the request.
    pub sensors: Vec<SensorSpectrum>,
}

/// All that one speed of a sweep produces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpeedResult {
    /// Credentials and summary.
    pub point: Point,
    /// Absent unless `point.status` is `completed`.
    pub spectra: Option<SpeedSpectra>,
    /// Where the wheel was at the end of a completed run of a sweep up or down, otherwise absent.
    pub end_state: Option<EndState>,
    /// Of an abradable coating.
    pub wear: Option<WearMap>,
}

/// Spectra side by side over Ω, as downloaded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct InteractionMap {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Engine orders of the columns.
    pub engine_orders: Vec<f64>,
    /// `[speed][engine order]`; a row is null where that speed has no result.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub amplitude: Vec<Option<Vec<f64>>>,
    /// What was recorded.
    pub sensor: Sensor,
    /// Restricted to this nodal diameter, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodal_diameter: Option<u32>,
    /// Units of the model.
    pub units: Units,
    /// Credentials, one per finished speed, in the order of the speeds.
    pub points: Vec<Point>,
    /// The worst verdict on K(Ω) of `points`; absent where none has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
    /// Estimated errors of the amplitudes, once the job is successful; absent without control runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorEstimate>,
    /// What `refine` has added; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refinement>,
    /// What the sweep was expected to cost; absent before its speeds are queued.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// What its finished speeds have cost.
    #[serde(default)]
    pub spent: Spent,
    /// The whole request as resolved.
    pub settings: super::request::SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// Result of a modal analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Campbell {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// `[speed][nodal diameter][family]`: natural frequencies in the rotating frame without Coriolis forces, Hz.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
    /// Those with Coriolis forces, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<WaveTables>,
    /// `[superharmonic][speed][nodal diameter][family]`: |−f + i·n·Ω/2π| in the absolute frame, Hz (Eq. 11); with Coriolis
    /// forces f is the backward wave's.
    pub absolute_frequencies_hz: Vec<AbsoluteFrequencies>,
    /// The linear criterion's critical speeds within the range.
    pub crossings: Vec<Crossing>,
    /// Those crossings that the lobes can drive.
    pub driven_crossings: Vec<DrivenCrossing>,
    /// What the reduction found about the model.
    pub reduction: ReductionReport,
    /// The whole request as resolved.
    pub settings: super::request::ModalAnalysisRequest,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// Version of the code.
    pub version: String,
}

impl Campbell {
    /// Natural frequencies as they are met, `[speed][nodal diameter][family]`: of waves of either direction where Coriolis
    /// forces split them, otherwise one table.
    pub fn branches(&self) -> Vec<(Option<Wave>, &Table)> {
        match &self.waves {
            None => vec![(None, &self.frequencies_hz)],
            Some(WaveTables { forward_hz, backward_hz }) => {
                vec![(Some(Wave::Forward), forward_hz), (Some(Wave::Backward), backward_hz)]
            }
        }
    }
}

/// Natural frequencies in the rotating frame that Coriolis forces split, `[speed][nodal diameter][family]`, Hz. A single
/// nodal diameter (0, and N/2 of an even number of sectors) stands: it has the same frequencies in both tables.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WaveTables {
    /// Of waves that travel with the rotation.
    pub forward_hz: Vec<Vec<Vec<f64>>>,
    /// Of waves that travel against it.
    pub backward_hz: Vec<Vec<Vec<f64>>>,
}

/// Absolute-frame frequencies for one superharmonic number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AbsoluteFrequencies {
    /// n in |−f + i·n·Ω/2π|.
    pub superharmonic: u32,
    /// `[speed][nodal diameter][family]`, Hz.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
}

/// One critical speed of a sweep: a peak of the steady response over Ω.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CriticalSpeed {
    /// Ω of the peak, rad/s.
    pub speed_rad_s: f64,
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Whether it lies at an end of the range or beside a speed without a result, so that the true peak may be beyond.
    pub at_edge: bool,
    /// How far the true peak may be from `speed_rad_s` because only the speeds of the sweep were computed, rad/s: the distance
    /// to the farther one of the two neighbouring speeds. A speed without a result, like the end of the range, bounds
    /// nothing: with `at_edge` this is the distance to the other neighbour, and the peak may be farther away on the open side.
    pub speed_error_rad_s: f64,
    /// Whether the speeds of the sweep resolve the peak: on both sides the response at the neighbouring speed is at least 90
    /// % of the peak's, from an interval no more than three times as wide as the other; or the neighbouring speed is
    /// within 5e-4 of the peak's, which is then known to that sharpness even where the response jumps (at the fold of a
    /// backbone curve). Otherwise the true peak may be higher. Never with `at_edge`.
    pub resolved: bool,
    /// Steady response: root mean square about the mean, in the model's unit of length.
    pub rms: f64,
    /// Half the peak-to-peak displacement there.
    pub half_peak_to_peak: f64,
    /// Height above the higher of the two neighbouring valleys, in the same measure as `rms`.
    pub prominence: f64,
    /// How far the error of the natural frequencies may have moved the peak, rad/s: the largest relative difference of the reduced
    /// sector's ten lowest ones of any nodal diameter from the full sector's, times the speed.
    #[serde(default)]
    pub frequency_error_rad_s: f64,
    /// Estimated relative error of the steady response at this speed; absent without control runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_error: Option<f64>,
    /// Engine order of the largest spectral amplitude; absent where no line up to `max_engine_order` stands above round-off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_engine_order: Option<f64>,
    /// Nodal diameter that carries it; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_nodal_diameter: Option<u32>,
    /// Steady-state verdict of that speed.
    pub settling: Verdict,
    /// Nearest prediction of the linear criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_crossing: Option<Crossing>,
    /// Peak speed minus the nearest prediction's, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_rad_s: Option<f64>,
}

/// Critical speeds of a sweep beside the linear prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CriticalSpeeds {
    /// The sensor whose response is judged.
    pub sensor: Sensor,
    /// Peaks in ascending speed.
    pub critical_speeds: Vec<CriticalSpeed>,
    /// All crossings of the first two families and n = 1, 2, 3 within the sweep's range.
    pub linear_crossings: Vec<Crossing>,
    /// Crossings that the lobes can drive.
    pub driven_crossings: Vec<DrivenCrossing>,
    /// Where travelling waves of the wheel meet those of an elastic casing; absent where it is rigid.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub casing_coincidences: Vec<Coincidence>,
    /// Speeds that gave no amplitude, by index.
    pub missing: Vec<u32>,
    /// What `refine` has added; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refinement>,
    /// What the sweep was expected to cost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// What it has cost.
    #[serde(default)]
    pub spent: Spent,
    /// What the reduction found about the model.
    pub reduction: ReductionReport,
    /// The whole request as resolved.
    pub settings: super::request::SweepRequest,
    /// Units of the model.
    pub units: Units,
    /// Version of the code.
    pub version: String,
}

/// How trustworthy K(Ω) = K0 + Ω²K1 + Ω⁴K2 is between the given speeds (docs/method.md, Centrifugal stiffening).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum StiffeningVerdict {
    /// One stiffness matrix: no stiffening in the model.
    Absent,
    /// Linear in Ω² as on the undeformed geometry.
    Sound,
    /// Shows signs of stiffness taken on the deformed geometry; usable with the stated error.
    Suspect,
    /// Interpolates badly: frequencies between the given speeds are not smooth or K(Ω) is indefinite.
    Unsound,
}

impl StiffeningVerdict {
    /// What numbers that rest on K(Ω) are worth, where that is not what they seem.
    pub fn warning(self) -> Option<&'static str> {
        match self {
            Self::Absent | Self::Sound => None,
            Self::Suspect => Some(
                "K(Ω) is suspect: between the speeds at which the stiffness is given, frequencies and amplitudes are off; the \
                 reduction estimates by how much",
            ),
            Self::Unsound => Some(
                "K(Ω) is unsound: between the speeds at which the stiffness is given, frequencies, critical speeds and amplitudes \
                 are not to be relied on",
            ),
        }
    }
}

/// What the stiffness matrices of a model tell about K(Ω) by themselves. Preliminary: how far frequencies between the given speeds
/// are off, and with it the verdict, the first reduction finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PreliminaryStiffening {
    /// `absent`, `sound` or `suspect`; what is suspect may prove to be unsound.
    pub verdict: StiffeningVerdict,
    /// ‖Ω1²K1‖/‖K0‖.
    pub linear_ratio: f64,
    /// ‖Ω1⁴K2‖/‖K0‖.
    pub quadratic_ratio: f64,
    /// The finding in words, with what to do.
    pub message: String,
}

/// The check of the stiffness interpolation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StiffeningReport {
    /// The verdict.
    pub verdict: StiffeningVerdict,
    /// ‖Ω1²K1‖/‖K0‖.
    pub linear_ratio: f64,
    /// ‖Ω1⁴K2‖/‖K0‖.
    pub quadratic_ratio: f64,
    /// Estimated largest relative error of a first-family frequency between the given speeds.
    pub frequency_error: f64,
    /// The finding in words, with what to do.
    pub message: String,
}

/// The largest difference between a frequency of the reduced and of the full sector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LargestDifference {
    /// |reduced/full − 1|.
    pub relative: f64,
    /// Nodal diameter it occurs in.
    pub nodal_diameter: u32,
    /// Mode it occurs in, counted from 1.
    pub mode: u32,
    /// Frequency of that mode in the full sector, Hz.
    pub full_hz: f64,
}

/// The lowest frequencies of the reduced sector beside the full sector's at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FrequencyDifference {
    /// Ω, rad/s.
    pub speed_rad_s: f64,
    /// Where they differ most; null where every nodal diameter is left out.
    pub largest: Option<LargestDifference>,
    /// Nodal diameters left out because the full sector's stiffness is not positive definite at this speed.
    pub indefinite: Vec<u32>,
}

/// What the reduction of a model found and what it cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ReductionReport {
    /// k.
    pub modes_per_speed: u32,
    /// Generalised coordinates kept per nodal diameter (contact DOF and modes of the basis).
    pub unknowns: Vec<u32>,
    /// Real unknowns of the whole reduced wheel.
    pub wheel_unknowns: u32,
    /// Largest relative residual ‖Kx − λMx‖/‖Kx‖ over all fixed-interface modes.
    pub largest_mode_residual: f64,
    /// Fixed-interface modes over all nodal diameters and speeds.
    pub modes: u32,
    /// How many of them are proven to be the lowest, none missed, by a count of eigenvalues (Sylvester's law of
    /// inertia) or because they are all there are. Fewer than `modes` only where round-off leaves no shift to count at.
    pub counted_modes: u32,
    /// The reduced model's ten lowest frequencies per nodal diameter beside the full sector's, at the given speeds
    /// and between them.
    pub full_model: Vec<FrequencyDifference>,
    /// Relative tolerance below which nearly dependent directions of the basis were dropped.
    pub basis_tolerance: f64,
    /// Stiffness interpolation check.
    pub stiffening: StiffeningReport,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// Version of the code.
    pub version: String,
}

impl ReductionReport {
    /// Largest relative difference of the ten lowest frequencies of any nodal diameter, at any speed, from the full sector's.
    pub(super) fn largest_difference(&self) -> f64 {
        let lines = self.full_model.iter().filter_map(|line| line.largest.as_ref());
        lines.fold(0.0, |largest, difference| largest.max(difference.relative))
    }
}
