//! What happens between the points of a branch: bifurcations and maxima of amplitudes.

use super::crests::{Crest, Passed};
use super::family::Scenes;
use super::told::{Told, amplitudes_of, carried, tell};
use crate::result::{Bifurcation, BifurcationKind, BranchMaximum};
use rubmap_wheel::dynamics::initial::Stepped;
use rubmap_wheel::dynamics::steady::branch::{Branch, Lost, Motion};
use rubmap_wheel::dynamics::steady::stability::Stability;

/// A point with what is told of it.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    pub(super) motion: &'a Motion,
    pub(super) told: &'a Told,
}

/// A change of stability, with the motion there, and what grows from it.
pub(super) struct Event {
    pub(super) bifurcation: Bifurcation,
    pub(super) motion: Motion,
    pub(super) grows: Stepped,
    /// Lobes that pass until the motion repeats, and passages over one.
    pub(super) lobe_passages: u32,
    pub(super) passages: u32,
}

/// Where events are looked for.
pub(super) struct Events<'a> {
    pub(super) scenes: &'a Scenes<'a>,
    pub(super) branch: &'a Branch<'a>,
}

impl Events<'_> {
    /// The fold at the middle one of three points, if the branch turns back there.
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

    /// Where between two points the stability changes, if it does.
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
        // Of one kind of multiplier: real ones of either sign, or a pair.
        let kind = |told: &Told| {
            let leading = told.multipliers.first();
            leading.map(|leading| (leading.imaginary == 0.0, leading.real < 0.0 && leading.imaginary == 0.0))
        };
        let alike = |one: &Told, other: &Told| kind(one) == kind(other);
        let ends = [(a.motion, a.told.growth()), (b.motion, b.told.growth())];
        let found = self.branch.crossing(ends[0], ends[1], look, alike);
        let (motion, told, error) = match found {
            Ok(Some(place)) if place.told.growth() > 0.0 => (place.motion, place.told, place.error),
            Ok(Some(place)) => (place.motion, unstable.told.clone(), place.error),
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

    /// The maxima of sensors' amplitudes that were passed.
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
