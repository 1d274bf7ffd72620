//! A sweep as it is stored and run.

use serde::Serialize;

use crate::effects::casing::request::ClearanceState;
use crate::error::Violation;
use crate::request::speeds::Speeds;
use crate::request::{
    Accuracy, AutoOr, HistoriesRequest, Integration, Limits, Operation, Record, Setting, SweepDirection,
    SweepRequest, sweep::default_peak_prominence,
};
use crate::resolved::knobs::Modes;
use crate::resolved::scene::Scene;
use crate::resolved::sensor::{Place, ResolvedSensor};
use crate::resolved::speeds::ResolvedSpeeds;
use rubmap_solid::material::GivenStrengths;

/// Share of the error that is asked for by which a motion may still change where it counts as repeating.
const SETTLED_SHARE: f64 = 0.1;

/// Default number of control runs where the service chooses the knobs, and where limits are judged.
const DEFAULT_CONTROL_SPEEDS: u32 = 5;

/// Fewest speeds that are refined by default: fewer do not show which peaks there are.
const FEWEST_REFINED: usize = 20;

/// Sweep that was checked against its model; written as [`SweepRequest`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "SweepRequest")]
pub struct ResolvedSweep {
    pub(crate) model: String,
    pub(crate) modes: Modes,
    pub(crate) speeds: ResolvedSpeeds,
    pub(crate) scene: Scene,
    pub(crate) integration: Integration,
    pub(crate) sensors: Vec<ResolvedSensor>,
    pub(crate) max_engine_order: u32,
    pub(crate) peak_prominence: f64,
    pub(crate) sweep: SweepDirection,
    pub(crate) refine: bool,
    pub(crate) reproducible: bool,
    /// Number of speeds that are simulated again at a finer setting.
    pub(crate) control_speeds: u32,
    pub(crate) record: Record,
    pub(crate) fields: Option<bool>,
    pub(crate) operation: Option<Operation>,
    pub(crate) limits: Option<Limits>,
    pub(crate) blade_thickness: Option<f64>,
}

impl ResolvedSweep {
    /// Resolves `asked` without checking it against a model; the last `rounds` of its lists of speeds are rounds of a refinement. `refuse` is given
    /// violations where it says too much or too little, or nothing that is a speed.
    pub(crate) fn of(asked: SweepRequest, rounds: u32, refuse: &mut dyn FnMut(Violation)) -> Self {
        let modes = Modes::of(asked.modes_per_speed, asked.accuracy, asked.budget);
        let independent = asked.sweep == SweepDirection::Independent;
        let controlled = independent && (matches!(modes, Modes::Sought(_)) || asked.limits.is_some());
        let speeds = ResolvedSpeeds::of(asked.speeds, rounds).unwrap_or_else(|violations| {
            violations.into_iter().for_each(&mut *refuse);
            ResolvedSpeeds::none()
        });
        // All sensors are resolved before any is given up, so that all violations are found.
        let sensors: Vec<_> = (asked.sensors.into_iter().enumerate())
            .map(|(index, asked)| ResolvedSensor::of(asked, index, refuse))
            .collect();
        let sensors = sensors.into_iter().collect::<Option<_>>().unwrap_or_default();
        let settled_to = match asked.accuracy {
            Some(Accuracy { target, .. }) => asked.integration.settled_to.min(SETTLED_SHARE * target),
            None => asked.integration.settled_to,
        };
        let integration = Integration { settled_to, ..asked.integration };
        let refined = independent && asked.budget.is_none() && speeds.asked() >= FEWEST_REFINED;
        Self {
            model: asked.model,
            modes,
            speeds,
            scene: Scene::of(asked.scene, refuse),
            integration,
            sensors,
            max_engine_order: asked.max_engine_order,
            peak_prominence: asked.peak_prominence,
            sweep: asked.sweep,
            refine: asked.refine.unwrap_or(refined),
            reproducible: asked.reproducible,
            control_speeds: asked.control_speeds.unwrap_or(if controlled {
                DEFAULT_CONTROL_SPEEDS
            } else {
                0
            }),
            record: asked.record,
            fields: asked.fields,
            operation: asked.operation,
            limits: asked.limits,
            blade_thickness: asked.blade_thickness,
        }
    }

