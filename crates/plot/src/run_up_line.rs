//! Line of a run: amplitude of a sensor, frame by frame.

use super::axis::{label, significant};
use super::cells::rpm;
use super::run_up_words::{long_name, name};
use rubmap_analysis::result::{RunUp, RunUpFrame};

/// Frame of a run at one sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// Mean speed of the frame, rpm.
    pub(super) rpm: f64,
    /// Middle of the frame, s.
    pub(super) time_s: f64,
    pub(super) half_peak_to_peak: f64,
    /// Share of the frame's steps in which something touches.
    pub(super) contact_share: f64,
}

impl Step {
    fn of(frame: &RunUpFrame, sensor: usize) -> Option<Self> {
        let middle = |[from, to]: [f64; 2]| 0.5 * from + 0.5 * to;
        let half_peak_to_peak = *frame.half_peak_to_peak.get(sensor)?;
        let step = Self {
            rpm: rpm(middle(frame.speeds_rad_s)),
            time_s: middle(frame.times_s),
            half_peak_to_peak,
            contact_share: frame.contact_share,
        };
        [step.rpm, step.time_s, half_peak_to_peak].iter().all(|value| value.is_finite()).then_some(step)
    }

    /// Point of the line: speed in rpm, and half the peak-to-peak displacement.
    pub(super) fn over_speed(&self) -> (f64, f64) {
        (self.rpm, self.half_peak_to_peak)
    }

    pub(super) fn touches(&self) -> bool {
        self.contact_share > 0.0
    }

    /// Words for speed, time and amplitude.
    pub(super) fn words(&self, unit: &str) -> String {
        let Self { rpm, time_s, half_peak_to_peak, contact_share } = self;
        let touching = if self.touches() {
            format!(", something touches in {} % of the time", significant(100.0 * contact_share))
        } else {
            String::new()
        };
        let (rpm, time) = (label(*rpm, 0), significant(*time_s));
        format!("{rpm} rpm at {time} s: {} {unit}{touching}", significant(*half_peak_to_peak))
    }
}

/// Line of a run.
#[derive(Debug)]
pub(super) struct Line {
    pub(super) name: String,
    pub(super) title: String,
    pub(super) rate_rad_s2: Option<f64>,
    /// Rank of the run among all runs, the slowest first; it decides the colour.
    pub(super) rank: usize,
    /// Frames in the order of time; of many, the lowest and the highest of neighbours.
    pub(super) steps: Vec<Step>,
    /// Frame in which the sensor swings most, if it moves.
    pub(super) largest: Option<Step>,
}

impl Line {
    /// Builds the line of a run with about `most` steps.
    pub(super) fn of(run: &RunUp, sensor: usize, rank: usize, most: usize) -> Self {
        let all: Vec<Step> = run.frames.iter().filter_map(|frame| Step::of(frame, sensor)).collect();
        let moves = all.iter().copied().filter(|step| step.half_peak_to_peak > 0.0);
        let largest = moves.max_by(|a, b| a.half_peak_to_peak.total_cmp(&b.half_peak_to_peak));
        let (name, title) = (name(run), long_name(run));
        let steps = extremes(all, most);
        Self { name, title, rate_rad_s2: run.rate_rad_s2, rank, steps, largest }
    }

    /// Stretches of the line in which something touches.
    pub(super) fn touching(&self) -> impl Iterator<Item = &[Step]> {
        self.steps.chunk_by(|a, b| a.touches() == b.touches()).filter(|stretch| stretch[0].touches())
    }
}

/// Thins steps to about `most`: of each stretch of neighbours the lowest and the highest stay, in their order; both touch if one of the
/// stretch does.
fn extremes(steps: Vec<Step>, most: usize) -> Vec<Step> {
    let together = (2 * steps.len()).div_ceil(most.max(2));
    if together <= 2 {
        return steps;
    }
    let pair = |stretch: &[Step]| {
        let by_height =
            |a: &usize, b: &usize| stretch[*a].half_peak_to_peak.total_cmp(&stretch[*b].half_peak_to_peak);
        let low = (0..stretch.len()).min_by(by_height).unwrap_or(0);
        let high = (0..stretch.len()).max_by(by_height).unwrap_or(0);
        let contact_share = stretch.iter().map(|step| step.contact_share).fold(0.0, f64::max);
        [low.min(high), low.max(high)].map(|index| Step { contact_share, ..stretch[index] })
    };
    steps.chunks(together).flat_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_of_many_stays() {
        let step = |k: u32| Step {
            rpm: f64::from(k),
            time_s: f64::from(k),
            half_peak_to_peak: if k == 7_777 { 9.0 } else { (0.1 * f64::from(k)).sin().abs() },
            contact_share: if k == 501 { 0.25 } else { 0.0 },
        };
        let all: Vec<Step> = (0..10_000).map(step).collect();
        let left = extremes(all.clone(), 300);
        assert!((200..=302).contains(&left.len()), "{}", left.len());
        assert!(left.windows(2).all(|pair| pair[0].rpm <= pair[1].rpm));
        assert!(left.iter().any(|step| step.over_speed() == (7_777.0, 9.0)));
        assert_eq!(left.iter().filter(|step| step.touches()).count(), 2);
        assert_eq!(extremes(all[..300].to_vec(), 300).len(), 300);
    }
}
