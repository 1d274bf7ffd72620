//! Critical speeds: peaks of the steady response over Ω, and whether the computed speeds resolve them (docs/method.md, Reading
//! responses).

/// Share of a peak that the response at the neighbouring speeds must reach for the peak to be resolved. Evenly sampled, a linear resonance
/// 1/√(1 + x²) is then seen at |x| < 0.18 half-bandwidths and within 1.5 % of its top.
pub const RESOLVED_SHARE: f64 = 0.9;

/// Distance between speeds, relative to the peak's, at which they resolve it whatever the response does between them. At the fold of a
/// backbone curve the response of a wheel that touches its casing jumps: no grid makes the neighbour higher there.
pub const SHARPNESS: f64 = 5e-4;

/// Largest ratio of the two intervals beside a resolved peak. In a wide one beside a narrow one a higher peak could hide whose flanks are
/// what was sampled; up to this ratio a linear resonance is within 7 % of its top.
const WIDEST_RATIO: f64 = 3.0;

/// Least distance, relative to its speed, between a maximum of solved responses and the speeds beside it: exact responses have an exact maximum.
pub const ON_BRANCH: f64 = 1e-5;

/// Local maximum of a sampled curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Index of the sample.
    pub index: usize,
    /// Value at the sample.
    pub height: f64,
    /// Height above the higher of the two valleys that separate it from higher ground (or from the ends).
    pub prominence: f64,
    /// Whether the peak is the end of a stretch, so that the curve may rise further beyond.
    pub at_edge: bool,
}

/// Peaks of `curve` whose prominence is at least `share` of the curve's largest value, in order. A missing value
/// separates what lies left and right of it. The middle sample stands for a flat top; an end of a stretch can be a peak,
/// since the response may be highest at the edge of the range.
pub fn peaks(curve: &[Option<f64>], share: f64) -> Vec<Peak> {
    let largest = curve.iter().flatten().fold(0.0f64, |m, &v| m.max(v));
    let mut found = Vec::new();
    let mut start = 0;
    for stretch in curve.split(Option::is_none) {
        let values: Vec<f64> = stretch.iter().flatten().copied().collect();
        found.extend(peaks_of_stretch(&values).into_iter().map(|p| Peak { index: p.index + start, ..p }));
        start += stretch.len() + 1;
    }
    found.retain(|peak| peak.prominence > 0.0 && peak.prominence >= share * largest);
    found
}

fn peaks_of_stretch(values: &[f64]) -> Vec<Peak> {
    let mut found = Vec::new();
    let mut left = 0;
    while left < values.len() {
        let mut right = left;
        while right + 1 < values.len() && values[right + 1] == values[left] {
            right += 1;
        }
        let height = values[left];
        let rises = left == 0 || values[left - 1] < height;
        let falls = right + 1 == values.len() || values[right + 1] < height;
        if rises && falls && values.len() > 1 {
            found.push(Peak {
                index: (left + right) / 2,
                height,
                prominence: prominence(values, left, right),
                at_edge: left == 0 || right + 1 == values.len(),
            });
        }
        left = right + 1;
    }
    found
}

/// Topographic prominence of the flat top `left..=right`.
fn prominence(values: &[f64], left: usize, right: usize) -> f64 {
    let height = values[left];
    let valley = |side: &mut dyn Iterator<Item = &f64>| {
        let mut lowest = height;
        for &value in side {
            if value > height {
                break;
            }
            lowest = lowest.min(value);
        }
        lowest
    };
    let before = valley(&mut values[..left].iter().rev());
    let after = valley(&mut values[right + 1..].iter());
    // At an end of the range only the inner valley is known.
    let base = match (left == 0, right + 1 == values.len()) {
        (true, _) => after,
        (_, true) => before,
        _ => before.max(after),
    };
    height - base
}

/// Accuracy with which a sampled curve determines one of its peaks.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolution {
    /// Distance from the peak's sample to the farther one of its two neighbours: the true peak is no farther away. A
    /// neighbour without a value, or none at all, bounds nothing; then the other one's distance.
    pub error: f64,
    /// Whether the samples resolve the peak; never if one of the neighbours has no value.
    pub resolved: bool,
    /// Whether the curve ends beside the peak.
    pub at_end: bool,
    /// Speeds that would resolve the peak further, with the intervals they are for; none beside the end of the curve, where the peak may
    /// lie beyond.
    pub wanted: Vec<Wanted>,
    /// Whether the peak is a maximum on a branch: its sample and both beside it are of solved responses that follow from each other.
    pub on_branch: bool,
}

