//! Campbell data and the linear interaction criterion (docs/method.md, Reading responses; Eq. 11).

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::waves::{Branch, Frequencies, Wave, Waves, driven_wave, fold};

/// Natural frequency that equals an engine order, where the linear criterion expects an interaction. With Coriolis forces it is that of the
/// backward wave, which alone can stand still in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Crossing {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Modal family j, from 1.
    pub family: u32,
    /// Superharmonic number n with f = i·n·Ω/2π.
    pub superharmonic: u32,
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Frequency in the rotating frame, Hz (per unit of time of the model).
    pub frequency_hz: f64,
}

/// Crossing that the scene can drive: f = kΩ/2π with k, a multiple of the lobe count or the order of a force, that aliases onto i.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct DrivenCrossing {
    /// Nodal diameter i = fold(k).
    pub nodal_diameter: u32,
    /// Modal family j, from 1.
    pub family: u32,
    /// Engine order k.
    pub engine_order: u32,
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Frequency in the rotating frame, Hz.
    pub frequency_hz: f64,
    /// Direction of the travelling wave that has this frequency, the one that engine order k drives. Absent without Coriolis forces and
    /// where the nodal diameter is single.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// Frequency f_a = |−f + i·n·Ω/2π| of Eq. 11, f in Hz, Ω in rad/s.
pub fn absolute_frequency(
    frequency_hz: f64,
    nodal_diameter: u32,
    superharmonic: u32,
    speed_rad_s: f64,
) -> f64 {
    (f64::from(nodal_diameter * superharmonic) * speed_rad_s / TAU - frequency_hz).abs()
}

/// Line over speed that a frequency f is to meet: ±f = kΩ/2π − offset.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Engine order k.
    pub(super) order: u32,
    /// Sign of f, 1 or −1.
    pub(super) sign: f64,
    /// Offset of the line, Hz.
    pub(super) offset: f64,
}

impl Line {
    /// Line of engine order `order`.
    fn engine_order(order: u32) -> Self {
        Self { order, sign: 1.0, offset: 0.0 }
    }

    fn excess(self, speed: f64, frequency: f64) -> f64 {
        f64::from(self.order) / TAU * speed - self.sign * frequency - self.offset
    }

    fn frequency(self, speed: f64) -> f64 {
        self.sign * (f64::from(self.order) / TAU * speed - self.offset)
    }
}

/// Speeds in the range of `grid` (ascending, rad/s) at which the frequency of a family meets `line`, with that frequency: sign
/// changes of the difference between neighbouring grid points, refined on newly computed frequencies. No crossing is reported
/// where the model fails on the way.
pub(super) fn roots<F: Frequencies>(
    &Branch { table, frequencies }: &Branch<'_, F>,
    grid: &[f64],
    nodal_diameter: u32,
    family: usize,
    line: Line,
) -> Vec<(f64, f64)> {
    let slope = f64::from(line.order) / TAU;
    let excess = |point: usize| {
        let found = table[point][nodal_diameter as usize].get(family);
        found.map(|&f| line.excess(grid[point], f))
    };
    let mut found = Vec::new();
    for point in 0..grid.len() {
        let Some(here) = excess(point) else { return found };
        if here == 0.0 {
            found.push((grid[point], line.frequency(grid[point])));
        }
        if point + 1 == grid.len() {
            break;
        }
        let Some(there) = excess(point + 1) else { return found };
        if here * there < 0.0 {
            let excess_at = |speed: f64| {
                let refined = frequencies.at(speed, nodal_diameter)?;
                refined.get(family).map(|&f| line.excess(speed, f))
            };
            if let Some(root) = refine((grid[point], here), (grid[point + 1], there), slope, excess_at) {
                found.push((root, line.frequency(root)));
            }
        }
    }
    found
}

