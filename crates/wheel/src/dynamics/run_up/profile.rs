//! Speed profile Ω(t): piecewise cubic, without jumps.

use std::f64::consts::TAU;

use crate::dynamics::euler::{SpeedRate, StraightRate};

/// Speed over time, and the angle turned.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedProfile {
    pieces: Vec<Piece>,
}

/// Piece Ω = c₀ + c₁x + c₂x² + c₃x³ of a profile, x = t − t₀ up to T.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Start t₀, s.
    start_s: f64,
    /// Duration T, s.
    duration_s: f64,
    /// Angle θ at t₀, rad.
    angle_rad: f64,
    speed: [f64; 4],
}

impl Piece {
    fn speed(&self, x: f64) -> f64 {
        let [a, b, c, d] = self.speed;
        a + x * (b + x * (c + x * d))
    }

    fn rate(&self, x: f64) -> f64 {
        let [_, b, c, d] = self.speed;
        b + x * (2.0 * c + x * 3.0 * d)
    }

    /// Angle turned since the start of the piece.
    fn turned(&self, x: f64) -> f64 {
        let [a, b, c, d] = self.speed;
        x * (a + x * (b / 2.0 + x * (c / 3.0 + x * d / 4.0)))
    }

    /// Largest |Ω̇| between two instants of the piece.
    fn largest_rate(&self, from: f64, to: f64) -> f64 {
        let [_, _, c, d] = self.speed;
        let turning = (d != 0.0).then(|| -c / (3.0 * d)).filter(|x| (from..=to).contains(x));
        [Some(from), Some(to), turning]
            .into_iter()
            .flatten()
            .fold(0.0, |most, x| most.max(self.rate(x).abs()))
    }
}

impl SpeedProfile {
    /// Profile that is straight between points (time in s, ascending from 0; speed in rad/s, above 0), at least two of them.
    pub fn linear(points: &[(f64, f64)]) -> Self {
        let slopes: Vec<f64> = points.windows(2).map(slope).collect();
        Self::of(points, |i| [slopes[i]; 2])
    }

    /// Profile through `points`, as of [`Self::linear`], without a corner, and between two neighbours beyond neither: cubics with the
    /// slopes of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5 (1984) 300–304), level at both ends.
    pub fn smooth(points: &[(f64, f64)]) -> Self {
        let secants: Vec<f64> = points.windows(2).map(slope).collect();
        let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        let inner = |i: usize| {
            let (before, after) = (secants[i - 1], secants[i]);
            if before * after <= 0.0 {
                return 0.0;
            }
            let (w1, w2) = (2.0 * widths[i] + widths[i - 1], widths[i] + 2.0 * widths[i - 1]);
            (w1 + w2) / (w1 / before + w2 / after)
        };
        let at = |i: usize| if i == 0 || i == secants.len() { 0.0 } else { inner(i) };
        Self::of(points, |i| [at(i), at(i + 1)])
    }

    /// Profile of cubics between `points` with the slopes at both ends of each interval.
    fn of(points: &[(f64, f64)], slopes: impl Fn(usize) -> [f64; 2]) -> Self {
        let mut angle_rad = 0.0;
        let pieces = points.windows(2).enumerate().map(|(i, pair)| {
            let ([from, to], secant, duration_s) = (slopes(i), slope(pair), pair[1].0 - pair[0].0);
            let speed = [
                pair[0].1,
                from,
                (3.0 * secant - 2.0 * from - to) / duration_s,
                (from + to - 2.0 * secant) / (duration_s * duration_s),
            ];
            let piece = Piece { start_s: pair[0].0, duration_s, angle_rad, speed };
            angle_rad += piece.turned(duration_s);
            piece
        });
        Self { pieces: pieces.collect() }
    }

    /// Duration of the profile, s.
    pub fn duration_s(&self) -> f64 {
        let last = self.last();
        last.start_s + last.duration_s
    }

    /// Number of revolutions that the profile turns.
    pub fn revolutions(&self) -> f64 {
        let last = self.last();
        (last.angle_rad + last.turned(last.duration_s)) / TAU
    }

    /// Speed Ω at an instant, rad/s; beyond the end the value at the end.
    pub fn speed_rad_s(&self, time_s: f64) -> f64 {
        let piece = self.pieces[self.piece(time_s)];
        piece.speed((time_s - piece.start_s).clamp(0.0, piece.duration_s))
    }

    /// Rate Ω̇ at an instant, rad/s²; at a corner that behind it.
    pub fn rate_rad_s2(&self, time_s: f64) -> f64 {
        let piece = self.pieces[self.piece(time_s)];
        piece.rate((time_s - piece.start_s).clamp(0.0, piece.duration_s))
    }

