//! Surface of a field, for drawings.

use super::field::Field;
use super::points::{Points, skin_faces};
use super::sector::{FieldSector, Part};
use super::tensor::von_mises;
use crate::result::{FieldSurface, SurfaceColour, drawn_stress_unit};
use rubmap_wheel::dynamics::sector::Units;

/// Skin of a part with one frame of a field on it, coloured by von Mises stress where the field has stress and otherwise by displacement;
/// none without a mesh or without that frame. Places without valid stress have no value.
pub fn surface(
    field: &Field,
    of: &FieldSector,
    part: Part,
    frame: usize,
    units: &Units,
) -> Option<FieldSurface> {
    let mesh = of.mesh()?;
    let frame = field.frames.get(frame)?;
    let faces = skin_faces(mesh, part);
    let points = Points::of_faces(of, part, &faces);
    let places = points.places();
    let claimed = |place| of.excluded().is_none_or(|excluded| !excluded.contains(place));
    let (mut nodes, mut displacement, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut all_faces = Vec::new();
    for sector in of.sectors_of(part) {
        let moved = field.about_axis(of, sector, places, &frame.weights);
        match field.stress(of, sector, places, &frame.weights) {
            Some(stress) => values.extend(stress.into_iter().zip(places).map(|(stress, &place)| {
                let value = von_mises(stress);
                (value.is_finite() && claimed(place)).then_some(value)
            })),
            None => values.extend(moved.iter().map(|[x, y, z]| Some(x.hypot(*y).hypot(*z)))),
        }
        displacement.extend(moved);
        nodes.extend(places.iter().map(|&place| {
            let [r, theta, z] = of.nodes()[place as usize].coordinates;
            let (sin, cos) = (theta + of.turn(sector)).sin_cos();
            [r * cos, r * sin, z]
        }));
        all_faces.extend(
            faces.iter().map(|face| face.iter().map(|&place| points.number(sector, place) as u32).collect()),
        );
    }
    let colour = match of.has_stress() {
        true => {
            let (unit, factor) = drawn_stress_unit(units);
            values.iter_mut().flatten().for_each(|value| *value *= factor);
            SurfaceColour { quantity: "von Mises stress".to_owned(), unit, values }
        }
        false => SurfaceColour { quantity: "displacement".to_owned(), unit: units.length.clone(), values },
    };
    Some(FieldSurface {
        title: field.title.clone(),
        subtitles: field.subtitles.clone(),
        nodes,
        displacement,
        faces: all_faces,
        colour,
        length_unit: units.length.clone(),
    })
}
