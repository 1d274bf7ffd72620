//! Symmetry breaking: the growth of nodal diameters that the symmetry of a scene keeps at rest (docs/method.md, Symmetry).
//!
//! A run is started from a tiny asymmetry; the amplitude of the nodal diameters that a symmetric run would leave at rest,
//! √(their energy), is followed from revolution to revolution and fitted by e^{rate·revolutions} as long as it is small.

use serde::{Deserialize, Serialize};

use super::growth::{CLEARLY, Rate, rate};

/// Fate of a tiny asymmetry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SymmetryBreaking {
    /// Number of times that the scene repeats around the wheel.
    pub repeats: u32,
    /// Whether the asymmetry grew: it left the linear range or its fitted rate is clearly above 0.
    pub grows: bool,
    /// Growth rate of the asymmetry's amplitude per revolution, natural logarithm; negative where it decays. Absent where too few
    /// revolutions lie in the linear range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_per_revolution: Option<f64>,
    /// Standard error of the rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_error: Option<f64>,
    /// Revolution by which the asymmetry had left the linear range (a hundredth of the response), if it did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken_after_revolutions: Option<u32>,
    /// Share of the broken nodal diameters in the energy at the end.
    pub energy_share: f64,
    /// Nodal diameters that symmetry keeps at rest.
    pub nodal_diameters: Vec<u32>,
}

/// Share of the symmetric response's largest energy from which on an asymmetry is no longer small: a hundredth in amplitude.
const LINEAR: f64 = 1e-4;

/// Share of the energy below which energies are round-off.
const ROUND_OFF: f64 = 1e-24;

/// Factor by which energies have to change to have grown.
const GROWN: f64 = 4.0;

/// Judges `energies[revolution][nodal diameter]` from revolution `from` on (when the casing is fully grown) for a scene that repeats
/// `repeats` times. Where there is no symmetric response to be small against, all revolutions count.
pub fn judge(energies: &[Vec<f64>], repeats: usize, from: usize) -> SymmetryBreaking {
    let diameters = energies.first().map_or(0, Vec::len);
    let broken: Vec<usize> = (0..diameters).filter(|i| !i.is_multiple_of(repeats)).collect();
    let asymmetric: Vec<f64> = energies.iter().map(|row| broken.iter().map(|&i| row[i]).sum()).collect();
    let symmetric =
        energies.iter().zip(&asymmetric).map(|(row, asymmetric)| row.iter().sum::<f64>() - asymmetric);
    let response = symmetric.fold(0.0, f64::max);
    let start = asymmetric.get(from).copied().unwrap_or(0.0);
    let limit = if start < LINEAR * response { LINEAR * response } else { f64::INFINITY };
    let floor = ROUND_OFF * response.max(start);
    let since = || asymmetric.iter().enumerate().skip(from);
    let broken_after =
        since().find(|&(_, &e)| e > limit && e > GROWN * start).map(|(revolution, _)| revolution);
    let small = since().take_while(|&(_, &e)| e > floor && e <= limit);
    let line: Vec<_> = small.map(|(revolution, e)| (revolution as f64, 0.5 * e.ln())).collect();
    let fit = rate(&line);
    let last = energies.last().map_or(0.0, |row| row.iter().sum());
    SymmetryBreaking {
        repeats: repeats as u32,
        grows: broken_after.is_some() || fit.is_some_and(|Rate { value, error }| value > CLEARLY * error),
        rate_per_revolution: fit.map(|rate| rate.value),
        rate_error: fit.map(|rate| rate.error),
        broken_after_revolutions: broken_after.map(|revolution| revolution as u32 + 1),
        energy_share: if last > 0.0 { asymmetric.last().map_or(0.0, |e| e / last) } else { 0.0 },
        nodal_diameters: broken.iter().map(|&i| i as u32).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn energies(rate: f64, revolutions: usize) -> Vec<Vec<f64>> {
        let amplitude =
            |r: usize| 1e-8 * (rate * r as f64).exp() * if r.is_multiple_of(2) { 1.05 } else { 0.95 };
        (0..revolutions).map(|r| vec![1.0, amplitude(r).powi(2), 0.5, 0.0]).collect()
    }

    #[test]
    fn finds_the_rate_of_growth_and_of_decay() {
        for rate in [0.4, 0.05, -0.3] {
            let found = judge(&energies(rate, 30), 2, 1);
            assert!((found.rate_per_revolution.unwrap() - rate).abs() < 3.0 * found.rate_error.unwrap());
            assert_eq!((found.grows, found.nodal_diameters), (rate > 0.0, vec![1, 3]));
            assert_eq!(found.broken_after_revolutions, None);
        }
        let flat = judge(&energies(0.0, 30), 2, 1);
        assert!(!flat.grows && flat.rate_per_revolution.unwrap().abs() < 1e-2);
    }

    #[test]
    fn an_asymmetry_alone_decays_and_is_not_called_growth() {
        let alone: Vec<Vec<f64>> =
            (0..20).map(|r| vec![0.0, (-0.4 * f64::from(r)).exp(), 0.0, 0.0]).collect();
        let found = judge(&alone, 2, 1);
        assert!(!found.grows && found.broken_after_revolutions.is_none(), "{found:?}");
        assert!((found.rate_per_revolution.unwrap() + 0.2).abs() < 1e-12 && found.energy_share == 1.0);
    }

    #[test]
    fn an_asymmetry_that_takes_over_is_said() {
        let found = judge(&energies(0.9, 40), 2, 1);
        assert!(found.grows && found.broken_after_revolutions.unwrap() == 17 && found.energy_share > 0.5);
    }
}
