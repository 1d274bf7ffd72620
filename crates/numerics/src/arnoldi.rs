//! The largest eigenvalues of a matrix of which only products are known (Arnoldi, Quart. Appl. Math. 9, 1951), without restarts.

use faer::{Mat, c64};

/// Products between two checks of convergence.
const LOOKS: usize = 5;

/// An eigenvalue with its vector, of length 1.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Eigenvalue λ.
    pub value: c64,
    /// Eigenvector v.
    pub vector: Vec<c64>,
    /// Residual ‖A v − λ v‖, as the recursion has it.
    pub residual: f64,
}

/// Finds the `count` largest eigenvalues (one more where the last would be half of a conjugate pair), largest first. Ends once
/// `enough(place, value, residual)` holds for each of them, or after `most` products with the pairs as they are then.
pub fn largest(
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    start: &[f64],
    count: usize,
    most: usize,
    enough: impl Fn(usize, c64, f64) -> bool,
) -> Vec<Pair> {
    let scale = dot(start, start).sqrt();
    if scale == 0.0 {
        return Vec::new();
    }
    let mut basis = vec![start.iter().map(|value| value / scale).collect::<Vec<_>>()];
    let mut columns = Vec::<Vec<f64>>::new();
    loop {
        let size = columns.len() + 1;
        let mut next = product(&basis[size - 1]);
        let before = dot(&next, &next).sqrt();
        let mut column = vec![0.0; size];
        // Twice is enough.
        for _ in 0..2 {
            for (direction, entry) in basis.iter().zip(&mut column) {
                let along = dot(direction, &next);
                *entry += along;
                next.iter_mut().zip(direction).for_each(|(next, direction)| *next -= along * direction);
            }
        }
        let left = dot(&next, &next).sqrt();
        column.push(left);
        columns.push(column);
        let whole = left <= f64::EPSILON * before || size == start.len();
        let last = whole || size >= most;
        if last || size.is_multiple_of(LOOKS) {
            let found = Ritz::of(&columns);
            let told = found.told(count);
            let is_enough = |(place, &index): (usize, &usize)| {
                let (value, residual) = found.pair(index);
                enough(place, value, residual)
            };
            if last || (told.len() >= count && told.iter().enumerate().all(is_enough)) {
                return told.into_iter().map(|index| found.lifted(index, &basis)).collect();
            }
        }
        next.iter_mut().for_each(|value| *value /= left);
        basis.push(next);
    }
}

/// Eigenpairs of the projection on the basis.
struct Ritz {
    values: Vec<c64>,
    vectors: Mat<c64>,
    /// Length of the part of the last product that lies outside the basis.
    left: f64,
}

impl Ritz {
    fn of(columns: &[Vec<f64>]) -> Self {
        let size = columns.len();
        let projected = Mat::from_fn(size, size, |i, j| columns[j].get(i).copied().unwrap_or(0.0));
        match projected.eigen() {
            Ok(eigen) => Self {
                values: eigen.S().column_vector().iter().copied().collect(),
                vectors: eigen.U().to_owned(),
                left: columns[size - 1][size],
            },
            Err(_) => Self { values: Vec::new(), vectors: Mat::zeros(size, 0), left: 0.0 },
        }
    }

    /// Indices of the `count` largest eigenvalues, and of the conjugate of the last.
    fn told(&self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|&a, &b| self.values[b].norm().total_cmp(&self.values[a].norm()));
        if order.len() > count && self.values[order[count]] == self.values[order[count - 1]].conj() {
            order.truncate(count + 1);
        } else {
            order.truncate(count);
        }
        order
    }

    fn pair(&self, index: usize) -> (c64, f64) {
        let vector = self.vectors.col(index);
        (self.values[index], self.left * vector[vector.nrows() - 1].norm() / vector.norm_l2())
    }

    fn lifted(&self, index: usize, basis: &[Vec<f64>]) -> Pair {
        let (value, residual) = self.pair(index);
        let weights = self.vectors.col(index);
        let scale = 1.0 / weights.norm_l2();
        let entry = |i: usize| {
            let sum: c64 =
                basis.iter().zip(weights.iter()).map(|(direction, weight)| *weight * direction[i]).sum();
            sum * scale
        };
        Pair { value, residual, vector: (0..basis[0].len()).map(entry).collect() }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Product with blocks r (cos φ, −sin φ; sin φ, cos φ) with r = 1, 0.99, 0.98 …, coupled to the block after.
    fn product(x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for k in 0..x.len() / 2 {
            let (r, (sin, cos)) = (1.0 - 0.01 * k as f64, (0.3 + 0.7 * k as f64).sin_cos());
            let (a, b) = (x[2 * k], x[2 * k + 1]);
            y[2 * k] = r * (cos * a - sin * b) + 0.1 * x.get(2 * k + 2).unwrap_or(&0.0);
            y[2 * k + 1] = r * (sin * a + cos * b);
        }
        y
    }

    #[test]
    fn the_largest_of_many_that_lie_close_are_found() {
        let size = 120;
        let found = largest(product, &vec![1.0; size], 3, size, |_, _, residual| residual < 1e-8);
        // The third has its conjugate beside it.
        assert_eq!(found.len(), 4);
        for (j, Pair { value, vector, residual }) in found.iter().enumerate() {
            assert!(*residual < 1e-8);
            assert!((value.norm() - (1.0 - 0.01 * (j / 2) as f64)).abs() < 1e-7, "{value}");
            let parts = |of: fn(&c64) -> f64| product(&vector.iter().map(of).collect::<Vec<_>>());
            let (re, im) = (parts(|v| v.re), parts(|v| v.im));
            let left: f64 = (0..size).map(|i| (c64::new(re[i], im[i]) - value * vector[i]).norm_sqr()).sum();
            assert!(left.sqrt() < 1e-7, "{left}");
        }
    }

    #[test]
    fn a_space_that_is_mapped_to_itself_says_all_it_knows() {
        let product = |x: &[f64]| vec![2.0 * x[0], -3.0 * x[1], x[2]];
        let found = largest(product, &[1.0, 1.0, 0.0], 3, 10, |_, _, residual| residual < 1e-12);
        let values: Vec<f64> = found.iter().map(|pair| pair.value.re).collect();
        assert!(values.len() == 2 && found.iter().all(|pair| pair.residual < 1e-12));
        assert!((values[0] + 3.0).abs() < 1e-12 && (values[1] - 2.0).abs() < 1e-12);
        assert!(largest(<[f64]>::to_vec, &[0.0; 2], 1, 3, |_, _, _| true).is_empty());
    }
}