/// Speed that would resolve a peak further.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// Speed to compute.
    pub speed: f64,
    /// Width of the interval that the speed divides.
    pub width: f64,
}

/// Sampled curve.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Speeds, ascending.
    pub speeds: &'a [f64],
    /// Values at the speeds.
    pub values: &'a [Option<f64>],
    /// Whether the values are of periodic responses that were solved for and last, instead of read from a march.
    pub solved: &'a [bool],
}

/// Neighbour of a peak on one side.
struct Side {
    /// Distance from the end of the peak's flat top, which is usually one sample, to the next sample.
    width: f64,
    to: f64,
    interval: (f64, f64),
    value: Option<f64>,
    solved: bool,
}

impl Resolution {
    /// Resolution of a peak of `curve`; of equal speeds one counts.
    pub fn of(curve: Curve<'_>, peak: &Peak) -> Self {
        let below = curve.side(peak, &mut (0..peak.index).rev());
        let above = curve.side(peak, &mut (peak.index + 1..curve.speeds.len()));
        let at = curve.speeds[peak.index];
        let known = [&below, &above].into_iter().flatten().filter(|side| side.value.is_some());
        let error = known.map(|side| (side.to - at).abs()).fold(0.0, f64::max);
        let (Some(below), Some(above)) = (below, above) else {
            return Self { error, resolved: false, at_end: true, wanted: Vec::new(), on_branch: false };
        };
        let sharp = SHARPNESS * at;
        let is_high = |side: &Side| side.value.is_some_and(|value| value >= RESOLVED_SHARE * peak.height);
        let enough = |side: &Side, other: &Side| {
            side.width <= sharp || is_high(side) && side.width <= WIDEST_RATIO * other.width
        };
        let sides = [(&below, &above), (&above, &below)];
        // One that is much narrower than the other is not halved before the other is: see WIDEST_RATIO.
        let coarse = sides
            .into_iter()
            .filter(|(side, other)| !enough(side, other) && other.width <= WIDEST_RATIO * side.width);
        let mut wanted: Vec<Wanted> = coarse.map(|(side, _)| side.middle()).collect();
        let known = below.value.is_some() && above.value.is_some();
        let resolved = wanted.is_empty() && known;
        let on_branch = resolved
            && curve.solved[peak.index]
            && [&below, &above].iter().all(|side| side.solved && is_high(side));
        if on_branch {
            wanted = towards_the_top(at, peak.height, [&below, &above]);
        }
        Self { error, resolved, at_end: false, wanted, on_branch }
    }
}

/// Speeds that locate the maximum of a smooth curve between its neighbours: the summit of the parabola through the three, and where that is
/// the highest sample, close beside it.
fn towards_the_top(at: f64, height: f64, [below, above]: [&Side; 2]) -> Vec<Wanted> {
    let close = ON_BRANCH * at;
    let wide = |side: &&&Side| (side.to - at).abs() > close;
    let (left, right) = (at - below.to, at - above.to);
    let fall = |side: &Side| height - side.value.unwrap_or(height);
    let (fall_left, fall_right) = (fall(below), fall(above));
    let summit = at
        - 0.5 * (left * left * fall_right - right * right * fall_left)
            / (left * fall_right - right * fall_left);
    let sides = [below, above];
    if sides.iter().all(|side| !wide(&side)) {
        return Vec::new();
    }
    let width = above.to - below.to;
    let inside = below.to + 0.5 * close < summit && summit < above.to - 0.5 * close;
    if inside && (summit - at).abs() > 0.5 * close {
        return vec![Wanted { speed: summit, width }];
    }
    let beside = |side: &Side| at + 0.9 * close * (side.to - at).signum();
    sides.iter().filter(wide).map(|side| Wanted { speed: beside(side), width }).collect()
}

impl Side {
    fn middle(&self) -> Wanted {
        Wanted { speed: 0.5 * (self.interval.0 + self.interval.1), width: self.width }
    }
}

