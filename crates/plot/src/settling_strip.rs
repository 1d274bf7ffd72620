//! Strip with the verdict on each speed: how far its amplitudes can be trusted as a steady state.

use super::cells::Cell;
use super::diagram::Diagram;
use super::svg::{Element, group, rectangle, text};
use rubmap_analysis::result::{InteractionMap, PointStatus, Verdict};

/// Standing of a speed in a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    /// Computed speed, with the verdict on its steady state.
    Settled(Verdict),
    /// Diverged or failed speed.
    Missing,
    /// Speed that is not computed yet.
    Pending,
}

impl Standing {
    pub(super) const ALL: [Self; 6] = [
        Self::Settled(Verdict::Periodic),
        Self::Settled(Verdict::Subharmonic),
        Self::Settled(Verdict::Aperiodic),
        Self::Settled(Verdict::NotSettled),
        Self::Missing,
        Self::Pending,
    ];

    pub(super) fn of(map: &InteractionMap, index: usize) -> Self {
        let point = map.points.iter().find(|point| point.index as usize == index);
        match point.map(|point| (point.status, &point.settling)) {
            Some((PointStatus::Completed, Some(settling))) => Self::Settled(settling.verdict),
            Some(_) => Self::Missing,
            None => Self::Pending,
        }
    }

    pub(super) fn colour(self) -> &'static str {
        match self {
            Self::Settled(Verdict::Periodic) => "#b7d3e6",
            Self::Settled(Verdict::Subharmonic) => "#009e73",
            Self::Settled(Verdict::Aperiodic) => "#cc79a7",
            Self::Settled(Verdict::NotSettled) => "#e69f00",
            Self::Missing => "#000000",
            Self::Pending => "#dddddd",
        }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Settled(Verdict::Periodic) => "periodic",
            Self::Settled(Verdict::Subharmonic) => "subharmonic",
            Self::Settled(Verdict::Aperiodic) => "aperiodic",
            Self::Settled(Verdict::NotSettled) => "not settled",
            Self::Missing => "no result",
            Self::Pending => "not computed yet",
        }
    }
}

/// Draws the strip, `height` high from `top` on, over the horizontal axis of `diagram`.
pub(super) fn strip(
    map: &InteractionMap,
    cells: &[Cell],
    diagram: &Diagram,
    top: f64,
    height: f64,
) -> Element {
    let mut stretches: Vec<(Standing, f64, f64)> = Vec::new();
    for cell in cells {
        let standing = Standing::of(map, cell.index);
        match stretches.last_mut() {
            Some((same, _, to)) if *same == standing => *to = cell.to,
            _ => stretches.push((standing, cell.from, cell.to)),
        }
    }
    let (low, high) = diagram.x.values;
    group().children(stretches.into_iter().filter(|(_, from, to)| *to > low && *from < high).map(
        |(standing, from, to)| {
            let (from, to) = (diagram.x.place(from.max(low)), diagram.x.place(to.min(high)));
            rectangle(from, top, to - from, height).set("fill", standing.colour()).title(standing.words())
        },
    ))
}

/// Draws the key of the standings that occur.
pub(super) fn legend(map: &InteractionMap, x: f64, y: f64) -> Element {
    let occurs = |standing: &Standing| (0..map.speeds_rad_s.len()).any(|i| Standing::of(map, i) == *standing);
    let mut place = x;
    let mut key = group().child(text(x, y, "start", "Steady state:"));
    place += 92.0;
    for standing in Standing::ALL.into_iter().filter(occurs) {
        key = key.child(rectangle(place, y - 10.0, 14.0, 11.0).set("fill", standing.colour())).child(text(
            place + 20.0,
            y,
            "start",
            standing.words(),
        ));
        place += 40.0 + 7.0 * standing.words().len() as f64;
    }
    key
}