/// Root of `excess` between `low` and `high` (argument and value, of opposite signs) by regula falsi with halving
/// (Illinois): a handful of eigenvalue solutions to twelve digits. None where `excess` has no value.
fn refine(
    mut low: (f64, f64),
    mut high: (f64, f64),
    slope: f64,
    excess: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    let mut kept = 0;
    for _ in 0..60 {
        let speed = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = excess(speed)?;
        if value.abs() <= 1e-12 * slope * speed || (high.0 - low.0) <= 1e-12 * high.0 {
            return Some(speed);
        }
        if value * low.1 > 0.0 {
            low = (speed, value);
            if kept == 1 {
                high.1 *= 0.5;
            }
            kept = 1;
        } else {
            high = (speed, value);
            if kept == -1 {
                low.1 *= 0.5;
            }
            kept = -1;
        }
    }
    Some(low.0)
}

/// Crossings of the linear criterion: roots of f_a = 0 for every nodal diameter, the first `families` and each superharmonic number, in
/// ascending speed.
pub fn crossings<F: Frequencies>(
    waves: &Waves<'_, F>,
    grid: &[f64],
    families: usize,
    superharmonics: &[u32],
) -> Vec<Crossing> {
    let branch = waves.of(Wave::Backward);
    let harmonics = branch.table.first().map_or(0, Vec::len) as u32;
    let mut all = Vec::new();
    for nodal_diameter in 1..harmonics {
        for family in 0..families {
            for &superharmonic in superharmonics {
                let line = Line::engine_order(nodal_diameter * superharmonic);
                for (speed_rad_s, frequency_hz) in roots(branch, grid, nodal_diameter, family, line) {
                    all.push(Crossing {
                        nodal_diameter,
                        family: family as u32 + 1,
                        superharmonic,
                        speed_rad_s,
                        frequency_hz,
                    });
                }
            }
        }
    }
    all.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    all
}

/// Multiples of `lobes` up to `highest`: the engine orders of equal lobes.
pub fn multiples(lobes: u32, highest: u32) -> Vec<u32> {
    if lobes == 0 { Vec::new() } else { (lobes..=highest).step_by(lobes as usize).collect() }
}

