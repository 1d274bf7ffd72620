//! Amplitudes of a map as cells.

use crate::frame::Frame;
use crate::heat::Heat;
use crate::layer::{Band, Cells};
use crate::map_view::VerticalAxis;

/// Cells of a map with the amplitude of each, its frequency in Hz (with frequencies on the vertical axis: its engine order), and the speed
/// in rad/s.
pub(super) fn cells(heat: &Heat<'_>) -> Cells {
    let view = &heat.view;
    let rows = heat.rows();
    let (mut values, mut data) = (Vec::new(), Vec::new());
    for row in &rows {
        let (mut line, mut numbers) = (Vec::new(), Vec::new());
        for column in heat.columns() {
            let found = column.iter().filter_map(|cell| Some((heat.loudest(cell, row)?, cell.rpm)));
            let found = found.max_by(|a, b| a.0.total_cmp(&b.0));
            line.push(found.map(|(amplitude, _)| amplitude));
            numbers.push(found.map_or_else(Vec::new, |(amplitude, rpm)| {
                let other = match view.axis {
                    VerticalAxis::EngineOrder => row.middle * rpm / 60.0,
                    VerticalAxis::Frequency => view.order(row.middle, rpm),
                };
                [amplitude, other, rpm * std::f64::consts::TAU / 60.0].map(|value| value as f32).to_vec()
            }));
        }
        values.push(line);
        data.push(numbers);
    }
    let (order, frequency) = match view.axis {
        VerticalAxis::EngineOrder => ("%{y:.4~g}", "%{customdata[1]:,.1f}"),
        VerticalAxis::Frequency => ("%{customdata[1]:.3~g}", "%{y:,.1f}"),
    };
    let orders = match view.frame {
        Frame::Rotating => "engine order",
        Frame::Fixed => "multiple of Ω",
    };
    let columns = heat.columns().map(|column| Band {
        from: column[0].from,
        to: column[column.len() - 1].to,
        value: column[column.len() / 2].rpm,
    });
    Cells {
        columns: columns.collect(),
        rows: rows.iter().map(|row| Band { from: row.band.0, to: row.band.1, value: row.middle }).collect(),
        values,
        hover: vec![
            "%{x:,.1f} rpm (%{customdata[2]:,.1f} rad/s)".to_owned(),
            format!("{orders} {order}, {frequency} Hz"),
            format!("%{{customdata[0]:.3~g}} {}", heat.map.sensor.unit(&heat.map.units)),
        ],
        has_speeds: false,
        merged: "",
        data,
    }
}
