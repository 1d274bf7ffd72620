//! Linear systems of which only products are known (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 1986), without restarts.

/// Solution of a linear system, with its residual.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Solution x.
    pub x: Vec<f64>,
    /// Relative residual ‖b − A x‖ / ‖b‖, as the recursion has it.
    pub residual: f64,
    /// Number of products that were asked for.
    pub products: usize,
}

/// Solves for x with ‖b − A x‖ ≤ `tolerance` ‖b‖, or the best of `most` products.
pub fn solve(
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    b: &[f64],
    tolerance: f64,
    most: usize,
) -> Solution {
    let scale = dot(b, b).sqrt();
    if scale == 0.0 {
        return Solution { x: vec![0.0; b.len()], residual: 0.0, products: 0 };
    }
    let mut basis = vec![b.iter().map(|value| value / scale).collect::<Vec<_>>()];
    // Columns of R, the rotations that made them, and the rotated right side.
    let (mut columns, mut rotations, mut side) =
        (Vec::<Vec<f64>>::new(), Vec::<(f64, f64)>::new(), vec![scale]);
    while columns.len() < most.min(b.len()) {
        let j = columns.len();
        let mut next = product(&basis[j]);
        let mut column = vec![0.0; j + 1];
        // Twice is enough.
        for _ in 0..2 {
            for (direction, entry) in basis.iter().zip(&mut column) {
                let along = dot(direction, &next);
                *entry += along;
                next.iter_mut().zip(direction).for_each(|(next, direction)| *next -= along * direction);
            }
        }
        let length = dot(&next, &next).sqrt();
        for (i, &(cos, sin)) in rotations.iter().enumerate() {
            let (upper, lower) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (cos * upper + sin * lower, cos * lower - sin * upper);
        }
        let hypotenuse = column[j].hypot(length);
        if hypotenuse == 0.0 {
            break;
        }
        let (cos, sin) = (column[j] / hypotenuse, length / hypotenuse);
        column[j] = hypotenuse;
        rotations.push((cos, sin));
        side.push(-sin * side[j]);
        side[j] *= cos;
        columns.push(column);
        if length <= f64::EPSILON * hypotenuse || side[j + 1].abs() <= tolerance * scale {
            break;
        }
        next.iter_mut().for_each(|value| *value /= length);
        basis.push(next);
    }
    let count = columns.len();
    let mut weights = side[..count].to_vec();
    for j in (0..count).rev() {
        weights[j] /= columns[j][j];
        for i in 0..j {
            weights[i] -= columns[j][i] * weights[j];
        }
    }
    let mut x = vec![0.0; b.len()];
    for (direction, weight) in basis.iter().zip(&weights) {
        x.iter_mut().zip(direction).for_each(|(x, direction)| *x += weight * direction);
    }
    Solution { x, residual: side[count].abs() / scale, products: count }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Product with a matrix that is not symmetric, with eigenvalues on both sides of zero.
    fn product(x: &[f64]) -> Vec<f64> {
        let n = x.len();
        let row = |i: usize| {
            let own = if i.is_multiple_of(3) { -2.0 } else { 1.0 + i as f64 };
            own * x[i] + if i + 1 < n { 0.5 * x[i + 1] } else { 0.0 }
                - if i > 0 { 0.2 * x[i - 1] } else { 0.0 }
        };
        (0..n).map(row).collect()
    }

    #[test]
    fn what_is_solved_is_the_system() {
        let b: Vec<f64> = (0..12).map(|i| (i as f64).sin()).collect();
        for (tolerance, most) in [(1e-12, 12), (1e-3, 12), (0.0, 4)] {
            let Solution { x, residual, products } = solve(product, &b, tolerance, most);
            let left: Vec<f64> = b.iter().zip(product(&x)).map(|(b, ax)| b - ax).collect();
            let left = (dot(&left, &left) / dot(&b, &b)).sqrt();
            assert!((left - residual).abs() < 1e-12, "{left} {residual}");
            assert!(products <= most && (residual <= tolerance.max(1e-12) || products == most));
        }
    }

    #[test]
    fn nothing_is_the_answer_to_nothing_and_one_product_that_to_the_identity() {
        assert_eq!(solve(product, &[0.0; 3], 1e-9, 3).x, [0.0; 3]);
        let identity = solve(<[f64]>::to_vec, &[3.0, -1.0], 1e-9, 2);
        assert!(identity.products == 1 && (identity.x[0] - 3.0).abs() < 1e-15);
    }
}
