//! Legs of run-ups: each takes a run some frames further.

use std::borrow::Cow;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::cutting::{BAND_RATIO, cutting};
use super::frame::{Frame, order_step};
use crate::discretisation::Discretisation;
use crate::effects::casing::convert::running_clearance;
use crate::end_state::{EndState, Shapes};
use crate::error::{AnalysisError, Violation};
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::not_runnable::NotRunnable;
use crate::record::cut_short;
use crate::request::{AutoOr, SchemeChoice};
use crate::resolved::{ResolvedRunUps, ResolvedSweep};
use crate::result::{LargestOfRun, PointStatus, RunUpEnd, RunUpFrame, RunUpLeg, SchemeReport};
use crate::speed_scene::SpeedScene;
use crate::stepping::Stepping;
use crate::wheel::{rotation, wheel_of};
use rubmap_wheel::dynamics::clearance_drift::ClearanceDrift;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::euler::{EulerForce, modal_load};
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::integrate::{Part, Simulation, Stretch};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::run_up::profile::SpeedProfile;
use rubmap_wheel::dynamics::run_up::segments::Segment;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::vectors::vectors;

/// Approximate numbers of steps and amplitudes of a leg: at most these are lost when the service dies, and stored at once.
const LEG_STEPS: u64 = 1_000_000;
const LEG_AMPLITUDES: usize = 500_000;

/// State of a run-up job between legs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunUpCourse {
    run: u32,
    /// Number of finished segments.
    segments: usize,
    /// State of the wheel after the finished segments; none before the first.
    state: Option<EndState>,
    so_far: SoFar,
}

/// Results of a run so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct SoFar {
    largest: Vec<LargestOfRun>,
    /// Scheme of the lowest band so far, with that band.
    scheme: Option<(u32, SchemeReport)>,
    steps: u64,
    contact_steps: u64,
    largest_energy: f64,
    largest_energy_off: f64,
    /// Largest difference between work and energy of blades that stiffen, where they do.
    largest_bending_off: Option<f64>,
    stiffening_work: f64,
    transfer_loss: f64,
    largest_penetration: f64,
    /// Mechanical energy at the end of the last segment.
    last_energy: Option<f64>,
    wall_time_s: f64,
}

/// Computes the leg after `course`, or the first one; returns it with the next course, none when all runs have ended. Deterministic, on the
/// calling thread. A run that diverges or cannot be integrated is a result.
///
/// # Errors
/// Cancellation; a refusal where the speed changes too fast for the angle's tolerance.
pub fn run_up_leg(
    sector: &ReducedSector,
    asked: &ResolvedRunUps,
    course: Option<RunUpCourse>,
    monitor: &dyn Monitor,
) -> Result<(RunUpLeg, Option<RunUpCourse>), AnalysisError> {
    let course = course.unwrap_or_else(|| RunUpCourse::begins(0));
    let run = course.run;
    let march = March::new(asked, sector.wheel.sectors, run)?;
    let turned = |run: u32| asked.speed.profile(run).revolutions();
    let (before, all) = ((0..run).map(turned).sum::<f64>(), (0..asked.runs()).map(turned).sum::<f64>());
    let own = march.profile.revolutions();
    let watch = |share: f64, speed_rad_s: f64| {
        let words = format!("run {} of {}, {speed_rad_s:.0} rad/s", run + 1, asked.runs());
        monitor.progress((before + share * own) / all, &words);
        !monitor.is_cancelled()
    };
    let (leg, next) = march.go(sector, course, &watch)?;
    let next_run = (run + 1 < asked.runs()).then(|| RunUpCourse::begins(run + 1));
    Ok((leg, next.or(next_run)))
}

impl RunUpCourse {
    /// State of a run before its first segment.
    fn begins(run: u32) -> Self {
        Self { run, segments: 0, state: None, so_far: SoFar::default() }
    }
}

/// Run with all that is known before it begins.
pub(super) struct March<'a> {
    asked: &'a ResolvedRunUps,
    pub(super) profile: SpeedProfile,
    pub(super) samples: usize,
    pub(super) frame_revolutions: u64,
    pub(super) segments: Vec<Segment>,
}

/// Stepping of the bands met so far.
struct Steppings(Vec<(u32, Stepping)>);

