//! The loop over part of a run.

use pulp::Simd;

use super::super::instant::Instant;
use super::super::run::Outcome;
use super::super::simulation::Simulation;
use super::super::stretch::{Part, Stretch};
use super::{Affected, Motion, Stepper};

impl Stepper {
    /// Takes the steps of `part`, which the stepper was made for.
    #[inline(always)]
    pub(in super::super) fn stretch<S: Simd>(
        &mut self,
        simd: S,
        simulation: &Simulation<'_>,
        part: Part,
        watch: &dyn Fn(f64) -> bool,
    ) -> Stretch {
        let mut largest = vec![Vec::with_capacity(part.samples as usize); simulation.sensors.len()];
        let ended = self.take(simd, (simulation, part, largest.as_mut_slice()), watch);
        let revolutions =
            (part.first_sample + part.samples) as f64 / simulation.samples_per_revolution as f64;
        let end = self.modes_at_end(simulation, revolutions);
        Stretch {
            ended: ended.err().map(|outcome| *outcome),
            displacement: self.recorder.take().displacement,
            largest,
            end,
            statistics: self.statistics,
            energy: self.energy,
        }
    }

    /// The loop. One is compiled for scenes with and without effects: what they do not have costs a question a step, another loop the compiler
    /// half a minute.
    #[inline(always)]
    fn take<S: Simd>(
        &mut self,
        simd: S,
        (simulation, part, largest): (&Simulation<'_>, Part, &mut [Vec<f64>]),
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Box<Outcome>> {
        let (steps, samples) = (simulation.steps_per_revolution, simulation.samples_per_revolution);
        let sampling = steps / samples;
        let revolution = (part.first_sample / samples as u64) as usize;
        let before = (part.first_sample % samples as u64) as usize * sampling;
        let all = part.samples as usize * sampling;
        let start = match before {
            0 => Instant::beginning(revolution),
            step => Instant::new(revolution, step, steps),
        };
        if self.touches_at::<S, Affected>(simd, start) {
            // Of the step before the first: nothing of it counts.
            let (statistics, energy) = (self.statistics, self.energy);
            self.solve::<S, Affected>(simd, start)?;
            (self.statistics, self.energy) = (statistics, energy);
        }
        for step in 1..=all {
            let now = Instant::of_any(revolution, before + step, steps);
            Affected::predict(self, simd, now);
            if !self.gaps::<S, Affected>(simd, now) {
                self.solve::<S, Affected>(simd, now)?;
            }
            self.statistics.steps += 1;
            self.quench::<Affected>();
            self.look_up(watch, step as f64 / all as f64)?;
            if step % sampling == 0 {
                Affected::apply(self, simd);
                self.record::<S, Affected>(simd, now, false)?;
                self.recorder.largest(&self.fourier, largest);
            }
        }
        Ok(())
    }
}
