//! Assignment of rows to columns by the shares that they have of each other.

use faer::MatRef;

/// Assigns a column of its own to every row of `shares`: pairs in descending order of their share, equal ones in ascending distance of row and
/// column.
///
/// Rows and columns of shares between two orthonormal bases add up to one. Two columns then cannot both have more than half of a row, nor two rows of a
/// column: all such pairs are assigned to each other, whatever the order in which they are taken.
pub fn assign(shares: MatRef<'_, f64>) -> Vec<usize> {
    let (rows, columns) = (shares.nrows(), shares.ncols());
    let mut pairs: Vec<(usize, usize)> =
        (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))).collect();
    pairs.sort_by(|&a, &b| {
        let distance = |(row, column): (usize, usize)| row.abs_diff(column);
        shares[b].total_cmp(&shares[a]).then(distance(a).cmp(&distance(b))).then(a.cmp(&b))
    });
    let mut found = vec![None; rows];
    let mut taken = vec![false; columns];
    for (row, column) in pairs {
        if found[row].is_none() && !taken[column] {
            found[row] = Some(column);
            taken[column] = true;
        }
    }
    // Only rows beyond the number of columns are left.
    found.into_iter().enumerate().map(|(row, column)| column.unwrap_or(row)).collect()
}

#[cfg(test)]
mod tests {
    use faer::mat;

    use super::*;

    #[test]
    fn takes_the_largest_shares() {
        let shares = mat![[0.1, 0.9, 0.0], [0.8, 0.1, 0.1], [0.1, 0.0, 0.9]];
        assert_eq!(assign(shares.as_ref()), [1, 0, 2]);
    }

    /// The sum over all rows would be larger the other way round, with shares below one half.
    #[test]
    fn shares_of_more_than_half_are_assigned_to_each_other() {
        let shares = mat![[0.52, 0.48, 0.0], [0.48, 0.0, 0.52], [0.0, 0.52, 0.48]];
        assert_eq!(assign(shares.as_ref()), [0, 2, 1]);
    }

    #[test]
    fn equal_shares_keep_their_order() {
        let shares = mat![[0.5, 0.5], [0.5, 0.5]];
        assert_eq!(assign(shares.as_ref()), [0, 1]);
    }
}
