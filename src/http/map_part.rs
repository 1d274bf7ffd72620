//! Part of a sweep's interaction maps that a request asks for, and its rows.

use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::problem::Problem;
use super::results::{FrameWord, check_sensor, sweep};
use super::selection;
use crate::analysis::kinds::sweep::ERRORS;
use crate::analysis::request::{Sensor, SpeedUnit};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{InteractionMap, SpeedSpectra};
use crate::analysis::run;
use crate::plot::{Frame, Window};
use crate::store::jobs::{Job, JobId};
use crate::store::{Store, StoreError};

/// Part of an interaction map to download, and its drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct MapQuery {
    /// Index of the sensor in the request; default 0.
    sensor: Option<u32>,
    /// Indices of sensors and ranges of them, such as `0-2,5`, in place of `sensor`. Amplitudes are then
    /// `[sensor][speed][engine order]`, even of one.
    #[param(max_length = 1000)]
    sensors: Option<String>,
    /// Speeds to download: indices in the request and ranges of them, or ranges in rpm, rad_s or hz, such as `0-9,15` or
    /// `24000-28000rpm`; default all. A drawing shows everything from the slowest to the fastest of them.
    #[param(max_length = 1000)]
    speeds: Option<String>,
    /// Engine orders to download: numbers and ranges, such as `0-8,12`; default all. A drawing shows everything from the lowest to the highest.
    #[param(max_length = 1000)]
    orders: Option<String>,
    /// Nodal diameter: only the wheel's component in it.
    nodal_diameter: Option<u32>,
    /// Nodal diameters of a sheet, such as `0-4`, in place of `nodal_diameter`: a drawing with a map of each of them.
    #[param(max_length = 1000)]
    nodal_diameters: Option<String>,
    /// Vertical axis of a drawing; default `engine_order`. A sheet has engine orders.
    #[param(inline)]
    pub(super) axis: Option<MapAxis>,
    /// Frame in which a drawing that is not a sheet shows the vibration; default `rotating`. In the fixed frame `orders` are
    /// multiples of the rotational frequency.
    #[param(inline)]
    pub(super) frame: Option<FrameWord>,
    /// Colour of the level above a drawn map, and of the strip above each map of a sheet; default `plain`.
    #[param(inline)]
    pub(super) colour: Option<MapColour>,
}

/// Quantity by which the level of an interaction map is coloured.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum MapColour {
    /// No quantity: one colour.
    Plain,
    /// Largest utilisation at each speed; critical speeds are labelled with theirs.
    Utilisation,
}

/// Vertical axis of an interaction map.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum MapAxis {
    /// Engine order: lines of equal engine order are horizontal.
    EngineOrder,
    /// Frequency: lines of equal engine order rise with speed.
    Frequency,
}

/// Part of a sweep's maps that a request asks for.
pub(super) struct Part {
    /// Sensors with their indices in the request, ascending.
    pub(super) sensors: Vec<(u32, Sensor)>,
    /// Whether the request has `sensors`, even with one index.
    pub(super) several: bool,
    /// Indices of the speeds in the request, ascending.
    pub(super) speeds: Vec<u32>,
    /// Columns of the engine orders, ascending.
    pub(super) columns: Vec<usize>,
    /// Whether the request selects speeds, and whether it selects engine orders.
    selects: (bool, bool),
    /// Nodal diameters; `None` is the motion of the whole wheel.
    pub(super) diameters: Vec<Option<u32>>,
    /// Whether the request has `nodal_diameters`: a sheet.
    pub(super) sheet: bool,
    /// Frame of a map that is not on a sheet.
    pub(super) frame: Frame,
}

impl Part {
    pub(super) fn of(job: &Job, query: &MapQuery) -> Result<Self, Problem> {
        let (request, facts) = sweep(job)?;
        let sensors = match (query.sensor, &query.sensors) {
            (Some(_), Some(_)) => {
                return Err(Problem::parameter("sensors", "give either sensor or sensors"));
            }
            (_, Some(sensors)) => selection::sensors(sensors, request.sensors().len())?,
            (sensor, None) => {
                let sensor = sensor.unwrap_or(0);
                check_sensor(request.sensors(), sensor)?;
                vec![sensor]
            }
        };
        let largest = facts.sectors / 2;
        let diameters = match (query.nodal_diameter, &query.nodal_diameters) {
            (Some(_), Some(_)) => {
                return Err(Problem::parameter(
                    "nodal_diameters",
                    "give either nodal_diameter or nodal_diameters",
                ));
            }
            (_, Some(some)) => {
                let some = selection::list("nodal_diameters", some, largest as usize + 1, "nodal diameter")?;
                some.into_iter().map(Some).collect()
            }
            (Some(nodal_diameter), None) if nodal_diameter > largest => {
                let detail = format!("{} sectors have nodal diameters 0 to {largest}", facts.sectors);
                return Err(Problem::parameter("nodal_diameter", detail));
            }
            (nodal_diameter, None) => vec![nodal_diameter],
        };
        let frame = FrameWord::frame(query.frame);
        if frame == Frame::Fixed && query.nodal_diameters.is_some() {
            return Err(Problem::parameter(
                "frame",
                "a sheet is in the rotating frame: give one nodal_diameter or none",
            ));
        }
        let (grid, orders) = (request.speeds().rad_s(), run::map_engine_orders(request));
        let speeds = query.speeds.as_ref().map(|some| selection::speeds(some, grid)).transpose()?;
        let columns = query.orders.as_ref().map(|some| selection::orders(some, &orders)).transpose()?;
        let all = whole(request);
        Ok(Self {
            sensors: sensors
                .into_iter()
                .map(|index| (index, request.sensors()[index as usize].into()))
                .collect(),
            several: query.sensors.is_some(),
            selects: (speeds.is_some(), columns.is_some()),
            speeds: speeds.unwrap_or(all.0),
            columns: columns.unwrap_or(all.1),
            diameters,
            sheet: query.nodal_diameters.is_some(),
            frame,
        })
    }

