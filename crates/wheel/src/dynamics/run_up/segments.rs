//! Cutting of a run-up into segments of one speed.

use std::f64::consts::TAU;

use super::profile::SpeedProfile;

/// Part of a run-up that is stepped at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// First sample of the segment, counted from the start of the run.
    pub first_sample: u64,
    /// Number of samples of the segment.
    pub samples: u64,
    /// Times at which the segment begins and ends, s.
    pub times_s: [f64; 2],
    /// Mean speed of the segment, rad/s.
    pub speed_rad_s: f64,
    /// Largest error of angles within the segment, rad.
    pub off_rad: f64,
    /// Index of the band of speeds that the segment lies in, from the lowest on.
    pub band: u32,
}

/// Settings by which a run-up is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cutting {
    /// Number of samples of a revolution, at which segments may begin and end.
    pub samples_per_revolution: usize,
    /// Largest error of angles, rad.
    pub tolerance_rad: f64,
    /// Number of revolutions of a frame, by which the run is reported: no segment has part of two.
    pub frame_revolutions: u64,
    /// Ratio of the lowest speed of every band to that of the band below: choices that hold for all speeds of a range are made once for each band.
    pub band_ratio: f64,
    /// Largest number of segments.
    pub most_segments: usize,
}

/// Reason why a run cannot be cut.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Uncut {
    /// Speed that changes so fast that angles are off by more than the tolerance from one sample to the next.
    #[error(
        "at {speed_rad_s:.1} rad/s the speed changes by {rate_rad_s2:.3e} rad/s², and angles would be off by {off_rad:.1e} rad within a sample"
    )]
    TooFast {
        /// Speed there, rad/s.
        speed_rad_s: f64,
        /// Rate of the speed there, rad/s².
        rate_rad_s2: f64,
        /// Error of the angle within a sample, rad.
        off_rad: f64,
    },
    /// Tolerance that takes too many segments.
    #[error("angles are kept to {tolerance_rad:.1e} rad only by more than {most} pieces of one speed")]
    TooMany {
        /// Tolerance of angles, rad.
        tolerance_rad: f64,
        /// Largest number of segments.
        most: usize,
    },
}

impl Cutting {
    /// Number of samples of `profile`, all that it reaches.
    pub fn samples(&self, profile: &SpeedProfile) -> u64 {
        // What round-off takes from the last one is no sample.
        (profile.revolutions() * self.samples_per_revolution as f64 * (1.0 + 1e-12)) as u64
    }

    /// Cuts `profile` up to its last sample: no segment has part of one revolution and part of another, nor revolutions of two bands.
    ///
    /// # Errors
    /// [`Uncut`] where the tolerance cannot be kept.
    pub fn segments(&self, profile: &SpeedProfile) -> Result<Vec<Segment>, Uncut> {
        let (lowest, _) = profile.range_rad_s();
        let (all, per_revolution) = (self.samples(profile), self.samples_per_revolution as u64);
        let mut segments: Vec<Segment> = Vec::new();
        for revolution in 0..all.div_ceil(per_revolution) {
            let samples = per_revolution.min(all - revolution * per_revolution);
            let whole = self.segment(profile, revolution, 0, (0, samples));
            let [from, to] = whole.times_s;
            let slowest = profile.lowest_rad_s(from, to);
            let band = ((slowest / lowest).ln() / self.band_ratio.ln() + 1e-9).max(0.0) as u32;
            let whole = Segment { band, ..whole };
            let parts = (whole.off_rad / self.tolerance_rad).sqrt().ceil().max(1.0) as u64;
            if parts == 1 {
                match segments.last_mut().and_then(|last| self.joined(profile, last, &whole)) {
                    Some((last, joined)) => *last = joined,
                    None => {
                        self.check(segments.len() + 1)?;
                        segments.push(whole);
                    }
                }
                continue;
            }
            let parts = parts.min(samples);
            self.check(segments.len() + parts as usize)?;
            for part in 0..parts {
                let ends = (part * samples / parts, (part + 1) * samples / parts);
                let segment = self.segment(profile, revolution, band, ends);
                // Parts differ by a sample, and the rate within a revolution.
                if segment.off_rad > 4.0 * self.tolerance_rad {
                    let [from, to] = segment.times_s;
                    let (speed_rad_s, off_rad) = (segment.speed_rad_s, segment.off_rad);
                    let rate_rad_s2 = profile.largest_rate(from, to);
                    return Err(Uncut::TooFast { speed_rad_s, rate_rad_s2, off_rad });
                }
                segments.push(segment);
            }
        }
        Ok(segments)
    }

    fn check(&self, segments: usize) -> Result<(), Uncut> {
        let (tolerance_rad, most) = (self.tolerance_rad, self.most_segments);
        if segments <= most { Ok(()) } else { Err(Uncut::TooMany { tolerance_rad, most }) }
    }

    /// Builds a segment between two samples of a revolution.
    fn segment(&self, profile: &SpeedProfile, revolution: u64, band: u32, (from, to): (u64, u64)) -> Segment {
        let per_revolution = self.samples_per_revolution as u64;
        let first_sample = revolution * per_revolution + from;
        self.between(profile, first_sample, to - from, band)
    }

