//! Critical speeds: peaks of the steady response over Ω (§9).

/// A local maximum of a sampled curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Index of the sample.
    pub index: usize,
    /// Value there.
    pub height: f64,
    /// Height above the higher of the two valleys that separate it from higher ground (or from the ends).
    pub prominence: f64,
    /// Whether it is the end of a stretch, so that the curve may rise further beyond.
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

#[cfg(test)]
mod tests {
    use super::*;

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
