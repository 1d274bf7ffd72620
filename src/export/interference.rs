//! Interference diagram of one speed.

use super::Export;
use super::array::Array;
use crate::analysis::result::Interference;

impl Export for Interference {
    /// A line per mode, with the nearest engine order of the lobes.
    fn table(&self) -> Vec<Array> {
        let modes = || self.modes.iter();
        let nearest = || modes().map(|mode| mode.nearest);
        vec![
            Array::whole("nodal_diameter", modes().map(|mode| mode.nodal_diameter)),
            Array::whole("family", modes().map(|mode| mode.family)),
            Array::words("wave", modes().map(|mode| mode.wave)),
            Array::reals("frequency_hz", modes().map(|mode| mode.frequency_hz)),
            Array::some_whole("engine_order", nearest().map(|order| Some(order?.engine_order))),
            Array::some_reals("engine_order_frequency_hz", nearest().map(|order| Some(order?.frequency_hz))),
            Array::some_reals("margin_percent", nearest().map(|order| Some(order?.margin_percent))),
            Array::flags("met_in_range", modes().map(|mode| !mode.met_in_range.is_empty())),
        ]
    }

    /// Columns of the table, and the engine orders.
    fn arrays(&self) -> Vec<Array> {
        let orders = || self.engine_orders.iter();
        let mut arrays = self.table();
        arrays.extend([
            Array::real("speed_rad_s", self.speed_rad_s),
            Array::whole("orders_engine_order", orders().map(|order| order.engine_order)),
            Array::whole("orders_nodal_diameter", orders().map(|order| order.nodal_diameter)),
            Array::reals("orders_frequency_hz", orders().map(|order| order.frequency_hz)),
            Array::flags("orders_of_lobes", orders().map(|order| order.of_lobes)),
            Array::real("sectors", f64::from(self.sectors)),
            Array::real("lobes", f64::from(self.lobes)),
            Array::text("model", &self.model),
            Array::text("version", &self.version),
        ]);
        arrays
    }
}
