//! Campaigns.

use super::Export;
use super::array::Array;
use crate::analysis::result::{Campaign, severity_unit};

impl Export for Campaign {
    /// A line per design.
    fn table(&self) -> Vec<Array> {
        let designs = || self.designs.iter();
        let parameters = self.settings.parameters.iter().enumerate();
        let mut columns = vec![Array::whole("design", designs().map(|design| design.index))];
        columns.extend(parameters.map(|(place, parameter)| {
            Array::some_reals(
                parameter.name.clone(),
                designs().map(|design| design.values.get(place).copied()),
            )
        }));
        let unit = severity_unit(self.settings.severity, &self.units);
        let severity =
            format!("{}{}{unit}", self.settings.severity.as_str(), if unit.is_empty() { "" } else { "_" });
        let meets = |met: Option<bool>| met.map_or("", |met| if met { "yes" } else { "no" });
        columns.extend([
            Array::some_reals(severity, designs().map(|design| design.severity)),
            Array::some_reals("worst_speed_rad_s", designs().map(|design| design.worst_speed_rad_s)),
            Array::texts("meets_limit", designs().map(|design| meets(design.meets_limit))),
            Array::whole("finished", designs().map(|design| design.finished)),
            Array::whole("diverged", designs().map(|design| design.diverged)),
            Array::whole("failed", designs().map(|design| design.failed)),
        ]);
        columns
    }

    /// The columns of the table; `by_speed` is `[design][speed]`; sensitivities one array per field.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        let row = |by_speed: &Vec<Option<f64>>| -> Vec<f64> {
            by_speed.iter().map(|severity| severity.unwrap_or(f64::NAN)).collect()
        };
        let rows: Vec<Vec<f64>> = self.designs.iter().map(|design| row(&design.by_speed)).collect();
        arrays.push(Array::reals("speeds_rad_s", self.speeds_rad_s.iter().copied()));
        arrays.push(Array::rows("by_speed", rows.iter().map(Vec::as_slice)));
        if let Some(sensitivities) = &self.sensitivities {
            let of = || sensitivities.parameters.iter();
            arrays.extend([
                Array::texts("parameter", of().map(|one| one.parameter.as_str())),
                Array::reals("first_order", of().map(|one| one.first_order)),
                Array::reals("first_order_error", of().map(|one| one.first_order_error)),
                Array::reals("total", of().map(|one| one.total)),
                Array::reals("total_error", of().map(|one| one.total_error)),
            ]);
        }
        arrays.extend([
            Array::json("threshold", &self.threshold),
            Array::json("settings", &self.settings),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
