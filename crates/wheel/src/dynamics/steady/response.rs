//! Periodic response of a scene: sought from where its march begins, judged, and checked by a march.

use super::damping::{ContinuedResponse, follow};
use super::multipliers::MOST_PRODUCTS;
use super::periodic::{DEPTH, NotFound, Periodic, Search, find};
use super::stability::{Floquet, Stability};
use crate::dynamics::casing::Casing;
use crate::dynamics::effects::Effects;
use crate::dynamics::excitation::EngineOrderExcitation;
use crate::dynamics::initial::Stepped;
use crate::dynamics::integrate::{
    Detail, Outcome, Passage, PassageError, Revolutions, Run, Simulation, Trace,
};

/// Residual ‖P(x) − x‖ / ‖x‖ at which a response is found.
const FOUND: f64 = 1e-8;

/// Number of revolutions that are taken as they come before acceleration begins.
const MARCHED: usize = 3;

/// Number of multipliers that are reported.
pub const MULTIPLIERS: usize = 4;

/// Fewest revolutions of a search after the ramp, with the multipliers and the revolution that is recorded.
pub const LEAST_REVOLUTIONS: u64 = 10;

/// Relative distance ‖x − x*‖ / ‖x*‖ from which a march has to come back to a response that is called stable.
const BESIDE: f64 = 1e-3;

/// Number of revolutions for which the contact has to be that of the response: a response that repeats after some of them may look alike in
/// between.
const LASTING: usize = 8;

/// Share of the distance at most left to a march that is coming back, but slowly.
const COMING: f64 = 0.25;

/// Periodic response with its credentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// State at the beginning of a revolution.
    pub start: Stepped,
    /// Revolutions after which the response repeats: 1, except under an orbit that takes longer to come round.
    pub period: usize,
    /// Residual ‖P(x) − x‖ / ‖x‖ over the map of the search, in the norm of energies.
    pub residual: f64,
    /// Stability of the response.
    pub floquet: Floquet,
    /// Whether the march from where the scene begins arrives at the response; none if nobody asked, or it does not last.
    pub arrives: Option<bool>,
    /// Factor of the damping of the scene from which the response was followed, where the search with that damping stalled.
    pub followed_from: Option<f64>,
}

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Sought {
    /// Response, or why there is none.
    pub response: Result<Response, NotFound>,
    /// Revolutions of the wheel that the search took, all maps and products of derivatives counted.
    pub revolutions: f64,
}

/// Memory that a search holds, in bytes, beside that of a run: for `unknowns` numbers z and `pairs` of sector and contact node, twice as
/// many with friction.
pub fn memory(unknowns: usize, pairs: usize) -> usize {
    let state = 2 * unknowns;
    // Differences of residuals and images with two copies for their least squares, or the vectors of the multipliers; A of all pairs.
    size_of::<f64>() * (state * (4 * DEPTH).max(MOST_PRODUCTS) + unknowns * pairs)
}

/// Seeks the periodic response of the scene of `simulation`, whose recording is ignored, in at most `limit` revolutions, and in as many
/// again from heavier damping; with `control`, also whether a march arrives at it in as many. `go_on` is asked now and then.
pub fn seek(simulation: &Simulation<'_>, limit: usize, control: bool, go_on: &dyn Fn() -> bool) -> Sought {
    let mut revolutions = 0.0;
    let response = match Passage::about_half(simulation) {
        Ok(mut passage) => {
            let response = respond(&mut passage, simulation, limit, control, &mut revolutions, go_on);
            revolutions += passage.revolutions();
            response
        }
        Err(reason) => Err(reason.into()),
    };
    Sought { response, revolutions }
}

fn respond(
    passage: &mut Passage<'_>,
    simulation: &Simulation<'_>,
    limit: usize,
    control: bool,
    revolutions: &mut f64,
    go_on: &dyn Fn() -> bool,
) -> Result<Response, NotFound> {
    let (per_revolution, steps) = (simulation.steps_per_revolution, passage.steps());
    let passages = |revolutions: usize| (revolutions * per_revolution).div_ceil(steps);
    let most = passages(limit);
    let start = begin(simulation, passage, revolutions, go_on)?;
    let search = Search { tolerance: FOUND, marched: passages(MARCHED), most };
    let (Periodic { state, residual }, followed_from) = match find(passage, &start, &search, go_on) {
        Err(stalled @ NotFound::Stalled { .. }) => {
            let mut taken = 0;
            let followed = follow(simulation, &start, &search, &mut taken, go_on);
            *revolutions += (taken * steps) as f64 / per_revolution as f64;
            match followed {
                Ok(ContinuedResponse { periodic, from }) => (periodic, Some(from)),
                Err(NotFound::Cancelled) => return Err(NotFound::Cancelled),
                Err(_) => return Err(stalled),
            }
        }
        found => (found?, None),
    };
    let hint: Vec<f64> = start.iter().zip(&state).map(|(a, b)| a - b).collect();
    let mut floquet = Floquet::of(passage, &state, &hint, MULTIPLIERS)?;
    *revolutions += floquet.revolutions;
    let mut arrives = None;
    if floquet.stability == Stability::Stable {
        passage.map(&state)?;
        let orbit = Orbit { state: &state, trace: passage.trace().clone(), lasting: passages(LASTING) };
        if control {
            arrives = Some(orbit.attracts(passage, start, most, go_on)?);
        }
        if arrives != Some(true) && length(&hint) > 0.0 {
            let share = BESIDE * length(&state) / length(&hint);
            let beside = state.iter().zip(&hint).map(|(x, hint)| x + share * hint).collect();
            if !orbit.attracts(passage, beside, most, go_on)? {
                floquet.stability = Stability::Narrow;
            }
        }
    }
    let period = passage.whole() / simulation.steps_per_revolution;
    Ok(Response { start: passage.stepped(&state), period, residual, floquet, arrives, followed_from })
}

