//! Sensors in their stored form, among packed numbers.

use serde::{Deserialize, Serialize};

use crate::analysis::request::{Component, Gauge, Sensor};

/// Sensor as it is stored; a sensor at a contact node along a component has the bytes in which earlier versions wrote every sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct StoredSensor {
    /// Index of the contact node; 0 where the reading names another node.
    contact_node: u32,
    sector: u32,
    reading: Reading,
}

/// Quantity that the sensor reads; the first four are components at the contact node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum Reading {
    Radial,
    Tangential,
    Axial,
    Normal,
    /// Component along a direction at the contact node.
    Along([f64; 3]),
    /// Component at the node with this id.
    AtNode(u64, Component),
    /// Component along a direction at the node with this id.
    AtNodeAlong(u64, [f64; 3]),
    /// Strain between two nodes.
    Strain([u64; 2]),
}

impl StoredSensor {
    /// Stored form of `sensor`, if it is at a node.
    pub(super) fn of(sensor: &Sensor) -> Option<Self> {
        let Sensor { contact_node, node, sector, component, direction, gauge, .. } = *sensor;
        if let Some(nodes) = gauge.and_then(|gauge| gauge.nodes) {
            return Some(Self { contact_node: 0, sector, reading: Reading::Strain(nodes) });
        }
        let reading = match (contact_node, node, component, direction) {
            (Some(_), _, Some(component), _) => match component {
                Component::Radial => Reading::Radial,
                Component::Tangential => Reading::Tangential,
                Component::Axial => Reading::Axial,
                Component::Normal => Reading::Normal,
            },
            (Some(_), _, None, Some(direction)) => Reading::Along(direction),
            (None, Some(id), Some(component), _) => Reading::AtNode(id, component),
            (None, Some(id), None, Some(direction)) => Reading::AtNodeAlong(id, direction),
            _ => return None,
        };
        Some(Self { contact_node: contact_node.unwrap_or(0), sector, reading })
    }

    /// Sensor of the same reading in sector 0, for comparisons across sectors.
    pub(super) fn anywhere(self) -> Self {
        Self { sector: 0, ..self }
    }
}

impl From<StoredSensor> for Sensor {
    fn from(StoredSensor { contact_node, sector, reading }: StoredSensor) -> Self {
        let at_contact = |component| Self::at_contact(contact_node, sector, component);
        let at_node = |node| Self { node: Some(node), sector, ..Self::default() };
        match reading {
            Reading::Radial => at_contact(Component::Radial),
            Reading::Tangential => at_contact(Component::Tangential),
            Reading::Axial => at_contact(Component::Axial),
            Reading::Normal => at_contact(Component::Normal),
            Reading::Along(direction) => {
                Self { component: None, direction: Some(direction), ..at_contact(Component::Normal) }
            }
            Reading::AtNode(node, component) => Self { component: Some(component), ..at_node(node) },
            Reading::AtNodeAlong(node, direction) => Self { direction: Some(direction), ..at_node(node) },
            Reading::Strain(nodes) => {
                let gauge = Some(Gauge { nodes: Some(nodes), ..Gauge::default() });
                Self { gauge, sector, ..Self::default() }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sensor_comes_back() {
        let components = [Component::Radial, Component::Tangential, Component::Axial, Component::Normal];
        let mut sensors: Vec<Sensor> = Vec::new();
        for component in components {
            sensors.push(Sensor::at_contact(3, 2, component));
            sensors.push(Sensor { node: Some(u64::MAX), component: Some(component), ..Sensor::default() });
        }
        let direction = Some([1.0, -2.0, 0.5]);
        sensors.push(Sensor { contact_node: Some(4), sector: 1, direction, ..Sensor::default() });
        sensors.push(Sensor { node: Some(4), sector: 1, direction, ..Sensor::default() });
        let gauge = Some(Gauge { nodes: Some([7, u64::MAX]), ..Gauge::default() });
        sensors.push(Sensor { gauge, sector: 3, ..Sensor::default() });
        for sensor in sensors {
            let bytes = postcard::to_stdvec(&StoredSensor::of(&sensor).unwrap()).unwrap();
            let read: StoredSensor = postcard::from_bytes(&bytes).unwrap();
            assert_eq!(Sensor::from(read), sensor);
        }
        assert!(StoredSensor::of(&Sensor::default()).is_none());
    }

    #[test]
    fn sensors_of_earlier_versions_read_as_they_were_written() {
        // Contact node, sector and the number of the component, as postcard wrote the three fields.
        let read: StoredSensor = postcard::from_bytes(&[200, 1, 7, 2]).unwrap();
        assert_eq!(Sensor::from(read), Sensor::at_contact(200, 7, Component::Axial));
        assert_eq!(postcard::to_stdvec(&read).unwrap(), [200, 1, 7, 2]);
    }
}
