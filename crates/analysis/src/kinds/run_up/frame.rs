//! Frames of a run: some revolutions each, with their results.

use std::f64::consts::TAU;

use crate::result::{LargestOfRun, RunUpFrame};
use rubmap_numerics::spectrum::amplitudes;
use rubmap_wheel::dynamics::integrate::Stretch;
use rubmap_wheel::dynamics::run_up::profile::SpeedProfile;
use rubmap_wheel::dynamics::run_up::segments::Segment;

/// Most lines of an order, and most revolutions of a spectrum.
const LINES: u64 = 8;

/// Frame while it is simulated.
pub(super) struct Frame {
    /// Revolutions before the frame.
    revolution: u64,
    start_s: f64,
    end_s: f64,
    /// Displacement, `[sensor][sample]`.
    displacement: Vec<Vec<f64>>,
    largest: Vec<LargestOfRun>,
    steps: u64,
    contact_steps: u64,
}

impl Frame {
    /// Frame of `sensors` before its first segment, which is `segment`.
    pub(super) fn begin(segment: &Segment, samples_per_revolution: usize, sensors: usize) -> Self {
        let nothing =
            LargestOfRun { displacement: 0.0, time_s: segment.times_s[0], speed_rad_s: segment.speed_rad_s };
        Self {
            revolution: segment.first_sample / samples_per_revolution as u64,
            start_s: segment.times_s[0],
            end_s: segment.times_s[0],
            displacement: vec![Vec::new(); sensors],
            largest: vec![nothing; sensors],
            steps: 0,
            contact_steps: 0,
        }
    }

    /// Adds a segment that was simulated.
    pub(super) fn add(&mut self, segment: &Segment, stretch: &Stretch, profile: &SpeedProfile) {
        let [from, to] = segment.times_s;
        for (line, found) in self.displacement.iter_mut().zip(&stretch.displacement) {
            line.extend_from_slice(found);
        }
        for (largest, line) in self.largest.iter_mut().zip(&stretch.largest) {
            for (sample, &displacement) in line.iter().enumerate() {
                if displacement > largest.displacement && displacement.is_finite() {
                    let time_s = from + (to - from) * (sample + 1) as f64 / segment.samples as f64;
                    *largest =
                        LargestOfRun { displacement, time_s, speed_rad_s: profile.speed_rad_s(time_s) };
                }
            }
        }
        self.end_s = to;
        self.steps += stretch.statistics.steps;
        self.contact_steps += stretch.statistics.contact_steps;
    }

    /// Largest displacements in the frame.
    pub(super) fn into_largest(self) -> Vec<LargestOfRun> {
        self.largest
    }

    /// Result of a frame in which the run ends early; none where it ends at the beginning of the frame.
    pub(super) fn cut_short(self, profile: &SpeedProfile, told: (usize, u64)) -> Option<RunUpFrame> {
        (self.end_s > self.start_s).then(|| RunUpFrame { spectra: Vec::new(), ..self.told(profile, told, 0) })
    }

    /// Result of a frame, with spectra up to `max_engine_order` if it has all `frame_revolutions`.
    pub(super) fn told(
        self,
        profile: &SpeedProfile,
        (samples_per_revolution, frame_revolutions): (usize, u64),
        max_engine_order: u32,
    ) -> RunUpFrame {
        let whole = samples_per_revolution * frame_revolutions as usize;
        let spectrum = |line: &Vec<f64>| spectrum(line, frame_revolutions, max_engine_order);
        let complete = self.displacement.iter().all(|line| line.len() == whole);
        RunUpFrame {
            revolution: self.revolution,
            times_s: [self.start_s, self.end_s],
            speeds_rad_s: [self.start_s, self.end_s].map(|time| profile.speed_rad_s(time)),
            largest: self.largest.iter().map(|largest| largest.displacement).collect(),
            half_peak_to_peak: self.displacement.iter().map(|line| half_peak_to_peak(line)).collect(),
            contact_share: self.contact_steps as f64 / self.steps.max(1) as f64,
            spectra: if complete { self.displacement.iter().map(spectrum).collect() } else { Vec::new() },
        }
    }
}

fn half_peak_to_peak(line: &[f64]) -> f64 {
    let (low, high) =
        line.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &u| (low.min(u), high.max(u)));
    if low < high { 0.5 * (high - low) } else { 0.0 }
}

/// Order of the second line of a spectrum of a frame with this number of revolutions.
pub(super) fn order_step(frame_revolutions: u64) -> f64 {
    1.0 / frame_revolutions.min(LINES) as f64
}

/// Spectrum of equally spaced samples over the angle: amplitudes line by line over the order, of eight revolutions at a time under a Hann
/// window, of which the largest counts. A sinusoid of a whole number of periods reads its amplitude.
fn spectrum(samples: &[f64], revolutions: u64, max_engine_order: u32) -> Vec<f64> {
    let windows = (revolutions / LINES).max(1) as usize;
    let lines = max_engine_order as usize * revolutions.min(LINES) as usize + 1;
    let mut largest = vec![0.0f64; lines];
    for window in samples.chunks_exact(samples.len() / windows) {
        let count = window.len() as f64;
        // Half of a window's sum is lost with its flanks.
        let weighted: Vec<f64> =
            (window.iter().enumerate()).map(|(i, u)| u * (1.0 - (TAU * i as f64 / count).cos())).collect();
        let found = amplitudes(&weighted, lines.min(window.len() / 2 + 1));
        largest.iter_mut().zip(found).for_each(|(largest, found)| *largest = largest.max(found));
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sinusoid_reads_its_amplitude_at_its_order() {
        for revolutions in [1, 4, 8, 24] {
            let samples: Vec<f64> = (0..512 * revolutions)
                .map(|i| {
                    let angle = TAU * i as f64 / 512.0;
                    0.25 + 3.0 * (5.0 * angle + 0.3).cos() - 0.5 * (2.0 * angle).sin()
                })
                .collect();
            let found = spectrum(&samples, revolutions, 20);
            let lines = revolutions.min(8) as usize;
            assert_eq!(found.len(), 20 * lines + 1);
            assert!(
                (found[5 * lines] - 3.0).abs() < 1e-12 && (found[2 * lines] - 0.5).abs() < 0.76,
                "{found:?}"
            );
            assert!((order_step(revolutions) * (5 * lines) as f64 - 5.0).abs() < 1e-15);
            if revolutions > 1 {
                assert!((found[2 * lines] - 0.5).abs() < 1e-12 && (found[0] - 0.25).abs() < 1e-12);
                assert!(found[8 * lines..].iter().all(|rest| *rest < 1e-12));
            }
        }
    }
}