/// State once all has grown, marched from where the scene begins.
fn begin(
    simulation: &Simulation<'_>,
    passage: &mut Passage<'_>,
    revolutions: &mut f64,
    go_on: &dyn Fn() -> bool,
) -> Result<Vec<f64>, NotFound> {
    if passage.grown() == 0 {
        return Ok(passage.state(simulation.initial, &[]));
    }
    let unrecorded = Simulation {
        sensors: &[],
        samples_per_revolution: 1,
        revolutions: passage.grown(),
        window_revolutions: 0,
        repeats: None,
        detail: None,
        states: None,
        ..*simulation
    };
    let run = unrecorded.run(&|_| go_on());
    *revolutions += run.statistics.steps as f64 / simulation.steps_per_revolution as f64;
    match run.outcome {
        Outcome::Completed(history) => Ok(passage.state(&history.end, &history.casing_end)),
        Outcome::Diverged(divergence) => Err(PassageError::Diverged(divergence).into()),
        Outcome::ContactFailed { error, .. } => Err(PassageError::Contact(error).into()),
        Outcome::Cancelled => Err(NotFound::Cancelled),
    }
}

/// Periodic response, and the trace of its contact.
struct Orbit<'a> {
    state: &'a [f64],
    trace: Trace,
    /// Number of maps for which the contact has to be that of the response.
    lasting: usize,
}

impl Orbit<'_> {
    /// Whether a march from `x` arrives at the response in `most` maps: until, for some revolutions, the contact is that of the response, from
    /// where on multipliers tell the rest. A march from a thousandth beside that has not yet come so far, but has come closer, counts too.
    fn attracts(
        &self,
        passage: &mut Passage<'_>,
        mut x: Vec<f64>,
        most: usize,
        go_on: &dyn Fn() -> bool,
    ) -> Result<bool, NotFound> {
        let size = length(self.state);
        // Passages that were alike up to now, and how far away the first of them was.
        let (mut alike, mut entered) = (0, f64::INFINITY);
        for _ in 0..most {
            if !go_on() {
                return Err(NotFound::Cancelled);
            }
            let before = self.away(&x);
            x = passage.map(&x)?;
            if !passage.trace().is_alike(&self.trace) {
                alike = 0;
                continue;
            }
            if alike == 0 {
                entered = before;
            }
            alike += 1;
            let now = self.away(&x);
            if now <= FOUND * size || (alike >= self.lasting && now < entered) {
                return Ok(true);
            }
        }
        Ok(self.away(&x) <= COMING * BESIDE * size)
    }

    fn away(&self, x: &[f64]) -> f64 {
        x.iter().zip(self.state).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
    }
}

fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Runs `simulation` on `response` instead of from where its scene begins: one period, repeated for all revolutions asked for. Details of
/// chosen revolutions are recorded over as many equivalent ones, counted from the first.
pub fn record(simulation: &Simulation<'_>, response: &Response, watch: &dyn Fn(f64) -> bool) -> Run {
    let casing = simulation.casing.map(|casing| Casing { ramp_revolutions: 0.0, ..casing.clone() });
    let grown = |of: &EngineOrderExcitation| EngineOrderExcitation { ramp_revolutions: 0.0, ..of.clone() };
    let excitation: Vec<_> = simulation.effects.excitation.iter().map(grown).collect();
    let (window, wanted) = (simulation.window_revolutions, simulation.revolutions);
    // A window of no whole periods is recorded as it is.
    let period = if window.is_multiple_of(response.period) { response.period } else { window };
    let of = |revolutions: usize| Simulation {
        casing: casing.as_ref(),
        effects: Effects { excitation: &excitation, ..simulation.effects },
        initial: &[],
        revolutions,
        window_revolutions: period,
        repeats: None,
        detail: None,
        states: None,
        ..*simulation
    };
    let alike = |revolution: usize| revolution % response.period;
    let mut run = of(alike(wanted - window) + period).go_on(&response.start, watch);
    let bounds = |asked: Revolutions| asked.of(wanted, None);
    let first = |asked: Revolutions| {
        let (from, to) = bounds(asked);
        Revolutions::Between(alike(from), alike(from) + to - from)
    };
    let last = |asked: Revolutions| first(asked).of(wanted, None).1;
    let detail = simulation.detail;
    let asked = detail.map(|detail| detail.revolutions).into_iter().chain(simulation.states);
    if let (Some(revolutions), Outcome::Completed(history)) = (asked.map(last).max(), &mut run.outcome) {
        let recorded = Simulation {
            detail: detail.map(|detail| Detail { revolutions: first(detail.revolutions), ..detail }),
            states: simulation.states.map(first),
            window_revolutions: 1,
            ..of(revolutions)
        };
        let skipped = simulation.states.map_or(0, |asked| bounds(asked).0 - alike(bounds(asked).0));
        match recorded.go_on(&response.start, watch).outcome {
            Outcome::Completed(recorded) => {
                history.detail = recorded.detail;
                history.states = recorded.states;
                for instant in history.states.iter_mut().flat_map(|states| &mut states.revolutions) {
                    *instant += skipped as f64;
                }
            }
            other => run.outcome = other,
        }
    }
    run.repeated(period, wanted, window)
}
