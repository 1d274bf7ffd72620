//! Run-ups and their spectrograms.

use super::Export;
use super::array::Array;
use crate::analysis::result::{RunUp, RunUpEnd, RunUpFrame, RunUps, Spectrogram};

impl Export for RunUps {
    /// A line per frame, run by run.
    fn table(&self) -> Vec<Array> {
        let frames: Vec<(&RunUp, &RunUpFrame)> =
            self.runs.iter().flat_map(|run| run.frames.iter().map(move |frame| (run, frame))).collect();
        let of = || frames.iter().map(|(_, frame)| *frame);
        let mut columns = vec![
            Array::whole("run", frames.iter().map(|(run, _)| run.run)),
            Array::some_reals("rate_rad_s2", frames.iter().map(|(run, _)| run.rate_rad_s2)),
            Array::reals("revolution", of().map(|frame| frame.revolution as f64)),
            Array::reals("start_s", of().map(|frame| frame.times_s[0])),
            Array::reals("end_s", of().map(|frame| frame.times_s[1])),
            Array::reals("speed_start_rad_s", of().map(|frame| frame.speeds_rad_s[0])),
            Array::reals("speed_end_rad_s", of().map(|frame| frame.speeds_rad_s[1])),
        ];
        for (index, sensor) in self.sensors.iter().enumerate() {
            let unit = sensor.unit(&self.units);
            columns.push(Array::some_reals(
                format!("largest_{index}_{unit}"),
                of().map(|frame| frame.largest.get(index).copied()),
            ));
            columns.push(Array::some_reals(
                format!("half_peak_to_peak_{index}_{unit}"),
                of().map(|frame| frame.half_peak_to_peak.get(index).copied()),
            ));
        }
        columns.push(Array::reals("contact_share", of().map(|frame| frame.contact_share)));
        columns
    }

    /// Columns of the table, the runs with how they ended, and the settings that all rest on.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = self.table();
        let ends = || self.runs.iter().map(|run| run.end.as_ref());
        let of = |read: fn(&RunUpEnd) -> f64| ends().map(move |end| end.map(read));
        arrays.extend([
            Array::some_reals("runs_rate_rad_s2", self.runs.iter().map(|run| run.rate_rad_s2)),
            Array::words("runs_status", ends().map(|end| end.map(|end| end.status))),
            Array::some_reals("runs_steps", of(|end| end.steps as f64)),
            Array::some_reals("runs_largest_angle_error_rad", of(|end| end.largest_angle_error_rad)),
            Array::some_reals("runs_energy_residual", of(|end| end.energy_residual)),
            Array::some_reals("runs_transfer_loss", of(|end| end.transfer_loss)),
        ]);
        for index in 0..self.sensors.len() {
            let largest = || ends().map(move |end| end.and_then(|end| end.largest.get(index)));
            arrays.push(Array::some_reals(
                format!("runs_largest_{index}"),
                largest().map(|largest| largest.map(|largest| largest.displacement)),
            ));
            arrays.push(Array::some_reals(
                format!("runs_largest_{index}_speed_rad_s"),
                largest().map(|largest| largest.map(|largest| largest.speed_rad_s)),
            ));
        }
        arrays.extend([
            Array::json("passing", &self.passing),
            Array::sensors(&self.sensors),
            Array::json("units", &self.units),
            Array::json("settings", &self.settings),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}

impl Export for Spectrogram {
    /// A line per frame, a column per engine order.
    fn table(&self) -> Vec<Array> {
        let unit = self.sensor.unit(&self.units);
        let mut columns = frames(self);
        for (line, order) in self.engine_orders.iter().enumerate() {
            columns.push(Array::some_reals(
                format!("order_{order}_{unit}"),
                self.amplitudes.iter().map(|frame| frame.get(line).copied()),
            ));
        }
        columns
    }

    /// Frames of the spectrogram; `amplitudes` is `[frame][line]`.
    fn arrays(&self) -> Vec<Array> {
        let mut arrays = frames(self);
        arrays.extend([
            Array::reals("engine_orders", self.engine_orders.iter().copied()),
            Array::rows("amplitudes", self.amplitudes.iter().map(Vec::as_slice)),
            Array::sensors([&self.sensor]),
            Array::json("units", &self.units),
            Array::json("settings", &self.settings),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}

/// Time and speeds of the frames of a spectrogram.
fn frames(of: &Spectrogram) -> Vec<Array> {
    vec![
        Array::reals("time_s", of.times_s.iter().copied()),
        Array::reals("speed_start_rad_s", of.speeds_rad_s.iter().map(|speeds| speeds[0])),
        Array::reals("speed_end_rad_s", of.speeds_rad_s.iter().map(|speeds| speeds[1])),
    ]
}
