//! Periodic responses: fixed points of the map over a passage.
//!
//! Anderson acceleration first, which asks for nothing but the map; where it stalls, Newton's method with the exact derivative, whose
//! equations are solved by their products.

use super::tangent::Tangent;
use crate::dynamics::integrate::{Passage, PassageError};
use rubmap_numerics::anderson::Anderson;
use rubmap_numerics::gmres;

/// Differences that Anderson acceleration looks back at.
const DEPTH: usize = 60;

/// Passages within which the residual has to halve, or acceleration has stalled.
const PATIENCE: usize = 60;

/// What the equations of a Newton step are solved to, and their most products.
const SOLVED: f64 = 1e-4;
const PRODUCTS: usize = 200;

/// Shares of a Newton step that are tried.
const SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.1, 0.03];

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
    /// Passages that it took.
    pub passages: usize,
    /// Products of the derivative among them.
    pub products: usize,
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

impl NotFound {
    /// Passages that were taken before; 0 where the map ended the search.
    pub(super) fn passages(&self) -> usize {
        match self {
            Self::Stalled { passages, .. } => *passages,
            Self::Cancelled | Self::Passage(_) => 0,
        }
    }
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
    let mut state = start.to_vec();
    let mut passages = 0;
    for _ in 0..search.marched {
        state = passage.map(&state)?;
        passages += 1;
    }
    let mut best = accelerate(passage, state, search, &mut passages, go_on)?;
    let mut products = 0;
    while best.residual > search.tolerance {
        if !go_on() {
            return Err(NotFound::Cancelled);
        }
        let stalled = NotFound::Stalled { residual: best.residual, passages: passages + products };
        if passages + products >= search.most {
            return Err(stalled);
        }
        let step = newton_step(passage, &best, &mut products)?;
        passages += 1;
        let Some(better) = along(passage, &best, &step, &mut passages) else { return Err(stalled) };
        best = better;
    }
    Ok(Periodic { state: best.state, residual: best.residual, passages: passages + products, products })
}

fn accelerate(
    passage: &mut Passage<'_>,
    mut state: Vec<f64>,
    search: &Search,
    passages: &mut usize,
    go_on: &dyn Fn() -> bool,
) -> Result<Best, NotFound> {
    let mut anderson = Anderson::new(DEPTH);
    let mut image = passage.map(&state)?;
    *passages += 1;
    let mut best = Best { residual: repeats(&state, &image), state: state.clone(), image: image.clone() };
    let (mut since, mut wanted) = (0, 0.5 * best.residual);
    while best.residual > search.tolerance && since < PATIENCE && *passages < search.most {
        if !go_on() {
            return Err(NotFound::Cancelled);
        }
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
        *passages += 1;
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

/// (I − T)⁻¹ (P(x) − x).
fn newton_step(passage: &mut Passage<'_>, at: &Best, products: &mut usize) -> Result<Vec<f64>, PassageError> {
    // What touches on its way is to be that of this state.
    passage.map(&at.state)?;
    let tangent = Tangent::of(passage);
    let off: Vec<f64> = at.image.iter().zip(&at.state).map(|(image, x)| image - x).collect();
    let product = |x: &[f64]| {
        let mut moved = x.to_vec();
        tangent.follow(&mut moved);
        x.iter().zip(moved).map(|(x, moved)| x - moved).collect()
    };
    let solution = gmres::solve(product, &off, SOLVED, PRODUCTS);
    *products += solution.products;
    Ok(solution.x)
}

/// The largest share of `step` that comes closer.
fn along(passage: &mut Passage<'_>, from: &Best, step: &[f64], passages: &mut usize) -> Option<Best> {
    for share in SHARES {
        let state: Vec<f64> = from.state.iter().zip(step).map(|(x, step)| x + share * step).collect();
        *passages += 1;
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
