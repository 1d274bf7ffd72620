//! Interference diagram: natural frequencies over the nodal diameter at one speed, and the engine orders that drive them there.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::result::Campbell;
use crate::request::families::FamiliesBy;
use rubmap_wheel::response::campbell::multiples;
use rubmap_wheel::response::waves::{Table, Wave, driven_wave, fold};

/// Interference diagram of a modal analysis: modes over the nodal diameter at one speed, beside the engine orders folded onto the nodal diameters that
/// they drive (SAFE, ZZENF).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Interference {
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Speeds of the analysis between which frequencies were interpolated, f² over Ω², rad/s. Absent at a speed of the analysis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_rad_s: Option<[f64; 2]>,
    /// Operating range, rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_rad_s: Option<[f64; 2]>,
    /// Number N of sectors.
    pub sectors: u32,
    /// Number of lobes, whose multiples are the engine orders that drive.
    pub lobes: u32,
    /// Meaning of a family.
    pub families_by: FamiliesBy,
    /// Modes in ascending nodal diameter and family.
    pub modes: Vec<InterferingMode>,
    /// Engine orders from 1 on.
    pub engine_orders: Vec<FoldedOrder>,
    /// Id of the model.
    pub model: String,
    /// Version of the code.
    pub version: String,
}

/// Mode of an interference diagram.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct InterferingMode {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Modal family, from 1.
    pub family: u32,
    /// Direction of the travelling wave, where Coriolis forces split both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
    /// Frequency in the rotating frame, Hz.
    pub frequency_hz: f64,
    /// Nearest engine order of the lobes that drives the mode; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nearest: Option<NearestOrder>,
    /// Engine orders of the lobes that meet the frequency within the operating range.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub met_in_range: Vec<u32>,
}

/// Engine order that drives a mode, and its distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct NearestOrder {
    /// Engine order k, a multiple of the lobe count.
    pub engine_order: u32,
    /// Frequency kΩ/2π, Hz.
    pub frequency_hz: f64,
    /// Frequency of the mode above that of the order, per cent of the mode's: negative where the order is above the mode.
    pub margin_percent: f64,
}

/// Engine order and the nodal diameter that it drives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FoldedOrder {
    /// Engine order k.
    pub engine_order: u32,
    /// Nodal diameter |k − N·round(k/N)| that it drives.
    pub nodal_diameter: u32,
    /// Frequency kΩ/2π, Hz.
    pub frequency_hz: f64,
    /// Direction of the wave that it drives in the rotating frame; absent where the nodal diameter is single and stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
    /// Whether the order is a multiple of the number of lobes, so that they drive it.
    pub of_lobes: bool,
}

/// Question that an interference diagram answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedInterference {
    /// Speed, rad/s.
    pub speed_rad_s: f64,
    /// Number of lobes.
    pub lobes: u32,
    /// Highest engine order.
    pub max_engine_order: u32,
    /// Operating range, ascending, rad/s.
    pub range_rad_s: Option<[f64; 2]>,
}