    fn between(&self, profile: &SpeedProfile, first_sample: u64, samples: u64, band: u32) -> Segment {
        let revolutions = |sample: u64| sample as f64 / self.samples_per_revolution as f64;
        let [from, to] =
            [first_sample, first_sample + samples].map(|sample| profile.time_at(revolutions(sample)));
        let lasts = to - from;
        let rate = profile.largest_rate(from, to);
        Segment {
            first_sample,
            samples,
            times_s: [from, to],
            // A speed that is held is the same to the last digit in all of its segments.
            speed_rad_s: if rate == 0.0 {
                profile.speed_rad_s(from)
            } else {
                TAU * revolutions(samples) / lasts
            },
            off_rad: rate * lasts * lasts / 8.0,
            band,
        }
    }

    /// Joins the last segment with another revolution, if the result may be one segment.
    fn joined<'a>(
        &self,
        profile: &SpeedProfile,
        last: &'a mut Segment,
        whole: &Segment,
    ) -> Option<(&'a mut Segment, Segment)> {
        let per_revolution = self.samples_per_revolution as u64;
        let frame = |sample: u64| sample / (per_revolution * self.frame_revolutions);
        let is_whole = last.samples.is_multiple_of(per_revolution);
        if !is_whole || last.band != whole.band || frame(last.first_sample) != frame(whole.first_sample) {
            return None;
        }
        let joined = self.between(profile, last.first_sample, last.samples + whole.samples, last.band);
        (joined.off_rad <= self.tolerance_rad).then_some((last, joined))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cutting(tolerance_rad: f64) -> Cutting {
        Cutting {
            samples_per_revolution: 120,
            tolerance_rad,
            frame_revolutions: 8,
            band_ratio: 1.5,
            most_segments: 20_000,
        }
    }

    /// Segments hold all samples, one after the other; angles of equal steps are compared with the profile's own.
    #[test]
    fn segments_follow_each_other_and_keep_their_tolerance() {
        let profile = SpeedProfile::smooth(&[(0.0, 60.0), (0.4, 60.0), (0.9, 400.0), (1.4, 90.0)]);
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let segments = cutting(tolerance).segments(&profile).unwrap();
            let mut next = 0;
            for segment in &segments {
                assert_eq!(segment.first_sample, next);
                next += segment.samples;
                assert!(segment.samples <= 8 * 120, "{segment:?}");
                let [from, to] = segment.times_s;
                for share in [0.1, 0.3, 0.5, 0.8] {
                    let sample = segment.first_sample as f64 + share * segment.samples as f64;
                    let time = from + share * (to - from);
                    let off = TAU * (sample / 120.0 - turned(&profile, time));
                    assert!(off.abs() <= segment.off_rad + 1e-9, "{off} {segment:?}");
                    assert!(segment.off_rad <= 4.0 * tolerance);
                }
                let slowest = profile.speed_rad_s(from).min(profile.speed_rad_s(to));
                assert!(slowest >= 60.0 * 1.5f64.powf(f64::from(segment.band)) * (1.0 - 1e-6));
            }
            assert_eq!(next, (120.0 * profile.revolutions()) as u64);
        }
    }

    /// Revolutions turned until an instant, by halving.
    fn turned(profile: &SpeedProfile, time: f64) -> f64 {
        let (mut low, mut high) = (0.0, profile.revolutions() + 1.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if profile.time_at(middle) < time { low = middle } else { high = middle }
        }
        low
    }

    #[test]
    fn a_constant_speed_is_cut_where_frames_end() {
        let profile = SpeedProfile::linear(&[(0.0, TAU * 10.0), (2.0, TAU * 10.0)]);
        let segments = cutting(1e-3).segments(&profile).unwrap();
        assert_eq!(segments.iter().map(|segment| segment.samples / 120).collect::<Vec<_>>(), [8, 8, 4]);
        assert!(segments.iter().all(|segment| (segment.off_rad, segment.speed_rad_s) == (0.0, TAU * 10.0)));
    }

    /// Band of a segment is that of the slowest moment, also within a revolution.
    #[test]
    fn a_dip_within_a_revolution_is_of_the_lower_band() {
        let profile = SpeedProfile::linear(&[(0.0, 100.0), (0.02, 60.0), (0.04, 100.0), (0.2, 100.0)]);
        let segments = cutting(1e-1).segments(&profile).unwrap();
        assert_eq!((segments[0].band, segments.last().unwrap().band), (0, 1));
    }

    #[test]
    fn segments_have_an_end() {
        let profile = SpeedProfile::linear(&[(0.0, 100.0), (60.0, 2000.0)]);
        let refused = Cutting { most_segments: 50, ..cutting(1e-4) }.segments(&profile).unwrap_err();
        assert_eq!(refused, Uncut::TooMany { tolerance_rad: 1e-4, most: 50 });
    }

    #[test]
    fn what_changes_within_a_sample_is_too_fast() {
        let profile = SpeedProfile::linear(&[(0.0, 10.0), (1.0, 1e4)]);
        let refused = cutting(1e-6).segments(&profile).unwrap_err();
        assert!(refused.to_string().contains("9.990e3 rad/s²"), "{refused}");
    }
}
