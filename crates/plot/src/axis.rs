//! Axes: scales from values to positions in the drawing, and their ticks.

/// Linear or logarithmic map from values to positions in the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// Values at the two ends.
    pub(super) values: (f64, f64),
    /// Positions of the two ends in the drawing.
    places: (f64, f64),
    logarithmic: bool,
}

impl Scale {
    pub(super) fn linear(values: (f64, f64), places: (f64, f64)) -> Self {
        Self { values, places, logarithmic: false }
    }

    /// Builds a logarithmic scale; both values must be positive.
    pub(super) fn logarithmic(values: (f64, f64), places: (f64, f64)) -> Self {
        Self { values, places, logarithmic: true }
    }

    /// Relative position of a value between the ends: 0 at the first, 1 at the second.
    pub(super) fn share(&self, value: f64) -> f64 {
        let (low, high) = self.values;
        if self.logarithmic { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
    }

    pub(super) fn place(&self, value: f64) -> f64 {
        self.places.0 + self.share(value) * (self.places.1 - self.places.0)
    }

    /// Value at a position on a linear scale.
    pub(super) fn value(&self, place: f64) -> f64 {
        let share = (place - self.places.0) / (self.places.1 - self.places.0);
        self.values.0 + share * (self.values.1 - self.values.0)
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        (self.values.0..=self.values.1).contains(&value)
    }
}

/// Multiples of 1, 2 or 5 times a power of ten between `low` and `high`, about `wanted` of them, each with its label.
pub(super) fn ticks((low, high): (f64, f64), wanted: f64) -> Vec<(f64, String)> {
    let rough = (high - low) / wanted;
    if !(rough.is_finite() && rough > 0.0) {
        return vec![(low, label(low, 0))];
    }
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= 0.999 * rough);
    let step = step.unwrap_or(10.0 * power);
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| (i as f64 * step, label(i as f64 * step, decimals))).collect()
}

/// 1, 2 and 5 times the powers of ten between two positive values.
pub(super) fn logarithmic_ticks((low, high): (f64, f64)) -> Vec<(f64, String)> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let values = (first..=last).flat_map(|power| [1.0, 2.0, 5.0].map(|m| (m, power)));
    let values = values.map(|(m, power)| (m * 10f64.powi(power), power));
    values
        .filter(|(value, _)| (0.999 * low..=1.001 * high).contains(value))
        .map(|(value, power)| match power {
            -4..=3 => (value, label(value, (-power).max(0) as usize)),
            _ => (value, format!("{value:.0e}")),
        })
        .collect()
}

/// Ticks as of [`logarithmic_ticks`], or at the powers of ten alone where those would be more than `most`.
pub(super) fn decades(range: (f64, f64), most: usize) -> Vec<(f64, String)> {
    let mut ticks = logarithmic_ticks(range);
    if ticks.len() > most {
        ticks.retain(|(value, _)| (value.log10() - value.log10().round()).abs() < 1e-6);
    }
    ticks
}

/// Ticks at the eighths of a circle, in degrees.
pub(super) fn eighths() -> Vec<(f64, String)> {
    (0..=8).map(|i| (45.0 * f64::from(i), format!("{}°", 45 * i))).collect()
}

/// Formats a number with commas between thousands.
pub(super) fn label(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let (whole, rest) = text.split_once('.').map_or((text.as_str(), None), |(w, r)| (w, Some(r)));
    let mut out = String::new();
    if value < 0.0 && text.bytes().any(|b| matches!(b, b'1'..=b'9')) {
        out.push('−');
    }
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    if let Some(rest) = rest {
        out.push('.');
        out.push_str(rest);
    }
    out
}

/// Formats a value to three significant digits.
pub(super) fn significant(value: f64) -> String {
    let power = value.abs().log10().floor();
    match power {
        p if (-4.0..6.0).contains(&p) => label(value, (2.0 - p).max(0.0) as usize),
        _ if value == 0.0 => "0".to_owned(),
        _ => format!("{value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[(f64, String)]) -> Vec<&str> {
        ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(&ticks((11_800.0, 24_300.0), 5.0)), ["15,000", "20,000"]);
        assert_eq!(labels(&ticks((0.0, 0.31), 4.0)), ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(&ticks((-1.0, 1.0), 2.0)), ["−1", "0", "1"]);
        assert_eq!(ticks((3.0, 3.0), 5.0).len(), 1);
        assert_eq!(
            labels(&logarithmic_ticks((0.0021, 0.21))),
            ["0.005", "0.01", "0.02", "0.05", "0.1", "0.2"]
        );
    }

    #[test]
    fn many_decades_have_their_powers_of_ten_only() {
        assert_eq!(labels(&decades((2e-6, 0.3), 9)), ["1e-5", "0.0001", "0.001", "0.01", "0.1"]);
        assert_eq!(decades((2e-6, 0.3), 99).len(), 16);
    }

    #[test]
    fn values_and_places_agree() {
        let scale = Scale::linear((10.0, 20.0), (300.0, 100.0));
        assert_eq!((scale.place(10.0), scale.place(15.0), scale.value(200.0)), (300.0, 200.0, 15.0));
        let scale = Scale::logarithmic((0.01, 1.0), (0.0, 100.0));
        assert!((scale.place(0.1) - 50.0).abs() < 1e-9);
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(label(1_234_567.0, 0), "1,234,567");
        assert_eq!(significant(0.012_345), "0.0123");
        assert_eq!(significant(12_345.6), "12,346");
        assert_eq!(significant(0.0), "0");
    }
}
