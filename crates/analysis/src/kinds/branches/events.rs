//! Events between the points of a branch: bifurcations and maxima of amplitudes.

use super::crests::{Crest, Passed};
use super::family::Scenes;
use super::told::{Told, amplitudes_of, carried, tell};
use crate::result::{Bifurcation, BifurcationKind, BranchMaximum};
use rubmap_wheel::dynamics::initial::Stepped;
use rubmap_wheel::dynamics::steady::branch::locate::{FinerGrowth, SpecialPoint, off_by_steps};
use rubmap_wheel::dynamics::steady::branch::{Branch, Lost, Motion};
use rubmap_wheel::dynamics::steady::stability::Stability;

/// Multiples of the steps of a branch from which the error of its own steps is estimated: the finer, the less the jumps of the finer steps
/// themselves matter.
const FINER: [u32; 2] = [3, 8];

/// Share of the distance between two points, on either side of a bifurcation, over which slopes are taken.
const BESIDE: f64 = 0.1;

/// Point of a branch with its result.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    pub(super) motion: &'a Motion,
    pub(super) told: &'a Told,
}

/// Change of stability, with the motion and the growing disturbance there.
pub(super) struct Event {
    pub(super) bifurcation: Bifurcation,
    pub(super) motion: Motion,
    pub(super) grows: Stepped,
    /// Lobes that pass until the motion repeats; `passages` are those over one lobe.
    pub(super) lobe_passages: u32,
    pub(super) passages: u32,
}

/// Search for events on a branch.
pub(super) struct Events<'b, 's> {
    pub(super) scenes: &'b Scenes<'s>,
    pub(super) branch: &'b Branch<'b>,
}

impl Events<'_, '_> {
    /// Fold at the middle one of three points, if the branch turns back there.
    pub(super) fn fold(&self, [a, b, c]: [&Motion; 3]) -> Result<Option<(Bifurcation, Motion)>, Lost> {
        let up = (b.value - a.value).signum();
        if (c.value - b.value) * up >= 0.0 {
            return Ok(None);
        }
        let found = self.branch.summit(
            [(a, ()), (b, ()), (c, ())],
            |motion, ()| up * motion.value,
            |()| 0.0,
            |_| Ok(()),
        );
        let (motion, error) = match found {
            Ok(place) => (place.motion, place.error),
            Err(Lost::Cancelled) => return Err(Lost::Cancelled),
            Err(_) => (b.clone(), (a.value - b.value).abs().max((c.value - b.value).abs())),
        };
        let half_peak_to_peak = amplitudes_of(self.scenes, self.branch.lap, &motion)?.sampled;
        let bifurcation = Bifurcation {
            kind: BifurcationKind::Fold,
            value: motion.value,
            speed_rad_s: self.scenes.speed(motion.value),
            error,
            half_peak_to_peak,
            multiplier: None,
            stable_modulus: None,
        };
        Ok(Some((bifurcation, motion)))
    }

    /// Change of stability between two points, if there is one.
    pub(super) fn change(&self, a: At<'_>, b: At<'_>) -> Result<Option<Event>, Lost> {
        let both = [a, b];
        if !both.iter().all(|point| point.told.is_decided()) || a.told.growth() * b.told.growth() > 0.0 {
            return Ok(None);
        }
        let (unstable, stable) = if a.told.growth() > 0.0 { (a, b) } else { (b, a) };
        let look = |motion: &Motion| {
            let hint =
                carried(self.scenes, &unstable.told.disturbances, unstable.motion.value, motion.value)?;
            let told = tell(self.scenes, self.branch, motion, &hint)?;
            Ok((told.growth(), told))
        };
        let found = self.branch.crossing((a.motion, a.told.growth()), (b.motion, b.told.growth()), look);
        let (motion, told, error) = match found {
            Ok(Some(place)) => {
                let error = place.error.max(self.off_by_steps([a, b], &place, look)?);
                let told = if place.told.growth() > 0.0 { place.told } else { unstable.told.clone() };
                (place.motion, told, error)
            }
            Err(Lost::Cancelled) => return Err(Lost::Cancelled),
            Ok(None) | Err(_) => {
                let error = (a.motion.value - b.motion.value).abs();
                (unstable.motion.clone(), unstable.told.clone(), error)
            }
        };
        let kind = match told.stability {
            Stability::Flip => BifurcationKind::Flip,
            Stability::NeimarkSacker => BifurcationKind::NeimarkSacker,
            _ => BifurcationKind::Branching,
        };
        let bifurcation = Bifurcation {
            kind,
            value: motion.value,
            speed_rad_s: self.scenes.speed(motion.value),
            error,
            half_peak_to_peak: told.amplitudes.sampled,
            multiplier: told.multipliers.first().copied(),
            stable_modulus: stable.told.multipliers.first().map(|leading| leading.modulus),
        };
        let (lobe_passages, passages) = (told.lobe_passages, told.passages);
        Ok(Some(Event { bifurcation, motion, grows: told.leading, lobe_passages, passages }))
    }

