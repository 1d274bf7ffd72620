//! Part of a run.

use super::super::instant::Instant;
use super::super::run::Outcome;
use super::super::simulation::Simulation;
use super::super::step_range::{Observer, StepRange};
use super::super::stretch::{Part, Stretch};
use super::Stepper;

impl Stepper {
    /// Takes the steps of `part`, which the stepper was made for.
    pub(in super::super) fn stretch(
        &mut self,
        simulation: &Simulation<'_>,
        part: Part,
        watch: &dyn Fn(f64) -> bool,
    ) -> Stretch {
        let mut largest = vec![Vec::with_capacity(part.samples as usize); simulation.sensors.len()];
        let ended = self.take_part(simulation, part, &mut largest, watch);
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

    fn take_part(
        &mut self,
        simulation: &Simulation<'_>,
        part: Part,
        largest: &mut [Vec<f64>],
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Box<Outcome>> {
        let (per_revolution, samples) =
            (simulation.steps_per_revolution, simulation.samples_per_revolution as u64);
        let sampling = per_revolution / simulation.samples_per_revolution;
        let range_to = |sample: u64| StepRange {
            revolution: (sample / samples) as usize,
            before: (sample % samples) as usize * sampling,
            steps: sampling,
            per_revolution,
        };
        let first = range_to(part.first_sample);
        let start = match first.before {
            0 => Instant::beginning(first.revolution),
            step => Instant::new(first.revolution, step, per_revolution),
        };
        self.take_up(start)?;
        for done in 0..part.samples {
            let range = range_to(part.first_sample + done);
            self.take(range, Observer::Recorder { windowed: false })?;
            self.look_up(watch, range, (done + 1) as f64 / part.samples as f64)?;
            self.record(range.end(), false)?;
            self.recorder.largest(&self.fourier, largest);
        }
        Ok(())
    }
}
