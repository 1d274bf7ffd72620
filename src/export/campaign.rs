//! Export of campaigns.

use super::Export;
use super::array::Array;
use crate::analysis::result::{Campaign, DesignOutcome, severity_column};

impl Export for Campaign {
    /// A line per design.
    fn table(&self) -> Vec<Array> {
        let designs = || self.designs.iter();
        let parameters = self.settings.parameters.iter().enumerate();
        let mut columns = vec![Array::whole("design", designs().map(|design| design.index))];
        columns.extend(parameters.map(|(place, parameter)| {
            let values = designs().map(|design| design.values.get(place).copied());
            Array::some_reals(parameter.name.clone(), values).under_given_name()
        }));
        let severity = severity_column(self.settings.severity, &self.units);
        let own: Vec<&DesignOutcome> = designs().map(|design| &design.outcome).collect();
        columns.extend(outcomes("", &severity, &own));
        columns.extend(outcomes("compared_", &severity, &self.compared()));
        columns
    }

    /// Columns of the table; `by_speed` as `[design][speed]`; sensitivities as one array per field.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        arrays.push(Array::reals("speeds_rad_s", self.speeds_rad_s.iter().copied()));
        let own: Vec<&DesignOutcome> = self.designs.iter().map(|design| &design.outcome).collect();
        arrays.push(by_speed("by_speed", &own));
        if self.comparison.is_some() {
            arrays.push(by_speed("compared_by_speed", &self.compared()));
        }
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
            Array::json("comparison", &self.comparison),
            Array::json("settings", &self.settings),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}

/// Columns of the outcomes of designs with one model; none for a model that is not there.
fn outcomes(prefix: &str, severity: &str, of: &[&DesignOutcome]) -> Vec<Array> {
    if of.is_empty() {
        return Vec::new();
    }
    let name = |name: &str| format!("{prefix}{name}");
    let meets = |met: Option<bool>| met.map_or("", |met| if met { "yes" } else { "no" });
    vec![
        Array::some_reals(name(severity), of.iter().map(|one| one.severity)),
        Array::some_reals(name("worst_speed_rad_s"), of.iter().map(|one| one.worst_speed_rad_s)),
        Array::texts(name("meets_limit"), of.iter().map(|one| meets(one.meets_limit))),
        Array::whole(name("finished"), of.iter().map(|one| one.finished)),
        Array::whole(name("diverged"), of.iter().map(|one| one.diverged)),
        Array::whole(name("failed"), of.iter().map(|one| one.failed)),
        Array::whole(name("not_settled"), of.iter().map(|one| one.not_settled)),
    ]
}

fn by_speed(name: &str, of: &[&DesignOutcome]) -> Array {
    let row = |one: &&DesignOutcome| -> Vec<f64> {
        one.by_speed.iter().map(|severity| severity.unwrap_or(f64::NAN)).collect()
    };
    let rows: Vec<Vec<f64>> = of.iter().map(row).collect();
    Array::rows(name, rows.iter().map(Vec::as_slice))
}
