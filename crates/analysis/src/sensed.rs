//! The sensors of a request in the terms of the physics.

use std::borrow::Cow;

use crate::component::{along, direction};
use crate::model::ReducedSector;
use crate::not_runnable::NotRunnable;
use crate::request::Component;
use crate::resolved::ResolvedSweep;
use crate::resolved::sensor::{Along, Place, ResolvedSensor};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::integrate::SensorRow;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;

/// `wheel` with the nodes that sensors of `request` name, and the sensors.
pub(super) fn sensed<'a>(
    reduced: &ReducedSector,
    wheel: &'a ModalWheel,
    request: &ResolvedSweep,
) -> Result<(Cow<'a, ModalWheel>, Vec<SensorRow>), NotRunnable> {
    let sensor = |sensor: &ResolvedSensor| row(reduced, wheel, sensor);
    let sensors = request.sensors.iter().map(sensor).collect::<Result<Vec<_>, _>>()?;
    let contact = reduced.wheel.contact.len();
    let wheel = if sensors.iter().any(|sensor| sensor.direction.node >= contact) {
        let stiffening = request.scene.centrifugal_stiffening;
        Cow::Owned(reduced.nodes.join(wheel.clone(), &reduced.wheel, stiffening)?)
    } else {
        Cow::Borrowed(wheel)
    };
    Ok((wheel, sensors))
}

fn row(
    reduced: &ReducedSector,
    wheel: &ModalWheel,
    sensor: &ResolvedSensor,
) -> Result<SensorRow, NotRunnable> {
    let contact = &reduced.wheel.contact;
    let (place, turned) = match sensor.place {
        Place::Contact(node) => (node as usize, false),
        // The same numbers as by its place among them.
        Place::Node(id) => match contact.iter().position(|node| node.id == id) {
            Some(place) => (place, false),
            None if sensor.along == Along::Component(Component::Normal) => {
                return Err(NotRunnable::NoNormal { id });
            }
            None => {
                let (place, high) = reduced.nodes.find(id).ok_or(NotRunnable::UnreadNode { id })?;
                (contact.len() + place, high)
            }
        },
    };
    let direction = match sensor.along {
        Along::Component(component) => direction(contact, place, component),
        Along::Direction(vector) => Direction { node: place, components: along(vector) },
    };
    // The high face of a sector is the low face of the next one.
    Ok(SensorRow { direction, sector: (sensor.sector as usize + usize::from(turned)) % wheel.sectors })
}
