//! Interaction maps, whose rows are read while they are written: all of them may be larger than memory.

use std::io::{self, Write};

use super::array::{Array, Values};
use super::{add_to_arrays, csv, for_reading, npz};
use crate::analysis::request::{Sensor, SpeedUnit};
use crate::analysis::result::{InteractionMap, Point, PointStatus};
use crate::package::NpzWriter;

/// Chosen speeds and engine orders of the maps of chosen sensors.
pub struct Maps<R> {
    /// Common part of the maps, without rows: the chosen speeds, engine orders and points.
    pub map: InteractionMap,
    /// Indices of the speeds in the request.
    pub indices: Vec<u32>,
    /// Sensors with their indices in the request.
    pub sensors: Vec<(u32, Sensor)>,
    /// Whether a sensor's index is part of the arrays' shapes though there is only one.
    pub several: bool,
    /// Function that reads the row of a sensor and a speed by their indices in the request: an amplitude per engine order; `None`
    /// where that speed has no result.
    pub row: R,
}

impl<R: Fn(u32, u32) -> io::Result<Option<Vec<f64>>>> Maps<R> {
    /// Writes a line per sensor and speed, a column per engine order; empty where a speed has no result. The utilisation is there if
    /// stress was asked for.
    ///
    /// # Errors
    /// Errors of writing and of reading rows.
    pub fn csv(&self, unit: Option<SpeedUnit>, out: &mut dyn Write) -> io::Result<()> {
        let (speeds, columns) = (self.indices.len(), self.map.engine_orders.len());
        let left = |sensor: u32| {
            let mut left = vec![
                Array::whole("sensor", std::iter::repeat_n(sensor, speeds)),
                Array::whole("index", self.indices.iter().copied()),
                Array::reals("speed_rad_s", self.map.speeds_rad_s.iter().copied()),
                Array::words("status", self.status()),
            ];
            if self.map.settings.record.stress.is_some() {
                left.push(Array::some_reals("utilisation", self.found(Point::utilisation)));
            }
            for_reading(left, unit)
        };
        let unit_of_all = Sensor::common_unit(self.sensors.iter().map(|(_, sensor)| sensor), &self.map.units);
        let orders = self.map.engine_orders.iter();
        // One row of ones: what the columns of orders are multiplied by.
        let orders = orders.map(|order| Array::reals(format!("order_{order}_{unit_of_all}"), [1.0]));
        let orders = for_reading(orders.collect(), unit);
        let factor = orders.first().map_or(1.0, |order| match &order.values {
            Values::Real(values) => values[0],
            _ => 1.0,
        });
        csv::names(&left(0), out)?;
        out.write_all(b",")?;
        csv::names(&orders, out)?;
        csv::end_line(out)?;
        for &(sensor, _) in &self.sensors {
            let left = left(sensor);
            for (line, &index) in self.indices.iter().enumerate() {
                csv::cells(&left, line, out)?;
                let row = self.row(sensor, index)?;
                for column in 0..columns {
                    out.write_all(b",")?;
                    csv::real(row.as_ref().map_or(f64::NAN, |row| factor * row[column]), out)?;
                }
                csv::end_line(out)?;
            }
        }
        Ok(())
    }

    /// Writes arrays; `amplitude` is `[speed][engine order]`, or `[sensor][speed][engine order]` for several sensors, with NaN
    /// where a speed has no result.
    ///
    /// # Errors
    /// As of [`Maps::csv`].
    pub fn npz(&self, unit: Option<SpeedUnit>, out: &mut dyn Write) -> io::Result<()> {
        let map = &self.map;
        let lacking =
            self.found(|point| Some(point.validity_lacking())).into_iter().map(Option::unwrap_or_default);
        let arrays = vec![
            Array::reals("speeds_rad_s", map.speeds_rad_s.iter().copied()),
            Array::whole("speed_indices", self.indices.iter().copied()),
            Array::words("status", self.status()),
            Array::reals("engine_orders", map.engine_orders.iter().copied()),
            Array::sensors(self.sensors.iter().map(|(_, sensor)| sensor)),
            Array::some_reals("utilisation", self.found(Point::utilisation)),
            Array::some_reals(
                "largest_von_mises",
                self.found(|point| Some(point.stress.as_ref()?.largest.von_mises)),
            ),
            Array::words("validity", self.found(Point::validity_verdict)),
            Array::word_lists("validity_lacking", lacking),
            Array::json("settings", &map.settings),
            Array::json("units", &map.units),
            Array::text("version", &map.version),
        ];
        let mut file = NpzWriter::stream(out);
        npz::add(&add_to_arrays(arrays, unit), &mut file)?;
        let (speeds, columns) = (self.indices.len(), map.engine_orders.len());
        let shape = [self.sensors.len(), speeds, columns];
        file.reals_by("amplitude", if self.several { &shape } else { &shape[1..] }, |take| {
            for &(sensor, _) in &self.sensors {
                for &index in &self.indices {
                    match self.row(sensor, index)? {
                        Some(row) => row.into_iter().try_for_each(&mut *take)?,
                        None => (0..columns).try_for_each(|_| take(f64::NAN))?,
                    }
                }
            }
            Ok(())
        })?;
        file.finish()
    }

    /// Status of each speed; `None` for those that are not finished.
    fn status(&self) -> Vec<Option<PointStatus>> {
        self.found(|point| Some(point.status))
    }

    /// Values that `of` reads from the points of the speeds; `None` for speeds that are not finished.
    fn found<T>(&self, of: impl Fn(&Point) -> Option<T>) -> Vec<Option<T>> {
        let found = |index: &u32| {
            let place = self.map.points.binary_search_by_key(index, |point| point.index).ok()?;
            of(&self.map.points[place])
        };
        self.indices.iter().map(found).collect()
    }

    /// Reads a row; an error if it is not as long as there are engine orders.
    fn row(&self, sensor: u32, index: u32) -> io::Result<Option<Vec<f64>>> {
        let row = (self.row)(sensor, index)?;
        match &row {
            Some(row) if row.len() != self.map.engine_orders.len() => {
                Err(io::Error::other(format!("speed {index} has {} amplitudes", row.len())))
            }
            _ => Ok(row),
        }
    }
}
