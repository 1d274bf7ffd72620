//! A sector on its way in: the facts requests are checked against, and its reduction with a report in words.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::error::AnalysisError;
use super::monitor::Monitor;
use super::result::{
    FrequencyDifference, LargestDifference, PreliminaryStiffening, ReductionReport, StiffeningReport,
    StiffeningVerdict,
};
use super::run::VERSION;
use rubmap_numerics::sector_fourier::is_single;
use rubmap_wheel::dynamics::reduction::{
    Checkpoints, Completeness, InterpolationCheck, InterpolationVerdict, MatrixRatios, ReducedWheel,
    ReductionError, ReductionOptions, reduce,
};
use rubmap_wheel::dynamics::sector::{SectorModel, Units};

/// A reduced sector: all that simulations need of a model. Computed once per (model, `modes_per_speed`) and stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReducedSector {
    /// Units of the model.
    pub units: Units,
    /// The reduced wheel.
    pub wheel: ReducedWheel,
    /// What the reduction found and cost.
    pub report: ReductionReport,
}

/// The few facts about a model that requests are checked against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ModelFacts {
    /// Free text of the user.
    pub name: String,
    /// Number of sectors N.
    pub sectors: u32,
    /// Number of contact nodes.
    pub contact_nodes: u32,
    /// Own DOF of a sector (internal with the low face, and contact).
    pub own_dofs: u32,
    /// Speeds of the stiffness matrices, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Units.
    pub units: Units,
    /// Whether the package has a gyroscopic matrix, so that Coriolis forces can be simulated.
    #[serde(default)]
    pub gyroscopic: bool,
    /// Largest distance of a contact node from the axis, in the model's unit of length; absent of models that an earlier version
    /// has kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_radius: Option<f64>,
    /// How far K(Ω) can be trusted, as far as the stiffness matrices tell by themselves; absent of models that an earlier version
    /// has kept. The verdict is that of a reduction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<PreliminaryStiffening>,
}

impl ModelFacts {
    /// The facts of `sector`.
    pub fn of(sector: &SectorModel) -> Self {
        Self {
            name: sector.name.clone(),
            sectors: sector.sectors as u32,
            contact_nodes: sector.contact.len() as u32,
            own_dofs: sector.own_dofs() as u32,
            speeds_rad_s: sector.speeds_rad_s.clone(),
            units: sector.units.clone(),
            gyroscopic: sector.gyroscopic.is_some(),
            contact_radius: sector.contact.iter().map(|node| node.position[0]).reduce(f64::max),
            stiffening: Some(preliminary_stiffening(sector)),
        }
    }

    /// Whether the model has stiffness at three speeds.
    pub fn has_stiffening(&self) -> bool {
        self.speeds_rad_s.len() == 3
    }
}

/// Reduces a sector (docs/method.md, Reduction). Deterministic. Takes at most `memory_bytes`, if given; goes on from `checkpoints`.
pub fn prepare(
    sector: &SectorModel,
    modes_per_speed: u32,
    memory_bytes: Option<u64>,
    checkpoints: &dyn Checkpoints,
    monitor: &dyn Monitor,
) -> Result<ReducedSector, AnalysisError> {
    let start = Instant::now();
    let options = ReductionOptions { memory_bytes, ..ReductionOptions::new(modes_per_speed as usize) };
    let watch = |fraction: f64, phase: &str| {
        monitor.progress(fraction, phase);
        !monitor.is_cancelled()
    };
    let wheel = reduce(sector, &options, checkpoints, &watch).map_err(|error| match error {
        ReductionError::Cancelled => AnalysisError::Cancelled,
        ReductionError::Memory { needed_bytes, allowed_bytes } => {
            AnalysisError::Memory { needed_bytes, allowed_bytes }
        }
        ReductionError::Model(error) => error.into(),
    })?;
    let report = report(&wheel, &options, sector, start.elapsed().as_secs_f64());
    Ok(ReducedSector { units: sector.units.clone(), wheel, report })
}

fn report(
    wheel: &ReducedWheel,
    options: &ReductionOptions,
    sector: &SectorModel,
    wall_time_s: f64,
) -> ReductionReport {
    let size = |i: usize| wheel.harmonics[i].mass.nrows() as u32;
    let copies = |i: usize| if is_single(i, wheel.sectors) { 1 } else { 2 };
    let residual = wheel.harmonics.iter().fold(0.0f64, |m, h| m.max(h.largest_mode_residual()));
    ReductionReport {
        modes_per_speed: options.modes_per_speed as u32,
        unknowns: (0..wheel.harmonics.len()).map(size).collect(),
        wheel_unknowns: (0..wheel.harmonics.len()).map(|i| copies(i) * size(i)).sum(),
        largest_mode_residual: residual,
        counted_modes: wheel
            .harmonics
            .iter()
            .flat_map(|h| &h.certificates)
            .filter(|certificate| certificate.completeness != Completeness::Unproven)
            .map(|certificate| certificate.eigenvalues.len() as u32)
            .sum(),
        modes: wheel
            .harmonics
            .iter()
            .flat_map(|h| &h.certificates)
            .map(|certificate| certificate.eigenvalues.len() as u32)
            .sum(),
        full_model: frequency_differences(wheel),
        basis_tolerance: options.basis_tolerance,
        stiffening: stiffening_report(&wheel.interpolation, sector),
        wall_time_s,
        version: VERSION.to_owned(),
    }
}

