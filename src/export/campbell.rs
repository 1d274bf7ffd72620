//! Natural frequencies over speed.

use super::Export;
use super::array::Array;
use crate::analysis::result::{Campbell, FollowedFamilies, WaveTables};

impl Export for Campbell {
    /// A line per speed, nodal diameter and family.
    fn table(&self) -> Vec<Array> {
        let mut places = Vec::new();
        for (speed, by_diameter) in self.frequencies_hz.iter().enumerate() {
            for (diameter, families) in by_diameter.iter().enumerate() {
                places.extend((0..families.len()).map(|family| (speed, diameter, family)));
            }
        }
        let of = |name: String, table: &[Vec<Vec<f64>>]| {
            let at = |&(speed, diameter, family): &(usize, usize, usize)| {
                table.get(speed)?.get(diameter)?.get(family).copied()
            };
            Array::some_reals(name, places.iter().map(at))
        };
        let mut columns = vec![
            Array::reals("speed_rad_s", places.iter().map(|place| self.speeds_rad_s[place.0])),
            Array::whole("nodal_diameter", places.iter().map(|place| place.1 as u32)),
            Array::whole("family", places.iter().map(|place| place.2 as u32 + 1)),
            of("frequency_hz".to_owned(), &self.frequencies_hz),
        ];
        if let Some(FollowedFamilies { ranks, assurance, .. }) = &self.followed {
            let rank = |&(speed, diameter, family): &(usize, usize, usize)| {
                ranks.get(speed)?.get(diameter)?.get(family).copied()
            };
            columns.push(Array::some_whole("rank", places.iter().map(rank)));
            columns.push(of("assurance".to_owned(), assurance));
        }
        if let Some(WaveTables { forward_hz, backward_hz }) = &self.waves {
            columns.push(of("forward_hz".to_owned(), forward_hz));
            columns.push(of("backward_hz".to_owned(), backward_hz));
        }
        columns.extend(self.absolute_frequencies_hz.iter().map(|absolute| {
            of(format!("absolute_superharmonic_{}_hz", absolute.superharmonic), &absolute.frequencies_hz)
        }));
        columns
    }

    fn arrays(&self) -> Vec<Array> {
        let absolute = &self.absolute_frequencies_hz;
        let flat: Vec<Vec<Vec<f64>>> = absolute.iter().flat_map(|one| one.frequencies_hz.clone()).collect();
        let mut arrays = vec![
            Array::reals("speeds_rad_s", self.speeds_rad_s.iter().copied()),
            Array::cube("frequencies_hz", &self.frequencies_hz),
            Array::whole("superharmonics", absolute.iter().map(|one| one.superharmonic)),
            Array::cube("absolute_frequencies_hz", &flat).in_parts(absolute.len()),
        ];
        if let Some(FollowedFamilies { ranks, assurance, veerings }) = &self.followed {
            let real = |ranks: &Vec<u32>| ranks.iter().copied().map(f64::from).collect();
            let rows = |rows: &Vec<Vec<u32>>| rows.iter().map(real).collect();
            arrays.push(Array::cube("ranks", &ranks.iter().map(rows).collect::<Vec<_>>()));
            arrays.push(Array::cube("assurance", assurance));
            arrays.extend([
                Array::reals("veerings_speed_rad_s", veerings.iter().map(|found| found.speed_rad_s)),
                Array::reals("veerings_frequency_hz", veerings.iter().map(|found| found.frequency_hz)),
                Array::reals("veerings_distance_hz", veerings.iter().map(|found| found.distance_hz)),
                Array::whole("veerings_nodal_diameter", veerings.iter().map(|found| found.nodal_diameter)),
                Array::whole("veerings_lower_family", veerings.iter().map(|found| found.families[0])),
                Array::whole("veerings_upper_family", veerings.iter().map(|found| found.families[1])),
                Array::words("veerings_course", veerings.iter().map(|found| found.course)),
            ]);
        }
        if let Some(WaveTables { forward_hz, backward_hz }) = &self.waves {
            arrays.push(Array::cube("forward_hz", forward_hz));
            arrays.push(Array::cube("backward_hz", backward_hz));
        }
        let (linear, driven) = (&self.crossings, &self.driven_crossings);
        arrays.extend([
            Array::reals("crossings_speed_rad_s", linear.iter().map(|crossing| crossing.speed_rad_s)),
            Array::reals("crossings_frequency_hz", linear.iter().map(|crossing| crossing.frequency_hz)),
            Array::whole("crossings_nodal_diameter", linear.iter().map(|crossing| crossing.nodal_diameter)),
            Array::whole("crossings_family", linear.iter().map(|crossing| crossing.family)),
            Array::whole("crossings_superharmonic", linear.iter().map(|crossing| crossing.superharmonic)),
            Array::reals("driven_crossings_speed_rad_s", driven.iter().map(|crossing| crossing.speed_rad_s)),
            Array::reals(
                "driven_crossings_frequency_hz",
                driven.iter().map(|crossing| crossing.frequency_hz),
            ),
            Array::whole(
                "driven_crossings_nodal_diameter",
                driven.iter().map(|crossing| crossing.nodal_diameter),
            ),
            Array::whole("driven_crossings_family", driven.iter().map(|crossing| crossing.family)),
            Array::whole(
                "driven_crossings_engine_order",
                driven.iter().map(|crossing| crossing.engine_order),
            ),
            Array::json("settings", &self.settings),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
