//! Distributions of the parameters of a campaign.

use crate::error::Violation;
use crate::request::{DistributionKind, Parameter};
use rubmap_numerics::sampling::quantile;

/// Distribution of the values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// Uniform between two ends.
    Uniform(f64, f64),
    /// Uniform in the logarithm.
    LogUniform(f64, f64),
    /// Normal, cut off where `from` and `to` are finite.
    Normal {
        /// Mean before the distribution is cut off.
        mean: f64,
        /// Standard deviation before the distribution is cut off.
        standard_deviation: f64,
        /// Smallest value.
        from: f64,
        /// Largest value.
        to: f64,
    },
    /// Triangular between two ends, with the most probable value last.
    Triangular(f64, f64, f64),
    /// Whole numbers between two ends.
    Whole(f64, f64),
    /// Given values, equally probable.
    Values(Vec<f64>),
}

/// Largest magnitude of a whole number: beyond it doubles do not hold all of them.
const LARGEST_WHOLE: f64 = (1u64 << 53) as f64;

impl Distribution {
    /// Reads the distribution of a parameter; none where the parameter says nothing at all, as it may in a list.
    ///
    /// # Errors
    /// Violations, at JSON pointers into the parameter.
    pub(crate) fn of(parameter: &Parameter) -> Result<Option<Self>, Vec<Violation>> {
        use DistributionKind::{LogUniform, Normal, Triangular, Uniform, Values, Whole};
        let Parameter { distribution: kind, from, to, mode, mean, standard_deviation, ref values, .. } =
            *parameter;
        let given =
            [from, to, mode, mean, standard_deviation].iter().any(Option::is_some) || values.is_some();
        if kind == Uniform && !given {
            return Ok(None);
        }
        let mut found = Vec::new();
        let mut require = |holds: bool, pointer: &str, message: &str| {
            if !holds {
                found.push(Violation::new(pointer, message));
            }
        };
        let finite = |number: Option<f64>| number.is_none_or(f64::is_finite);
        for (pointer, number) in [
            ("/from", from),
            ("/to", to),
            ("/mode", mode),
            ("/mean", mean),
            ("/standard_deviation", standard_deviation),
        ] {
            require(finite(number), pointer, "a finite number");
        }
        for (pointer, is_given, owners) in [
            ("/from", from.is_some(), &[Uniform, LogUniform, Normal, Triangular, Whole][..]),
            ("/to", to.is_some(), &[Uniform, LogUniform, Normal, Triangular, Whole]),
            ("/mode", mode.is_some(), &[Triangular]),
            ("/mean", mean.is_some(), &[Normal]),
            ("/standard_deviation", standard_deviation.is_some(), &[Normal]),
            ("/values", values.is_some(), &[Values]),
        ] {
            let belongs = owners.contains(&kind);
            require(
                belongs || !is_given,
                pointer,
                "not of this distribution: leave it away, or name another",
            );
            let may_lack = kind == Normal && ["/from", "/to"].contains(&pointer);
            require(!belongs || is_given || may_lack, pointer, "this distribution needs it");
        }
        let (low, high) = (from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY));
        require(kind == Values || low < high, "/to", "above from");
        require(kind != LogUniform || low > 0.0, "/from", "a logarithm needs numbers above 0");
        let mode = mode.unwrap_or(low);
        require(kind != Triangular || (low..=high).contains(&mode), "/mode", "between from and to");
        let deviation = standard_deviation.unwrap_or(1.0);
        require(deviation > 0.0, "/standard_deviation", "above 0");
        let mean = mean.unwrap_or(0.0);
        // In the far tails shares are too small for doubles.
        let cut = |end: f64, sign: f64| sign * (end - mean) > -8.0 * deviation;
        require(
            kind != Normal || (cut(high, 1.0) && cut(low, -1.0)),
            if cut(high, 1.0) { "/from" } else { "/to" },
            "what is left of the distribution lies more than eight standard deviations from its mean",
        );
        let whole = |number: f64| number.fract() == 0.0 && number.abs() <= LARGEST_WHOLE;
        require(kind != Whole || whole(low), "/from", "a whole number");
        require(kind != Whole || whole(high), "/to", "a whole number");
        let values = values.clone().unwrap_or_default();
        require(values.iter().all(|value| value.is_finite()), "/values", "finite numbers");
        require(kind != Values || !values.is_empty(), "/values", "at least one");
        if !found.is_empty() {
            return Err(found);
        }
        Ok(Some(match kind {
            Uniform => Self::Uniform(low, high),
            LogUniform => Self::LogUniform(low, high),
            Normal => Self::Normal { mean, standard_deviation: deviation, from: low, to: high },
            Triangular => Self::Triangular(low, high, mode),
            Whole => Self::Whole(low, high),
            Values => Self::Values(values),
        }))
    }

    /// Value below which a share `u` of the distribution lies, 0 < u < 1.
    pub fn quantile(&self, u: f64) -> f64 {
        match *self {
            Self::Uniform(from, to) => quantile::uniform(u, (from, to)),
            Self::LogUniform(from, to) => quantile::log_uniform(u, (from, to)),
            Self::Normal { mean, standard_deviation, from, to } => {
                quantile::truncated_normal(u, mean, standard_deviation, (from, to))
            }
            Self::Triangular(from, to, mode) => quantile::triangular(u, (from, to), mode),
            Self::Whole(from, to) => (from + (u * (to - from + 1.0)).floor()).min(to),
            Self::Values(ref values) => values[((u * values.len() as f64) as usize).min(values.len() - 1)],
        }
    }

    /// Smallest and largest value; either may be infinite.
    pub fn range(&self) -> (f64, f64) {
        match *self {
            Self::Uniform(from, to)
            | Self::LogUniform(from, to)
            | Self::Normal { from, to, .. }
            | Self::Triangular(from, to, _)
            | Self::Whole(from, to) => (from, to),
            Self::Values(ref values) => {
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| {
                    (low.min(value), high.max(value))
                })
            }
        }
    }

    /// Whether the distribution takes every value of its range.
    pub fn is_continuous(&self) -> bool {
        !matches!(self, Self::Whole(..) | Self::Values(_))
    }

    /// Number of levels that the distribution has of its own.
    pub(crate) fn own_levels(&self) -> Option<f64> {
        match self {
            Self::Whole(from, to) => Some(to - from + 1.0),
            Self::Values(values) => Some(values.len() as f64),
            _ => None,
        }
    }

    /// Level `index` of a grid of so many `levels`.
    pub(crate) fn level(&self, index: usize, levels: usize) -> f64 {
        let evenly = |from: f64, to: f64| {
            let share = if levels == 1 { 0.5 } else { index as f64 / (levels - 1) as f64 };
            quantile::uniform(share, (from, to)).clamp(from, to)
        };
        match *self {
            Self::Values(ref values) => values[index],
            Self::Whole(from, _) => from + index as f64,
            Self::LogUniform(from, to) => evenly(from.ln(), to.ln()).exp().clamp(from, to),
            Self::Uniform(from, to) | Self::Triangular(from, to, _) | Self::Normal { from, to, .. } => {
                evenly(from, to)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn of(mut said: Value) -> Result<Option<Distribution>, Vec<String>> {
        said["name"] = "p".into();
        said["at"] = json!(["/scene/damping/modal_ratio"]);
        let parameter: Parameter = serde_json::from_value(said).unwrap();
        Distribution::of(&parameter)
            .map_err(|found| found.into_iter().map(|violation| violation.pointer).collect())
    }

    #[test]
    fn distributions_say_what_they_need_and_no_more() {
        let wrong = [
            (json!({"from": 1.0}), vec!["/to"]),
            (json!({"from": 2.0, "to": 1.0}), vec!["/to"]),
            (json!({"from": 1.0, "to": 2.0, "mean": 1.5}), vec!["/mean"]),
            (json!({"distribution": "log_uniform", "from": 0.0, "to": 2.0}), vec!["/from"]),
            (json!({"distribution": "normal", "mean": 1.0}), vec!["/standard_deviation"]),
            (
                json!({"distribution": "normal", "mean": 1.0, "standard_deviation": 0.0}),
                vec!["/standard_deviation"],
            ),
            (
                json!({"distribution": "normal", "mean": 1.0, "standard_deviation": 0.1, "from": 2.0}),
                vec!["/from"],
            ),
            (json!({"distribution": "triangular", "from": 1.0, "to": 2.0, "mode": 3.0}), vec!["/mode"]),
            (json!({"distribution": "whole", "from": 1.5, "to": 3.0}), vec!["/from"]),
            (json!({"distribution": "values"}), vec!["/values", "/values"]),
        ];
        for (said, pointers) in wrong {
            assert_eq!(of(said.clone()).unwrap_err(), pointers, "{said}");
        }
        assert_eq!(of(json!({})), Ok(None));
        assert_eq!(of(json!({"from": 1.0, "to": 2.0})), Ok(Some(Distribution::Uniform(1.0, 2.0))));
    }

    #[test]
    fn whole_numbers_and_values_come_equally_often() {
        for distribution in [Distribution::Whole(-1.0, 2.0), Distribution::Values(vec![-1.0, 0.0, 1.0, 2.0])]
        {
            let mut found: Vec<f64> =
                (0..400).map(|i| distribution.quantile((f64::from(i) + 0.5) / 400.0)).collect();
            assert_eq!(
                (0..4).map(|level| distribution.level(level, 4)).collect::<Vec<_>>(),
                [-1.0, 0.0, 1.0, 2.0]
            );
            found.dedup();
            assert_eq!(found, [-1.0, 0.0, 1.0, 2.0]);
            assert_eq!((distribution.quantile(0.2499), distribution.quantile(0.2501)), (-1.0, 0.0));
            assert_eq!((distribution.range(), distribution.own_levels()), ((-1.0, 2.0), Some(4.0)));
        }
    }

    #[test]
    fn levels_reach_from_end_to_end() {
        let uniform = Distribution::Uniform(1.0, 3.0);
        assert_eq!([0, 1, 2].map(|level| uniform.level(level, 3)), [1.0, 2.0, 3.0]);
        assert_eq!(uniform.level(0, 1), 2.0);
        let log = Distribution::LogUniform(0.01, 1.0);
        assert!((log.level(1, 3) - 0.1).abs() < 1e-15);
        assert!((log.level(0, 3) - 0.01).abs() < 1e-15 && log.level(2, 3) == 1.0);
    }
}
