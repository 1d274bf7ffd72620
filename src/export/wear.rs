//! Wear of an abradable coating.

use super::array::Array;
use crate::analysis::result::{Point, WearMap};
use crate::dynamics::sector::Units;

/// A line per rod and contact node.
pub fn table(wear: &WearMap, units: &Units) -> Vec<Array> {
    let places = || {
        let rods = wear.depths.iter().enumerate();
        rods.flat_map(|(rod, depths)| (0..depths.len()).map(move |node| (rod as u32, node as u32)))
    };
    vec![
        Array::whole("rod", places().map(|(rod, _)| rod)),
        Array::whole("contact_node", places().map(|(_, node)| node)),
        Array::reals(format!("depth_{}", units.length), wear.depths.iter().flatten().copied()),
    ]
}

/// Arrays as `[rod][contact node]`.
pub fn arrays(point: &Point, wear: &WearMap, units: &Units) -> Vec<Array> {
    vec![
        Array::real("speed_rad_s", point.speed_rad_s),
        Array::rows("depths", wear.depths.iter().map(Vec::as_slice)),
        Array::json("point", point),
        Array::json("units", units),
        Array::text("version", &point.version),
    ]
}
