//! Periodic responses: fixed points of the map over a passage.
//!
//! Anderson acceleration first, which asks for nothing but the map; where it stalls, Newton's method with the exact derivative, whose
//! equations are solved by their products.

use super::tangent::Tangent;
use crate::dynamics::integrate::{Passage, PassageError};
use rubmap_numerics::anderson::Anderson;
use rubmap_numerics::gmres;

/// Differences that Anderson acceleration looks back at.
pub(super) const DEPTH: usize = 60;

/// Passages within which the residual has to halve, or acceleration has stalled.
const PATIENCE: usize = 60;

/// What the equations of a Newton step are solved to, and their most products.
const SOLVED: f64 = 1e-4;
const PRODUCTS: usize = 200;

/// Shares of a Newton step that are tried.
const SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.1, 0.03];

/// Passages that a search takes beyond its most: of a Newton step the state's own, its last product, and all shares.
pub const MOST_BEYOND: u64 = 7;

/// How a periodic response is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// ‖P(x) − x‖ / ‖x‖ at which it is found, in the norm of energies.
    pub tolerance: f64,
    /// Passages that are taken as they come, before.
    pub marched: usize,
    /// Most passages, products of the derivative among them.
    pub most: usize,
}

/// A periodic response.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodic {
    /// x, as of [`Passage::state`].
    pub state: Vec<f64>,
    /// ‖P(x) − x‖ / ‖x‖.
    pub residual: f64,
}

/// None was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotFound {
    /// The search came no closer.
    #[error("no periodic response was found in {passages} passages: the best repeats to {residual:.1e}")]
    Stalled {
        /// Smallest ‖P(x) − x‖ / ‖x‖.
        residual: f64,
        /// That were taken.
        passages: usize,
    },
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// The map has no value where the search went.
    #[error(transparent)]
    Passage(#[from] PassageError),
}

/// The best state so far.
struct Best {
    state: Vec<f64>,
    image: Vec<f64>,
    residual: f64,
}

/// The periodic response that the search from `start` comes to. `go_on` is asked before every passage.
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
    let mut best = accelerate(passage, state, (search, before + search.most), go_on)?;
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
    (search, last): (&Search, usize),
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

/// (I − T)⁻¹ (P(x) − x), in at most `products` of T.
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

/// The largest share of `step` that comes closer.
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

/// ‖P(x) − x‖ / ‖x‖; 0 at rest.
pub(super) fn repeats(state: &[f64], image: &[f64]) -> f64 {
    let off: f64 = state.iter().zip(image).map(|(x, image)| (image - x).powi(2)).sum();
    let size: f64 = image.iter().map(|x| x * x).sum();
    if off == 0.0 { 0.0 } else { (off / size).sqrt() }
}