impl Steppings {
    fn in_band(
        &mut self,
        march: &March<'_>,
        sector: &ReducedSector,
        band: u32,
    ) -> Result<&Stepping, NotRunnable> {
        let place = match self.0.iter().position(|(of, _)| *of == band) {
            Some(place) => place,
            None => {
                self.0.push((band, march.stepping(sector, band)?));
                self.0.len() - 1
            }
        };
        Ok(&self.0[place].1)
    }
}

/// Scene at the speed of a segment, with the mode shapes of its wheel.
struct SegmentScene<'a> {
    at_speed: SpeedScene<'a>,
    shapes: Shapes,
}

impl<'a> March<'a> {
    /// Run `run` of a wheel of this number of sectors.
    pub(super) fn new(asked: &'a ResolvedRunUps, sectors: usize, run: u32) -> Result<Self, AnalysisError> {
        let profile = asked.speed.profile(run);
        let samples = Discretisation::of_every_speed(&asked.sweep, sectors);
        let revolutions = profile.revolutions();
        let segments = cutting(asked, revolutions, samples)
            .segments(&profile)
            .map_err(|error| AnalysisError::Refused(vec![Violation::new("/speed", error.to_string())]))?;
        let frame_revolutions = asked.frame_revolutions(revolutions);
        Ok(Self { asked, profile, samples, frame_revolutions, segments })
    }