/// Crossings that fields at rest can drive whose periods around the casing are `orders`: f = kΩ/2π with fold(k) = i, for the
/// first `families`; in ascending speed. Split waves are each met by the engine orders that drive them.
pub fn driven_crossings<F: Frequencies>(
    waves: &Waves<'_, F>,
    grid: &[f64],
    families: usize,
    orders: &[u32],
    sectors: u32,
) -> Vec<DrivenCrossing> {
    let mut all = Vec::new();
    for &order in orders {
        let nodal_diameter = fold(order, sectors);
        let wave = driven_wave(order, sectors);
        let branch = waves.of(wave.unwrap_or(Wave::Backward));
        for family in 0..families {
            let line = Line::engine_order(order);
            for (speed_rad_s, frequency_hz) in roots(branch, grid, nodal_diameter, family, line) {
                all.push(DrivenCrossing {
                    nodal_diameter,
                    family: family as u32 + 1,
                    engine_order: order,
                    speed_rad_s,
                    frequency_hz,
                    wave: wave.filter(|_| waves.are_split()),
                });
            }
        }
    }
    all.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::waves::Table;

    /// Frequencies f² = f0² + BΩ² fitted to the paper's Table 2: per nodal diameter (f0, B) of families 1 and 2.
    struct PaperFit;

    /// Fit (i, j, f0, B). Family (1,1) has one row only, f = 12.0 at Ω = 4.0: with B = 3 like its neighbours f0 is 9.798.
    const FIT: [(u32, usize, f64, f64); 9] = [
        (1, 1, 9.798, 3.0),
        (2, 1, 9.749, 3.43),
        (3, 1, 10.003, 2.88),
        (4, 1, 9.994, 2.83),
        (5, 1, 9.882, 3.34),
        (2, 2, 19.393, 2.98),
        (3, 2, 20.291, 5.38),
        (4, 2, 20.762, 3.33),
        (5, 2, 21.013, 3.17),
    ];

    impl Frequencies for PaperFit {
        fn at(&self, speed: f64, nodal_diameter: u32) -> Option<Vec<f64>> {
            // The paper's unit of frequency is its unit of speed: an engine order is f = kΩ, here kΩ/2π.
            let omega = speed / TAU;
            let family = |j: usize| {
                let row = FIT.iter().find(|row| row.0 == nodal_diameter && row.1 == j);
                row.map_or(1e3, |&(_, _, f0, b)| (f0 * f0 + b * omega * omega).sqrt())
            };
            Some(vec![family(1), family(2)])
        }
    }

    fn alike(table: &Table) -> Waves<'_, PaperFit> {
        Waves::Alike(Branch { table, frequencies: &PaperFit })
    }

    #[test]
    fn finds_table_2_of_the_paper() {
        let table_2 = [
            (0.67, 5, 1, 3),
            (0.83, 4, 1, 3),
            (1.00, 5, 1, 2),
            (1.12, 3, 1, 3),
            (1.29, 4, 1, 2),
            (1.42, 5, 2, 3),
            (1.71, 2, 1, 3),
            (1.75, 3, 1, 2),
            (1.75, 4, 2, 3),
            (2.12, 5, 1, 1),
            (2.12, 5, 2, 2),
            (2.33, 3, 2, 3),
            (2.67, 4, 2, 2),
            (2.75, 4, 1, 1),
            (2.75, 2, 1, 2),
            (3.37, 2, 2, 3),
            (3.67, 3, 2, 2),
            (4.00, 1, 1, 3),
            (4.04, 3, 1, 1),
            (4.50, 5, 2, 1),
            (5.37, 2, 2, 2),
            (5.83, 4, 2, 1),
        ];
        let grid: Vec<f64> = (0..=24).map(|i| TAU * 0.25 * f64::from(i)).collect();
        let table: Table =
            grid.iter().map(|&s| (0..=5).map(|i| PaperFit.at(s, i).unwrap()).collect()).collect();
        let found = crossings(&alike(&table), &grid, 2, &[1, 2, 3]);
        assert_eq!(found.len(), table_2.len(), "{found:#?}");
        for (omega, i, j, n) in table_2 {
            let row =
                found.iter().find(|c| (c.nodal_diameter, c.family, c.superharmonic) == (i, j, n)).unwrap();
            // The paper's speeds sit on a grid of 1/24, then two decimals.
            let snapped = (row.speed_rad_s / TAU * 24.0).round() / 24.0;
            assert!((snapped - omega).abs() < 0.0051, "({i},{j},{n}): {snapped} for {omega}");
            let f = PaperFit.at(row.speed_rad_s, i).unwrap()[j as usize - 1];
            assert!(absolute_frequency(f, i, n, row.speed_rad_s) < 1e-9);
        }
    }

    #[test]
    fn driven_crossings_are_multiples_of_the_lobe_count_on_their_alias() {
        let grid: Vec<f64> = (2..=24).map(|i| TAU * 0.25 * f64::from(i)).collect();
        let table: Table =
            grid.iter().map(|&s| (0..=5).map(|i| PaperFit.at(s, i).unwrap()).collect()).collect();
        let found = driven_crossings(&alike(&table), &grid, 2, &multiples(2, 24), 10);
        assert!(!found.is_empty());
        for c in &found {
            assert_eq!(c.engine_order % 2, 0);
            assert_eq!(fold(c.engine_order, 10), c.nodal_diameter);
            assert!(
                (c.frequency_hz - f64::from(c.engine_order) * c.speed_rad_s / TAU).abs()
                    < 1e-12 * c.frequency_hz
            );
        }
        assert!(
            found.iter().any(|c| (c.nodal_diameter, c.engine_order) == (4, 6)),
            "aliased orders count too"
        );
    }
}
