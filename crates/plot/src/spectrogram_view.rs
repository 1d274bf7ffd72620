//! Layout of the spectra of a run.

use std::f64::consts::TAU;

use super::cells::rpm;
use super::map_view::lobes_of;
use rubmap_analysis::request::Sensor;
use rubmap_analysis::result::{RunUp, RunUpFrame, RunUps};

/// Quantity on the vertical axis of a spectrogram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpectrogramUnit {
    /// Engine order: lines that turn with the wheel stay level, natural frequencies fall as the speed rises.
    Order,
    /// Frequency in Hz, the order times the mean speed of the frame over 2π: engine orders fan out, natural frequencies stay level.
    Hz,
}

/// Quantity on the horizontal axis of a spectrogram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Over {
    /// Speed, which never turns back.
    Speed,
    /// Time, where the speed does not separate frames.
    Time,
}

impl Over {
    /// Relative difference, to the highest speed, below which speeds are equal.
    const SAME: f64 = 1e-9;

    fn of(frames: &[&RunUpFrame]) -> Self {
        let speeds: Vec<f64> = frames.iter().flat_map(|frame| frame.speeds_rad_s).collect();
        let (low, high) = bounds(speeds.iter().copied());
        let same = Self::SAME * high;
        let keeps_to = |sign: f64| speeds.windows(2).all(|pair| sign * (pair[1] - pair[0]) >= -same);
        let is_monotonic = high - low > same && (keeps_to(1.0) || keeps_to(-1.0));
        if is_monotonic { Self::Speed } else { Self::Time }
    }

    /// Title of the horizontal axis.
    pub(super) fn axis(self) -> &'static str {
        match self {
            Self::Speed => "rotational speed Ω, rpm",
            Self::Time => "time, s",
        }
    }

    /// Unit of the horizontal axis.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Speed => "rpm",
            Self::Time => "s",
        }
    }
}

/// Line of an engine order: points in the units of the axes.
pub(super) struct OrderLine {
    pub(super) order: u32,
    /// Whether the lobes excite the engine order.
    pub(super) excited: bool,
    pub(super) places: Vec<(f64, f64)>,
}

/// Spectra of a sensor in the frames of a run that have one.
pub(super) struct View<'a> {
    pub(super) run: &'a RunUp,
    pub(super) sensor: &'a Sensor,
    pub(super) unit: SpectrogramUnit,
    pub(super) over: Over,
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    /// Frames in the order of time.
    pub(super) frames: Vec<&'a RunUpFrame>,
    /// Orders of the lines that are shown.
    pub(super) orders: Vec<f64>,
    /// Loudest amplitude of all, if anything moves.
    pub(super) loudest: Option<f64>,
    lobes: u32,
    index: usize,
}

