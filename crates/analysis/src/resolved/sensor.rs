//! A sensor whose place and direction are known.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{Component, Gauge, Sensor};

/// Recorded displacement or strain, at a known place and along a known direction; written as [`Sensor`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "Sensor")]
pub struct ResolvedSensor {
    pub(crate) place: Place,
    pub(crate) sector: u32,
    pub(crate) along: Along,
}

/// Place of a sensor in its sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// A contact node, from the leading edge.
    Contact(u32),
    /// Any node, by its id in the package.
    Node(u64),
    /// Two nodes of a strain gauge.
    Gauge([u64; 2]),
}

/// Direction along which a sensor records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Along {
    /// Component, by name.
    Component(Component),
    /// Direction in radial, tangential and axial components, of any length but 0.
    Direction([f64; 3]),
    /// Strain from one node of a gauge to the other, per length.
    Strain,
}

impl ResolvedSensor {
    /// Resolves `asked`, sensor `index` of a request; `refuse` is given violations where it says too much, too little or nothing.
    pub(crate) fn of(asked: Sensor, index: usize, refuse: &mut dyn FnMut(Violation)) -> Option<Self> {
        let Sensor { contact_node, node, nearest, sector, component, direction, gauge } = asked;
        let mut found = |field: &str, message: &str| {
            refuse(Violation::new(format!("/sensors/{index}{field}"), message));
        };
        if let Some(gauge) = gauge {
            return match (gauge, contact_node, node, nearest, component, direction) {
                (
                    Gauge { nodes: Some(nodes), at: None, direction: None, length: None },
                    None,
                    None,
                    None,
                    None,
                    None,
                ) => Some(Self { place: Place::Gauge(nodes), sector, along: Along::Strain }),
                (Gauge { nodes: None, .. }, ..) => {
                    found("/gauge", "the nodes of the model are not known here: give `nodes`");
                    None
                }
                (Gauge { at: None, direction: None, length: None, .. }, ..) => {
                    found(
                        "",
                        "a gauge has its place and direction of its own: give nothing else but a `sector`",
                    );
                    None
                }
                _ => {
                    found("/gauge", "give either `nodes`, or `at`, `direction` and `length`");
                    None
                }
            };
        }
        let place = match (contact_node, node, nearest) {
            (Some(node), None, None) => Ok(Place::Contact(node)),
            (None, Some(id), None) => Ok(Place::Node(id)),
            (None, None, Some(_)) => {
                Err(("/nearest", "the nodes of the model are not known here: give `node`"))
            }
            (None, None, None) => Err(("", "say where: give one of `contact_node`, `node` and `nearest`")),
            _ => Err(("", "a sensor is at one node: give only one of `contact_node`, `node` and `nearest`")),
        };
        let along = match (component, direction) {
            (Some(component), None) => Ok(Along::Component(component)),
            (None, Some([0.0, 0.0, 0.0])) => {
                Err(("/direction", "this points nowhere: give a direction other than 0, 0, 0"))
            }
            (None, Some(direction)) => Ok(Along::Direction(direction)),
            (None, None) => Err(("", "say along what: give `component` or `direction`")),
            (Some(_), Some(_)) => Err(("/direction", "give either `component` or `direction`, not both")),
        };
        match (place, along) {
            (Ok(place), Ok(along)) => Some(Self { place, sector, along }),
            (place, along) => {
                for (field, message) in place.err().into_iter().chain(along.err()) {
                    found(field, message);
                }
                None
            }
        }
    }
}

impl From<ResolvedSensor> for Sensor {
    fn from(sensor: ResolvedSensor) -> Self {
        let ResolvedSensor { place, sector, along } = sensor;
        let (contact_node, node, gauge) = match place {
            Place::Contact(node) => (Some(node), None, None),
            Place::Node(id) => (None, Some(id), None),
            Place::Gauge(nodes) => (None, None, Some(Gauge { nodes: Some(nodes), ..Gauge::default() })),
        };
        let (component, direction) = match along {
            Along::Component(component) => (Some(component), None),
            Along::Direction(direction) => (None, Some(direction)),
            Along::Strain => (None, None),
        };
        Self { contact_node, node, nearest: None, sector, component, direction, gauge }
    }
}