    /// Rates Ω̇ between two instants, cut at the points between; a piece changes the speed by as much as the profile does.
    pub fn rates(&self, [from_s, to_s]: [f64; 2]) -> SpeedRate {
        let of = |piece: &Piece| {
            let ends = [from_s, to_s].map(|time| (time - piece.start_s).clamp(0.0, piece.duration_s));
            let lasts = ends[1] - ends[0];
            let mean = (piece.speed(ends[1]) - piece.speed(ends[0])) / lasts;
            let half = 0.5 * (piece.rate(ends[1]) - piece.rate(ends[0]));
            let revolutions = ends.map(|x| (piece.angle_rad + piece.turned(x)) / TAU);
            (lasts > 0.0).then_some(StraightRate { revolutions, rad_s2: [mean - half, mean + half] })
        };
        let (first, last) = (self.piece(from_s), self.piece(to_s));
        SpeedRate(self.pieces[first..=last].iter().filter_map(of).collect())
    }

    /// Lowest and highest speed Ω, rad/s: at the profile's points, as nothing lies beyond them.
    pub fn range_rad_s(&self) -> (f64, f64) {
        let ends = self.pieces.iter().flat_map(|piece| [piece.speed(0.0), piece.speed(piece.duration_s)]);
        ends.fold((f64::INFINITY, 0.0), |(low, high), speed| (low.min(speed), high.max(speed)))
    }

    /// Lowest speed Ω between two instants, rad/s: at one of them, or at a point between.
    pub fn lowest_rad_s(&self, from_s: f64, to_s: f64) -> f64 {
        let points =
            self.pieces.iter().map(|piece| piece.start_s).filter(|time| (from_s..=to_s).contains(time));
        points.chain([from_s, to_s]).map(|time| self.speed_rad_s(time)).fold(f64::INFINITY, f64::min)
    }

    /// Largest |Ω̇| between two instants, rad/s².
    pub fn largest_rate(&self, from_s: f64, to_s: f64) -> f64 {
        let (first, last) = (self.piece(from_s), self.piece(to_s));
        let of = |piece: &Piece| {
            let within = |time: f64| (time - piece.start_s).clamp(0.0, piece.duration_s);
            piece.largest_rate(within(from_s), within(to_s))
        };
        self.pieces[first..=last].iter().map(of).fold(0.0, f64::max)
    }

    /// Time, s, at which the profile has turned by `revolutions`.
    pub fn time_at(&self, revolutions: f64) -> f64 {
        let angle = TAU * revolutions;
        let next = self.pieces.partition_point(|piece| piece.angle_rad <= angle);
        let piece = self.pieces[next.saturating_sub(1)];
        let wanted = angle - piece.angle_rad;
        let (mut low, mut high) = (0.0, piece.duration_s);
        let mut x = (wanted / piece.speed(0.0)).clamp(low, high);
        // Newton's method, halving where it would leave what is known: the angle grows throughout.
        for _ in 0..100 {
            let off = piece.turned(x) - wanted;
            if off > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let next = x - off / piece.speed(x);
            let next = if (low..=high).contains(&next) { next } else { 0.5 * (low + high) };
            if (next - x).abs() <= f64::EPSILON * piece.duration_s {
                x = next;
                break;
            }
            x = next;
        }
        piece.start_s + x
    }

    fn last(&self) -> Piece {
        self.pieces[self.pieces.len() - 1]
    }

    /// Index of the piece that holds an instant.
    fn piece(&self, time_s: f64) -> usize {
        self.pieces.partition_point(|piece| piece.start_s <= time_s).saturating_sub(1)
    }
}

