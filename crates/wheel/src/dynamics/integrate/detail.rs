//! Histories beyond displacements, of chosen revolutions.

use super::super::energy::EnergyAudit;
use super::revolutions::Repeated;
use super::simulation::{Detail, Simulation};
use super::tally::ContactInterval;

/// Histories recorded of chosen revolutions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DetailHistory {
    /// Velocities `[sensor][sample]`: (u⁺ − u⁻)/2h of the steps beside the sample; at the end of the run, which no step follows,
    /// (3u − 4u⁻ + u⁻⁻)/2h.
    pub velocity: Vec<Vec<f64>>,
    /// Forces `[sector · contact nodes + contact node][sample]`, mean over the interval that the sample ends.
    pub force: Vec<Vec<f64>>,
    /// Number of nodes in contact at each sample, mean over the interval.
    pub nodes_in_contact: Vec<f64>,
    /// Length of the contact lines that touches at each sample, mean over the interval.
    pub contact_length: Vec<f64>,
    /// Energy audit so far at each sample.
    pub energy: Vec<EnergyAudit>,
}

/// Recorder of a [`DetailHistory`].
#[derive(Debug)]
pub(super) struct DetailRecorder {
    detail: Detail,
    /// Whole revolutions after which recording begins and ends.
    revolutions: (usize, usize),
    steps_per_revolution: usize,
    sampling: usize,
    step_s: f64,
    /// Displacements of the sensors at the last three steps, the latest first.
    last: [Vec<f64>; 3],
    interval: ContactInterval,
    history: DetailHistory,
}

impl DetailRecorder {
    /// Recorder whose `interval` the tally of the run fills; of no pairs where nothing can be touched.
    pub(super) fn new(simulation: &Simulation<'_>, detail: Detail, interval: ContactInterval) -> Self {
        let revolutions = detail.revolutions.of(simulation.revolutions, None);
        let samples = simulation.samples_per_revolution * (revolutions.1 - revolutions.0);
        let line = |wanted: bool| Vec::with_capacity(if wanted { samples } else { 0 });
        let sensors = simulation.sensors.len();
        let lines =
            |count: usize, wanted: bool| (0..if wanted { count } else { 0 }).map(|_| line(true)).collect();
        Self {
            history: DetailHistory {
                velocity: lines(sensors, detail.velocity),
                force: lines(interval.force.len(), detail.forces),
                nodes_in_contact: line(detail.contact),
                contact_length: line(detail.contact),
                energy: Vec::with_capacity(if detail.energy { samples } else { 0 }),
            },
            detail,
            revolutions,
            steps_per_revolution: simulation.steps_per_revolution,
            sampling: simulation.steps_per_revolution / simulation.samples_per_revolution,
            step_s: simulation.step_s(),
            last: std::array::from_fn(|_| vec![0.0; sensors]),
            interval,
        }
    }

    /// Takes note that the run ends because its motion repeats.
    pub(super) fn end_after(&mut self, repeated: Repeated) {
        self.revolutions = self.detail.revolutions.of(0, Some(repeated));
    }

    /// Whether a sample at the end of this step, counted from the start, is recorded.
    fn holds(&self, step: u64) -> bool {
        let end = |revolutions: usize| (revolutions * self.steps_per_revolution) as u64;
        let (from, to) = self.revolutions;
        end(from) < step && step <= end(to) && step.is_multiple_of(self.sampling as u64)
    }

    /// Whether the displacements of the sensors after this step are needed, because a sample is beside it.
    pub(super) fn reads(&self, step: u64) -> bool {
        self.detail.velocity
            && (self.holds(step)
                || self.holds(step + 1)
                || (step > 0 && self.holds(step - 1))
                || self.closes(step))
    }

    /// Whether the last sample is two steps after this one.
    fn closes(&self, step: u64) -> bool {
        let end = (self.revolutions.1 * self.steps_per_revolution) as u64;
        step + 2 == end
    }

    /// Reads the displacements of the sensors after `step`; called for every needed step in turn.
    #[inline(always)]
    pub(super) fn read(&mut self, step: u64, displacement: impl Fn(usize) -> f64) {
        self.last.rotate_right(1);
        for (sensor, place) in self.last[0].iter_mut().enumerate() {
            *place = displacement(sensor);
        }
        if step > 1 && self.holds(step - 1) {
            let [after, _, before] = &self.last;
            for (line, (after, before)) in self.history.velocity.iter_mut().zip(after.iter().zip(before)) {
                line.push((after - before) / (2.0 * self.step_s));
            }
        }
    }

    /// Interval of contact to fill between this sample and the last one, where it is asked for.
    #[inline(always)]
    pub(super) fn interval(&mut self, step: u64) -> Option<&mut ContactInterval> {
        let wanted = self.detail.contact || self.detail.forces;
        (wanted && self.holds(step)).then_some(&mut self.interval)
    }

    /// Ends a sample, once its contact is known.
    #[inline(always)]
    pub(super) fn sample(&mut self, step: u64, energy: &EnergyAudit) {
        if !self.holds(step) {
            return;
        }
        let history = &mut self.history;
        // Without lines nothing is kept of them.
        for (line, force) in history.force.iter_mut().zip(&self.interval.force) {
            line.push(*force);
        }
        if self.detail.contact {
            history.nodes_in_contact.push(self.interval.nodes);
            history.contact_length.push(self.interval.length);
        }
        if self.detail.energy {
            history.energy.push(*energy);
        }
    }

    /// Ends the run after `steps` steps.
    pub(super) fn end(mut self, steps: u64) -> DetailHistory {
        if self.detail.velocity && self.holds(steps) {
            let [now, before, earlier] = &self.last;
            for (sensor, line) in self.history.velocity.iter_mut().enumerate() {
                let difference = 3.0 * now[sensor] - 4.0 * before[sensor] + earlier[sensor];
                line.push(difference / (2.0 * self.step_s));
            }
        }
        self.history
    }
}
