//! Backbone curves.

use super::Export;
use super::array::Array;
use crate::analysis::result::{BackboneCurve, BackbonePoint, Backbones};

/// Points of all curves, each with its curve.
fn points(of: &Backbones) -> Vec<(&BackboneCurve, &BackbonePoint)> {
    of.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point))).collect()
}

/// Columns of numbers, with an entry per point, curve by curve.
fn numbers(of: &Backbones) -> Vec<Array> {
    let points = points(of);
    let only = || points.iter().map(|(_, point)| *point);
    vec![
        Array::whole("nodal_diameter", points.iter().map(|(curve, _)| curve.nodal_diameter)),
        Array::whole("family", points.iter().map(|(curve, _)| curve.family)),
        Array::reals(format!("amplitude_{}", of.units.length), only().map(|point| point.amplitude)),
        Array::reals("frequency_hz", only().map(|point| point.frequency_hz)),
        Array::reals("change_percent", only().map(|point| point.change_percent)),
        Array::reals("outside_coordinates", points.iter().map(|(curve, _)| curve.outside_coordinates)),
        Array::reals("harmonics_percent", only().map(|point| point.harmonics_percent)),
    ]
}

impl Export for Backbones {
    /// A line per point, curve by curve, with the end of its curve.
    fn table(&self) -> Vec<Array> {
        let points = points(self);
        let curves = || points.iter().map(|(curve, _)| *curve);
        let mut columns = numbers(self);
        columns.extend([
            Array::flags("complete", curves().map(|curve| curve.complete)),
            Array::texts("end", curves().map(|curve| curve.end.as_str())),
            Array::texts("passed", curves().map(|curve| curve.passed.join("; "))),
        ]);
        columns
    }

    /// Numbers of all points, and the curves with the reasons for their ends.
    fn arrays(&self) -> Vec<Array> {
        let curves = || self.curves.iter();
        let mut arrays = numbers(self);
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
