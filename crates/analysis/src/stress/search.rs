//! The largest stress of a speed, and its most utilised places.

use std::cmp::Ordering;

use faer::{Mat, c64};

use super::bounds::{BATCH, Bounds, Seen, turn};
use super::cycle::{Cycle, Weights, weights};
use super::measure::{Stress, von_mises};
use super::reduced::ReducedStress;
use super::trajectory::{Path, paths};
use crate::result::stress::{PointStress, StressCycle, StressPeak};
use rubmap_numerics::hermitian::EigenError;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::dynamics::reduction::ReducedHarmonic;
use rubmap_wheel::dynamics::states::WheelStates;

/// Places whose cycles are told.
const CYCLES: usize = 20;

/// A wheel at a speed over a revolution.
pub(crate) struct Course<'a> {
    /// Of the whole wheel.
    pub(crate) harmonics: &'a [ReducedHarmonic],
    /// The simulated part of it.
    pub(crate) wheel: &'a ModalWheel,
    pub(crate) states: &'a WheelStates,
    pub(crate) stiffening: bool,
}

/// Finds them; none where every node is left out. Exact: a place is left out only if a bound rules it out. On the calling thread; deterministic.
///
/// # Errors
/// If an eigenvalue iteration fails.
pub(crate) fn stress_of(
    stress: &ReducedStress,
    course: &Course<'_>,
) -> Result<Option<PointStress>, EigenError> {
    if stress.places() == 0 {
        return Ok(None);
    }
    let fixed = stress.fixed(course.wheel.speed_rad_s, course.stiffening);
    let paths = paths(course.states, course.harmonics)?;
    let (weights, lacking) = weights(&stress.sets);
    let blades = (course.wheel.sectors, course.wheel.around());
    let instants = course.states.revolutions.len();
    let bounds = Bounds::new(stress, &fixed, &paths, blades, instants);
    let weights: Vec<Option<Weights>> = stress.places.iter().map(|place| weights[place.set]).collect();
    let mut search = Search {
        tight: vec![None; stress.places()],
        seen: vec![None; stress.places()],
        followed: vec![None; stress.places()],
        instants,
        stress,
        fixed: &fixed,
        paths: &paths,
        blades,
        bounds,
        weights,
    };
    let rough: Vec<(f64, f64)> = (0..stress.places())
        .map(|place| {
            let bound = search.bounds.of(place);
            (bound.largest, search.weights[place].map_or(-1.0, |weights| weights.most(&bound)))
        })
        .collect();
    let largest = search.best(1, &rough, Sought::VonMises(&vec![1.0; stress.places()])).first().copied();
    let utilised = search.best(CYCLES, &rough, Sought::Utilisation);
    let over_yield: Vec<f64> = (stress.places.iter())
        .map(|place| stress.sets[place.set].material.yield_strength.map_or(-1.0, f64::recip))
        .collect();
    let yielding = search.best(1, &rough, Sought::VonMises(&over_yield)).first().copied();
    let place = |place: usize| (&stress.places[place], &stress.sets[stress.places[place].set]);
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
            over_yield: set.material.yield_strength.map(|strength| followed.peak.0 / strength),
        }
    });
    let cycles = cycles.collect();
    let Some(largest) = peak else { return Ok(None) };
    Ok(Some(PointStress {
        largest,
        largest_over_yield: yielding.map(|at| over_yield[at] * search.follow(at).peak.0),
        largest_static: fixed.iter().map(von_mises).fold(0.0, f64::max),
        cycles,
        excluded_radius: stress.excluded_radius,
        excluded_nodes: stress.excluded_nodes,
        followed_nodes: search.followed.iter().flatten().count() as u32,
        lacking,
    }))
}

/// What is sought.
#[derive(Clone, Copy)]
enum Sought<'a> {
    /// Von Mises stress times a factor of each place; places with a negative one are passed over.
    VonMises(&'a [f64]),
    /// The measure of utilisation.
    Utilisation,
}

impl Sought<'_> {
    /// From `rough` bounds of von Mises stress and the measure.
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

/// A place over all blades and instants.
#[derive(Debug, Clone, Copy)]
struct Followed {
    /// Largest von Mises stress, its instant and its blade.
    peak: (f64, usize),
    peak_blade: usize,
    /// Of the blade with the largest measure of utilisation.
    cycle: Cycle,
    cycle_blade: usize,
    measure: f64,
}

struct Search<'a> {
    stress: &'a ReducedStress,
    fixed: &'a [Stress],
    paths: &'a [Path],
    /// Told apart, and around the wheel.
    blades: (usize, usize),
    instants: usize,
    bounds: Bounds<'a>,
    /// Of every place; none of those that are not ranked.
    weights: Vec<Option<Weights>>,
    /// Bounds of von Mises stress and the measure, where they were tightened.
    tight: Vec<Option<(f64, f64)>>,
    seen: Vec<Option<Seen>>,
    followed: Vec<Option<Followed>>,
}