    /// Reads a sweep that was resolved and stored before, with so many `rounds` of a refinement.
    ///
    /// # Errors
    /// Violations, if the sweep was never resolved.
    pub fn stored(mut written: SweepRequest, rounds: u32) -> Result<Self, Vec<Violation>> {
        let mut found = Vec::new();
        // Earlier versions left defaults away, which have changed since.
        written.refine.get_or_insert(false);
        if written.accuracy.is_none() && written.budget.is_none() {
            written.control_speeds.get_or_insert(0);
        }
        let resolved = Self::of(written, rounds, &mut |violation| found.push(violation));
        if found.is_empty() { Ok(resolved) } else { Err(found) }
    }

    /// Id of the model.
    pub fn model(&self) -> &str {
        &self.model
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k: given, or still to be chosen.
    pub fn modes(&self) -> Modes {
        self.modes
    }

    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k; the default while they are sought.
    pub fn modes_per_speed(&self) -> u32 {
        self.modes.or_usual()
    }

    /// Whether the knobs have still to be chosen.
    pub fn is_sought(&self) -> bool {
        self.modes.given().is_none()
    }

    /// Speeds of the sweep.
    pub fn speeds(&self) -> &ResolvedSpeeds {
        &self.speeds
    }

    /// Request as it was asked for, without the speeds that rounds of `refine` have added: asked for again, it gets the same rounds.
    pub fn unrefined(&self) -> SweepRequest {
        let mut request = SweepRequest::from(self.clone());
        if let Speeds::Several(lists) = &mut request.speeds {
            lists.truncate(lists.len() - self.speeds.rounds() as usize);
        }
        request
    }

    /// Sensors of the sweep; at least one.
    pub fn sensors(&self) -> &[ResolvedSensor] {
        &self.sensors
    }

    /// Whether the wheel stiffens with speed.
    pub fn is_stiffened(&self) -> bool {
        self.scene.centrifugal_stiffening
    }

    /// Number of coordinates in which blades bend far; none where the scene has linear theory.
    pub fn bending_coordinates(&self) -> Option<u32> {
        self.scene.geometric_nonlinearity.as_ref().map(|of| of.coordinates)
    }

    /// Whether clearances are given cold and the casing may be touched.
    pub fn has_cold_clearances(&self) -> bool {
        let cold = self.scene.casing.as_ref().is_some_and(|casing| casing.given == ClearanceState::Cold);
        cold && self.scene.contact.is_some()
    }

    /// Whether the casing has a coating that wears.
    pub fn is_worn(&self) -> bool {
        self.scene.abradable.is_some()
    }

    /// Ids of the nodes that the sensors name, ascending, each once.
    pub fn sensor_nodes(&self) -> Vec<u64> {
        let of = |sensor: &ResolvedSensor| match sensor.place {
            Place::Contact(_) => [None; 2],
            Place::Node(id) => [Some(id), None],
            Place::Gauge(nodes) => nodes.map(Some),
        };
        let mut nodes: Vec<u64> = self.sensors.iter().flat_map(of).flatten().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Highest engine order of the spectra.
    pub fn max_engine_order(&self) -> u32 {
        self.max_engine_order
    }

    /// Revolutions that the spectra are computed from; spectra have as many lines per engine order.
    pub fn window_revolutions(&self) -> u32 {
        self.integration.window_revolutions
    }

    /// Whether speeds are added around the peaks.
    pub fn is_refined(&self) -> bool {
        self.refine
    }

    /// Whether limits are given, by which the sweep is judged.
    pub fn is_limited(&self) -> bool {
        self.limits.is_some()
    }

    /// Whether the whole sweep must be computed on processors with one kind of vector instructions.
    pub fn is_of_one_kind(&self) -> bool {
        self.reproducible || self.sweep != SweepDirection::Independent
    }

    /// Histories that the sweep asks for.
    pub fn histories(&self) -> Option<&HistoriesRequest> {
        self.record.histories.as_ref()
    }

    /// Radius about contact nodes within which no stress is claimed, if the sweep asks for stress.
    pub fn stress_outside(&self) -> Option<f64> {
        self.record.stress.as_ref().map(|stress| stress.excluded_radius.unwrap_or(0.0))
    }

    /// Strengths that the sweep gives in place of the model's, by element set.
    pub fn strengths<'a>(&'a self) -> impl Fn(&str) -> Option<&'a GivenStrengths> {
        |set| self.record.stress.as_ref()?.strengths.get(set)
    }