impl<'a> View<'a> {
    /// Lays out the spectra of a sensor in the run of this number; or says why there are none.
    pub(super) fn of(
        run_ups: &'a RunUps,
        number: usize,
        index: usize,
        unit: SpectrogramUnit,
    ) -> Result<Self, &'static str> {
        let run = run_ups.runs.iter().find(|run| run.run as usize == number).ok_or("there is no such run")?;
        let sensor = run_ups.sensors.get(index).ok_or("there is no such sensor")?;
        let has_spectrum = |frame: &&RunUpFrame| frame.spectra.get(index).is_some_and(|row| !row.is_empty());
        let frames: Vec<&RunUpFrame> = run.frames.iter().filter(has_spectrum).collect();
        let lines = frames.iter().map(|frame| frame.spectra[index].len()).max().unwrap_or(0);
        let orders: Vec<f64> =
            (first_line(run.order_step)..lines).map(|line| run.order_step * line as f64).collect();
        let highest = orders.last().copied().filter(|order| order.is_finite() && *order > 0.0);
        let highest = highest.ok_or("no frame of this run has a spectrum")? + 0.5 * run.order_step;
        let over = Over::of(&frames);
        let lobes = lobes_of(&run_ups.settings.sweep.scene);
        let (x, y, loudest) = ((0.0, 1.0), (0.0, highest), None);
        let mut view = Self { run, sensor, unit, over, x, y, frames, orders, loudest, lobes, index };
        view.x = wide(bounds(view.frames.iter().flat_map(|frame| <[f64; 2]>::from(view.stretch(frame)))));
        let fastest = view.frames.iter().map(|frame| view.height(1.0, mean(frame))).fold(0.0, f64::max);
        view.y = (0.0, if fastest > 0.0 { highest * fastest } else { highest });
        let amplitudes = view.frames.iter().flat_map(|frame| view.amplitudes(frame)).copied();
        let loudest = amplitudes.filter(|amplitude| amplitude.is_finite()).fold(0.0, f64::max);
        // A smaller amplitude has no three decades below it.
        view.loudest = Some(loudest).filter(|loudest| *loudest > 1e6 * f64::MIN_POSITIVE);
        Ok(view)
    }

    /// Amplitudes of a frame at [`orders`](Self::orders), or at the first of them.
    pub(super) fn amplitudes(&self, frame: &'a RunUpFrame) -> &'a [f64] {
        let row = frame.spectra.get(self.index).map_or(&[][..], Vec::as_slice);
        row.get(first_line(self.run.order_step)..).unwrap_or_default()
    }

    /// Lower and upper bound of a frame on the horizontal axis.
    pub(super) fn stretch(&self, frame: &RunUpFrame) -> (f64, f64) {
        let [from, to] = match self.over {
            Over::Speed => frame.speeds_rad_s.map(rpm),
            Over::Time => frame.times_s,
        };
        (from.min(to), from.max(to))
    }

    /// Height of an order at a speed in rad/s.
    pub(super) fn height(&self, order: f64, speed_rad_s: f64) -> f64 {
        match self.unit {
            SpectrogramUnit::Order => order,
            SpectrogramUnit::Hz => order * speed_rad_s / TAU,
        }
    }

    /// Title of the vertical axis.
    pub(super) fn upwards(&self) -> &'static str {
        match self.unit {
            SpectrogramUnit::Order => "engine order k",
            SpectrogramUnit::Hz => "frequency (rotating frame), Hz",
        }
    }

    /// Lines of whole engine orders; of many only some, and those that the lobes excite unless they are many themselves.
    pub(super) fn order_lines(&self) -> Vec<OrderLine> {
        const MOST: u32 = 30;
        let highest = self.orders.last().map_or(0.0, |order| order + 1e-9) as u32;
        let rows = highest.div_ceil(MOST).max(1);
        let excited = |order: u32| self.lobes > 1 && order.is_multiple_of(self.lobes);
        let few = highest / self.lobes.max(1) <= MOST;
        let shown = (1..=highest).filter(|order| order.is_multiple_of(rows) || few && excited(*order));
        shown
            .map(|order| OrderLine { order, excited: excited(order), places: self.course(f64::from(order)) })
            .collect()
    }

    fn course(&self, order: f64) -> Vec<(f64, f64)> {
        /// Largest number of points of a line over time.
        const MOST: usize = 300;
        match (self.unit, self.over) {
            (SpectrogramUnit::Order, _) => vec![(self.x.0, order), (self.x.1, order)],
            (SpectrogramUnit::Hz, Over::Speed) => {
                [self.x.0, self.x.1].map(|rpm| (rpm, order * rpm / 60.0)).to_vec()
            }
            (SpectrogramUnit::Hz, Over::Time) => {
                let begin =
                    |frame: &&RunUpFrame| (frame.times_s[0], self.height(order, frame.speeds_rad_s[0]));
                let end = |frame: &&RunUpFrame| (frame.times_s[1], self.height(order, frame.speeds_rad_s[1]));
                let some = self.frames.iter().step_by(self.frames.len().div_ceil(MOST).max(1));
                some.map(begin).chain(self.frames.last().map(end)).collect()
            }
        }
    }
}

/// Mean speed of a frame, rad/s.
pub(super) fn mean(frame: &RunUpFrame) -> f64 {
    let [from, to] = frame.speeds_rad_s;
    0.5 * from + 0.5 * to
}

/// Index of the first line without the mean: under a Hann window the mean is in the line next to it as well, unless that is an engine
/// order.
fn first_line(order_step: f64) -> usize {
    if order_step > 0.5 { 1 } else { 2 }
}

fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Widens a range that has no width.
fn wide((low, high): (f64, f64)) -> (f64, f64) {
    match low <= high {
        true if low < high => (low, high),
        true => (low - 0.01 * low.abs().max(1.0), high + 0.01 * high.abs().max(1.0)),
        false => (0.0, 1.0),
    }
}
