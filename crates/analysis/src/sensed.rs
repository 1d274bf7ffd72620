//! Sensors of a request as rows of the wheel.

use std::borrow::Cow;

use crate::component::{along, direction};
use crate::gauge::{End, add_gauge};
use crate::model::ReducedSector;
use crate::not_runnable::NotRunnable;
use crate::request::Component;
use crate::resolved::ResolvedSweep;
use crate::resolved::sensor::{Along, Place, ResolvedSensor};
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::integrate::SensorRow;
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;

/// Adds to `wheel` the nodes and gauges that sensors of `request` name; returns it with the sensors.
pub(super) fn sensed<'a>(
    reduced: &ReducedSector,
    wheel: &'a ModalWheel,
    request: &ResolvedSweep,
) -> Result<(Cow<'a, ModalWheel>, Vec<SensorRow>), NotRunnable> {
    let contact = reduced.wheel.contact.len();
    let named: Vec<End> =
        request.sensor_nodes().into_iter().map(|id| find(reduced, id)).collect::<Result<_, _>>()?;
    let mut wheel = if named.iter().any(|end| end.place >= contact) {
        let stiffening = request.scene.centrifugal_stiffening;
        Cow::Owned(reduced.nodes.join(wheel.clone(), &reduced.wheel, stiffening)?)
    } else {
        Cow::Borrowed(wheel)
    };
    let mut rows = Vec::with_capacity(request.sensors.len());
    for sensor in &request.sensors {
        rows.push(row(reduced, &mut wheel, sensor)?);
    }
    Ok((wheel, rows))
}

fn row(
    reduced: &ReducedSector,
    wheel: &mut Cow<'_, ModalWheel>,
    sensor: &ResolvedSensor,
) -> Result<SensorRow, NotRunnable> {
    let contact = &reduced.wheel.contact;
    let (place, turned) = match sensor.place {
        Place::Contact(node) => (node as usize, false),
        Place::Node(id) if sensor.along == Along::Component(Component::Normal) => {
            let place = contact.iter().position(|node| node.id == id);
            (place.ok_or(NotRunnable::NoNormal { id })?, false)
        }
        Place::Node(id) => find(reduced, id).map(|end| (end.place, end.on_high_face))?,
        Place::Gauge([a, b]) => (add_gauge(wheel.to_mut(), [find(reduced, a)?, find(reduced, b)?]), false),
    };
    let direction = match sensor.along {
        Along::Component(component) => direction(contact, place, component),
        Along::Direction(vector) => Direction { node: place, components: along(vector) },
        Along::Strain => Direction { node: place, components: [1.0, 0.0, 0.0] },
    };
    // The high face of a sector is the low face of the next one.
    Ok(SensorRow { direction, sector: (sensor.sector as usize + usize::from(turned)) % wheel.sectors })
}

/// Place of the rows of node `id`; a contact node gives the same numbers as by its index.
fn find(reduced: &ReducedSector, id: u64) -> Result<End, NotRunnable> {
    let contact = &reduced.wheel.contact;
    if let Some(place) = contact.iter().position(|node| node.id == id) {
        return Ok(End { place, on_high_face: false, coordinates: contact[place].position });
    }
    let (index, on_high_face) = reduced.nodes.find(id).ok_or(NotRunnable::UnreadNode { id })?;
    let coordinates = reduced.nodes.coordinates(index);
    Ok(End { place: contact.len() + index, on_high_face, coordinates })
}
