//! How far branches have been followed: all that the next leg needs, to the bit.

use serde::{Deserialize, Serialize};

use super::crests::{Crests, Passed};
use super::kept::{KeptFront, KeptTold};
use crate::result::{Bifurcation, Track};
use rubmap_wheel::dynamics::steady::branch::Motion;
use rubmap_wheel::dynamics::steady::branch::follow::Front;

/// How far branches have been followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// The stretch under way.
    pub(super) under_way: UnderWay,
    /// Those that have still to be begun, the next one last.
    pub(super) waiting: Vec<Stretch>,
    /// Branches so far.
    pub(super) branches: u32,
    /// Flips so far: one that is found from both sides of a point is one.
    #[serde(default)]
    pub(super) flips: Vec<FoundFlip>,
}

/// Flip of a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FoundFlip {
    pub(super) branch: u32,
    pub(super) flip: Bifurcation,
}

/// A branch away from where it begins, to one side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Stretch {
    pub(super) track: Track,
    /// How far the flip may be from where a branch of doubled period begins.
    #[serde(default)]
    pub(super) flip_error: f64,
    /// Passages over a lobe after which its motions repeat; none of those that repeat as their scene does.
    pub(super) passages: Option<u32>,
    pub(super) backwards: bool,
    pub(super) front: KeptFront,
    /// Whether where it begins is a point of it.
    pub(super) tells_start: bool,
    /// The first points of the branch behind where it begins, if it was followed to the other side; the nearest first.
    pub(super) behind: Vec<Passed>,
}

/// Points behind a beginning by which it is told whether there is a maximum.
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

    /// Whether it is the same branch from the same point, to the other side.
    pub(super) fn continues(&self, other: &Self) -> bool {
        self.track == other.track && self.backwards != other.backwards
    }

    /// Continues a branch that goes on to the other side with these points.
    pub(super) fn go_on_from(&mut self, more: Vec<Passed>) {
        self.behind.extend(more);
        self.behind.truncate(BEHIND);
        self.front.before = self.behind.first().map(|beside| beside.motion.clone());
    }

    /// Whether both are of doubled periods, and of the same branch.
    pub(super) fn doubles_as(&self, other: &Self) -> bool {
        let doubled = |stretch: &Self| stretch.track.doubles.map(|(branch, _)| branch);
        doubled(self).is_some() && doubled(self) == doubled(other)
    }

    /// Where it begins.
    pub(super) fn start(&self) -> Motion {
        (&self.front.last).into()
    }
}

/// A stretch that was begun.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct UnderWay {
    pub(super) stretch: Stretch,
    /// Points that it has, but for where it begins.
    pub(super) points: u32,
    /// What was told of the last one.
    pub(super) last: Option<KeptTold>,
    /// Maxima that it may have passed.
    pub(super) crests: Crests,
    /// A multiplier passed 1 before the last point: of a fold, if the branch turns back at the next.
    pub(super) pending: Option<Bifurcation>,
}

impl UnderWay {
    /// Nothing of it is done.
    pub(super) fn new(mut stretch: Stretch) -> Self {
        let mut crests = Crests::default();
        // What is found there was told on the other side.
        for passed in std::mem::take(&mut stretch.behind).into_iter().rev() {
            crests.pass(passed);
        }
        Self { stretch, points: 0, last: None, crests, pending: None }
    }
}
