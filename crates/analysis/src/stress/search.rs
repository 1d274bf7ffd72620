//! Search for the largest stress of a speed, and for its most utilised places.

use num_integer::Integer;

use super::bounds::bounds;
use super::cycle::{Cycle, Weights, weights};
use super::error::StressError;
use super::follow::{Follow, Followed};
use super::leaders::{Leaders, descending};
use super::look::{BATCH, Look, Seen};
use super::measure::von_mises;
use super::reduced::ReducedStress;
use super::trajectory::paths;
use crate::result::stress::{LeadingPlace, PointStress, StressCycle, StressPeak};
use rubmap_solid::material::GivenStrengths;
use rubmap_solid::mesh::ElementSet;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::reduction::ReducedHarmonic;
use rubmap_wheel::dynamics::states::WheelStates;

/// Number of places whose cycles are reported.
const CYCLES: usize = 20;

/// Number of places whose largest stress is reported.
const LEADING: usize = 20;

/// Motion of a wheel at a speed over a revolution.
pub(crate) struct Course<'a> {
    /// Nodal diameters of the whole wheel.
    pub(crate) harmonics: &'a [ReducedHarmonic],
    /// Simulated part of the wheel.
    pub(crate) wheel: &'a ModalWheel,
    pub(crate) states: &'a WheelStates,
    pub(crate) stiffening: bool,
}

/// Finds the largest stress of a speed and its most utilised places, by the model's strengths or those `given` for a set; none where every node is
/// left out. Exact: a place is skipped only if a
/// bound rules it out. On the calling thread; deterministic.
///
/// # Errors
/// Eigenvalue iteration that fails, or bound that is not finite.
pub(crate) fn stress_of<'a>(
    stress: &ReducedStress,
    course: &Course<'_>,
    given: impl Fn(&str) -> Option<&'a GivenStrengths>,
) -> Result<Option<PointStress>, StressError> {
    if stress.places() == 0 {
        return Ok(None);
    }
    let with_strengths = |set: &ElementSet| match given(&set.name) {
        Some(given) => ElementSet { material: set.material.with_strengths(given), ..set.clone() },
        None => set.clone(),
    };
    let sets: Vec<ElementSet> = stress.sets.iter().map(with_strengths).collect();
    let fixed = stress.fixed(course.wheel.speed_rad_s, course.stiffening);
    let paths = paths(course.states, course.harmonics, stress)?;
    let (weights, lacking) = weights(&sets);
    let around = course.wheel.around();
    // Nodal diameters with a common divisor repeat that often around the wheel.
    let repeats = paths.iter().fold(around, |common, path| common.gcd(&path.harmonic));
    let blades = (course.wheel.sectors.min(around / repeats), around);
    let instants = course.states.revolutions.len();
    let bounds = bounds(stress, &fixed, &paths);
    if bounds.iter().any(|bound| !bound.largest.is_finite()) {
        return Err(StressError::NotFinite);
    }
    let weights: Vec<Option<Weights>> =
        stress.places.iter().map(|place| weights[place.weakest(&sets)]).collect();
    let rough: Vec<(f64, f64)> = (bounds.iter().zip(&weights))
        .map(|(bound, weights)| (bound.largest, weights.map_or(-1.0, |weights| weights.most(bound))))
        .collect();
    let mut search = Search {
        look: Look::new(stress, &bounds, &fixed, &paths, blades, instants),
        follow: Follow { stress, fixed: &fixed, paths: &paths, blades, instants },
        seen: vec![None; stress.places()],
        followed: vec![None; stress.places()],
        weights,
    };
    let largest = search.best(1, &rough, Sought::VonMises(&vec![1.0; stress.places()])).first().copied();
    let utilised = search.best(CYCLES, &rough, Sought::Utilisation);
    let over_yield: Vec<f64> =
        stress.places.iter().map(|place| place.yield_strength(&sets).map_or(-1.0, f64::recip)).collect();
    let yielding = search.best(1, &rough, Sought::VonMises(&over_yield)).first().copied();
    let place = |place: usize| (&stress.places[place], &sets[stress.places[place].weakest(&sets)]);
    let peak = largest.map(|at| {
        let followed = search.follow(at);
        let (von_mises, instant) = followed.peak;
        let (place, _) = place(at);
        StressPeak {
            von_mises,
            node: place.node,
            position: place.position,
            sector: followed.peak_blade as u32,
            revolution: course.states.revolutions[instant],
        }
    });
    let cycles = utilised.into_iter().map(|at| {
        let followed = search.follow(at);
        let (place, set) = place(at);
        let Cycle { mean, alternating, principal_mean, principal_alternating, .. } = followed.cycle;
        StressCycle {
            node: place.node,
            position: place.position,
            sector: followed.cycle_blade as u32,
            set: set.name.clone(),
            mean,
            alternating,
            principal_mean,
            principal_alternating,
            utilisation: Weights::goodman(&set.material).map(|goodman| goodman.of(alternating, mean)),
            over_yield: place.yield_strength(&sets).map(|strength| followed.peak.0 / strength),
        }
    });
    let cycles = cycles.collect();
    let leading = search.leading().into_iter().map(|(von_mises, at)| {
        let (place, set) = place(at);
        LeadingPlace { node: place.node, set: set.name.clone(), von_mises }
    });
    let leading = leading.collect();
    let Some(largest) = peak else { return Ok(None) };
    Ok(Some(PointStress {
        largest,
        largest_over_yield: yielding.map(|at| over_yield[at] * search.follow(at).peak.0),
        largest_static: fixed.iter().map(von_mises).fold(0.0, f64::max),
        cycles,
        leading,
        excluded_radius: stress.excluded_radius,
        excluded_nodes: stress.excluded_nodes,
        followed_nodes: search.followed.iter().flatten().count() as u32,
        lacking,
    }))
}

