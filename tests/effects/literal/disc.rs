//! Coulomb's disc by repetition: normal forces under the friction there is, friction moved towards its sliding and cut to the disc,
//! until neither changes.

use nalgebra::{DMatrix, DVector};

use super::contact::{self, Law};

/// Largest number of rounds; a place that sticks takes as many as W is large over what it does least.
const MOST: usize = 200_000;

/// Forces λ, and friction along both tangents of every place. `w` is the motion along the normals and both tangents
/// (`[direction][place]`) by forces along the same; `q` are the gaps and `free` the sliding without any force, [tangent][place].
pub(super) fn solve(
    w: &DMatrix<f64>,
    q: &DVector<f64>,
    free: &DVector<f64>,
    mu: f64,
) -> (DVector<f64>, DVector<f64>) {
    let places = q.len();
    let block = |row: usize, column: usize, rows: usize, columns: usize| {
        w.view((row * places, column * places), (rows * places, columns * places)).into_owned()
    };
    let (normal, lifts) = (block(0, 0, 1, 1), block(0, 1, 1, 2));
    let (pulls, shears) = (block(1, 0, 2, 1), block(1, 1, 2, 2));
    let stride = 1.0 / shears.norm();
    let mut friction = DVector::zeros(2 * places);
    let mut lambda: DVector<f64> = DVector::zeros(places);
    for _ in 0..MOST {
        let before = (lambda.clone(), friction.clone());
        lambda = contact::solve(&normal, &(q + &lifts * &friction), |_| Law::wall());
        let sliding = free - &pulls * &lambda - &shears * &friction;
        for place in 0..places {
            let aim = [place, places + place].map(|row| friction[row] + stride * sliding[row]);
            let (size, most) = (aim[0].hypot(aim[1]), mu * lambda[place]);
            let share = if size > most { most / size } else { 1.0 };
            friction[place] = share * aim[0];
            friction[places + place] = share * aim[1];
        }
        let change = (&lambda - before.0).amax() + (&friction - before.1).amax();
        if change <= 1e-15 * lambda.amax() {
            return (lambda, friction);
        }
    }
    panic!("friction does not come to rest");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::Numbers;

    /// Problems are made from their solutions: places that are open, stick and slide.
    #[test]
    fn finds_the_solution_a_problem_was_made_from() {
        let mut numbers = Numbers::new(5);
        for round in 0..30 {
            let root = DMatrix::from_fn(9, 9, |_, _| numbers.next() - 0.5);
            let w = &root * root.transpose() + DMatrix::identity(9, 9) * 0.3;
            let mu = 0.1;
            let (mut x, mut y) = (DVector::zeros(9), DVector::zeros(9));
            for place in 0..3 {
                let (sin, cos) = (6.0 * numbers.next()).sin_cos();
                let lambda = 0.2 + numbers.next();
                let (force, sliding) = match (round + place) % 3 {
                    0 => {
                        y[place] = numbers.next();
                        continue;
                    }
                    1 => (0.9 * numbers.next(), 0.0),
                    _ => (1.0, numbers.next()),
                };
                x[place] = lambda;
                for (tangent, direction) in [cos, sin].into_iter().enumerate() {
                    x[3 * (tangent + 1) + place] = mu * lambda * force * direction;
                    y[3 * (tangent + 1) + place] = -sliding * direction;
                }
            }
            let known = y - &w * &x;
            let (q, free) = (known.rows(0, 3).into_owned(), -known.rows(3, 6).into_owned());
            let (lambda, friction) = solve(&w, &q, &free, mu);
            assert!((lambda - x.rows(0, 3)).amax() < 1e-12);
            assert!((friction - x.rows(3, 6)).amax() < 1e-12);
        }
    }
}
