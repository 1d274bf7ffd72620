//! Cache-aligned storage of numbers for wide vectors.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line and of the widest vector.
const LINE: usize = 64;

/// Numbers that start at the beginning of a cache line, so that a wide vector never straddles two lines, which would halve the bandwidth of
/// a product.
#[derive(Debug)]
pub struct Aligned {
    values: Vec<f64>,
    start: usize,
}

impl Aligned {
    /// Storage of `length` zeros.
    pub fn zeros(length: usize) -> Self {
        let mut values = vec![0.0; length + LINE / size_of::<f64>()];
        let start = values.as_ptr().align_offset(LINE).min(LINE / size_of::<f64>());
        values.truncate(start + length);
        Self { values, start }
    }
}

impl From<&[f64]> for Aligned {
    fn from(values: &[f64]) -> Self {
        let mut aligned = Self::zeros(values.len());
        aligned.copy_from_slice(values);
        aligned
    }
}

impl Clone for Aligned {
    fn clone(&self) -> Self {
        Self::from(&**self)
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values[self.start..]
    }
}

impl DerefMut for Aligned {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[self.start..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn begins_on_a_line_wherever_it_is_allocated() {
        for length in [0, 1, 7, 8, 1000] {
            let mut numbers = Aligned::zeros(length);
            numbers.iter_mut().enumerate().for_each(|(i, x)| *x = i as f64);
            let copy = numbers.clone();
            for numbers in [&numbers, &copy] {
                assert_eq!(numbers.as_ptr().addr() % LINE, 0);
                assert!(numbers.iter().enumerate().all(|(i, &x)| x == i as f64) && numbers.len() == length);
            }
        }
    }
}
