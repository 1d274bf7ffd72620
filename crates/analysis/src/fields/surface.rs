//! A field as a surface that is drawn.

use super::field::Field;
use super::points::{Points, skin_faces};
use super::sector::{FieldSector, Part};
use super::tensor::von_mises;
use crate::result::{FieldSurface, SurfaceColour, stress_unit};
use rubmap_wheel::dynamics::nodes::SectorNode;
use rubmap_wheel::dynamics::sector::Units;

/// The skin of a part with one frame of a field on it, coloured by von Mises stress where the field has stress and otherwise by
/// displacement; nothing without a mesh or without that frame. No stress is claimed within one spacing of the contact nodes, where forces
/// act on points.
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
    let claimed = claimed(of);
    let (mut nodes, mut displacement, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut all_faces = Vec::new();
    for sector in of.sectors_of(part) {
        let moved = field.about_axis(of, sector, places, &frame.weights);
        match field.stress(of, sector, places, &frame.weights) {
            Some(stress) => values.extend(stress.into_iter().zip(places).map(|(stress, &place)| {
                let value = von_mises(stress);
                (value.is_finite() && claimed[place as usize]).then_some(value)
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
        true => SurfaceColour { quantity: "von Mises stress".to_owned(), unit: stress_unit(units), values },
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

/// Whether a node is further from every contact node, of the blades beside its own too, than these are from each other.
fn claimed(of: &FieldSector) -> Vec<bool> {
    let place = |[r, theta, z]: [f64; 3], turn: f64| {
        let (sin, cos) = (theta + turn).sin_cos();
        [r * cos, r * sin, z]
    };
    let apart = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2]);
    let mut line: Vec<_> =
        of.nodes().iter().filter_map(|node| Some((node.contact?, node.coordinates))).collect();
    line.sort_unstable_by_key(|&(place, _)| place);
    let spacings = line.windows(2).map(|pair| apart(place(pair[0].1, 0.0), place(pair[1].1, 0.0)));
    let spacing = spacings.sum::<f64>() / line.len().saturating_sub(1).max(1) as f64;
    let turns = [0.0, of.turn(1), -of.turn(1)];
    let contact: Vec<[f64; 3]> = line.iter().flat_map(|&(_, at)| turns.map(|turn| place(at, turn))).collect();
    let far = |node: &SectorNode| contact.iter().all(|&at| apart(place(node.coordinates, 0.0), at) > spacing);
    of.nodes().iter().map(far).collect()
}
