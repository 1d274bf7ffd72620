//! Scenes along a branch, as the continuation takes them.

use std::borrow::Cow;
use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use crate::effects::casing::resolved::Clearance;
use crate::end_state::{EndState, Shapes};
use crate::model::ReducedSector;
use crate::not_runnable::NotRunnable;
use crate::request::{AutoOr, BranchParameter, Setting};
use crate::resolved::{ResolvedBranches, ResolvedSpeeds, ResolvedSweep};
use crate::result::SchemeReport;
use crate::speed_scene::SpeedScene;
use crate::steady::most_revolutions;
use crate::stepping::Stepping;
use rubmap_wheel::dynamics::initial::{InitialMode, Stepped, SteppedMode};
use rubmap_wheel::dynamics::integrate::{Passage, Simulation};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::steady::branch::{Family, Lap, Unreachable};
use rubmap_wheel::dynamics::steady::response::{Sought, seek};

/// Number of values whose wheels are kept: a point and the one for the difference of its map, the point before, and places between.
pub(super) const KEPT: usize = 6;

/// Scenes of a branch request, all stepped alike.
pub(super) struct Scenes<'a> {
    sector: &'a ReducedSector,
    asked: &'a ResolvedBranches,
    setting: Setting,
    report: SchemeReport,
    /// Resolved sweep at the starting value, with the chosen setting.
    sweep: ResolvedSweep,
    kept: RefCell<Vec<(f64, Rc<Scene<'a>>)>>,
}

/// Scene at one value of the parameter.
pub(super) struct Scene<'a> {
    pub(super) at_speed: SpeedScene<'a>,
    /// Mode shapes of the wheel, once a state has been carried to it or from it.
    shapes: OnceCell<Shapes>,
}

impl Scene<'_> {
    fn shapes(&self) -> Result<&Shapes, Unreachable> {
        if let Some(shapes) = self.shapes.get() {
            return Ok(shapes);
        }
        let SpeedScene { sector, request, wheel, .. } = &self.at_speed;
        let shapes = Shapes::of(wheel, &sector.wheel, request.scene.centrifugal_stiffening)
            .map_err(|error| Unreachable(error.to_string()))?;
        Ok(self.shapes.get_or_init(|| shapes))
    }
}

impl<'a> Scenes<'a> {
    /// Chooses one scheme and one number of steps for all scenes: the most needed among the two ends and the start.
    pub(super) fn new(sector: &'a ReducedSector, asked: &'a ResolvedBranches) -> Result<Self, NotRunnable> {
        let along = asked.along;
        let values = [asked.start(), along.from, along.to];
        // Which scheme is chosen depends on the slowest speed.
        let slowest = values.into_iter().map(|value| speed(asked, value)).fold(f64::INFINITY, f64::min);
        let sweep = ResolvedSweep { speeds: ResolvedSpeeds::one(slowest), ..asked.sweep.clone() };
        let chosen = |value: f64| {
            let changed = changed(&sweep, asked, value);
            SpeedScene::new(sector, Cow::Owned(changed), speed(asked, value)).map(|scene| scene.stepping)
        };
        let choices = [chosen(asked.start())?, chosen(along.from)?, chosen(along.to)?];
        let kept_modes = choices.iter().filter_map(|stepping| match stepping.scheme {
            Scheme::MasslessBoundary { kept_modes } => Some(kept_modes as u32),
            _ => None,
        });
        let kept_modes = kept_modes.min().map_or(AutoOr::Auto, AutoOr::Fixed);
        let [start, from, to] = choices;
        let finer = |a: Stepping, b: Stepping| {
            if a.discretisation.per_revolution >= b.discretisation.per_revolution { a } else { b }
        };
        let Stepping { discretisation, report, .. } = finer(finer(start, from), to);
        let setting = Setting {
            modes_per_speed: asked.sweep.modes_per_speed(),
            scheme: report.name,
            kept_modes,
            steps_per_revolution: discretisation.per_revolution as u32,
        };
        let sweep = asked.sweep.at(setting);
        Ok(Self { sector, asked, setting, report, sweep, kept: RefCell::default() })
    }

    /// Scenes with `times` the steps.
    pub(super) fn with_more_steps(&self, times: u32) -> Self {
        let steps_per_revolution = self.setting.steps_per_revolution.saturating_mul(times);
        let setting = Setting { steps_per_revolution, ..self.setting };
        Self {
            sector: self.sector,
            asked: self.asked,
            setting,
            report: self.report.clone(),
            sweep: self.asked.sweep.at(setting),
            kept: RefCell::default(),
        }
    }

    /// Setting with which all scenes are stepped.
    pub(super) fn setting(&self) -> Setting {
        self.setting
    }

    /// Reason for the scheme and the steps: the report of the scene that needs most steps.
    pub(super) fn report(&self) -> &SchemeReport {
        &self.report
    }

    /// Rotational speed at a value, rad/s.
    pub(super) fn speed(&self, value: f64) -> f64 {
        speed(self.asked, value)
    }

