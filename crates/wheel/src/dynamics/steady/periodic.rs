//! Periodic responses: fixed points of a return map.
//!
//! Anderson acceleration comes first, which needs nothing but the map; where it stalls, Newton's method with the exact derivative, whose
//! equations are solved by products.

use super::tangent::Tangent;
use crate::dynamics::integrate::{Passage, PassageError};
use rubmap_numerics::anderson::Anderson;
use rubmap_numerics::gmres;

/// Number of differences that Anderson acceleration uses.
pub(super) const DEPTH: usize = 60;

/// Number of maps within which the residual has to halve, or acceleration has stalled.
const PATIENCE: usize = 60;

/// Tolerance to which the equations of a Newton step are solved, and their most products.
const SOLVED: f64 = 1e-4;
const PRODUCTS: usize = 200;

/// Shares of a Newton step that are tried.
const SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.1, 0.03];

/// Number of maps that a search takes beyond its most: of a Newton step the state's own, its last product, and all shares.
pub const MOST_BEYOND: u64 = 7;

/// Settings of the search for a periodic response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Residual ‖P(x) − x‖ / ‖x‖ at which a response is found, in the norm of energies.
    pub tolerance: f64,
    /// Number of maps that are taken as they come, before acceleration begins.
    pub marched: usize,
    /// Largest number of maps, products of the derivative among them.
    pub most: usize,
}

/// Periodic response.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodic {
    /// State x, as of [`Passage::state`].
    pub state: Vec<f64>,
    /// Residual ‖P(x) − x‖ / ‖x‖.
    pub residual: f64,
}

/// Reason why no periodic response was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotFound {
    /// Search that came no closer.
    #[error("no periodic response was found in {passages} passages: the best repeats to {residual:.1e}")]
    Stalled {
        /// Smallest residual ‖P(x) − x‖ / ‖x‖.
        residual: f64,
        /// Number of maps that were taken.
        passages: usize,
    },
    /// Search that the caller stopped.
    #[error("cancelled")]
    Cancelled,
    /// Map that has no value where the search went.
    #[error(transparent)]
    Passage(#[from] PassageError),
}

/// Best state so far.
struct Best {
    state: Vec<f64>,
    image: Vec<f64>,
    residual: f64,
}

/// Finds the periodic response that the search from `start` converges to. `go_on` is asked before every map.
///
/// # Errors
/// [`NotFound`].
pub fn find(
    passage: &mut Passage<'_>,
    start: &[f64],
    search: &Search,
    go_on: &dyn Fn() -> bool,
) -> Result<Periodic, NotFound> {
    let before = passage.taken();
    let mut state = start.to_vec();
    for _ in 0..search.marched {
        asked(go_on)?;
        state = passage.map(&state)?;
    }
    let mut best = accelerate(passage, state, search, before + search.most, go_on)?;
    while best.residual > search.tolerance {
        asked(go_on)?;
        let stalled = |passage: &Passage<'_>| NotFound::Stalled {
            residual: best.residual,
            passages: passage.taken() - before,
        };
        if passage.taken() - before >= search.most {
            return Err(stalled(passage));
        }
        let left = search.most.saturating_sub(passage.taken() - before);
        let step = newton_step(passage, &best, left)?;
        let Some(better) = along(passage, &best, &step) else { return Err(stalled(passage)) };
        best = better;
    }
    Ok(Periodic { state: best.state, residual: best.residual })
}

fn asked(go_on: &dyn Fn() -> bool) -> Result<(), NotFound> {
    if go_on() { Ok(()) } else { Err(NotFound::Cancelled) }
}

fn accelerate(
    passage: &mut Passage<'_>,
    mut state: Vec<f64>,
    search: &Search,
    last: usize,
    go_on: &dyn Fn() -> bool,
) -> Result<Best, NotFound> {
    let mut anderson = Anderson::new(DEPTH);
    let mut image = passage.map(&state)?;
    let mut best = Best { residual: repeats(&state, &image), state: state.clone(), image: image.clone() };
    let (mut since, mut wanted) = (0, 0.5 * best.residual);
    while best.residual > search.tolerance && since < PATIENCE && passage.taken() < last {
        asked(go_on)?;
        state = anderson.next(&state, &image);
        image = match passage.map(&state) {
            Ok(image) => image,
            // An extrapolation that led nowhere: on from the best, without the past.
            Err(_) => {
                anderson.restart();
                state.clone_from(&best.state);
                best.image.clone()
            }
        };
        since += 1;
        let residual = repeats(&state, &image);
        if residual < best.residual {
            best = Best { state: state.clone(), image: image.clone(), residual };
        }
        if residual < wanted {
            (since, wanted) = (0, 0.5 * residual);
        }
    }
    Ok(best)
}

/// Newton step (I − T)⁻¹ (P(x) − x), in at most `products` of T.
fn newton_step(passage: &mut Passage<'_>, at: &Best, products: usize) -> Result<Vec<f64>, PassageError> {
    // What touches on its way is to be that of this state.
    passage.map(&at.state)?;
    let tangent = Tangent::of(passage);
    let off: Vec<f64> = at.image.iter().zip(&at.state).map(|(image, x)| image - x).collect();
    let product = |x: &[f64]| {
        let mut moved = x.to_vec();
        tangent.follow(&mut moved);
        x.iter().zip(moved).map(|(x, moved)| x - moved).collect()
    };
    Ok(gmres::solve(product, &off, SOLVED, PRODUCTS.min(products)).x)
}

/// State at the largest share of `step` that comes closer.
fn along(passage: &mut Passage<'_>, from: &Best, step: &[f64]) -> Option<Best> {
    for share in SHARES {
        let state: Vec<f64> = from.state.iter().zip(step).map(|(x, step)| x + share * step).collect();
        let Ok(image) = passage.map(&state) else { continue };
        let residual = repeats(&state, &image);
        if residual < (1.0 - 0.1 * share) * from.residual {
            return Some(Best { state, image, residual });
        }
    }
    None
}

/// Residual ‖P(x) − x‖ / ‖x‖; 0 at rest.
pub(super) fn repeats(state: &[f64], image: &[f64]) -> f64 {
    let off: f64 = state.iter().zip(image).map(|(x, image)| (image - x).powi(2)).sum();
    let size: f64 = image.iter().map(|x| x * x).sum();
    if off == 0.0 { 0.0 } else { (off / size).sqrt() }
}
