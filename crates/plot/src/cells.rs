//! Stretch of the speed axis that each speed of a sweep covers.

use std::f64::consts::TAU;

/// Converts rad/s to revolutions per minute.
pub(super) fn rpm(speed_rad_s: f64) -> f64 {
    speed_rad_s * 60.0 / TAU
}

/// Speed and the stretch it covers, in rpm: halfway to its neighbours, at the ends as far outwards as inwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Index of the speed in the sweep.
    pub(super) index: usize,
    pub(super) rpm: f64,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Cells in ascending speed, whatever the order of the sweep.
pub(super) fn cells(speeds_rad_s: &[f64]) -> Vec<Cell> {
    let mut sorted: Vec<(usize, f64)> = speeds_rad_s.iter().map(|s| rpm(*s)).enumerate().collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let last = sorted.len().saturating_sub(1);
    let cell = |(place, &(index, rpm)): (usize, &(usize, f64))| {
        // A sweep of one speed still needs a width.
        let alone = 0.01 * rpm.max(1.0);
        let below = (place > 0).then(|| 0.5 * (rpm - sorted[place - 1].1));
        let above = (place < last).then(|| 0.5 * (sorted[place + 1].1 - rpm));
        let from = rpm - below.or(above).unwrap_or(alone);
        let to = rpm + above.or(below).unwrap_or(alone);
        Cell { index, rpm, from, to }
    };
    sorted.iter().enumerate().map(cell).collect()
}

/// Cells, in ascending speed, of which a range of speeds contains a part.
pub(super) fn within(cells: &[Cell], (low, high): (f64, f64)) -> &[Cell] {
    let first = cells.partition_point(|cell| cell.to <= low);
    let end = cells.partition_point(|cell| cell.from < high);
    cells.get(first..end).unwrap_or_default()
}

/// Lowest and highest of some speeds, in rpm; from standstill where all are equal.
pub(super) fn range(speeds_rad_s: &[f64]) -> (f64, f64) {
    let speeds = speeds_rad_s.iter().map(|speed| rpm(*speed));
    let (slow, fast) =
        speeds.fold((f64::INFINITY, 0f64), |(slow, fast), speed| (slow.min(speed), fast.max(speed)));
    if slow < fast { (slow, fast) } else { (0.0, f64::max(fast, 1.0)) }
}

/// First and last value of the speed axis, in rpm.
pub(super) fn extent(cells: &[Cell]) -> (f64, f64) {
    match (cells.first(), cells.last()) {
        (Some(first), Some(last)) if last.to > first.from => (first.from, last.to),
        (Some(first), _) => (first.rpm - 1.0, first.rpm + 1.0),
        _ => (0.0, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_halfway() {
        let speeds = [300.0, 100.0, 120.0].map(|rpm| rpm * TAU / 60.0);
        let cells = cells(&speeds);
        let rounded: Vec<_> =
            cells.iter().map(|c| (c.index, c.from.round(), c.rpm.round(), c.to.round())).collect();
        assert_eq!(rounded, [(1, 90.0, 100.0, 110.0), (2, 110.0, 120.0, 210.0), (0, 210.0, 300.0, 390.0)]);
        assert_eq!(extent(&[]), (0.0, 1.0));
        let seen = |range| -> Vec<usize> { within(&cells, range).iter().map(|cell| cell.index).collect() };
        assert_eq!(seen((100.0, 215.0)), [1, 2, 0]);
        assert_eq!((seen((110.5, 111.0)), seen((500.0, 600.0))), (vec![2], vec![]));
    }
}
