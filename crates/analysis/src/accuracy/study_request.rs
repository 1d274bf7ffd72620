//! What a convergence study asks for: a scene, a few speeds, a grid of settings.

use serde::{Deserialize, Serialize};

use super::trial::{Setting, TrialRequest};
use crate::auto_or::AutoOr;
use crate::discretisation::aligned_samples;
use crate::error::Violation;
use crate::model::ModelFacts;
use crate::request::{
    Integration, SchemeChoice, Sensor, SweepDirection, SweepRequest, default_peak_prominence,
};
use crate::resolve::{limits, resolve_sweep};
use crate::scene::Scene;
use crate::speeds::Speeds;
use crate::stepping::MOST_STEPS;

/// A convergence study: errors of a grid of settings against a reference one level finer, and what each costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct StudyRequest {
    /// Id of an uploaded model.
    #[cfg_attr(feature = "schema", schema(max_length = 64))]
    pub model: String,
    /// One to eight speeds.
    pub speeds: Speeds,
    /// Effects of the simulation.
    pub scene: Scene,
    /// The settings: every combination is run.
    #[serde(default)]
    pub grid: Grid,
    /// The length of a run.
    #[serde(default)]
    pub integration: StudyIntegration,
    /// Revolutions from the start over which displacements are compared, before chaos separates trajectories.
    #[serde(default = "default_history_revolutions")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub history_revolutions: u32,
    /// Where the response is recorded; default: radial at the first and the last contact node of sector 0.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schema(max_items = 64))]
    pub sensors: Vec<Sensor>,
    /// Highest engine order that is compared.
    #[serde(default = "default_max_engine_order")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub max_engine_order: u32,
}

fn default_history_revolutions() -> u32 {
    3
}

fn default_max_engine_order() -> u32 {
    24
}

/// Settings of a study. The defaults are the paper's five numbers of modes by all schemes. Of ten sectors with ten contact nodes and
/// three stiffness speeds they make at most 330, 540, 900, 1140 and 1560 unknowns, the paper's sizes; nearly dependent directions
/// are dropped, which leaves the demo's impeller 330, 492, 728, 891 and 1169. `reductions[].wheel_unknowns` of the result has the
/// numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Grid {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub modes_per_speed: Vec<u32>,
    /// Time steps per revolution; each is rounded up so that all histories share their instants.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub steps_per_revolution: Vec<u32>,
    /// Schemes, none of them `auto`.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub schemes: Vec<SchemeChoice>,
    /// Modes per nodal diameter that `massless_boundary` integrates.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 12))]
    pub kept_modes: Vec<AutoOr>,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            modes_per_speed: vec![1, 8, 20, 28, 42],
            steps_per_revolution: vec![450, 900, 1800, 3600, 7200, 14_400],
            schemes: vec![
                SchemeChoice::ExactModal,
                SchemeChoice::MasslessBoundary,
                SchemeChoice::CentralDifferences,
            ],
            kept_modes: vec![AutoOr::Auto],
        }
    }
}

/// The length of a run, as in a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct StudyIntegration {
    /// Revolutions to simulate.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub revolutions: u32,
    /// Revolutions over which the restriction grows from zero to its full height.
    #[cfg_attr(feature = "schema", schema(minimum = 0))]
    pub ramp_revolutions: f64,
    /// Revolutions at the end of the run that spectra are computed from.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100_000))]
    pub window_revolutions: u32,
}

impl Default for StudyIntegration {
    fn default() -> Self {
        let Integration { revolutions, ramp_revolutions, window_revolutions, .. } = Integration::default();
        Self { revolutions, ramp_revolutions, window_revolutions }
    }
}

/// Most speeds of a study, and most entries of each list of its grid.
const MOST_SPEEDS: usize = 8;
const MOST_ENTRIES: usize = 12;

/// Most runs of a study, and most displacements kept of all of them together (8 bytes each).
const MOST_RUNS: usize = 2000;
const MOST_KEPT: usize = 1 << 24;

/// A level finer than the finest of a grid: so many times its steps and, where it has a single size, its modes.
const FINER: u32 = 2;

