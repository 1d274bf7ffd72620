//! Counts of contact, per contact node and blade.

use super::super::casing::arc_lengths;
use super::super::contact::flexibility::outward_normals;
use super::super::excitation::steady_amplitudes;
use super::super::sector::ContactNode;
use super::simulation::Simulation;

/// Contact of one node of one blade over the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairContact {
    /// Largest force, mean over the interval between two samples.
    pub peak_force: f64,
    /// Impulse ∫λ dt, force·time.
    pub impulse: f64,
    /// Number of steps with a force.
    pub steps: u64,
    /// Number of times that the gap closed.
    pub closings: u64,
    /// Largest outward displacement along the normal at a sample, length.
    pub outward: f64,
}

/// Contact over the window of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactRecord {
    /// Number of contact nodes of a sector.
    pub nodes: usize,
    /// Contact of every pair, `[sector][contact node]`, one after the other.
    pub pairs: Vec<PairContact>,
    /// Largest sum of all forces, mean over the interval between two samples.
    pub peak_force: f64,
    /// Amplitude along the normal of the steady response to the forces at engine orders, were there no contact, `[contact node]`; empty
    /// without such forces.
    pub linear: Vec<f64>,
}

/// Contact between two samples.
#[derive(Debug, Default)]
pub(super) struct ContactInterval {
    /// Mean forces, `[sector·nodes + node]`.
    pub(super) force: Vec<f64>,
    /// Mean number of nodes that touch.
    pub(super) nodes: f64,
    /// Mean length of the contact lines that touches.
    pub(super) length: f64,
}

/// Counter of contact, step by step.
#[derive(Debug)]
pub(super) struct ContactTally {
    record: ContactRecord,
    /// Contact of every pair since the last sample.
    pairs: Vec<Recent>,
    touched: Vec<usize>,
    /// Forces λ of all pairs, summed over the steps since the last sample.
    force: f64,
    interval: f64,
    step_s: f64,
    /// Length of the contact line that each node stands for.
    lengths: Vec<f64>,
    /// Whether the window has begun.
    windowed: bool,
}

/// Contact of a pair since the last sample.
#[derive(Debug, Clone, Copy)]
struct Recent {
    /// Force λ, summed over the steps.
    force: f64,
    steps: u32,
    /// Last step with a force.
    last: u64,
}

impl ContactTally {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        let nodes = simulation.contact_nodes.len();
        let pairs = nodes * simulation.wheel.sectors;
        let none =
            PairContact { peak_force: 0.0, impulse: 0.0, steps: 0, closings: 0, outward: f64::NEG_INFINITY };
        Self {
            record: ContactRecord {
                nodes,
                pairs: vec![none; pairs],
                peak_force: 0.0,
                linear: linear(simulation),
            },
            pairs: vec![Recent { force: 0.0, steps: 0, last: u64::MAX }; pairs],
            touched: Vec::with_capacity(pairs),
            force: 0.0,
            interval: (simulation.steps_per_revolution / simulation.samples_per_revolution) as f64,
            step_s: simulation.step_s(),
            lengths: tributary_lengths(simulation.contact_nodes),
            windowed: false,
        }
    }

    /// Begins the window: contact counts from now on.
    pub(super) fn begin_window(&mut self) {
        self.windowed = true;
    }

    /// Counts the force `lambda` on a node of a blade in step `step`, counted from 1.
    #[inline(always)]
    pub(super) fn press(&mut self, sector: usize, node: usize, lambda: f64, step: u64) {
        let index = sector * self.record.nodes + node;
        let recent = &mut self.pairs[index];
        if recent.steps == 0 {
            self.touched.push(index);
        }
        let closing = recent.last.wrapping_add(1) != step;
        recent.force += lambda;
        recent.steps += 1;
        recent.last = step;
        self.force += lambda;
        if self.windowed {
            let pair = &mut self.record.pairs[index];
            pair.impulse += lambda * self.step_s;
            pair.steps += 1;
            pair.closings += u64::from(closing);
        }
    }

    /// Ends an interval; `outward` is the normal displacement of a pair, `seen` receives the contact of the interval, if it is asked for.
    #[inline(always)]
    pub(super) fn sample(
        &mut self,
        outward: impl Fn(usize, usize) -> f64,
        mut seen: Option<&mut ContactInterval>,
    ) {
        if let Some(seen) = &mut seen {
            seen.force.fill(0.0);
            (seen.nodes, seen.length) = (0.0, 0.0);
        }
        for &index in &self.touched {
            let recent = &mut self.pairs[index];
            let force = recent.force / self.interval;
            let pair = &mut self.record.pairs[index];
            if self.windowed && force > pair.peak_force {
                pair.peak_force = force;
            }
            if let Some(seen) = &mut seen {
                let share = f64::from(recent.steps) / self.interval;
                seen.force[index] = force;
                seen.nodes += share;
                seen.length += share * self.lengths[index % self.record.nodes];
            }
            (recent.force, recent.steps) = (0.0, 0);
        }
        self.touched.clear();
        let force = std::mem::take(&mut self.force) / self.interval;
        if self.windowed {
            self.record.peak_force = self.record.peak_force.max(force);
            let blades = self.record.pairs.chunks_exact_mut(self.record.nodes);
            for (sector, blade) in blades.enumerate() {
                for (node, pair) in blade.iter_mut().enumerate() {
                    pair.outward = pair.outward.max(outward(sector, node));
                }
            }
        }
    }

    /// Interval of all pairs, without contact.
    pub(super) fn interval(&self) -> ContactInterval {
        ContactInterval { force: vec![0.0; self.pairs.len()], ..ContactInterval::default() }
    }

    pub(super) fn record(&self) -> &ContactRecord {
        &self.record
    }
}

/// Amplitudes of [`ContactRecord::linear`].
fn linear(simulation: &Simulation<'_>) -> Vec<f64> {
    let Simulation { wheel, effects, damping, contact_nodes, .. } = *simulation;
    match effects.excitation {
        [] => Vec::new(),
        forces => steady_amplitudes(wheel, forces, damping, &outward_normals(contact_nodes)),
    }
}

/// Lengths from half-way to half-way between neighbours along the contact line.
fn tributary_lengths(nodes: &[ContactNode]) -> Vec<f64> {
    let positions: Vec<_> = nodes.iter().map(|node| node.position).collect();
    let arc = arc_lengths(&positions);
    let mut lengths = vec![0.0; nodes.len()];
    for (first, pair) in arc.windows(2).enumerate() {
        let half = 0.5 * (pair[1] - pair[0]);
        lengths[first] += half;
        lengths[first + 1] += half;
    }
    lengths
}