impl Curve<'_> {
    /// First sample among `indices`, which lead away from the peak, that is not part of its top; none at the end.
    fn side(&self, peak: &Peak, indices: &mut dyn Iterator<Item = usize>) -> Option<Side> {
        let mut top = self.speeds[peak.index];
        for index in indices {
            let (to, value) = (self.speeds[index], self.values[index]);
            if value == Some(peak.height) {
                top = to;
            } else if to != top {
                let interval = (to.min(top), to.max(top));
                let width = interval.1 - interval.0;
                return Some(Side { width, to, interval, value, solved: self.solved[index] });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Highest peak of `response` over ascending speeds, with its speed.
    fn highest(speeds: &[f64], response: impl Fn(f64) -> Option<f64>) -> (f64, Resolution) {
        highest_of(speeds, response, false)
    }

    fn highest_of(
        speeds: &[f64],
        response: impl Fn(f64) -> Option<f64>,
        is_solved: bool,
    ) -> (f64, Resolution) {
        let values: Vec<_> = speeds.iter().map(|&speed| response(speed)).collect();
        let found = peaks(&values, 0.0);
        let peak = found.iter().max_by(|a, b| a.height.total_cmp(&b.height)).unwrap();
        let solved = vec![is_solved; speeds.len()];
        (speeds[peak.index], Resolution::of(Curve { speeds, values: &values, solved: &solved }, peak))
    }

    /// Intervals to be halved.
    fn halved(of: &Resolution) -> Vec<(f64, f64)> {
        of.wanted.iter().map(|each| (each.speed - 0.5 * each.width, each.speed + 0.5 * each.width)).collect()
    }

    /// Linear resonance at 1000 with a half-bandwidth of 10.
    fn resonance(speed: f64) -> Option<f64> {
        Some(1.0 / (1.0 + ((speed - 1000.0) / 10.0).powi(2)).sqrt())
    }

    fn grid(from: f64, step: f64, count: u32) -> Vec<f64> {
        (0..count).map(|i| from + step * f64::from(i)).collect()
    }

    #[test]
    fn a_resonance_is_resolved_by_a_fine_grid_only() {
        for shift in [0.0, 0.3, 0.4, 0.9] {
            let (at, coarse) = highest(&grid(900.0 + 20.0 * shift, 20.0, 10), resonance);
            assert!(!coarse.resolved && coarse.error == 20.0 && (at - 1000.0).abs() <= 20.0, "{coarse:?}");
            assert_eq!(halved(&coarse), [(at - 20.0, at), (at, at + 20.0)]);
            let (at, fine) = highest(&grid(900.0 + 2.0 * shift, 2.0, 100), resonance);
            assert!(fine.resolved && fine.wanted.is_empty(), "{fine:?}");
            assert!((fine.error - 2.0).abs() < 1e-9 && (at - 1000.0).abs() <= fine.error, "{fine:?}");
        }
        // What the constant promises, for any even grid.
        for step in grid(0.5, 0.01, 1000) {
            for shift in grid(0.0, 0.05, 21) {
                let (at, found) = highest(&grid(1000.0 - step * (20.0 + shift), step, 41), resonance);
                let seen = resonance(at).unwrap();
                assert!(!found.resolved || seen > 0.985 && (at - 1000.0).abs() < 1.8, "{step} {shift}");
            }
        }
    }

    #[test]
    fn flanks_of_a_hidden_peak_are_not_taken_for_it() {
        // As high at 900 as at 1100, and 1102 is hardly lower.
        let (at, found) = highest(&[850.0, 900.0, 1099.0, 1101.0, 1103.0], resonance);
        assert_eq!(at, 1099.0);
        assert!(!found.resolved);
        assert_eq!(halved(&found), [(900.0, 1099.0)], "halving the narrow one would help nobody");
        assert_eq!(found.error, 199.0);
    }

    #[test]
    fn a_jump_is_resolved_when_it_is_known_sharply() {
        // The response climbs along a backbone and falls off its end at 1000.
        let sawtooth = |speed: f64| Some(if speed < 1000.0 { 0.001 * speed } else { 0.2 });
        let (at, found) = highest(&[950.0, 990.0, 1030.0], sawtooth);
        assert_eq!((at, found.resolved), (990.0, false));
        assert_eq!(halved(&found), [(990.0, 1030.0)]);
        let (_, found) = highest(&[999.0, 999.8, 1000.2, 1001.0], sawtooth);
        assert!(found.resolved, "{found:?}");
        assert!((found.error - 0.8).abs() < 1e-9);
    }

    #[test]
    fn what_lies_beyond_an_edge_is_not_known() {
        let (at, found) = highest(&grid(1000.0, 1.0, 10), resonance);
        assert_eq!(
            (at, found),
            (
                1000.0,
                Resolution {
                    error: 1.0,
                    resolved: false,
                    at_end: true,
                    wanted: Vec::new(),
                    on_branch: false
                }
            )
        );
        // A missing speed bounds nothing, however close, but may be approached.
        let gap = |missing: f64| move |speed: f64| resonance(speed).filter(|_| speed != missing);
        let (at, found) = highest(&[990.0, 995.0, 1000.0, 1010.0], gap(1000.0));
        assert_eq!((at, found.error, found.resolved), (995.0, 5.0, false));
        assert_eq!(halved(&found), [(990.0, 995.0), (995.0, 1000.0)]);
        let (_, found) = highest(&[999.3, 999.7, 1000.0, 1010.0], gap(1000.0));
        assert!(!found.resolved && found.wanted.is_empty(), "{found:?}");
    }

    #[test]
    fn equal_speeds_and_a_flat_top_count_once() {
        let (_, found) = highest(&[998.0, 998.0, 1000.0, 1000.0, 1000.0, 1001.0, 1001.0], resonance);
        assert_eq!((found.error, found.resolved), (2.0, true));
        let flat = |speed: f64| Some(if (990.0..1010.0).contains(&speed) { 1.0 } else { 0.1 });
        let (at, found) = highest(&grid(970.0, 10.0, 7), flat);
        assert!((at, found.error, found.resolved) == (990.0, 20.0, false), "{at} {found:?}");
        assert_eq!(halved(&found), [(980.0, 990.0), (1000.0, 1010.0)]);
    }

    /// Maxima of solved responses are found, of any smooth curve, in a handful of speeds; jumps are no branch.
    #[test]
    fn maxima_of_solved_responses_are_found_to_their_tolerance() {
        let lopsided = |speed: f64| {
            let x = (speed - 1000.3) / 7.0;
            Some((1.0 + 0.2 * x).max(0.1) / (1.0 + x * x + 0.1 * x.powi(3).abs()))
        };
        let top = grid(1000.0, 1e-4, 30_000)
            .into_iter()
            .max_by(|&a, &b| lopsided(a).partial_cmp(&lopsided(b)).unwrap());
        let mut speeds = vec![980.0, 999.0, 1000.0, 1002.0, 1020.0];
        let (mut at, mut found) = highest_of(&speeds, lopsided, true);
        assert!(found.resolved && found.on_branch);
        while !found.wanted.is_empty() {
            speeds.extend(found.wanted.iter().map(|each| each.speed));
            speeds.sort_by(f64::total_cmp);
            assert!(speeds.windows(2).all(|pair| pair[0] < pair[1]), "{speeds:?}");
            (at, found) = highest_of(&speeds, lopsided, true);
        }
        assert!(speeds.len() < 5 + 8, "{speeds:?}");
        assert!(found.on_branch && found.error <= ON_BRANCH * at, "{found:?}");
        assert!((at - top.unwrap()).abs() <= found.error + 1e-4, "{at} {top:?}");
        let sawtooth = |speed: f64| Some(if speed < 1000.0 { 0.001 * speed } else { 0.2 });
        let (_, found) = highest_of(&[999.0, 999.8, 1000.2, 1001.0], sawtooth, true);
        assert!(found.resolved && !found.on_branch && found.wanted.is_empty(), "{found:?}");
    }

    fn indices(curve: &[f64], share: f64) -> Vec<usize> {
        let curve: Vec<_> = curve.iter().map(|&v| Some(v)).collect();
        peaks(&curve, share).iter().map(|p| p.index).collect()
    }

    #[test]
    fn finds_prominent_peaks_only() {
        assert_eq!(indices(&[0.0, 1.0, 0.2, 3.0, 2.9, 2.95, 0.0], 0.1), [1, 3]);
        assert_eq!(indices(&[0.0, 1.0, 0.2, 3.0, 2.9, 2.95, 0.0], 0.01), [1, 3, 5]);
        assert_eq!(indices(&[0.0, 2.0, 2.0, 2.0, 0.0], 0.1), [2]);
        assert_eq!(indices(&[5.0, 1.0, 0.0, 4.0], 0.1), [0, 3]);
        let edges = peaks(&[5.0, 1.0, 3.0, 0.0].map(Some), 0.1);
        assert_eq!(edges.iter().map(|p| p.at_edge).collect::<Vec<_>>(), [true, false]);
        assert!(indices(&[1.0, 1.0, 1.0], 0.1).is_empty());
        assert!(indices(&[1.0], 0.1).is_empty());
    }

    #[test]
    fn prominence_is_measured_from_the_higher_valley() {
        let curve: Vec<_> = [0.0, 5.0, 2.0, 4.0, 1.0].map(Some).to_vec();
        let found = peaks(&curve, 0.0);
        assert_eq!((found[0].prominence, found[1].prominence), (5.0 - 1.0, 4.0 - 2.0));
    }

    #[test]
    fn missing_points_separate() {
        let curve = [Some(1.0), Some(3.0), None, Some(0.5), Some(2.0), Some(1.0)];
        assert_eq!(peaks(&curve, 0.1).iter().map(|p| p.index).collect::<Vec<_>>(), [1, 4]);
    }
}
