//! Where responses are recorded.

use serde::{Deserialize, Serialize};

/// A displacement recorded during a run: at a node, which is named in exactly one of three ways, along a `component` or a
/// `direction`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// A contact node, counted from the leading edge from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_node: Option<u32>,
    /// Any node, by its id in the package.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<u64>,
    /// The node nearest to this point, among those that are not clamped; x, y, z as in the package. `settings` have its `node` in place
    /// of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub nearest: Option<[f64; 3]>,
    /// Sector, counted from 0.
    #[serde(default)]
    pub sector: u32,
    /// Displacement component.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub component: Option<Component>,
    /// In place of `component`: a direction in radial, tangential and axial components, of any length but 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 3, max_items = 3))]
    pub direction: Option<[f64; 3]>,
}

/// Displacement component at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Component {
    /// Outward from the axis.
    Radial,
    /// Towards +θ, the direction of rotation.
    Tangential,
    /// Along the axis.
    Axial,
    /// Along the outward contact normal of a contact node.
    Normal,
}

impl Component {
    /// In words.
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
    /// At a contact node.
    pub fn at_contact(contact_node: u32, sector: u32, component: Component) -> Self {
        Self { contact_node: Some(contact_node), sector, component: Some(component), ..Self::default() }
    }
}

impl Sensor {
    /// What it measures of the motion ("displacement", "velocity"), in words.
    pub fn measuring(&self, what: &str) -> String {
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
    }

    #[test]
    fn a_sensor_at_a_contact_node_is_written_as_ever() {
        let sensor = Sensor::at_contact(1, 2, Component::Axial);
        let written = serde_json::to_string(&sensor).unwrap();
        assert_eq!(written, r#"{"contact_node":1,"sector":2,"component":"axial"}"#);
    }
}
