//! Contact by trying combinations of branches: the one that Gauss–Seidel sweeps end on, and then every other.

use nalgebra::{DMatrix, DVector};

/// Straight piece of an obstacle's force over the penetration x: x = start + compliance·λ between two forces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) start: f64,
    pub(super) compliance: f64,
    pub(super) least_force: f64,
    pub(super) greatest_force: f64,
}

/// Pieces with a force, and the penetration up to which there is none.
#[derive(Debug, Clone)]
pub(super) struct Law {
    pub(super) free_to: f64,
    pub(super) pieces: Vec<Piece>,
}

impl Law {
    /// Law of a rigid wall.
    pub(super) fn wall() -> Self {
        let wall = Piece { start: 0.0, compliance: 0.0, least_force: 0.0, greatest_force: f64::INFINITY };
        Self { free_to: 0.0, pieces: vec![wall] }
    }
}

/// Round-off of a gap, mm.
const CLOSED: f64 = 1e-13;

/// Forces λ with a penetration x = −(q + Wλ) on the law of every place. Places that are free without any force are left
/// out until the forces of the others push them in.
pub(super) fn solve(w: &DMatrix<f64>, q: &DVector<f64>, law: impl Fn(usize) -> Law) -> DVector<f64> {
    let laws: Vec<_> = (0..q.len()).map(law).collect();
    let mut candidates: Vec<usize> = (0..q.len()).filter(|&i| q[i] < -laws[i].free_to).collect();
    loop {
        let lambda = enumerate(w, q, &laws, &candidates);
        let gap = q + w * &lambda;
        let pushed_in = |&i: &usize| !candidates.contains(&i) && -gap[i] > laws[i].free_to + CLOSED;
        let more: Vec<_> = (0..q.len()).filter(pushed_in).collect();
        if more.is_empty() {
            return lambda;
        }
        candidates.extend(more);
    }
}

/// Forces of the first combination that fits all candidates.
fn enumerate(w: &DMatrix<f64>, q: &DVector<f64>, laws: &[Law], candidates: &[usize]) -> DVector<f64> {
    let guess = sweep(w, q, laws, candidates);
    if let Some(lambda) = fits(w, q, laws, candidates, &guess) {
        return lambda;
    }
    let mut branch = vec![0usize; candidates.len()];
    loop {
        if let Some(lambda) = fits(w, q, laws, candidates, &branch) {
            return lambda;
        }
        let next = branch.iter().zip(candidates).position(|(&b, &i)| b < laws[i].pieces.len());
        let next = next.expect("W is a P-matrix: one combination fits");
        branch[next] += 1;
        branch[..next].fill(0);
    }
}

/// Branches that sweeps over the candidates end on, each place meeting its law while the others stay.
fn sweep(w: &DMatrix<f64>, q: &DVector<f64>, laws: &[Law], candidates: &[usize]) -> Vec<usize> {
    let mut lambda = DVector::zeros(q.len());
    let mut branch = vec![0; candidates.len()];
    for _ in 0..1000 {
        let mut change = 0.0f64;
        for (&i, branch) in candidates.iter().zip(&mut branch) {
            let others = w.row(i).transpose().dot(&lambda) - w[(i, i)] * lambda[i];
            let on = |piece: &Piece| -(q[i] + others + piece.start) / (w[(i, i)] + piece.compliance);
            let mut force = 0.0;
            *branch = 0;
            for (number, piece) in laws[i].pieces.iter().enumerate() {
                if on(piece) > piece.least_force {
                    (*branch, force) = (number + 1, on(piece));
                }
            }
            change = change.max((force - lambda[i]).abs() / (1.0 + force));
            lambda[i] = force;
        }
        if change < 1e-14 {
            break;
        }
    }
    branch
}

/// Forces if the candidates are on these branches (0: no force), unless one of them lies outside its own.
fn fits(
    w: &DMatrix<f64>,
    q: &DVector<f64>,
    laws: &[Law],
    candidates: &[usize],
    branch: &[usize],
) -> Option<DVector<f64>> {
    let on = |(&i, &b): (&usize, &usize)| (b > 0).then(|| (i, laws[i].pieces[b - 1]));
    let active: Vec<_> = candidates.iter().zip(branch).filter_map(on).collect();
    let matrix = DMatrix::from_fn(active.len(), active.len(), |r, c| {
        w[(active[r].0, active[c].0)] + if r == c { active[r].1.compliance } else { 0.0 }
    });
    let right = DVector::from_fn(active.len(), |r, _| -(q[active[r].0] + active[r].1.start));
    let solved = if active.is_empty() { right } else { matrix.lu().solve(&right)? };
    let mut lambda = DVector::zeros(q.len());
    for (&(i, piece), &force) in active.iter().zip(&solved) {
        // A force is known to a gap's round-off over what gives way.
        let slack = CLOSED / (w[(i, i)] + piece.compliance);
        if force < piece.least_force - slack || force > piece.greatest_force + slack {
            return None;
        }
        lambda[i] = force;
    }
    let gap = q + w * &lambda;
    let open = |(&i, &b): (&usize, &usize)| b > 0 || -gap[i] <= laws[i].free_to + CLOSED;
    candidates.iter().zip(branch).all(open).then_some(lambda)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::Numbers;

    /// Problems are made from their solutions: forces and penetrations on the laws give q = −x − Wλ.
    #[test]
    fn finds_the_solution_a_problem_was_made_from() {
        let mut numbers = Numbers::new(3);
        let coated = Law {
            free_to: 0.1,
            pieces: vec![
                Piece { start: 0.1, compliance: 0.5, least_force: 0.0, greatest_force: 0.4 },
                Piece { start: -0.9, compliance: 3.0, least_force: 0.4, greatest_force: 0.6 },
                Piece { start: 0.9, compliance: 0.0, least_force: 0.6, greatest_force: f64::INFINITY },
            ],
        };
        for law in [Law::wall(), coated] {
            for _ in 0..50 {
                let root = DMatrix::from_fn(4, 4, |_, _| numbers.next() - 0.5);
                let skew = DMatrix::from_fn(4, 4, |_, _| numbers.next() - 0.5);
                let w = &root * root.transpose()
                    + (&skew - skew.transpose()) * 0.2
                    + DMatrix::identity(4, 4) * 0.05;
                let lambda = DVector::from_fn(4, |_, _| (numbers.next() * 2.0 - 0.8).max(0.0));
                let penetration = DVector::from_fn(4, |i, _| {
                    let on = law.pieces.iter().find(|p| lambda[i] <= p.greatest_force).unwrap();
                    if lambda[i] > 0.0 {
                        on.start + on.compliance * lambda[i]
                    } else {
                        law.free_to - 0.01 - numbers.next()
                    }
                });
                let q = -penetration - &w * &lambda;
                let found = solve(&w, &q, |_| law.clone());
                assert!((found - &lambda).amax() < 1e-11, "{lambda}");
            }
        }
    }
}
