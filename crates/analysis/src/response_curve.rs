//! Response of a sweep over ascending speed.

use crate::result::{Point, PointStatus, Stability};
use rubmap_wheel::response::critical_speed::Curve;

/// Speeds of a sweep in ascending order, with their points.
pub(super) struct ResponseCurve<'a> {
    pub(super) speeds_rad_s: Vec<f64>,
    /// Point of each speed, none where it was not completed.
    pub(super) points: Vec<Option<&'a Point>>,
    /// Whether each point shows a stable periodic response that was solved for.
    solved: Vec<bool>,
}

impl<'a> ResponseCurve<'a> {
    /// Response curve of `speeds_rad_s`, in the order of the request, and their finished points, in any order.
    pub(super) fn of(speeds_rad_s: &[f64], finished: &'a [Point]) -> Self {
        let mut ascending: Vec<usize> = (0..speeds_rad_s.len()).collect();
        ascending.sort_by(|&a, &b| speeds_rad_s[a].total_cmp(&speeds_rad_s[b]));
        let mut completed = vec![None; speeds_rad_s.len()];
        for point in finished.iter().filter(|point| point.status == PointStatus::Completed) {
            completed[point.index as usize] = Some(point);
        }
        let is_solved = |index: &usize| {
            let steady = completed[*index].and_then(|point| point.steady.as_ref());
            steady.is_some_and(|steady| steady.taken && steady.stability == Some(Stability::Stable))
        };
        Self {
            speeds_rad_s: ascending.iter().map(|&index| speeds_rad_s[index]).collect(),
            points: ascending.iter().map(|&index| completed[index]).collect(),
            solved: ascending.iter().map(is_solved).collect(),
        }
    }

    /// Curve of `values` over the speeds.
    pub(super) fn of_values<'b>(&'b self, values: &'b [Option<f64>]) -> Curve<'b> {
        Curve { speeds: &self.speeds_rad_s, values, solved: &self.solved }
    }

    /// Level of a sensor at each speed: root mean square about the mean.
    pub(super) fn level(&self, sensor: usize) -> Vec<Option<f64>> {
        self.points.iter().map(|point| point.map(|point| point.responses[sensor].rms)).collect()
    }

    /// Level of the tip that moves most, at each speed: root mean square about the mean.
    pub(super) fn tip_level(&self) -> Vec<Option<f64>> {
        self.points.iter().map(|point| Some(point.as_ref()?.tip?.rms)).collect()
    }
}
