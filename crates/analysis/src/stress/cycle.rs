//! Utilisation: cycles of stress compared with the strength of a material.

use super::measure::{Stress, principal, signed, von_mises};
use rubmap_solid::material::Material;
use rubmap_solid::mesh::ElementSet;

/// Linear measure of a cycle: `alternating·σ_a + mean·max(σ_m, 0)`; Goodman's measure has one over the fatigue strength and one over the
/// ultimate strength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    alternating: f64,
    mean: f64,
}

/// Sign of the mean normal stress of a place over the whole path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    Tension,
    Pressure,
    /// Sign that may change.
    Either,
}

impl Sign {
    /// Sign of a trace between `low` and `high`.
    pub(super) fn of(low: f64, high: f64) -> Self {
        match (low > 0.0, high < 0.0) {
            (true, _) => Self::Tension,
            (_, true) => Self::Pressure,
            _ => Self::Either,
        }
    }
}

/// Bounds of the cycle of a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    /// Upper bound of the von Mises stress.
    pub(super) largest: f64,
    /// Upper bound of the difference of the von Mises stress from that of the middle of the path.
    pub(super) swing: f64,
    pub(super) sign: Sign,
}

impl Weights {
    /// Weights of Goodman's measure, if the material has both strengths.
    pub(super) fn goodman(material: &Material) -> Option<Self> {
        let fatigue = material.fatigue_strength.as_ref()?.amplitude;
        Some(Self { alternating: 1.0 / fatigue, mean: 1.0 / material.ultimate_strength? })
    }

    /// Weights of the alternating stress alone.
    pub(super) const ALTERNATING: Self = Self { alternating: 1.0, mean: 0.0 };

    pub(super) fn of(self, alternating: f64, mean: f64) -> f64 {
        self.alternating * alternating + self.mean * mean.max(0.0)
    }

    /// Upper bound of the measure of cycles within `bound`.
    pub(super) fn most(self, bound: &Bound) -> f64 {
        let Self { alternating, mean } = self;
        match bound.sign {
            // From max = σ_m + σ_a ≤ largest and σ_a ≤ swing.
            Sign::Tension => mean * bound.largest + (alternating - mean).max(0.0) * bound.swing,
            Sign::Pressure => alternating * bound.swing,
            // A jump from one sign to the other swings by both.
            Sign::Either => alternating.max(mean) * bound.largest,
        }
    }

    /// Bounds of the measure of a cycle whose ends lie within `lows` and `highs`, the lower one first.
    pub(super) fn within(self, lows: (f64, f64), highs: (f64, f64)) -> (f64, f64) {
        let of = |low: f64, high: f64| self.of(0.5 * (high - low).max(0.0), 0.5 * (high + low));
        // Convex in both ends, so that it is largest at a corner.
        let most = of(lows.0, highs.1).max(of(lows.1, highs.1));
        // The measure grows with the upper end, and falls with the lower one as long as alternating stress weighs more.
        let least = if self.alternating < self.mean { 0.0 } else { of(lows.1, highs.0) };
        (least, most)
    }
}

/// Weights of every element set, and a sentence about missing strengths. Sets without strengths are skipped unless all lack them.
pub(super) fn weights(sets: &[ElementSet]) -> (Vec<Option<Weights>>, Option<String>) {
    let goodman: Vec<Option<Weights>> = sets.iter().map(|set| Weights::goodman(&set.material)).collect();
    let without: Vec<&str> = sets
        .iter()
        .zip(&goodman)
        .filter(|(_, known)| known.is_none())
        .map(|(set, _)| set.name.as_str())
        .collect();
    if without.is_empty() {
        return (goodman, None);
    }
    let names = without.join(", ");
    let lacking = format!(
        "fatigue strength and ultimate strength are not both given of {names}: no utilisation is told there"
    );
    if goodman.iter().all(Option::is_none) {
        return (vec![Some(Weights::ALTERNATING); sets.len()], Some(lacking));
    }
    (goodman, Some(lacking))
}

/// Cycle of one place of one blade, from the extremes of its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cycle {
    pub(super) mean: f64,
    pub(super) alternating: f64,
    pub(super) principal_mean: f64,
    pub(super) principal_alternating: f64,
    /// Largest von Mises stress and its instant.
    pub(super) peak: (f64, usize),
}

