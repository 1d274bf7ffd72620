//! Force maps: contact over speed and contact node.

use super::Export;
use super::array::Array;
use crate::analysis::result::{ForceMap, ForceRow};

/// Field of a row that has a number per contact node.
type PerNode = fn(&ForceRow) -> &[f64];

/// Fields of a row that have a number per contact node, with their names.
const PER_NODE: [(&str, PerNode); 6] = [
    ("peak_force", |row| &row.peak_force),
    ("impulse_per_revolution", |row| &row.impulse_per_revolution),
    ("contact_share", |row| &row.contact_share),
    ("closings_per_revolution", |row| &row.closings_per_revolution),
    ("clearance_consumption", |row| &row.clearance_consumption),
    ("linear_clearance_consumption", |row| &row.linear_clearance_consumption),
];

impl Export for ForceMap {
    /// A line per completed speed and contact node.
    fn table(&self) -> Vec<Array> {
        let nodes = self.rows.iter().flatten().map(|row| row.peak_force.len()).max().unwrap_or(0);
        let rows = || self.speeds_rad_s.iter().zip(&self.rows).enumerate();
        let places = || {
            let places = rows().filter_map(|(index, (speed, row))| Some((index, *speed, row.as_ref()?)));
            places.flat_map(|(index, speed, row)| (0..nodes).map(move |node| (index, speed, row, node)))
        };
        let unit = |name: &str| match name {
            "peak_force" => format!("{name}_{}", self.units.force),
            "impulse_per_revolution" => format!("{name}_{}_{}", self.units.force, self.units.time),
            name => name.to_owned(),
        };
        let mut columns = vec![
            Array::whole("index", places().map(|(index, ..)| index as u32)),
            Array::reals("speed_rad_s", places().map(|(_, speed, ..)| speed)),
            Array::whole("contact_node", places().map(|(.., node)| node as u32)),
            Array::some_whole("worst_sector", places().map(|(.., row, node)| *row.worst_sector.get(node)?)),
        ];
        columns.extend(PER_NODE.iter().map(|(name, of)| {
            Array::some_reals(unit(name), places().map(|(.., row, node)| of(row).get(node).copied()))
        }));
        columns
    }

    /// Arrays as `[speed][contact node]`; NaN where a speed is not completed.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = vec![Array::reals("speeds_rad_s", self.speeds_rad_s.iter().copied())];
        arrays.extend(PER_NODE.iter().map(|(name, of)| {
            Array::rows(*name, self.rows.iter().map(|row| row.as_ref().map_or(&[][..], of)))
        }));
        let summaries = || self.rows.iter().map(|row| row.as_ref().map(|row| &row.summary));
        arrays.extend([
            Array::some_reals("mean_force", summaries().map(|summary| Some(summary?.mean_force))),
            Array::some_reals("wheel_peak_force", summaries().map(|summary| Some(summary?.peak_force))),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