    /// Calls `act` with the simulation at `value` and the wheel of the scene, to which sensors may have added rows; returns its result.
    pub(super) fn simulation<T>(
        &self,
        value: f64,
        ramp_revolutions: f64,
        act: impl FnOnce(Simulation<'_>, &ModalWheel) -> T,
    ) -> Result<T, NotRunnable> {
        let scene = &self.at(value)?.at_speed;
        scene.staged(ramp_revolutions, |simulation| act(simulation, &scene.wheel))
    }

    /// Seeks the periodic response at the start, from the initial state of the scene.
    pub(super) fn seek(&self, go_on: &dyn Fn() -> bool) -> Result<Sought, NotRunnable> {
        let scene = &self.at(self.asked.start())?.at_speed;
        scene.staged(scene.request.integration.ramp_revolutions, |simulation| {
            let initial = scene.initial(simulation.casing)?;
            let simulation = Simulation { initial: &initial, ..simulation };
            Ok(seek(&simulation, most_revolutions(&scene.request), false, go_on))
        })?
    }

    pub(super) fn at(&self, value: f64) -> Result<Rc<Scene<'a>>, NotRunnable> {
        let kept = self.kept.borrow().iter().position(|(at, _)| *at == value);
        let scene = match kept {
            Some(index) => self.kept.borrow_mut().remove(index).1,
            None => {
                let request = Cow::Owned(changed(&self.sweep, self.asked, value));
                let at_speed = SpeedScene::new(self.sector, request, self.speed(value))?;
                Rc::new(Scene { at_speed, shapes: OnceCell::new() })
            }
        };
        // The last one asked for is last.
        let mut kept = self.kept.borrow_mut();
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push((value, Rc::clone(&scene)));
        Ok(scene)
    }
}

impl Family for Scenes<'_> {
    fn with(&self, value: f64, lap: Lap, act: &mut dyn FnMut(&mut Passage<'_>)) -> Result<(), Unreachable> {
        self.simulation(value, 0.0, |simulation, _| {
            let mut passage = lap.passage(&simulation)?;
            act(&mut passage);
            Ok(())
        })
        .map_err(unreachable)?
    }

    fn carry(&self, state: &Stepped, from: f64, to: f64) -> Result<Stepped, Unreachable> {
        if self.asked.along.parameter != BranchParameter::Speed {
            return Ok(state.clone());
        }
        let [before, after] = [self.at(from).map_err(unreachable)?, self.at(to).map_err(unreachable)?];
        let reduced = &*self.sector.wheel;
        // Increments are carried as displacements are; the step has another length.
        let longer = from / to;
        let as_initial = |mode: &SteppedMode| InitialMode {
            harmonic: mode.harmonic,
            family: mode.family,
            displacement: mode.displacement,
            velocity: mode.increment * longer,
        };
        let as_stepped = |mode: InitialMode| SteppedMode {
            harmonic: mode.harmonic,
            family: mode.family,
            displacement: mode.displacement,
            increment: mode.velocity,
        };
        let modes: Vec<InitialMode> = state.modes.iter().map(as_initial).collect();
        let SpeedScene { wheel, stepping, .. } = &after.at_speed;
        let modes = EndState::new(&modes, before.shapes()?)
            .modes(wheel, after.shapes()?, reduced, stepping.scheme)
            .ok_or_else(|| unreachable(NotRunnable::OtherReduction))?;
        let mut casing = state.casing.clone();
        casing.iter_mut().flat_map(|wave| &mut wave.increment).for_each(|increment| *increment *= longer);
        Ok(Stepped { modes: modes.into_iter().map(as_stepped).collect(), casing })
    }
}

fn unreachable(reason: NotRunnable) -> Unreachable {
    Unreachable(reason.to_string())
}

fn speed(asked: &ResolvedBranches, value: f64) -> f64 {
    match asked.along.parameter {
        BranchParameter::Speed => value,
        _ => asked.speed_rad_s(),
    }
}

/// Copy of `sweep` with the parameter at `value`.
fn changed(sweep: &ResolvedSweep, asked: &ResolvedBranches, value: f64) -> ResolvedSweep {
    let mut sweep = sweep.clone();
    let casing = sweep.scene.casing.as_mut();
    match asked.along.parameter {
        BranchParameter::Speed => {}
        BranchParameter::Clearance => match casing.map(|casing| &mut casing.clearance) {
            Some(Clearance::AlongChord { leading, trailing }) => {
                *leading *= value;
                *trailing *= value;
            }
            Some(Clearance::Each(values)) => values.iter_mut().for_each(|clearance| *clearance *= value),
            None => {}
        },
        BranchParameter::LobeAmplitude => {
            if let Some(lobes) = casing.and_then(|casing| casing.shape.lobes.as_mut()) {
                lobes.amplitude *= value;
            }
        }
        BranchParameter::Damping => {
            if let Some(damping) = &mut sweep.scene.damping {
                damping.modal_ratio *= value;
                damping.family_ratios.iter_mut().for_each(|ratio| *ratio *= value);
            }
        }
    }
    sweep
}
