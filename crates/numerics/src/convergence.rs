//! The order at which a quantity converges, from the differences between its values at three levels.

/// Range of orders that are searched.
const LOWEST: f64 = 0.05;
const HIGHEST: f64 = 12.0;

/// Difference of quantities of size 1 below which it is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Order p at which the differences between successive levels fall, where the step is 1/n and `n` ascends.
///
/// With Q(h) = Q₀ + C hᵖ the differences d₀ = |Q(1/n₀) − Q(1/n₁)| and d₁ = |Q(1/n₁) − Q(1/n₂)| fulfil
/// d₀/d₁ = (n₀⁻ᵖ − n₁⁻ᵖ)/(n₁⁻ᵖ − n₂⁻ᵖ), which grows with p. None where they are round-off or fall at no such order.
pub fn observed_order(n: [f64; 3], differences: [f64; 2]) -> Option<f64> {
    if !differences.iter().all(|&difference| difference > ROUND_OFF) {
        return None;
    }
    let wanted = differences[0] / differences[1];
    let ratio = |p: f64| {
        // In units of the middle level: no power overflows.
        let [coarse, fine] = [n[0] / n[1], n[2] / n[1]].map(|n| n.powf(-p));
        (coarse - 1.0) / (1.0 - fine)
    };
    if !(ratio(LOWEST)..=ratio(HIGHEST)).contains(&wanted) {
        return None;
    }
    let (mut low, mut high) = (LOWEST, HIGHEST);
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        if ratio(middle) < wanted { low = middle } else { high = middle }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_order_on_even_and_uneven_levels() {
        for n in [[100.0, 200.0, 400.0], [520.0, 1040.0, 3640.0], [1.0, 10.0, 11.0]] {
            for p in [0.5, 1.0, 2.0, 4.0] {
                let value = |n: f64| 3.0 * n.powf(-p);
                let differences = [value(n[0]) - value(n[1]), value(n[1]) - value(n[2])];
                let found = observed_order(n, differences).unwrap();
                assert!((found - p).abs() < 1e-6, "{n:?} {p} {found}");
            }
        }
    }

    #[test]
    fn differences_that_do_not_fall_have_no_order() {
        assert_eq!(observed_order([1.0, 2.0, 4.0], [1e-3, 1e-3]), None);
        assert_eq!(observed_order([1.0, 2.0, 4.0], [1e-15, 1e-16]), None);
        assert_eq!(observed_order([1.0, 2.0, 4.0], [1e-3, 0.0]), None);
    }
}