impl Search<'_> {
    /// The `count` places that have most of what is sought, the first of equal ones; `rough` bounds of all.
    fn best(&mut self, count: usize, rough: &[(f64, f64)], sought: Sought<'_>) -> Vec<usize> {
        let mut order: Vec<(f64, usize)> = (rough.iter().enumerate())
            .map(|(place, &rough)| (sought.rough(place, rough), place))
            .filter(|&(bound, _)| bound >= 0.0)
            .collect();
        order.sort_unstable_by(descending);
        let mut floor = Leaders::new(count);
        let (first, others) = order.split_at(BATCH.min(order.len()));
        self.look(&first.iter().map(|&(_, place)| place).collect::<Vec<_>>());
        for &(_, place) in first {
            floor.add(self.seen[place].map_or(f64::NEG_INFINITY, |seen| sought.at_least(place, &seen)));
        }
        let mut tight = Vec::new();
        for batch in others.chunks(BATCH) {
            if batch[0].0 < floor.least() {
                break;
            }
            self.tighten(&batch.iter().map(|&(_, place)| place).collect::<Vec<_>>());
            let bound = |place: usize| self.tight[place].map(|bounds| (sought.rough(place, bounds), place));
            tight.extend(batch.iter().filter_map(|&(_, place)| bound(place)));
        }
        tight.sort_unstable_by(descending);
        let mut candidates: Vec<(f64, usize)> = (first.iter())
            .filter_map(|&(_, place)| self.seen[place].map(|seen| (sought.at_most(place, &seen), place)))
            .collect();
        for batch in tight.chunks(BATCH) {
            if batch[0].0 < floor.least() {
                break;
            }
            self.look(&batch.iter().map(|&(_, place)| place).collect::<Vec<_>>());
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

    fn tighten(&mut self, batch: &[usize]) {
        let new: Vec<usize> = batch.iter().copied().filter(|&place| self.tight[place].is_none()).collect();
        for (&place, bound) in new.iter().zip(self.bounds.tighten(&new)) {
            let most = self.weights[place].map_or(-1.0, |weights| weights.most(&bound));
            self.tight[place] = Some((bound.largest, most));
        }
    }

    fn look(&mut self, batch: &[usize]) {
        let new: Vec<usize> = batch.iter().copied().filter(|&place| self.seen[place].is_none()).collect();
        let weights: Vec<_> = new.iter().map(|&place| self.weights[place]).collect();
        for (&place, seen) in new.iter().zip(self.bounds.look(&new, &weights)) {
            self.seen[place] = Some(seen);
        }
    }

    fn follow(&mut self, place: usize) -> Followed {
        if let Some(followed) = self.followed[place] {
            return followed;
        }
        let fixed = &self.fixed[place];
        let weights = self.weights[place].unwrap_or(Weights::ALTERNATING);
        let waves: Vec<(usize, Mat<c64>)> = (self.paths.iter())
            .map(|path| {
                let rows = self.stress.harmonics[path.harmonic].matrix(place);
                (path.harmonic, rows * &path.directions * &path.course)
            })
            .collect();
        let mut found: Option<Followed> = None;
        for blade in 0..self.blades.0 {
            let turns: Vec<c64> =
                waves.iter().map(|&(harmonic, _)| turn(harmonic, blade, self.blades.1)).collect();
            let path = (0..self.instants).map(|instant| -> Stress {
                let mut stress = *fixed;
                for ((_, wave), turn) in waves.iter().zip(&turns) {
                    for (component, stress) in stress.iter_mut().enumerate() {
                        *stress += (turn * wave[(component, instant)]).re;
                    }
                }
                stress
            });
            let cycle = Cycle::of(path);
            let measure = weights.of(cycle.alternating, cycle.mean);
            let here = Followed { peak: cycle.peak, peak_blade: blade, cycle, cycle_blade: blade, measure };
            found = Some(found.map_or(here, |before| before.with(&here)));
        }
        let found = found.unwrap_or_else(|| unreachable!("a wheel has at least one blade"));
        self.followed[place] = Some(found);
        found
    }
}

impl Followed {
    /// With another blade, if it has more.
    fn with(mut self, other: &Self) -> Self {
        if other.peak.0 > self.peak.0 {
            (self.peak, self.peak_blade) = (other.peak, other.peak_blade);
        }
        if other.measure > self.measure {
            (self.cycle, self.cycle_blade, self.measure) = (other.cycle, other.cycle_blade, other.measure);
        }
        self
    }
}

/// By value, then by place.
fn descending(a: &(f64, usize), b: &(f64, usize)) -> Ordering {
    b.0.total_cmp(&a.0).then(a.1.cmp(&b.1))
}

/// The largest few of some numbers.
struct Leaders {
    count: usize,
    /// Descending.
    values: Vec<f64>,
}

impl Leaders {
    fn new(count: usize) -> Self {
        Self { count, values: Vec::new() }
    }

    fn add(&mut self, value: f64) {
        let place = self.values.partition_point(|&known| known >= value);
        self.values.insert(place, value);
        self.values.truncate(self.count);
    }

    /// What one must have to be among them.
    fn least(&self) -> f64 {
        if self.values.len() < self.count { f64::NEG_INFINITY } else { self.values[self.count - 1] }
    }
}