impl Interference {
    /// Interference diagram of a wheel of `sectors` sectors; none at a speed outside those of the analysis.
    pub fn of(campbell: &Campbell, sectors: u32, asked: AskedInterference) -> Option<Self> {
        let AskedInterference { speed_rad_s, lobes, max_engine_order, range_rad_s } = asked;
        let place = Place::of(&campbell.speeds_rad_s, speed_rad_s)?;
        let mut modes = Vec::new();
        for (wave, table) in campbell.branches() {
            for (i, line) in place.row(table).into_iter().enumerate() {
                let single = i == 0 || 2 * i == sectors as usize;
                if single && wave == Some(Wave::Forward) {
                    continue;
                }
                let named = line.into_iter().enumerate();
                modes.extend(named.map(|(j, frequency_hz)| InterferingMode {
                    nodal_diameter: i as u32,
                    family: j as u32 + 1,
                    wave: wave.filter(|_| !single),
                    frequency_hz,
                    nearest: None,
                    met_in_range: Vec::new(),
                }));
            }
        }
        modes.sort_by_key(|mode| (mode.nodal_diameter, mode.family));
        let hz = |order: u32, speed: f64| f64::from(order) * speed / TAU;
        for mode in &mut modes {
            let drives = |order: &u32| {
                let turns = driven_wave(*order, sectors);
                fold(*order, sectors) == mode.nodal_diameter && (mode.wave.is_none() || turns == mode.wave)
            };
            let driving: Vec<u32> = multiples(lobes, max_engine_order).into_iter().filter(drives).collect();
            let orders = driving.iter().map(|&engine_order| {
                let frequency_hz = hz(engine_order, speed_rad_s);
                let margin_percent = 100.0 * (mode.frequency_hz - frequency_hz) / mode.frequency_hz;
                NearestOrder { engine_order, frequency_hz, margin_percent }
            });
            mode.nearest = orders.min_by(|a, b| a.margin_percent.abs().total_cmp(&b.margin_percent.abs()));
            if let Some([from, to]) = range_rad_s {
                let is_met = |order: &u32| (hz(*order, from)..=hz(*order, to)).contains(&mode.frequency_hz);
                mode.met_in_range = driving.into_iter().filter(is_met).collect();
            }
        }
        let engine_orders = (1..=max_engine_order).map(|engine_order| FoldedOrder {
            engine_order,
            nodal_diameter: fold(engine_order, sectors),
            frequency_hz: hz(engine_order, speed_rad_s),
            wave: driven_wave(engine_order, sectors),
            of_lobes: lobes > 0 && engine_order.is_multiple_of(lobes),
        });
        let engine_orders = engine_orders.collect();
        let followed = campbell.followed.is_some();
        Some(Self {
            speed_rad_s,
            between_rad_s: place.between(&campbell.speeds_rad_s),
            range_rad_s,
            sectors,
            lobes,
            families_by: if followed { FamiliesBy::Shape } else { FamiliesBy::Rank },
            modes,
            engine_orders,
            model: campbell.settings.model.clone(),
            version: campbell.version.clone(),
        })
    }
}

/// Place of a speed among those of an analysis.
enum Place {
    At(usize),
    /// Share of the way, in Ω², from this speed to the next.
    After(usize, f64),
}

impl Place {
    fn of(speeds: &[f64], speed: f64) -> Option<Self> {
        let above = speeds.iter().position(|&there| there >= speed * (1.0 - 1e-12))?;
        if speeds[above] <= speed * (1.0 + 1e-12) {
            return Some(Self::At(above));
        }
        let (low, high) = (speeds[above.checked_sub(1)?], speeds[above]);
        Some(Self::After(above - 1, (speed * speed - low * low) / (high * high - low * low)))
    }

    fn between(&self, speeds: &[f64]) -> Option<[f64; 2]> {
        match *self {
            Self::At(_) => None,
            Self::After(low, _) => Some([speeds[low], speeds[low + 1]]),
        }
    }

