//! Histories at one speed, sample by sample.

use super::Export;
use super::array::Array;
use crate::analysis::result::{ContactHistory, EnergyHistory, SpeedHistories};

/// Histories of the energy by the names of their fields; histories that were not recorded are empty.
fn energies(energy: &EnergyHistory) -> [(&'static str, &[f64]); 9] {
    [
        ("mechanical", &energy.mechanical),
        ("contact_work", &energy.contact_work),
        ("damping_loss", &energy.damping_loss),
        ("excitation_work", &energy.excitation_work),
        ("mistuning_work", &energy.mistuning_work),
        ("bending_work", &energy.bending_work),
        ("casing_work", &energy.casing_work),
        ("casing_loss", &energy.casing_loss),
        ("friction_heat", &energy.friction_heat),
    ]
}

/// Every history of one number per sample with its name in a table.
fn columns(histories: &SpeedHistories) -> Vec<(String, &[f64])> {
    let units = &histories.units;
    let (length, force, time) = (&units.length, &units.force, &units.time);
    let mut columns: Vec<(String, &[f64])> = Vec::new();
    for (index, sensor) in histories.sensors.iter().enumerate() {
        let (what, rate) = match sensor.sensor.gauge {
            Some(_) => ("strain".to_owned(), format!("strain_per_{time}")),
            None => (format!("displacement_{length}"), format!("velocity_{length}_per_{time}")),
        };
        columns.push((format!("sensor_{index}_{what}"), &sensor.displacement));
        columns.push((format!("sensor_{index}_{rate}"), &sensor.velocity));
    }
    if let Some(ContactHistory { force: forces, nodes_in_contact, contact_length }) = &histories.contact {
        columns.push(("nodes_in_contact".to_owned(), nodes_in_contact));
        columns.push((format!("contact_length_{length}"), contact_length));
        for (sector, nodes) in forces.iter().enumerate() {
            columns.extend(nodes.iter().enumerate().map(|(node, samples)| {
                (format!("force_sector_{sector}_node_{node}_{force}"), samples.as_slice())
            }));
        }
    }
    if let Some(energy) = &histories.energy {
        let named = energies(energy).into_iter();
        columns.extend(named.map(|(name, samples)| (format!("energy_{name}_{force}_{length}"), samples)));
    }
    columns.retain(|(_, samples)| !samples.is_empty());
    columns
}

/// Instants of the samples, in revolutions after the start.
fn revolutions(histories: &SpeedHistories) -> Array {
    let samples = columns(histories).iter().map(|(_, samples)| samples.len()).max().unwrap_or(0);
    let [begin, _] = histories.revolutions;
    let per_revolution = f64::from(histories.samples_per_revolution);
    Array::reals("revolution", (1..=samples).map(|sample| f64::from(begin) + sample as f64 / per_revolution))
}

impl Export for SpeedHistories {
    /// A line per sample, a column per history.
    fn table(&self) -> Vec<Array> {
        let first = revolutions(self);
        let samples = first.values.len();
        let columns = columns(self).into_iter().map(|(name, values)| {
            Array::some_reals(name, (0..samples).map(|sample| values.get(sample).copied()))
        });
        [first].into_iter().chain(columns).collect()
    }

    /// Arrays as `[sensor][sample]`, `[sector][contact node][sample]` and `[sample]`; histories that were not recorded are absent.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = vec![Array::real("speed_rad_s", self.speed_rad_s), revolutions(self)];
        let sensors = || self.sensors.iter();
        arrays.push(Array::rows("displacement", sensors().map(|sensor| sensor.displacement.as_slice())));
        arrays.push(Array::rows("velocity", sensors().map(|sensor| sensor.velocity.as_slice())));
        if let Some(contact) = &self.contact {
            arrays.push(Array::cube("force", &contact.force));
            arrays.push(Array::reals("nodes_in_contact", contact.nodes_in_contact.iter().copied()));
            arrays.push(Array::reals("contact_length", contact.contact_length.iter().copied()));
        }
        if let Some(energy) = &self.energy {
            let named = energies(energy).into_iter();
            arrays.extend(
                named.map(|(name, samples)| Array::reals(format!("energy_{name}"), samples.iter().copied())),
            );
            arrays.push(Array::real("energy_initial", energy.initial));
        }
        arrays.retain(|array| !array.values.is_empty());
        arrays.extend([
            Array::sensors(self.sensors.iter().map(|sensor| &sensor.sensor)),
            Array::json("point", &self.point),
            Array::json("settings", &self.settings),
            Array::json("units", &self.units),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
