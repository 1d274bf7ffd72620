//! Curves thinned to the samples that a screen shows.

/// Approximate number of samples of all curves of a figure together.
const MOST: usize = 24_000;

/// Thins a curve, from left to right, one of `curves`: of each stretch with too many samples the lowest and the highest are left, in their
/// order. Returns it with the number of samples per stretch.
pub(super) fn thinned(places: Vec<(f64, f64)>, curves: usize) -> (Vec<(f64, f64)>, usize) {
    let together = (2 * places.len()).div_ceil((MOST / curves.max(1)).max(500));
    if together <= 2 {
        return (places, 1);
    }
    let mut left = Vec::with_capacity(2 * places.len().div_ceil(together));
    for stretch in places.chunks(together) {
        let numbers = || stretch.iter().enumerate().filter(|(_, place)| place.1.is_finite());
        let lowest = numbers().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let highest = numbers().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        match lowest.zip(highest) {
            Some(((a, _), (b, _))) => left.extend([stretch[a.min(b)], stretch[a.max(b)]]),
            None => left.push((stretch[0].0, f64::NAN)),
        }
    }
    (left, together)
}

/// Note that a figure shows only the extremes of every `together` samples.
pub(super) fn words(together: usize) -> Option<String> {
    (together > 1).then(|| format!("of {together} samples each the lowest and the highest are drawn"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_stay_where_they_are() {
        let swing =
            |i: u32| (f64::from(i), (0.37 * f64::from(i)).sin() + if i == 77_777 { 9.0 } else { 0.0 });
        let all: Vec<(f64, f64)> = (0..100_000).map(swing).collect();
        let (left, together) = thinned(all.clone(), 1);
        assert!(left.len() <= MOST + 2 && together > 1, "{} {together}", left.len());
        assert!(left.contains(&swing(77_777)) && left.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        assert!(left.iter().all(|place| all[place.0 as usize] == *place));
        assert_eq!(thinned(all[..9].to_vec(), 3), (all[..9].to_vec(), 1));
    }
}