    /// Map of the first sensor, without rows.
    pub(super) fn head(&self, job: &Job, store: &Store, runtime: &Handle) -> Result<InteractionMap, Problem> {
        let (request, facts) = sweep(job)?;
        let errors = runtime.block_on(store.document(job.id, ERRORS))?;
        let errors = errors.map(|errors| serde_json::from_str(&errors)).transpose()?;
        let points = runtime.block_on(store.points(job.id))?.into_iter().map(|point| (point, None)).collect();
        let sensor = self.sensors[0].0 as usize;
        let mut map = run::interaction_map(request, &facts.units, points, sensor, self.diameters[0]);
        map.speeds_rad_s = self.speeds.iter().map(|&index| map.speeds_rad_s[index as usize]).collect();
        map.engine_orders = self.columns.iter().map(|&column| map.engine_orders[column]).collect();
        map.points.retain(|point| self.speeds.binary_search(&point.index).is_ok());
        Ok(InteractionMap { plan: job.plan.clone(), errors, amplitude: Vec::new(), ..map })
    }

    /// Chosen columns of a row, of each nodal diameter one after the other.
    pub(super) fn row(
        &self,
        store: &Store,
        runtime: &Handle,
        job: JobId,
        sensor: u32,
        index: u32,
    ) -> Result<Option<Vec<f64>>, StoreError> {
        let of = |spectra: &SpeedSpectra| {
            let mut chosen = Vec::with_capacity(self.diameters.len() * self.columns.len());
            for diameter in &self.diameters {
                let row = run::map_row(spectra, sensor as usize, *diameter)?;
                chosen.extend(self.columns.iter().filter_map(|&column| row.get(column)));
            }
            Some(chosen)
        };
        runtime.block_on(store.map_row(job, index, of))
    }

    /// Maps of the first sensor with their rows, one per nodal diameter, or the one in the fixed frame.
    pub(super) fn maps(
        &self,
        job: &Job,
        store: &Store,
        runtime: &Handle,
    ) -> Result<Vec<InteractionMap>, Problem> {
        if self.frame == Frame::Fixed {
            return Ok(vec![self.fixed_frame_map(job, store, runtime)?]);
        }
        let head = self.head(job, store, runtime)?;
        let empty = vec![None; self.speeds.len()];
        let of = |diameter: &Option<u32>| InteractionMap {
            nodal_diameter: *diameter,
            amplitude: empty.clone(),
            ..head.clone()
        };
        let mut maps: Vec<InteractionMap> = self.diameters.iter().map(of).collect();
        for point in &head.points {
            let Some(row) = self.row(store, runtime, job.id, self.sensors[0].0, point.index)? else {
                continue;
            };
            let place = self.speeds.partition_point(|index| *index < point.index);
            for (map, row) in maps.iter_mut().zip(row.chunks(self.columns.len())) {
                map.amplitude[place] = Some(row.to_vec());
            }
        }
        Ok(maps)
    }

    fn fixed_frame_map(&self, job: &Job, store: &Store, runtime: &Handle) -> Result<InteractionMap, Problem> {
        let (request, _) = sweep(job)?;
        let head = self.head(job, store, runtime)?;
        let (sensor, revolutions) = (self.sensors[0].0 as usize, request.window_revolutions());
        let row =
            |spectra: &SpeedSpectra| run::fixed_frame_row(spectra, sensor, self.diameters[0], revolutions);
        let mut amplitude = vec![None; self.speeds.len()];
        for point in &head.points {
            let place = self.speeds.partition_point(|index| *index < point.index);
            amplitude[place] = runtime.block_on(store.map_row(job.id, point.index, row))?;
        }
        Ok(InteractionMap { engine_orders: self.seen(job)?, amplitude, ..head })
    }

    /// Engine orders of a drawing of the whole map; in the fixed frame, multiples of the rotational frequency.
    pub(super) fn seen(&self, job: &Job) -> Result<Vec<f64>, Problem> {
        let (request, facts) = sweep(job)?;
        Ok(match self.frame {
            Frame::Rotating => run::map_engine_orders(request),
            Frame::Fixed => run::fixed_frame_orders(request, facts.sectors as usize / 2 + 1),
        })
    }

    /// Window of a drawing: from the slowest to the fastest chosen speed, and from the lowest to the highest chosen engine order.
    pub(super) fn window(&self, request: &ResolvedSweep) -> Result<Window, Problem> {
        let range = |name: &str, values: &mut dyn Iterator<Item = f64>| {
            let ends =
                values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
            if ends.0 < ends.1 {
                Ok(ends)
            } else {
                Err(Problem::parameter(name, "a drawing goes from one to another: choose two at least"))
            }
        };
        let (grid, orders) = (request.speeds().rad_s(), run::map_engine_orders(request));
        let mut rpm = self.speeds.iter().map(|&index| grid[index as usize] / SpeedUnit::Rpm.rad_s());
        let mut chosen = self.columns.iter().map(|&column| orders[column]);
        Ok(Window {
            speeds_rpm: self.selects.0.then(|| range("speeds", &mut rpm)).transpose()?,
            engine_orders: self.selects.1.then(|| range("orders", &mut chosen)).transpose()?,
        })
    }
}

/// Indices of all speeds and all columns of a sweep's maps.
pub(super) fn whole(request: &ResolvedSweep) -> (Vec<u32>, Vec<usize>) {
    let (speeds, orders) = (request.speeds().rad_s().len(), run::map_engine_orders(request).len());
    ((0..speeds as u32).collect(), (0..orders).collect())
}
