//! Responses at light damping, followed from heavier damping.
//!
//! Motion that decays slowly keeps the search from coming close enough for Newton's method. With several times the damping the response is
//! found from where the march begins; from there it is followed in geometric steps, each solved from the one before, a step that fails
//! being halved (its ratio replaced by the root).

use super::periodic::{NotFound, Periodic, Search, find};
use crate::dynamics::integrate::{Passage, Simulation};
use crate::dynamics::oscillators::ModalDamping;

/// Factors of the damping with which a response is sought first.
const HEAVIER: [f64; 2] = [4.0, 16.0];

/// Largest ζ of any mode with such a factor: beyond 1 nothing vibrates.
const MOST_DAMPING: f64 = 0.5;

/// First ratio of the damping before a step to that after it.
const STEP: f64 = 2.0;

/// Least ratio of a step: where even this step fails the branch has ended, or turned.
const LEAST_STEP: f64 = 1.02;

/// Response, and the factor of the damping of its scene from which it was followed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ContinuedResponse {
    pub(super) periodic: Periodic,
    pub(super) from: f64,
}

/// Follows the periodic response that the search from `start` finds with heavier damping to that of the scene of `simulation`, until
/// `search.most` maps are `taken`.
///
/// # Errors
/// [`NotFound`]: of the search with the heaviest damping, or of the last step; at once for a scene without damping.
pub(super) fn follow(
    simulation: &Simulation<'_>,
    start: &[f64],
    search: &Search,
    taken: &mut usize,
    go_on: &dyn Fn() -> bool,
) -> Result<ContinuedResponse, NotFound> {
    let stalled = |taken: usize| NotFound::Stalled { residual: f64::INFINITY, passages: taken };
    let Some(light) = simulation.damping else { return Err(stalled(*taken)) };
    let mut solve = |factor: f64, start: &[f64], marched: usize| {
        let damping = times(light, factor);
        let mut passage = Passage::about_half(&Simulation { damping: Some(&damping), ..*simulation })?;
        let left = Search { marched, most: search.most.saturating_sub(*taken), ..*search };
        if left.most == 0 || passage.size() != start.len() {
            return Err(stalled(*taken));
        }
        let found = find(&mut passage, start, &left, go_on);
        *taken += passage.taken();
        found
    };
    let ratios = light.family_ratios.iter().chain([&light.modal_ratio]);
    let largest = ratios.copied().fold(0.0, f64::max);
    let mut sought = Err(stalled(0));
    for from in HEAVIER.into_iter().filter(|from| largest > 0.0 && from * largest <= MOST_DAMPING) {
        sought = solve(from, start, search.marched).map(|periodic| ContinuedResponse { periodic, from });
        if matches!(sought, Ok(_) | Err(NotFound::Cancelled)) {
            break;
        }
    }
    let ContinuedResponse { mut periodic, from } = sought?;
    let (mut factor, mut step) = (from, STEP);
    while factor > 1.0 {
        let next = (factor / step).max(1.0);
        match solve(next, &periodic.state, 0) {
            Ok(nearer) => {
                (periodic, factor) = (nearer, next);
                step = (step * step).min(STEP);
            }
            Err(reason) => {
                step = step.sqrt();
                if step < LEAST_STEP || reason == NotFound::Cancelled {
                    return Err(reason);
                }
            }
        }
    }
    Ok(ContinuedResponse { periodic, from })
}

fn times(damping: &ModalDamping, factor: f64) -> ModalDamping {
    ModalDamping {
        modal_ratio: factor * damping.modal_ratio,
        family_ratios: damping.family_ratios.iter().map(|ratio| factor * ratio).collect(),
        ranks: damping.ranks.clone(),
    }
}