    /// Frequencies by nodal diameter and family.
    fn row(&self, table: &Table) -> Vec<Vec<f64>> {
        match *self {
            Self::At(index) => table[index].clone(),
            Self::After(low, share) => {
                let one = |(a, b): (&f64, &f64)| ((1.0 - share) * a * a + share * b * b).sqrt();
                let line = |(a, b): (&Vec<f64>, &Vec<f64>)| std::iter::zip(a, b).map(one).collect();
                std::iter::zip(&table[low], &table[low + 1]).map(line).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Modal analysis at rest and 100 revolutions per second of one family, whose f² of nodal diameter i is (100(i + 1))² + 3f_Ω².
    fn analysis(diameters: u32) -> Campbell {
        let row = |hz: f64| -> Vec<Vec<f64>> {
            let of = |i: u32| vec![((100.0 * f64::from(i + 1)).powi(2) + 3.0 * hz * hz).sqrt()];
            (0..diameters).map(of).collect()
        };
        let unit = json!({"verdict": "absent", "linear_ratio": 0.0, "quadratic_ratio": 0.0, "frequency_error": 0.0, "message": ""});
        serde_json::from_value(json!({
            "speeds_rad_s": [0.0, TAU * 100.0], "frequencies_hz": [row(0.0), row(100.0)], "absolute_frequencies_hz": [],
            "crossings": [], "driven_crossings": [],
            "reduction": {"modes_per_speed": 1, "unknowns": [1], "wheel_unknowns": 1, "largest_mode_residual": 0.0, "modes": 1,
                "counted_modes": 1, "full_model": [], "basis_tolerance": 1e-5, "stiffening": unit, "wall_time_s": 0.0, "version": "0"},
            "settings": {"model": "m", "speeds": {"values": [0, 6000], "unit": "rpm"}}, "wall_time_s": 0.0, "version": "0",
        }))
        .unwrap()
    }

    fn asked(hz: f64, lobes: u32, max_engine_order: u32) -> AskedInterference {
        AskedInterference { speed_rad_s: TAU * hz, lobes, max_engine_order, range_rad_s: None }
    }

    /// Nodal diameters of the zig-zag by hand: it climbs to N/2, and on odd numbers has both ends twice.
    #[test]
    fn engine_orders_fold_as_by_hand() {
        for (sectors, expected) in [
            (6, vec![1, 2, 3, 2, 1, 0, 1, 2, 3]),
            (5, vec![1, 2, 2, 1, 0, 1, 2, 2, 1]),
            (2, vec![1, 0, 1, 0, 1, 0, 1, 0, 1]),
            (1, vec![0; 9]),
        ] {
            let found = Interference::of(&analysis(sectors / 2 + 1), sectors, asked(50.0, 2, 9)).unwrap();
            let folded: Vec<u32> = found.engine_orders.iter().map(|order| order.nodal_diameter).collect();
            assert_eq!(folded, expected, "{sectors} sectors");
            assert_eq!(found.engine_orders[3].frequency_hz, 200.0);
            let driven = found.engine_orders.iter().filter(|order| order.of_lobes);
            assert_eq!(driven.map(|order| order.engine_order).collect::<Vec<_>>(), [2, 4, 6, 8]);
        }
    }

    /// Six sectors, two lobes, 50 Hz: orders 2, 4, 8 drive nodal diameter 2 and 6 drives 0; nothing drives 1 and 3.
    #[test]
    fn driven_modes_have_their_nearest_order() {
        let range = Some([TAU * 60.0, TAU * 80.0]);
        let asked = AskedInterference { range_rad_s: range, ..asked(50.0, 2, 9) };
        let found = Interference::of(&analysis(4), 6, asked).unwrap();
        assert!(found.between_rad_s.is_some());
        let hz = |i: f64| ((100.0 * (i + 1.0)).powi(2) + 3.0 * 2500.0_f64).sqrt();
        for (i, mode) in found.modes.iter().enumerate() {
            assert!((mode.frequency_hz / hz(i as f64) - 1.0).abs() < 1e-14);
        }
        let nearest = |i: usize| found.modes[i].nearest.map(|order| order.engine_order);
        assert_eq!([0, 1, 2, 3].map(nearest), [Some(6), None, Some(8), None]);
        let margin = found.modes[2].nearest.unwrap().margin_percent;
        assert!((margin - 100.0 * (hz(2.0) - 400.0) / hz(2.0)).abs() < 1e-12 && margin < 0.0);
        // 312.2 Hz is within 4·60 and 4·80 Hz.
        assert_eq!(found.modes[2].met_in_range, [4]);
        assert!(found.modes[0].met_in_range.is_empty());
    }

    #[test]
    fn speeds_outside_the_analysis_have_no_diagram() {
        let of = |hz: f64| Interference::of(&analysis(4), 6, asked(hz, 2, 9));
        assert!(of(100.5).is_none());
        assert_eq!(of(100.0).unwrap().between_rad_s, None);
        assert_eq!(of(0.0).unwrap().modes[3].frequency_hz, 400.0);
    }

    /// With Coriolis forces an order drives the wave of one direction: 4 of six sectors runs with the rotation, 2 and 8 against it.
    #[test]
    fn split_waves_are_driven_by_their_own_orders() {
        let mut split = analysis(4);
        let table = |by: f64| -> Table {
            let line = |line: &Vec<f64>| line.iter().map(|hz| hz + by).collect();
            split.frequencies_hz.iter().map(|row| row.iter().map(line).collect()).collect()
        };
        split.waves = Some(crate::result::WaveTables { forward_hz: table(-5.0), backward_hz: table(5.0) });
        let found = Interference::of(&split, 6, asked(50.0, 2, 9)).unwrap();
        let of = |i: u32| found.modes.iter().filter(move |mode| mode.nodal_diameter == i);
        assert_eq!([0, 1, 2, 3].map(|i| of(i).count()), [1, 2, 2, 1]);
        let order =
            |wave: Wave| of(2).find(|mode| mode.wave == Some(wave)).unwrap().nearest.unwrap().engine_order;
        assert_eq!((order(Wave::Forward), order(Wave::Backward)), (4, 8));
    }
}