/// One line per speed, ascending.
fn frequency_differences(wheel: &ReducedWheel) -> Vec<FrequencyDifference> {
    let mut speeds: Vec<f64> = wheel.comparison.iter().map(|c| c.speed_rad_s).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let at = |speed_rad_s: f64| {
        let here = || wheel.comparison.iter().filter(move |c| c.speed_rad_s == speed_rad_s);
        let worst = here()
            .filter_map(|c| c.largest_difference().map(|(difference, mode)| (difference, mode, c)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        FrequencyDifference {
            speed_rad_s,
            largest: worst.map(|(relative, mode, comparison)| LargestDifference {
                relative,
                nodal_diameter: comparison.harmonic as u32,
                mode: mode as u32 + 1,
                full_hz: comparison.full[mode] / std::f64::consts::TAU,
            }),
            indefinite: here().filter(|c| c.full.is_empty()).map(|c| c.harmonic as u32).collect(),
        }
    };
    speeds.into_iter().map(at).collect()
}

/// What to do about matrices of the deformed geometry.
const EXPORT_ADVICE: &str = "Export K(Ω) = K_e + K_σ(Ω) − Ω²M_spin on the undeformed geometry instead (linear static pre-stress, no \
                             geometrically non-linear step).";

const NO_STIFFENING: &str = "One stiffness matrix: the model has no centrifugal stiffening.";

fn preliminary_stiffening(sector: &SectorModel) -> PreliminaryStiffening {
    let Some(ratios) = MatrixRatios::of(sector) else {
        return PreliminaryStiffening {
            verdict: StiffeningVerdict::Absent,
            linear_ratio: 0.0,
            quadratic_ratio: 0.0,
            message: NO_STIFFENING.into(),
        };
    };
    let MatrixRatios { linear: linear_ratio, quadratic: quadratic_ratio } = ratios;
    let found = format!("(|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}, |Ω1²K1|/|K0| = {linear_ratio:.1e})");
    let (verdict, message) = if ratios.are_linear() {
        let message = format!(
            "By its matrices K(Ω) is linear in Ω², as it must be on the undeformed geometry {found}. Preliminary: whether it is \
             positive definite between the given speeds, the first reduction tells."
        );
        (StiffeningVerdict::Sound, message)
    } else {
        let message = format!(
            "By its matrices K(Ω) is not linear in Ω² {found}: it was probably exported on the deformed geometry of a non-linear \
             pre-stress step. Preliminary: how far results between the given speeds are off, and whether K(Ω) can be interpolated \
             at all, the first reduction tells. {EXPORT_ADVICE}"
        );
        (StiffeningVerdict::Suspect, message)
    };
    PreliminaryStiffening { verdict, linear_ratio, quadratic_ratio, message }
}

fn stiffening_report(check: &InterpolationCheck, sector: &SectorModel) -> StiffeningReport {
    let InterpolationCheck { verdict, linear_ratio, quadratic_ratio, frequency_error } = *check;
    let highest = sector.speeds_rad_s.last().copied().unwrap_or(0.0);
    let percent = 100.0 * frequency_error;
    let advice = EXPORT_ADVICE;
    let (verdict, message) = match verdict {
        InterpolationVerdict::Absent => (StiffeningVerdict::Absent, NO_STIFFENING.into()),
        InterpolationVerdict::Sound => (
            StiffeningVerdict::Sound,
            format!(
                "K(Ω) is linear in Ω² up to {highest} rad/s, as it must be on the undeformed geometry \
                 (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e})."
            ),
        ),
        InterpolationVerdict::Suspect => (
            StiffeningVerdict::Suspect,
            format!(
                "K(Ω) is not linear in Ω² (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}, |Ω1²K1|/|K0| = \
                 {linear_ratio:.1e}): it was probably exported on the deformed geometry of a non-linear pre-stress \
                 step. Results are right at the given speeds; between them the lowest frequencies deviate by an \
                 estimated {percent:.2} %. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound if frequency_error.is_finite() => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) cannot be interpolated: between the given speeds the lowest frequencies deviate by {percent:.1} \
                 % from a smooth curve (|Ω1⁴K2|/|K0| = {quadratic_ratio:.1e}). The matrices were probably exported on \
                 the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
        InterpolationVerdict::Unsound => (
            StiffeningVerdict::Unsound,
            format!(
                "K(Ω) interpolated between the given speeds is not positive definite (|Ω1⁴K2|/|K0| = \
                 {quadratic_ratio:.1e}); speeds at which this is so are refused. The matrices were probably exported \
                 on the deformed geometry of a non-linear pre-stress step. {advice}"
            ),
        ),
    };
    // JSON has no infinity; an indefinite K is an error of at least 100 %.
    let frequency_error = frequency_error.min(1.0);
    StiffeningReport { verdict, linear_ratio, quadratic_ratio, frequency_error, message }
}