impl Cycle {
    /// Cycle of a path.
    pub(super) fn of(path: impl Iterator<Item = Stress>) -> Self {
        let mut ends = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        let mut peak = (f64::NEG_INFINITY, 0);
        for (instant, stress) in path.enumerate() {
            let size = von_mises(&stress);
            if size > peak.0 {
                peak = (size, instant);
            }
            for ((low, high), value) in ends.iter_mut().zip([signed(&stress), principal(&stress)]) {
                (*low, *high) = (low.min(value), high.max(value));
            }
        }
        let [(low, high), (principal_low, principal_high)] = ends;
        Self {
            mean: 0.5 * (high + low),
            alternating: 0.5 * (high - low),
            principal_mean: 0.5 * (principal_high + principal_low),
            principal_alternating: 0.5 * (principal_high - principal_low),
            peak,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rubmap_solid::material::FatigueStrength;

    use super::*;

    fn steel(fatigue: Option<f64>, ultimate: Option<f64>) -> ElementSet {
        let fatigue_strength = fatigue.map(|amplitude| FatigueStrength { amplitude, source: "test".into() });
        let material = Material {
            youngs_modulus: 2e5,
            poissons_ratio: 0.3,
            density: 7.8e-9,
            yield_strength: None,
            ultimate_strength: ultimate,
            fatigue_strength,
        };
        ElementSet { name: "blade".into(), material }
    }

    /// Tension 100 + 40 sin and shear: by hand, Goodman 40/200 + 100/500 = 0.4.
    #[test]
    fn a_known_harmonic_has_its_mean_and_amplitude() {
        let path = |mean: f64, amplitude: f64| {
            (0..720).map(move |t| {
                let stress = mean + amplitude * (TAU * f64::from(t) / 720.0).sin();
                [0.0, stress, 0.0, 0.0, 0.0, 0.0]
            })
        };
        let cycle = Cycle::of(path(100.0, 40.0));
        assert!((cycle.mean - 100.0).abs() < 1e-12 && (cycle.alternating - 40.0).abs() < 1e-12);
        assert!((cycle.principal_mean - 100.0).abs() < 1e-9);
        assert_eq!(cycle.peak, (140.0, 180));
        let goodman = Weights::goodman(&steel(Some(200.0), Some(500.0)).material).unwrap();
        assert!((goodman.of(cycle.alternating, cycle.mean) - 0.4).abs() < 1e-12);
        // A mean in pressure does not help.
        let pressed = Cycle::of(path(-100.0, 40.0));
        assert!((pressed.mean + 100.0).abs() < 1e-12);
        assert!((goodman.of(pressed.alternating, pressed.mean) - 0.2).abs() < 1e-12);
        // Through zero the sign follows: fully reversed.
        let reversed = Cycle::of(path(0.0, 40.0));
        assert!(reversed.mean.abs() < 1e-12 && (reversed.alternating - 40.0).abs() < 1e-12);
    }

    #[test]
    fn what_sets_lack_is_said() {
        let (known, lacking) = weights(&[steel(Some(1.0), Some(2.0)), steel(None, Some(2.0))]);
        assert!(known[0].is_some() && known[1].is_none() && lacking.unwrap().contains("blade"));
        let (known, lacking) = weights(&[steel(Some(1.0), None)]);
        assert!(known == [Some(Weights::ALTERNATING)] && lacking.is_some());
        assert_eq!(weights(&[steel(Some(1.0), Some(2.0))]).1, None);
    }

    #[test]
    fn bounds_hold_for_cycles_inside_them() {
        let tension = Bound { largest: 140.0, swing: 40.0, sign: Sign::Tension };
        let goodman = Weights { alternating: 1.0 / 200.0, mean: 1.0 / 500.0 };
        assert!((goodman.most(&tension) - 0.4).abs() < 1e-12);
        let (least, most) = goodman.within((60.0, 60.0), (140.0, 140.0));
        assert!((least - 0.4).abs() < 1e-12 && (most - 0.4).abs() < 1e-12);
        let (least, most) = goodman.within((59.0, 61.0), (139.0, 141.0));
        assert!(least < 0.4 && most > 0.4 && most - least < 2.0 * (1.0 / 200.0 + 1.0 / 500.0));
        let jumping = Bound { sign: Sign::Either, ..tension };
        assert!(goodman.most(&jumping) >= goodman.of(140.0, 0.0));
        assert_eq!((Sign::of(-1.0, 1.0), Sign::of(0.1, 1.0)), (Sign::Either, Sign::Tension));
    }
}
