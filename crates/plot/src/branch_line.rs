//! Lines of a branch: which stretches are stable, unstable or undecided, and where that changes.

use rubmap_analysis::result::Stability;

/// Position in the diagram, in the units of its axes.
pub(super) type Place = (f64, f64);

/// Penalty on stretches whose two ends have the same stability: a bifurcation lies on one only if its detour there is this many times
/// smaller.
const UNCHANGED: f64 = 10.0;

/// Detour, relative to the size of the diagram, below which detours count as equal.
const NO_DETOUR: f64 = 1e-6;

/// Stability of a response as far as it is known, worst last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fate {
    /// Stable response.
    Stable,
    /// Unstable response.
    Unstable,
    /// Response whose stability is undecided.
    Undecided,
}

impl Fate {
    pub(super) const ALL: [Self; 3] = [Self::Stable, Self::Unstable, Self::Undecided];

    pub(super) fn of(stability: Stability) -> Self {
        match stability {
            Stability::Stable => Self::Stable,
            Stability::Undecided => Self::Undecided,
            Stability::Narrow | Stability::Flip | Stability::Fold | Stability::NeimarkSacker => {
                Self::Unstable
            }
        }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "stability undecided",
        }
    }
}

/// Line of one stability.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    pub(super) fate: Fate,
    /// Corners of the line, each with the index of its point; a bifurcation has no index.
    pub(super) corners: Vec<(Place, Option<usize>)>,
}

/// Lines of a branch through its points, interrupted where one is missing. Each of the `bends` (bifurcations) lies between the two points
/// that have the least detour over it, preferably two of different stability; there the stability of the line changes. A stretch whose
/// change no bifurcation explains takes the worse stability of its two ends. `scale`: width and height of the diagram, in its units.
pub(super) fn runs(points: &[Option<(Place, Fate)>], bends: &[Place], scale: (f64, f64)) -> Vec<Run> {
    let stretches = || points.windows(2).enumerate().filter_map(|(k, pair)| Some((k, pair[0]?, pair[1]?)));
    let distance = |a: Place, b: Place| f64::hypot((a.0 - b.0) / scale.0, (a.1 - b.1) / scale.1);
    let mut over = vec![Vec::<Place>::new(); points.len()];
    for &bend in bends {
        let detour = |(_, a, b): &(usize, (Place, Fate), (Place, Fate))| {
            let more = distance(a.0, bend) + distance(bend, b.0) - distance(a.0, b.0);
            (more + NO_DETOUR) * if a.1 == b.1 { UNCHANGED } else { 1.0 }
        };
        if let Some((k, ..)) = stretches().min_by(|a, b| detour(a).total_cmp(&detour(b))) {
            over[k].push(bend);
        }
    }
    let mut runs = Vec::<Run>::new();
    let mut is_open = false;
    for (k, point) in points.iter().enumerate() {
        let Some((place, fate)) = *point else {
            is_open = false;
            continue;
        };
        if !is_open {
            runs.push(Run { fate, corners: vec![(place, Some(k))] });
            is_open = true;
        }
        let Some((next, then)) = points.get(k + 1).copied().flatten() else { continue };
        let bends = &mut over[k];
        bends.sort_by(|a, b| distance(place, *a).total_cmp(&distance(place, *b)));
        let first = if bends.is_empty() { fate.max(then) } else { fate };
        extend(&mut runs, first, bends.first().map_or((next, Some(k + 1)), |bend| (*bend, None)));
        for corner in bends.iter().skip(1).map(|bend| (*bend, None)).chain([(next, Some(k + 1))]) {
            if !bends.is_empty() {
                extend(&mut runs, then, corner);
            }
        }
    }
    runs
}

/// Continues to a corner, on a new line if the stability differs.
fn extend(runs: &mut Vec<Run>, fate: Fate, corner: (Place, Option<usize>)) {
    let Some(last) = runs.last_mut() else { return };
    if last.fate == fate {
        last.corners.push(corner);
    } else if let [alone] = last.corners[..] {
        // A line with one corner would have no length.
        *last = Run { fate, corners: vec![alone, corner] };
    } else {
        let from = last.corners[last.corners.len() - 1];
        runs.push(Run { fate, corners: vec![from, corner] });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Fate::{Stable, Undecided, Unstable};

    const SCALE: (f64, f64) = (10.0, 1.0);

    fn drawn(points: &[(f64, f64, Fate)], bends: &[Place]) -> Vec<(Fate, Vec<Place>)> {
        let points: Vec<_> = points
            .iter()
            .map(|(x, y, fate)| (x.is_finite() && y.is_finite()).then_some(((*x, *y), *fate)))
            .collect();
        let runs = runs(&points, bends, SCALE);
        runs.into_iter().map(|run| (run.fate, run.corners.iter().map(|corner| corner.0).collect())).collect()
    }

    #[test]
    fn the_kind_changes_at_the_bifurcation() {
        let points = [(0.0, 0.1, Stable), (1.0, 0.2, Stable), (2.0, 0.3, Unstable), (3.0, 0.4, Unstable)];
        let found = drawn(&points, &[(1.25, 0.225)]);
        assert_eq!(
            found,
            [
                (Stable, vec![(0.0, 0.1), (1.0, 0.2), (1.25, 0.225)]),
                (Unstable, vec![(1.25, 0.225), (2.0, 0.3), (3.0, 0.4)])
            ]
        );
        // A change without a bifurcation is not drawn as stable.
        assert_eq!(drawn(&points, &[])[0].1, [(0.0, 0.1), (1.0, 0.2)]);
    }

    /// Branch that turns back beyond all of its points, after the one of largest value.
    #[test]
    fn a_fold_lies_beyond_the_points_beside_it() {
        let points = [(1.0, 0.1, Stable), (2.0, 0.2, Stable), (2.4, 0.3, Stable), (2.2, 0.4, Unstable)];
        let found = drawn(&points, &[(2.5, 0.34)]);
        assert_eq!(found[0].1.last(), Some(&(2.5, 0.34)));
        assert_eq!(found[1], (Unstable, vec![(2.5, 0.34), (2.2, 0.4)]));
    }

    #[test]
    fn what_is_missing_interrupts() {
        let points = [
            (0.0, 0.1, Stable),
            (1.0, f64::NAN, Stable),
            (2.0, 0.3, Stable),
            (3.0, 0.4, Undecided),
            (4.0, 0.4, Stable),
        ];
        let found = drawn(&points, &[]);
        assert_eq!(found[0], (Stable, vec![(0.0, 0.1)]));
        assert_eq!(found[1], (Undecided, vec![(2.0, 0.3), (3.0, 0.4), (4.0, 0.4)]));
        assert_eq!(found.len(), 2);
        assert!(drawn(&[], &[(1.0, 1.0)]).is_empty());
        assert_eq!(drawn(&[(1.0, 1.0, Stable)], &[(1.0, 1.0)]).len(), 1);
    }
}
