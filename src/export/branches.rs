//! Branches of periodic responses.

use super::Export;
use super::array::Array;
use crate::analysis::request::BranchParameter;
use crate::analysis::result::{BranchPoint, BranchTrack, Branches};

impl Export for Branches {
    /// A line per point, branch by branch, in the order of each.
    fn table(&self) -> Vec<Array> {
        let points: Vec<(&BranchTrack, &BranchPoint)> = self
            .branches
            .iter()
            .flat_map(|branch| branch.points.iter().map(move |point| (branch, point)))
            .collect();
        let of = || points.iter().map(|(_, point)| *point);
        let leading = || of().map(|point| point.multipliers.first());
        let value = if self.head.parameter == BranchParameter::Speed { "value_rad_s" } else { "value" };
        let mut columns = vec![
            Array::whole("branch", points.iter().map(|(branch, _)| branch.track.branch)),
            Array::reals(value, of().map(|point| point.value)),
            Array::reals("speed_rad_s", of().map(|point| point.speed_rad_s)),
        ];
        for (sensor, place) in self.head.sensors.iter().enumerate() {
            let name = format!("half_peak_to_peak_{sensor}_{}", place.unit(&self.head.units));
            columns.push(Array::some_reals(
                name,
                of().map(|point| point.half_peak_to_peak.get(sensor).copied()),
            ));
        }
        columns.extend([
            Array::words("stability", of().map(|point| point.stability)),
            Array::some_reals("multiplier_real", leading().map(|one| Some(one?.real))),
            Array::some_reals("multiplier_imaginary", leading().map(|one| Some(one?.imaginary))),
            Array::some_reals("multiplier_residual", leading().map(|one| Some(one?.residual))),
            Array::some_reals("order_offset", leading().map(|one| Some(one?.order_offset))),
            Array::some_whole("nodal_diameter", leading().map(|one| Some(one?.nodal_diameter))),
            Array::whole("lobe_passages", of().map(|point| point.lobe_passages)),
            Array::reals("residual", of().map(|point| point.residual)),
            Array::whole("newton_steps", of().map(|point| point.newton_steps)),
            Array::reals("revolutions", of().map(|point| point.revolutions)),
        ]);
        columns
    }

    /// Columns of the table, bifurcations and maxima with the number of their branch, and the settings that all rest on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        let bifurcations = || {
            self.branches
                .iter()
                .flat_map(|branch| branch.bifurcations.iter().map(move |one| (branch.track.branch, one)))
        };
        let maxima = || {
            self.branches
                .iter()
                .flat_map(|branch| branch.maxima.iter().map(move |one| (branch.track.branch, one)))
        };
        arrays.extend([
            Array::whole("bifurcations_branch", bifurcations().map(|(branch, _)| branch)),
            Array::words("bifurcations_kind", bifurcations().map(|(_, one)| one.kind)),
            Array::reals("bifurcations_value", bifurcations().map(|(_, one)| one.value)),
            Array::reals("bifurcations_error", bifurcations().map(|(_, one)| one.error)),
            Array::whole("maxima_branch", maxima().map(|(branch, _)| branch)),
            Array::whole("maxima_sensor", maxima().map(|(_, one)| one.sensor)),
            Array::reals("maxima_value", maxima().map(|(_, one)| one.value)),
            Array::reals("maxima_error", maxima().map(|(_, one)| one.error)),
            Array::reals("maxima_half_peak_to_peak", maxima().map(|(_, one)| one.half_peak_to_peak)),
            Array::json("settings", &self.head.settings),
            Array::text("version", &self.head.version),
        ]);
        arrays
    }
}