/// Quantity by which places are ranked.
#[derive(Clone, Copy)]
enum Sought<'a> {
    /// Von Mises stress times a factor of each place; places with a negative factor are skipped.
    VonMises(&'a [f64]),
    /// Measure of utilisation.
    Utilisation,
}

impl Sought<'_> {
    /// Bound of the quantity from `rough` bounds of von Mises stress and measure.
    fn rough(self, place: usize, rough: (f64, f64)) -> f64 {
        match self {
            Self::VonMises(factors) => factors[place] * rough.0,
            Self::Utilisation => rough.1,
        }
    }

    fn at_most(self, place: usize, seen: &Seen) -> f64 {
        match self {
            Self::VonMises(factors) => factors[place] * seen.largest,
            Self::Utilisation => seen.most,
        }
    }

    fn at_least(self, place: usize, seen: &Seen) -> f64 {
        match self {
            Self::VonMises(factors) => factors[place] * seen.largest_at_least,
            Self::Utilisation => seen.most_at_least,
        }
    }

    fn exact(self, place: usize, followed: &Followed) -> f64 {
        match self {
            Self::VonMises(factors) => factors[place] * followed.peak.0,
            Self::Utilisation => followed.measure,
        }
    }
}

struct Search<'a> {
    look: Look<'a>,
    follow: Follow<'a>,
    /// Weights of every place; none for places that are not ranked.
    weights: Vec<Option<Weights>>,
    seen: Vec<Option<Seen>>,
    followed: Vec<Option<Followed>>,
}

impl Search<'_> {
    /// Ranks the `count` places with most of the quantity, the first of equal ones; `rough` bounds of all places.
    fn best(&mut self, count: usize, rough: &[(f64, f64)], sought: Sought<'_>) -> Vec<usize> {
        let mut order: Vec<(f64, usize)> = (rough.iter().enumerate())
            .map(|(place, &rough)| (sought.rough(place, rough), place))
            .filter(|&(bound, _)| bound >= 0.0)
            .collect();
        order.sort_unstable_by(descending);
        let mut floor = Leaders::new(count);
        let mut candidates = Vec::new();
        for batch in order.chunks(BATCH) {
            if batch[0].0 < floor.least() {
                break;
            }
            self.look(batch.iter().map(|&(_, place)| place));
            for &(_, place) in batch {
                if let Some(seen) = &self.seen[place] {
                    floor.add(sought.at_least(place, seen));
                    candidates.push((sought.at_most(place, seen), place));
                }
            }
        }
        candidates.sort_unstable_by(descending);
        let mut exact = Leaders::new(count);
        let mut found = Vec::new();
        for (at_most, place) in candidates {
            if at_most < floor.least().max(exact.least()) {
                break;
            }
            let value = sought.exact(place, &self.follow(place));
            exact.add(value);
            found.push((value, place));
        }
        found.sort_unstable_by(descending);
        found.into_iter().take(count).map(|(_, place)| place).collect()
    }

    /// Places with the largest von Mises stress among those that were followed.
    fn leading(&self) -> Vec<(f64, usize)> {
        let followed = self.followed.iter().enumerate();
        let mut peaks: Vec<(f64, usize)> =
            followed.filter_map(|(place, followed)| Some((followed.as_ref()?.peak.0, place))).collect();
        peaks.sort_unstable_by(descending);
        peaks.truncate(LEADING);
        peaks
    }

    fn look(&mut self, places: impl Iterator<Item = usize>) {
        let new: Vec<usize> = places.filter(|&place| self.seen[place].is_none()).collect();
        let weights: Vec<_> = new.iter().map(|&place| self.weights[place]).collect();
        for (&place, seen) in new.iter().zip(self.look.at(&new, &weights)) {
            self.seen[place] = Some(seen);
        }
    }

    fn follow(&mut self, place: usize) -> Followed {
        let weights = self.weights[place].unwrap_or(Weights::ALTERNATING);
        *self.followed[place].get_or_insert_with(|| self.follow.place(place, weights))
    }
}