fn slope(pair: &[(f64, f64)]) -> f64 {
    (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [(f64, f64); 5] = [(0.0, 300.0), (0.5, 300.0), (2.0, 1200.0), (2.5, 1000.0), (4.0, 100.0)];

    /// Constant rate: Ω = Ω₀ + at, θ = Ω₀t + at²/2.
    #[test]
    fn a_constant_rate_turns_as_the_textbook_says() {
        let profile = SpeedProfile::linear(&[(0.0, 200.0), (3.0, 500.0)]);
        assert_eq!((profile.duration_s(), profile.range_rad_s()), (3.0, (200.0, 500.0)));
        assert!((profile.revolutions() - 1050.0 / TAU).abs() < 1e-11);
        for revolutions in [0.0, 1.0, 17.25, 100.0, 167.0] {
            let angle: f64 = TAU * revolutions;
            let expected = (-200.0 + (200.0f64 * 200.0 + 2.0 * 100.0 * angle).sqrt()) / 100.0;
            assert!((profile.time_at(revolutions) - expected).abs() < 1e-14 * 3.0);
            assert!((profile.speed_rad_s(expected) - (200.0 + 100.0 * expected)).abs() < 1e-11);
        }
        assert_eq!(profile.largest_rate(0.3, 0.9), 100.0);
    }

    /// Speed as the integral of its rates, which jump where a straight profile has a corner and nowhere else.
    #[test]
    fn rates_change_the_speed_by_as_much() {
        for profile in [SpeedProfile::smooth(&POINTS), SpeedProfile::linear(&POINTS)] {
            for [from, to] in [[0.1, 0.2], [0.45, 0.55], [0.5, 1.0], [1.5, 2.0], [0.0, 4.0]] {
                let SpeedRate(pieces) = profile.rates([from, to]);
                let lasts = |piece: &StraightRate| {
                    profile.time_at(piece.revolutions[1]) - profile.time_at(piece.revolutions[0])
                };
                let change: f64 = pieces.iter().map(|p| 0.5 * (p.rad_s2[0] + p.rad_s2[1]) * lasts(p)).sum();
                let expected = profile.speed_rad_s(to) - profile.speed_rad_s(from);
                assert!((change - expected).abs() < 1e-7, "{from}: {change} {expected}");
                assert!((pieces.iter().map(lasts).sum::<f64>() - (to - from)).abs() < 1e-9, "{from}");
            }
        }
        let linear = SpeedProfile::linear(&POINTS).rates([0.4, 0.6]);
        // 300 rad/s for half a second.
        let corner = 150.0 / TAU;
        let found = [-1e-9, 1e-9].map(|beside| linear.at(corner + beside));
        assert!(found[0] == 0.0 && (found[1] - 600.0).abs() < 1e-9, "{found:?}");
        let smooth = SpeedProfile::smooth(&POINTS);
        let near = smooth.rates([1.0, 1.001]);
        for time in [1.0, 1.0005, 1.001] {
            let StraightRate { revolutions: [from, to], .. } = near.0[0];
            let at = from + (time - 1.0) / 1e-3 * (to - from);
            assert!((near.at(at) - smooth.rate_rad_s2(time)).abs() < 1e-2, "{time}");
        }
    }

    /// Angle against the integral of the speed by a fine sum; speeds go through the points, and not beyond two neighbours.
    #[test]
    fn angles_are_the_integral_of_the_speed() {
        for profile in [SpeedProfile::linear(&POINTS), SpeedProfile::smooth(&POINTS)] {
            for (time, speed) in POINTS {
                assert!((profile.speed_rad_s(time) - speed).abs() < 1e-10, "{time}");
            }
            let (steps, mut angle) = (400_000, 0.0);
            let h = profile.duration_s() / f64::from(steps);
            for step in 0..steps {
                let at = f64::from(step) * h;
                let middle = profile.speed_rad_s(at + 0.5 * h);
                let pair =
                    POINTS.windows(2).find(|pair| (pair[0].0..=pair[1].0).contains(&(at + 0.5 * h))).unwrap();
                assert!(
                    middle >= pair[0].1.min(pair[1].1) - 1e-9 && middle <= pair[0].1.max(pair[1].1) + 1e-9
                );
                angle += h * middle;
                if step % 9973 == 0 {
                    let found = profile.time_at(angle / TAU);
                    assert!((found - (at + h)).abs() < 1e-8, "{found} {}", at + h);
                }
            }
            assert!((profile.revolutions() - angle / TAU).abs() < 1e-6);
        }
    }

    #[test]
    fn a_smooth_profile_has_no_corner() {
        let (smooth, linear) = (SpeedProfile::smooth(&POINTS), SpeedProfile::linear(&POINTS));
        let jump = |profile: &SpeedProfile, time: f64| {
            (profile.rate_rad_s2(time + 1e-9) - profile.rate_rad_s2(time - 1e-9)).abs()
        };
        for (time, _) in &POINTS[1..4] {
            assert!(jump(&smooth, *time) < 1e-3 && jump(&linear, *time) > 100.0, "{time}");
        }
        let steepest = (0..4000).map(|i| smooth.rate_rad_s2(f64::from(i) * 1e-3).abs()).fold(0.0, f64::max);
        let told = smooth.largest_rate(0.0, 4.0);
        assert!(told >= steepest && told < 1.001 * steepest, "{told} {steepest}");
    }
}
