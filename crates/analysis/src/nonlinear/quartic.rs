//! Search along a line on which the energy is a polynomial of fourth order.

/// Longest step, in steps of the quadratic part alone: a line that still falls there has no minimum.
const FARTHEST: f64 = 1e12;

/// Step at which the polynomial with these coefficients, in powers from 0 to 4, has its first minimum on the right of zero; none if it does
/// not fall there.
pub(super) fn first_minimum(coefficients: [f64; 5]) -> Option<f64> {
    let [_, c1, c2, c3, c4] = coefficients;
    let slope = |t: f64| c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4));
    if c1.is_nan() || c1 >= 0.0 {
        return None;
    }
    // The step of the quadratic part alone, or a unit step; short enough to pass over no minimum on the way up.
    let unit = if c2 > 0.0 { -0.5 * c1 / c2 } else { 1.0 };
    let (mut low, mut high) = (0.0, unit / 64.0);
    while slope(high) < 0.0 {
        (low, high) = (high, 1.25 * high);
        if high > FARTHEST * unit {
            return None;
        }
    }
    while high - low > 4.0 * f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if slope(middle) < 0.0 {
            low = middle
        } else {
            high = middle
        }
        if middle == low && 0.5 * (low + high) == low {
            break;
        }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_minimum_is_found_and_rising_lines_have_none() {
        // (t − 1)²(t − 3)²: the first of two minima.
        let found = first_minimum([9.0, -24.0, 22.0, -8.0, 1.0]).unwrap();
        assert!((found - 1.0).abs() < 1e-12, "{found}");
        let parabola = first_minimum([5.0, -3.0, 2.0, 0.0, 0.0]).unwrap();
        assert!((parabola - 0.75).abs() < 1e-14, "{parabola}");
        assert_eq!(first_minimum([0.0, 1.0, 1.0, 0.0, 1.0]), None);
        assert_eq!(first_minimum([0.0, -1.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(first_minimum([f64::NAN; 5]), None);
    }
}