impl StudyRequest {
    /// The sweep that its runs are speeds of.
    pub(super) fn sweep(&self) -> SweepRequest {
        SweepRequest {
            model: self.model.clone(),
            modes_per_speed: AutoOr::Auto,
            speeds: self.speeds.clone(),
            scene: self.scene.clone(),
            integration: Integration {
                revolutions: self.integration.revolutions,
                ramp_revolutions: self.integration.ramp_revolutions,
                window_revolutions: self.integration.window_revolutions,
                ..Integration::default()
            },
            sensors: self.sensors.clone(),
            max_engine_order: self.max_engine_order,
            peak_prominence: default_peak_prominence(),
            sweep: SweepDirection::Independent,
            refine: false,
            accuracy: None,
            budget: None,
            control_speeds: None,
        }
    }

    /// Every setting of the grid, sizes first, on a wheel of `sectors`. Steps that come out the same are taken once.
    pub(super) fn settings(&self, sectors: u32) -> Vec<Setting> {
        let sweep = self.sweep();
        let mut steps: Vec<u32> = self
            .grid
            .steps_per_revolution
            .iter()
            .map(|&s| Setting::aligned_steps(s, &sweep, sectors))
            .collect();
        steps.sort_unstable();
        steps.dedup();
        let mut settings = Vec::new();
        for &modes_per_speed in &self.grid.modes_per_speed {
            for &scheme in &self.grid.schemes {
                let kept: &[AutoOr] = match scheme {
                    SchemeChoice::MasslessBoundary => &self.grid.kept_modes,
                    _ => &[AutoOr::Auto],
                };
                for &kept_modes in kept {
                    let setting = |&steps_per_revolution| Setting {
                        modes_per_speed,
                        scheme,
                        kept_modes,
                        steps_per_revolution,
                    };
                    settings.extend(steps.iter().map(setting));
                }
            }
        }
        settings
    }

    /// One level finer than the finest of the grid: by the exact propagator with mass, which all schemes tend to as modes are
    /// added.
    pub(super) fn reference(&self, sectors: u32) -> Setting {
        let mut modes = self.grid.modes_per_speed.clone();
        modes.sort_unstable();
        let largest = modes.last().copied().unwrap_or(1);
        let finer = match modes.iter().rev().find(|&&k| k < largest) {
            // The grid's own last ratio once more.
            Some(&next) => (u64::from(largest) * u64::from(largest)).div_ceil(next.into()) as u32,
            None => FINER * largest,
        };
        let steps = self.grid.steps_per_revolution.iter().copied().max().unwrap_or(1);
        Setting {
            modes_per_speed: finer.min(limits::MODES_PER_SPEED),
            scheme: SchemeChoice::ExactModal,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: FINER * Setting::aligned_steps(steps, &self.sweep(), sectors),
        }
    }

    /// At `speed_rad_s`: the reference, which has the twin, and the grid.
    pub(super) fn trials(&self, speed_rad_s: f64, sectors: u32) -> (TrialRequest, Vec<TrialRequest>) {
        let sweep = self.sweep();
        let trial = |setting, twin| TrialRequest {
            history_revolutions: self.history_revolutions,
            twin,
            ..TrialRequest::new(&sweep, speed_rad_s, setting)
        };
        let reference = trial(self.reference(sectors), true);
        (reference, self.settings(sectors).into_iter().map(|setting| trial(setting, false)).collect())
    }

    /// All trials of a resolved study on a wheel of `sectors`, those of few modes first.
    pub fn all_trials(&self, sectors: u32) -> Vec<TrialRequest> {
        let mut trials = Vec::new();
        for speed in self.speeds.resolve().unwrap_or_default() {
            let (reference, grid) = self.trials(speed, sectors);
            trials.extend(grid);
            trials.push(reference);
        }
        trials.sort_by_key(|trial| trial.sweep.modes());
        trials
    }
}