    /// Error, in p, of a change of stability between two points because of the time steps; the whole distance between them where finer
    /// steps cannot be followed, as at a multiplier of 1.
    fn off_by_steps(
        &self,
        [a, b]: [At<'_>; 2],
        place: &SpecialPoint<Told>,
        look: impl Fn(&Motion) -> Result<(f64, Told), Lost>,
    ) -> Result<f64, Lost> {
        let known = |lost: Result<f64, Lost>| match lost {
            Err(Lost::Cancelled) => Err(Lost::Cancelled),
            other => Ok(other.ok()),
        };
        let mut finer = Vec::new();
        for times in FINER {
            let scenes = self.scenes.with_more_steps(times);
            let branch = Branch { family: &scenes, ..*self.branch };
            let growth = branch
                .with_more_steps(&place.motion, times.into())
                .and_then(|motion| Ok(tell(&scenes, &branch, &motion, &motion.state)?.growth()));
            finer.extend(known(growth)?.map(|growth| FinerGrowth { times: times.into(), growth }));
        }
        // Near the place: farther off multipliers may be of another kind.
        let (from, to) = (a.motion.value, b.motion.value);
        if finer.is_empty() {
            return Ok((to - from).abs());
        }
        let share = (place.motion.value - from) / (to - from);
        let (low, high) = ((share - BESIDE).max(0.0), (share + BESIDE).min(1.0));
        let growth = |share: f64| {
            known(self.branch.between(a.motion, b.motion, share).and_then(|found| Ok(look(&found.motion)?.0)))
        };
        let beside = growth(low)?.zip(growth(high)?);
        let slope = match beside {
            Some((before, behind)) => (behind - before) / ((high - low) * (to - from)),
            None => (b.told.growth() - a.told.growth()) / (to - from),
        };
        let off = off_by_steps(place.told.growth(), slope, &finer);
        // No more is left open than where the branch was known to be stable and not.
        Ok(off.min((to - from).abs()))
    }

    /// Maxima of the sensors' amplitudes, located between points.
    pub(super) fn maxima(&self, crests: Vec<Crest>) -> Result<Vec<BranchMaximum>, Lost> {
        let mut maxima = Vec::new();
        for Crest { sensor, points } in crests {
            let motions = points.each_ref().map(Passed::motion);
            let values = motions.each_ref().map(|motion| motion.value);
            let found = self.branch.summit(
                [0, 1, 2].map(|i| (&motions[i], points[i].amplitudes.clone())),
                |_, amplitudes| amplitudes.smooth[sensor],
                |amplitudes| (amplitudes.smooth[sensor] - amplitudes.sampled[sensor]).abs(),
                |motion| amplitudes_of(self.scenes, self.branch.lap, motion),
            );
            let (value, error, half_peak_to_peak) = match found {
                Ok(place) => (place.motion.value, place.error, place.told.sampled[sensor]),
                Err(Lost::Cancelled) => return Err(Lost::Cancelled),
                Err(_) => {
                    let error = (values[0] - values[1]).abs().max((values[2] - values[1]).abs());
                    (values[1], error, points[1].amplitudes.sampled[sensor])
                }
            };
            maxima.push(BranchMaximum {
                sensor: sensor as u32,
                value,
                speed_rad_s: self.scenes.speed(value),
                error,
                half_peak_to_peak,
                stability: points[1].stability,
            });
        }
        Ok(maxima)
    }
}
