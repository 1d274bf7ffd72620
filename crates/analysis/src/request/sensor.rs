//! Sensors: where responses are recorded.

use serde::{Deserialize, Serialize};

use rubmap_wheel::dynamics::sector::Units;

/// Sensor that records during a run: a displacement, at a node that is named in exactly one of three ways, along a `component` or a `direction`; or
/// the strain of a `gauge`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Contact node, counted from the leading edge from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_node: Option<u32>,
    /// Any node of the sector, by its id in the package.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<u64>,
    /// Point whose nearest node is meant, among those that are not clamped; x, y, z as in the package. `settings` have the `node` in its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub nearest: Option<[f64; 3]>,
    /// Sector, counted from 0.
    #[serde(default)]
    pub sector: u32,
    /// Displacement component.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub component: Option<Component>,
    /// Direction in radial, tangential and axial components, of any length but 0, in place of `component`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub direction: Option<[f64; 3]>,
    /// Virtual strain gauge, in place of a node and a direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauge: Option<Gauge>,
}

/// A virtual strain gauge between two nodes a and b: ε = (u_b − u_a)·e/L, with e from a to b and L their distance, as the small strain of a
/// fibre that both hold. The nodes are given, or found: those nearest to the ends of a gauge of this `length` along this `direction` with
/// its middle `at` this point. `settings` have the nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// Ids of both nodes of the gauge in the package.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 2, max_items = 2))]
    pub nodes: Option<[u64; 2]>,
    /// Middle of the gauge, x, y, z as in the package.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub at: Option<[f64; 3]>,
    /// Direction of the gauge, x, y, z as in the package, of any length but 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub direction: Option<[f64; 3]>,
    /// Length of the gauge, positive, in the model's unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(exclusive_minimum = 0))]
    pub length: Option<f64>,
}

/// Displacement component at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Component {
    /// Radial: outward from the axis.
    Radial,
    /// Tangential: towards +θ, the direction of rotation.
    Tangential,
    /// Axial: along the axis.
    Axial,
    /// Normal: along the outward contact normal of a contact node.
    Normal,
}

impl Component {
    /// Name of the component in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radial => "radial",
            Self::Tangential => "tangential",
            Self::Axial => "axial",
            Self::Normal => "normal",
        }
    }
}

impl Sensor {
    /// Sensor at a contact node.
    pub fn at_contact(contact_node: u32, sector: u32, component: Component) -> Self {
        Self { contact_node: Some(contact_node), sector, component: Some(component), ..Self::default() }
    }
}

impl Sensor {
    /// Unit of the recorded numbers: that of length, or `strain`.
    pub fn unit<'a>(&self, units: &'a Units) -> &'a str {
        if self.gauge.is_some() { "strain" } else { &units.length }
    }

    /// Unit that several sensors have in common; both units, where they differ.
    pub fn common_unit<'a>(sensors: impl Iterator<Item = &'a Sensor>, units: &Units) -> String {
        let mut words: Vec<&str> = sensors.map(|sensor| sensor.unit(units)).collect();
        words.sort_unstable_by_key(|word| *word != units.length);
        words.dedup();
        words.join("_or_")
    }

    /// Sensor in words, with `what` of the motion it measures ("displacement", "velocity").
    pub fn measuring(&self, what: &str) -> String {
        if let Some(gauge) = &self.gauge {
            let strain = if what == "displacement" { "strain" } else { "strain rate" };
            let place = match (gauge.nodes, gauge.at) {
                (Some([a, b]), _) => format!("between nodes {a} and {b}"),
                (None, Some([x, y, z])) => format!("at ({x}, {y}, {z})"),
                (None, None) => String::new(),
            };
            return format!("{strain} {place} of sector {}", self.sector);
        }
        let along = match (self.component, self.direction) {
            (Some(component), _) => format!("{} {what}", component.name()),
            (None, Some([r, t, z])) => format!("{what} along ({r}, {t}, {z})"),
            (None, None) => what.to_owned(),
        };
        let place = match (self.contact_node, self.node, self.nearest) {
            (Some(node), ..) => format!(" at contact node {node}"),
            (None, Some(node), _) => format!(" at node {node}"),
            (None, None, Some([x, y, z])) => format!(" at the node nearest to ({x}, {y}, {z})"),
            (None, None, None) => String::new(),
        };
        format!("{along}{place} of sector {}", self.sector)
    }
}

impl std::fmt::Display for Sensor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.measuring("displacement"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_read_well() {
        let words = |sensor| serde_json::from_value::<Sensor>(sensor).unwrap().to_string();
        let contact = serde_json::json!({"contact_node": 3, "component": "normal"});
        assert_eq!(words(contact), "normal displacement at contact node 3 of sector 0");
        let node = serde_json::json!({"node": 812, "sector": 2, "direction": [1, 0, -0.5]});
        assert_eq!(words(node), "displacement along (1, 0, -0.5) at node 812 of sector 2");
        let gauge = serde_json::json!({"gauge": {"nodes": [4, 17]}, "sector": 1});
        assert_eq!(words(gauge), "strain between nodes 4 and 17 of sector 1");
    }

    #[test]
    fn a_sensor_at_a_contact_node_is_written_as_ever() {
        let sensor = Sensor::at_contact(1, 2, Component::Axial);
        let written = serde_json::to_string(&sensor).unwrap();
        assert_eq!(written, r#"{"contact_node":1,"sector":2,"component":"axial"}"#);
    }
}