    /// Whether the rows of the reduction's basis must be stored, must not, or are stored where the sweep reduces.
    pub fn fields(&self) -> Option<bool> {
        if self.records_states() { Some(true) } else { self.fields }
    }

    /// Whether states are among the histories that the sweep asks for.
    pub fn records_states(&self) -> bool {
        self.record.wants_states()
    }

    /// Number of speeds that are simulated again at a finer setting.
    pub fn control_speeds(&self) -> usize {
        self.control_speeds as usize
    }

    /// Order in which the speeds follow each other, by index; none if each is on its own.
    pub fn chain(&self) -> Option<Vec<u32>> {
        self.sweep.chain(self.speeds.rad_s())
    }

    /// Sweep with other knobs.
    pub(crate) fn at(&self, setting: Setting) -> Self {
        Self {
            modes: Modes::Given(setting.modes_per_speed),
            integration: Integration {
                scheme: setting.scheme,
                kept_modes: setting.kept_modes,
                steps_per_revolution: AutoOr::Fixed(setting.steps_per_revolution),
                ..self.integration.clone()
            },
            ..self.clone()
        }
    }

    /// Sweep whose marches do not end before their limit.
    pub(crate) fn taking_all(&self) -> Self {
        let revolutions = AutoOr::Fixed(self.integration.revolutions());
        Self { integration: Integration { revolutions, ..self.integration.clone() }, ..self.clone() }
    }

    /// Sweep of a single speed at one setting, without what concerns several speeds, and without what chooses settings.
    pub(crate) fn one_speed(&self, speed_rad_s: f64, setting: Setting) -> Self {
        Self {
            speeds: ResolvedSpeeds::one(speed_rad_s),
            sweep: SweepDirection::Independent,
            refine: false,
            peak_prominence: default_peak_prominence(),
            control_speeds: 0,
            record: Record::default(),
            // Runs that are only compared need no rows.
            fields: self.fields.filter(|wanted| !wanted),
            operation: None,
            limits: None,
            ..self.at(setting)
        }
    }
}

impl From<ResolvedSweep> for SweepRequest {
    fn from(sweep: ResolvedSweep) -> Self {
        let (modes_per_speed, accuracy, budget) = sweep.modes.fields();
        Self {
            model: sweep.model,
            modes_per_speed,
            speeds: sweep.speeds.lists().clone(),
            scene: sweep.scene.into(),
            integration: sweep.integration,
            sensors: sweep.sensors.into_iter().map(Into::into).collect(),
            max_engine_order: sweep.max_engine_order,
            peak_prominence: sweep.peak_prominence,
            sweep: sweep.sweep,
            refine: Some(sweep.refine),
            reproducible: sweep.reproducible,
            accuracy,
            budget,
            control_speeds: Some(sweep.control_speeds),
            record: sweep.record,
            fields: sweep.fields,
            operation: sweep.operation,
            limits: sweep.limits,
            blade_thickness: sweep.blade_thickness,
        }
    }
}