    pub(super) fn request(&self) -> &'a ResolvedSweep {
        &self.asked.sweep
    }

    pub(super) fn has_euler_force(&self) -> bool {
        self.asked.euler_force
    }

    /// Lowest speed of a band, rad/s.
    pub(super) fn lowest_of(&self, band: u32) -> f64 {
        self.profile.range_rad_s().0 * BAND_RATIO.powi(band as i32)
    }

    /// Highest band of all segments.
    pub(super) fn highest_band(&self) -> u32 {
        self.segments.iter().map(|segment| segment.band).max().unwrap_or(0)
    }

    /// Stepping of a band: that of its lowest speed. A boundary without mass keeps the modes of the highest band in all bands: a mode that
    /// was integrated only above some speed would begin at rest, under forces that it had followed.
    pub(super) fn stepping(&self, sector: &ReducedSector, band: u32) -> Result<Stepping, NotRunnable> {
        let request = self.request();
        let highest = self.highest_band();
        let of_highest = self.stepping_at(sector, request, self.lowest_of(highest))?;
        let mut stepping = match of_highest.scheme {
            _ if band == highest => of_highest,
            Scheme::MasslessBoundary { kept_modes } => {
                let mut kept = request.clone();
                kept.integration.scheme = SchemeChoice::MasslessBoundary;
                kept.integration.kept_modes = AutoOr::Fixed(kept_modes as u32);
                self.stepping_at(sector, &kept, self.lowest_of(band))?
            }
            Scheme::CentralDifferences | Scheme::ExactModal => {
                self.stepping_at(sector, request, self.lowest_of(band))?
            }
        };
        stepping.discretisation = stepping.discretisation.sampled(self.samples);
        Ok(stepping)
    }

    /// Stepping of a scene at one speed, run in parts.
    fn stepping_at(
        &self,
        sector: &ReducedSector,
        request: &ResolvedSweep,
        speed: f64,
    ) -> Result<Stepping, NotRunnable> {
        let wheel = wheel_of(&request.scene, &sector.wheel, speed)?;
        Stepping::choose_for_parts(&wheel, &sector.wheel.contact, request, self.asked.euler_force)
    }

    /// Simulates only the first sample of the run with `stepping`: the time of this is the set-up of a segment.
    pub(super) fn begin(&self, sector: &ReducedSector, stepping: &Stepping) -> Result<(), NotRunnable> {
        let Some(first) = self.segments.first() else { return Ok(()) };
        let first = Segment { samples: 1, ..*first };
        let scene = self.scene(sector, &first, stepping, None)?;
        self.take(&scene, &first, None, &mut SoFar::default(), &|_| true).map(|_| ())
    }

    /// Takes the run some frames further; `watch` receives the finished share of the run, and the speed.
    fn go(
        &self,
        sector: &ReducedSector,
        course: RunUpCourse,
        watch: &dyn Fn(f64, f64) -> bool,
    ) -> Result<(RunUpLeg, Option<RunUpCourse>), AnalysisError> {
        let clock = Instant::now();
        let RunUpCourse { run, segments: mut done, mut state, mut so_far } = course;
        let (before, first_steps) = (so_far.wall_time_s, so_far.steps);
        let mut leg = RunUpLeg {
            run,
            order_step: order_step(self.frame_revolutions),
            frames: Vec::new(),
            end: None,
            vectors: vectors(),
        };
        let mut last: Option<SegmentScene<'_>> = None;
        let mut steppings = Steppings(Vec::new());
        let of_frame =
            |segment: &Segment| segment.first_sample / (self.samples as u64 * self.frame_revolutions);
        let mut amplitudes = 0;
        while done < self.segments.len()
            && so_far.steps - first_steps < LEG_STEPS
            && amplitudes < LEG_AMPLITUDES
        {
            let number = of_frame(&self.segments[done]);
            let mut frame = Frame::begin(&self.segments[done], self.samples, self.request().sensors.len());
            while let Some(segment) = self.segments.get(done).filter(|segment| of_frame(segment) == number) {
                let share = |within: f64| {
                    watch((done as f64 + within) / self.segments.len() as f64, segment.speed_rad_s)
                };
                // Shorter than what a run looks up after.
                if !share(0.0) {
                    return Err(AnalysisError::Cancelled);
                }
                let taken = steppings.in_band(self, sector, segment.band).and_then(|stepping| {
                    if so_far.scheme.as_ref().is_none_or(|(band, _)| segment.band < *band) {
                        so_far.scheme = Some((segment.band, stepping.report.clone()));
                    }
                    let scene = self.scene(sector, segment, stepping, last.take())?;
                    let stretch = self.take(&scene, segment, state.as_ref(), &mut so_far, &share)?;
                    Ok((scene, stretch))
                });
                let failed = match taken {
                    Ok((scene, stretch)) => {
                        so_far.steps += stretch.statistics.steps;
                        so_far.gather(&reached(segment, &stretch, &self.profile));
                        so_far.contact_steps += stretch.statistics.contact_steps;
                        match stretch.ended.as_ref().map(|outcome| cut_short(outcome, &sector.units.length)) {
                            None => Ok((scene, stretch)),
                            Some(None) => return Err(AnalysisError::Cancelled),
                            Some(Some(reason)) => Err(reason),
                        }
                    }
                    Err(reason) => Err((PointStatus::Failed, reason.to_string())),
                };
                let (scene, stretch) = match failed {
                    Ok(taken) => taken,
                    Err((status, message)) => {
                        let told = (self.samples, self.frame_revolutions);
                        leg.frames.extend(frame.cut_short(&self.profile, told));
                        so_far.wall_time_s = before + clock.elapsed().as_secs_f64();
                        let message = format!("at {:.4} rad/s: {message}", segment.speed_rad_s);
                        leg.end = Some(self.end(&so_far, done, status, Some(message)));
                        return Ok((leg, None));
                    }
                };
                frame.add(segment, &stretch, &self.profile);
                so_far.count(&stretch);
                state = Some(EndState::new(&stretch.end, &scene.shapes));
                so_far.last_energy = Some(modal_energy(&scene.at_speed.wheel, &stretch.end));
                last = Some(scene);
                done += 1;
            }
            let told = (self.samples, self.frame_revolutions);
            let frame = frame.told(&self.profile, told, self.request().max_engine_order);
            amplitudes += frame.spectra.iter().map(Vec::len).sum::<usize>();
            leg.frames.push(frame);
        }
        so_far.wall_time_s = before + clock.elapsed().as_secs_f64();
        if done < self.segments.len() {
            return Ok((leg, Some(RunUpCourse { run, segments: done, state, so_far })));
        }
        let message =
            leg.frames.last().filter(|last| last.revolution > 0).and_then(|last| ends_inside(last, &so_far));
        leg.end = Some(self.end(&so_far, done, PointStatus::Completed, message));
        Ok((leg, None))
    }

    /// Scene at the speed of a segment; the `last` one if its speed is the same.
    fn scene<'s>(
        &self,
        sector: &'s ReducedSector,
        segment: &Segment,
        stepping: &Stepping,
        last: Option<SegmentScene<'s>>,
    ) -> Result<SegmentScene<'s>, NotRunnable>
    where
        'a: 's,
    {
        let (request, speed) = (self.request(), segment.speed_rad_s);
        let stepping = stepping.clone();
        if let Some(SegmentScene { at_speed, shapes }) = last
            && at_speed.wheel.speed_rad_s == speed
        {
            return Ok(SegmentScene { at_speed: SpeedScene { stepping, ..at_speed }, shapes });
        }
        let (wheel, shapes) = ModalWheel::with_shapes(&sector.wheel, speed, rotation(&request.scene))?;
        let at_speed = SpeedScene { sector, request: Cow::Borrowed(request), wheel, stepping };
        Ok(SegmentScene { at_speed, shapes: Shapes::found(shapes) })
    }

    /// Simulates a segment from the state at its beginning, or from the initial state of the scene.
    fn take(
        &self,
        scene: &SegmentScene<'_>,
        segment: &Segment,
        state: Option<&EndState>,
        so_far: &mut SoFar,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<Stretch, NotRunnable> {
        let SpeedScene { sector, request, wheel, stepping } = &scene.at_speed;
        let handed = state.map(|state| {
            let all = state.modes(wheel, &scene.shapes, &sector.wheel, Scheme::ExactModal);
            all.ok_or(NotRunnable::OtherReduction)
        });
        let handed = handed.transpose()?;
        let drift = self.drift(sector, segment)?;
        let euler = self.euler_force(scene, segment)?;
        scene.at_speed.staged(request.integration.ramp_revolutions, |staged| {
            let modes = match handed {
                Some(all) => {
                    let kept = |mode: &InitialMode| {
                        let modes = wheel.harmonics[mode.harmonic].omega.len();
                        mode.family < stepping.scheme.integrated_modes(modes)
                    };
                    let energy = modal_energy(wheel, &all);
                    let kept: Vec<InitialMode> = all.into_iter().filter(kept).collect();
                    so_far.stiffening_work += so_far.last_energy.map_or(0.0, |before| energy - before);
                    so_far.transfer_loss += (energy - modal_energy(wheel, &kept)).max(0.0);
                    kept
                }
                None => scene.at_speed.initial(staged.casing)?,
            };
            let simulation = Simulation {
                initial: &modes,
                effects: Effects {
                    clearance_drift: drift.as_ref(),
                    euler_force: euler.as_ref(),
                    ..staged.effects
                },
                revolutions: 1,
                window_revolutions: 0,
                ..staged
            };
            let part = Part { first_sample: segment.first_sample, samples: segment.samples };
            Ok(simulation.stretch(part, watch))
        })?
    }

    /// Change of cold clearances with speed within a segment, whose casing has those of its mean speed; none without cold clearances.
    fn drift(
        &self,
        sector: &ReducedSector,
        segment: &Segment,
    ) -> Result<Option<ClearanceDrift>, NotRunnable> {
        let request = self.request();
        if !request.has_cold_clearances() {
            return Ok(None);
        }
        let at = |speed: f64| running_clearance(sector, request, speed).map(Option::unwrap_or_default);
        let [from, to] = segment.times_s;
        Ok(Some(ClearanceDrift {
            revolutions: self.revolutions(segment),
            without: at(segment.speed_rad_s)?,
            first: at(self.profile.speed_rad_s(from))?,
            last: at(self.profile.speed_rad_s(to))?,
        }))
    }

    /// Euler force within a segment, where it is asked for.
    fn euler_force(
        &self,
        scene: &SegmentScene<'_>,
        segment: &Segment,
    ) -> Result<Option<EulerForce>, NotRunnable> {
        if !self.asked.euler_force {
            return Ok(None);
        }
        let SpeedScene { sector, wheel, .. } = &scene.at_speed;
        let load = sector.euler_load.as_ref().ok_or(NotRunnable::UnreadEulerForce)?.of_unknowns();
        let rate = self.profile.rates(segment.times_s);
        Ok(Some(EulerForce { rate, load: modal_load(load, scene.shapes.of_harmonic(0), wheel.sectors) }))
    }

    /// Revolutions at which a segment begins and ends.
    fn revolutions(&self, segment: &Segment) -> [f64; 2] {
        [segment.first_sample, segment.first_sample + segment.samples]
            .map(|sample| sample as f64 / self.samples as f64)
    }

    fn end(&self, so_far: &SoFar, segments: usize, status: PointStatus, message: Option<String>) -> RunUpEnd {
        let done = &self.segments[..segments];
        let samples: u64 = done.iter().map(|segment| segment.samples).sum();
        let euler = |segment: &Segment| {
            let [from, to] = segment.times_s;
            self.profile.largest_rate(from, to) / segment.speed_rad_s.powi(2)
        };
        let energy = so_far.largest_energy;
        let of_energy = |off: f64| if energy > 0.0 { off / energy } else { 0.0 };
        let contact = self.request().scene.contact.is_some();
        RunUpEnd {
            status,
            message,
            largest: so_far.largest.clone(),
            scheme: so_far.scheme.as_ref().map(|(_, report)| report.clone()),
            revolutions: samples as f64 / self.samples as f64,
            steps: so_far.steps,
            segments: segments as u64,
            largest_angle_error_rad: done.iter().map(|segment| segment.off_rad).fold(0.0, f64::max),
            largest_energy: energy,
            energy_residual: of_energy(so_far.largest_energy_off),
            bending_residual: so_far.largest_bending_off.map(of_energy),
            stiffening_work: so_far.stiffening_work,
            transfer_loss: of_energy(so_far.transfer_loss),
            contact_share: so_far.contact_steps as f64 / so_far.steps.max(1) as f64,
            largest_penetration: contact.then_some(so_far.largest_penetration),
            euler_share: done.iter().map(euler).fold(0.0, f64::max),
            wall_time_s: so_far.wall_time_s,
        }
    }
}

