//! State of a branch job between legs: all that the next leg needs, to the bit.

use serde::{Deserialize, Serialize};

use super::crests::{Crests, Passed};
use super::kept::{KeptFront, KeptTold};
use crate::result::{Bifurcation, Track};
use rubmap_wheel::dynamics::steady::branch::Motion;
use rubmap_wheel::dynamics::steady::branch::follow::Front;

/// State of a branch job between legs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Course {
    /// Stretch that is being followed.
    pub(super) under_way: UnderWay,
    /// Stretches still to be begun, the next one last.
    pub(super) waiting: Vec<Stretch>,
    /// Number of branches so far.
    pub(super) branches: u32,
    /// Flips so far: a flip found from both sides of a point counts once.
    #[serde(default)]
    pub(super) flips: Vec<FoundFlip>,
}

/// Flip of a branch, with the number of that branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FoundFlip {
    pub(super) branch: u32,
    pub(super) flip: Bifurcation,
}

/// Side of a branch, followed away from where the branch begins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Stretch {
    pub(super) track: Track,
    /// Largest distance, in the parameter, of the flip from where a branch of doubled period begins.
    #[serde(default)]
    pub(super) flip_error: f64,
    /// Passages over a lobe after which the motions repeat; none for motions that repeat as their scene does.
    pub(super) passages: Option<u32>,
    pub(super) backwards: bool,
    pub(super) front: KeptFront,
    /// Whether the beginning is reported as a point of this stretch.
    pub(super) tells_start: bool,
    /// First points of the branch behind its beginning, if the other side was followed; the nearest first.
    pub(super) behind: Vec<Passed>,
}

/// Number of points behind a beginning that are used to find a maximum there.
const BEHIND: usize = 8;

impl Stretch {
    pub(super) fn new(track: Track, passages: Option<u32>, front: &Front) -> Self {
        Self {
            track,
            flip_error: 0.0,
            passages,
            backwards: false,
            front: front.into(),
            tells_start: true,
            behind: Vec::new(),
        }
    }

    /// Whether this stretch is the other side of the same branch.
    pub(super) fn continues(&self, other: &Self) -> bool {
        self.track == other.track && self.backwards != other.backwards
    }

    /// Continues a branch whose other side has these points.
    pub(super) fn go_on_from(&mut self, more: Vec<Passed>) {
        self.behind.extend(more);
        self.behind.truncate(BEHIND);
        self.front.before = self.behind.first().map(|beside| beside.motion.clone());
    }

    /// Whether both stretches are of doubled periods of the same branch.
    pub(super) fn doubles_as(&self, other: &Self) -> bool {
        let doubled = |stretch: &Self| stretch.track.doubles.map(|(branch, _)| branch);
        doubled(self).is_some() && doubled(self) == doubled(other)
    }

    /// Motion at the beginning of the stretch.
    pub(super) fn start(&self) -> Motion {
        (&self.front.last).into()
    }
}

/// Stretch that has been begun.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct UnderWay {
    pub(super) stretch: Stretch,
    /// Number of points so far, without the beginning.
    pub(super) points: u32,
    /// Result at the last point.
    pub(super) last: Option<KeptTold>,
    /// Amplitudes since the last maxima, for the maxima to come.
    pub(super) crests: Crests,
    /// Multiplier that passed 1 before the last point: a fold, if the branch turns back at the next point.
    pub(super) pending: Option<Bifurcation>,
}

impl UnderWay {
    /// Stretch of which nothing is done yet.
    pub(super) fn new(mut stretch: Stretch) -> Self {
        let mut crests = Crests::default();
        // Maxima found here were reported with the other side.
        for passed in std::mem::take(&mut stretch.behind).into_iter().rev() {
            crests.pass(passed);
        }
        Self { stretch, points: 0, last: None, crests, pending: None }
    }
}
