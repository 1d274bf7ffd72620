//! Cells merged to as many as a screen shows.

/// Columns and rows of a figure: about what a screen shows.
pub(super) const MOST: (usize, usize) = (500, 200);

/// Number of neighbouring columns or rows merged into one, so that of `parts` at most `most` are left.
pub(super) fn together(parts: usize, most: usize) -> usize {
    parts.div_ceil(most).max(1)
}