impl SoFar {
    fn count(&mut self, stretch: &Stretch) {
        let (statistics, energy) = (&stretch.statistics, &stretch.energy);
        self.largest_penetration = self.largest_penetration.max(statistics.largest_penetration);
        self.largest_energy = self.largest_energy.max(energy.largest_energy());
        self.largest_energy_off = self.largest_energy_off.max(energy.residual() * energy.largest_energy());
        let bending_off = energy.stiffening_residual().map(|residual| residual * energy.largest_energy());
        self.largest_bending_off = bending_off.into_iter().chain(self.largest_bending_off).reduce(f64::max);
    }

    fn gather(&mut self, of_frame: &[LargestOfRun]) {
        if self.largest.is_empty() {
            self.largest = of_frame.to_vec();
        }
        for (largest, of_frame) in self.largest.iter_mut().zip(of_frame) {
            if of_frame.displacement > largest.displacement {
                *largest = *of_frame;
            }
        }
    }
}

/// Largest displacements of a segment.
fn reached(segment: &Segment, stretch: &Stretch, profile: &SpeedProfile) -> Vec<LargestOfRun> {
    let mut frame = Frame::begin(segment, 1, stretch.largest.len());
    frame.add(segment, stretch, profile);
    frame.into_largest()
}

/// Message about a run whose largest displacement is in its `last` frame, in which the speed still changes; none for others.
fn ends_inside(last: &RunUpFrame, so_far: &SoFar) -> Option<String> {
    if last.speeds_rad_s[0] == last.speeds_rad_s[1] {
        return None;
    }
    let at_end = |largest: &LargestOfRun| largest.displacement > 0.0 && largest.time_s > last.times_s[0];
    let inside = so_far.largest.iter().position(at_end)?;
    Some(format!(
        "the displacement of sensor {inside} is largest at the end: the run may end within a critical speed, and what would follow is not \
         known; let it go further"
    ))
}

/// Modal energy ½(|ż|² + ω²|z|²), summed over the modes.
fn modal_energy(wheel: &ModalWheel, modes: &[InitialMode]) -> f64 {
    let of = |mode: &InitialMode| {
        let omega = wheel.harmonics[mode.harmonic].omega[mode.family];
        0.5 * (mode.velocity.norm_sqr() + omega * omega * mode.displacement.norm_sqr())
    };
    modes.iter().map(of).sum()
}
