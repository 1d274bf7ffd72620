//! Backbone curves.

use super::Export;
use super::array::Array;
use crate::analysis::result::{BackboneCurve, BackbonePoint, Backbones};

impl Export for Backbones {
    /// A line per point, curve by curve.
    fn table(&self) -> Vec<Array> {
        let points: Vec<(&BackboneCurve, &BackbonePoint)> = self
            .curves
            .iter()
            .flat_map(|curve| curve.points.iter().map(move |point| (curve, point)))
            .collect();
        let of = || points.iter().map(|(_, point)| *point);
        vec![
            Array::whole("nodal_diameter", points.iter().map(|(curve, _)| curve.nodal_diameter)),
            Array::whole("family", points.iter().map(|(curve, _)| curve.family)),
            Array::reals(format!("amplitude_{}", self.units.length), of().map(|point| point.amplitude)),
            Array::reals("frequency_hz", of().map(|point| point.frequency_hz)),
            Array::reals("change_percent", of().map(|point| point.change_percent)),
            Array::reals("outside_coordinates", points.iter().map(|(curve, _)| curve.outside_coordinates)),
            Array::reals("harmonics_percent", of().map(|point| point.harmonics_percent)),
        ]
    }

    /// Columns of the table, and the curves with the reasons for their ends.
    fn arrays(&self) -> Vec<Array> {
        let curves = || self.curves.iter();
        let mut arrays = self.table();
        arrays.extend([
            Array::whole("curves_nodal_diameter", curves().map(|curve| curve.nodal_diameter)),
            Array::whole("curves_family", curves().map(|curve| curve.family)),
            Array::whole("curves_contact_node", curves().map(|curve| curve.contact_node)),
            Array::words("curves_component", curves().map(|curve| curve.component)),
            Array::flags("curves_complete", curves().map(|curve| curve.complete)),
            Array::texts("curves_end", curves().map(|curve| curve.end.as_str())),
            Array::texts("curves_passed", curves().map(|curve| curve.passed.join("; "))),
            Array::real("speed_rad_s", self.speed_rad_s),
            Array::text("model", &self.model),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