/// Checks a study against its model and fills in the default sensors.
pub fn resolve_study(mut request: StudyRequest, facts: &ModelFacts) -> Result<StudyRequest, Vec<Violation>> {
    let mut found = match resolve_sweep(request.sweep(), facts) {
        Ok(sweep) => {
            request.sensors = sweep.sensors;
            Vec::new()
        }
        Err(found) => found,
    };
    let mut require = |holds: bool, pointer: &str, message: String| {
        if !holds {
            found.push(Violation::new(pointer, message));
        }
    };
    if let Ok(speeds) = request.speeds.resolve() {
        let message = format!("a study has at most {MOST_SPEEDS} speeds, not {}", speeds.len());
        require(speeds.len() <= MOST_SPEEDS, "/speeds", message);
    }
    let revolutions = request.integration.revolutions;
    require(
        (1..=revolutions).contains(&request.history_revolutions),
        "/history_revolutions",
        format!("the run has {revolutions} revolutions: between 1 and {revolutions} are compared"),
    );
    let Grid { modes_per_speed, steps_per_revolution, schemes, kept_modes } = &request.grid;
    for (list, length) in [
        ("modes_per_speed", modes_per_speed.len()),
        ("steps_per_revolution", steps_per_revolution.len()),
        ("schemes", schemes.len()),
        ("kept_modes", kept_modes.len()),
    ] {
        require(
            (1..=MOST_ENTRIES).contains(&length),
            &format!("/grid/{list}"),
            format!("between 1 and {MOST_ENTRIES} entries"),
        );
    }
    for (i, k) in modes_per_speed.iter().enumerate().take(MOST_ENTRIES) {
        require(
            (1..=limits::MODES_PER_SPEED).contains(k) && !modes_per_speed[..i].contains(k),
            &format!("/grid/modes_per_speed/{i}"),
            format!("numbers between 1 and {}, each once", limits::MODES_PER_SPEED),
        );
    }
    let least = 2 * request.max_engine_order.min(MOST_STEPS) + 1;
    for (i, steps) in steps_per_revolution.iter().enumerate().take(MOST_ENTRIES) {
        require(
            (least..=MOST_STEPS / FINER).contains(steps) && !steps_per_revolution[..i].contains(steps),
            &format!("/grid/steps_per_revolution/{i}"),
            format!(
                "numbers between {least} and {}, each once: the reference takes twice the largest",
                MOST_STEPS / FINER
            ),
        );
    }
    for (i, scheme) in schemes.iter().enumerate().take(MOST_ENTRIES) {
        require(
            *scheme != SchemeChoice::Auto && !schemes[..i].contains(scheme),
            &format!("/grid/schemes/{i}"),
            "central_differences, exact_modal or massless_boundary, each once".to_owned(),
        );
    }
    for (i, kept) in kept_modes.iter().enumerate().take(MOST_ENTRIES) {
        require(
            *kept != AutoOr::Fixed(0) && !kept_modes[..i].contains(kept),
            &format!("/grid/kept_modes/{i}"),
            "\"auto\" or numbers from 1 on, each once".to_owned(),
        );
    }
    if found.is_empty() {
        found = refused_settings(&request, facts);
    }
    if found.is_empty() { Ok(request) } else { Err(found) }
}

/// What the scene does not allow of a grid that is sound in itself, or what would take too much memory; each field once.
fn refused_settings(request: &StudyRequest, facts: &ModelFacts) -> Vec<Violation> {
    let sweep = request.sweep();
    let mut found: Vec<Violation> = Vec::new();
    let trials = request.all_trials(facts.sectors).len();
    let samples = aligned_samples(&sweep, facts.sectors as usize);
    let kept = trials * samples * request.history_revolutions as usize * request.sensors.len();
    if trials > MOST_RUNS || kept > MOST_KEPT {
        let message = format!(
            "{trials} runs with {kept} displacements to be kept: a study has at most {MOST_RUNS} runs and {MOST_KEPT} displacements; \
             take fewer settings, speeds or sensors, or compare fewer revolutions"
        );
        return vec![Violation::new("/grid", message)];
    }
    for setting in request.settings(facts.sectors).into_iter().chain([request.reference(facts.sectors)]) {
        for mut violation in resolve_sweep(setting.on(&sweep), facts).err().unwrap_or_default() {
            if violation.pointer == "/integration/steps_per_revolution" {
                violation.pointer = "/grid/steps_per_revolution".to_owned();
                violation.message = format!("{}: {}", setting.steps_per_revolution, violation.message);
            }
            if found.iter().all(|known| known.pointer != violation.pointer) {
                found.push(violation);
            }
        }
    }
    found
}
