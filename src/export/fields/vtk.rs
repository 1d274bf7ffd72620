//! Parts that all VTK files of a field have: points and point data.

use std::io::{self, Write};

use super::file::FieldFile;
use super::xml::array;
use crate::analysis::fields::{Points, principal, von_mises};
use crate::solid::element::ElementKind;

/// VTK's number of a single point.
pub(super) const VERTEX: u8 = 1;

/// VTK's number of an element, and its nodes in VTK's order, as places in CalculiX's order.
///
/// Both number corners and then the middles of edges alike, but for wedges: VTK sees their first triangle from outside, CalculiX from
/// inside.
pub(super) fn cell(kind: ElementKind) -> (u8, Vec<usize>) {
    let as_is = || (0..kind.nodes()).collect();
    match kind {
        ElementKind::C3D4 => (10, as_is()),
        ElementKind::C3D5 => (14, as_is()),
        ElementKind::C3D6 => (13, vec![0, 2, 1, 3, 5, 4]),
        ElementKind::C3D8 | ElementKind::C3D8I | ElementKind::QM6 => (12, as_is()),
        ElementKind::C3D10 => (24, as_is()),
        ElementKind::C3D13 => (27, as_is()),
        ElementKind::C3D15 => (26, vec![0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]),
        ElementKind::C3D20 | ElementKind::C3D20R => (25, as_is()),
    }
}

/// Notes about a field, for whoever opens the file in an editor.
pub(super) fn notes(file: &FieldFile) -> Vec<&str> {
    let field = &file.field;
    let lacking = "the package has no mesh: nodes only, without elements and stress";
    let excluded = "the point array excluded is 1 where no stress is claimed";
    let excluded = file.sector.excluded().map(|_| excluded);
    let lacking = file.sector.mesh().is_none().then_some(lacking);
    std::iter::once(field.title.as_str())
        .chain(field.subtitles.iter().map(String::as_str))
        .chain(excluded)
        .chain(lacking)
        .collect()
}

/// Writes the points, and point data of a frame.
pub(super) fn write_points(
    file: &FieldFile,
    points: &Points<'_>,
    frame: usize,
    out: &mut dyn Write,
) -> io::Result<()> {
    let FieldFile { sector: of, field, part } = file;
    let (frame, places) = (&field.frames[frame], points.places());
    let sectors = || of.sectors_of(*part);
    let count = points.count();
    let vectors = if field.has_displacement() { " Vectors=\"displacement\"" } else { "" };
    writeln!(out, "<PointData{vectors}>")?;
    array::<u64>(out, "node", (count, 1), |put| {
        sectors().try_for_each(|_| places.iter().try_for_each(|&place| put(&[of.nodes()[place as usize].id])))
    })?;
    array::<i32>(out, "sector", (count, 1), |put| {
        sectors().try_for_each(|sector| places.iter().try_for_each(|_| put(&[sector as i32])))
    })?;
    array::<i32>(out, "contact", (count, 1), |put| {
        sectors().try_for_each(|_| places.iter().try_for_each(|&place| put(&[of.contact(place) as i32])))
    })?;
    let no_columns = Vec::new();
    let mut moved = |name: &str, weights| {
        array::<f64>(out, name, (count, 3), |put| {
            sectors().try_for_each(|sector| {
                field.displacement(of, sector, places, weights).iter().try_for_each(|u| put(u))
            })
        })
    };
    if field.has_displacement() {
        moved("displacement", &frame.weights)?;
    }
    if field.has_static() {
        moved("static_displacement", &no_columns)?;
    }
    if !frame.before.is_empty() {
        moved("displacement_imaginary", &frame.before)?;
        array::<f64>(out, "displacement_amplitude", (count, 1), |put| {
            sectors().try_for_each(|sector| put(&field.amplitude(of, sector, places, frame)))
        })?;
    }
    if let Some(excluded) = of.excluded() {
        array::<u8>(out, "excluded", (count, 1), |put| {
            sectors().try_for_each(|_| {
                places.iter().try_for_each(|&place| put(&[u8::from(excluded.contains(place))]))
            })
        })?;
    }
    if of.has_stress() {
        let stress = |sector| field.stress(of, sector, places, &frame.weights).unwrap_or_default();
        array::<f64>(out, "stress", (count, 6), |put| {
            sectors().try_for_each(|sector| stress(sector).iter().try_for_each(|stress| put(stress)))
        })?;
        if field.has_static() {
            let fixed = |sector| field.stress(of, sector, places, &[]).unwrap_or_default();
            array::<f64>(out, "static_stress", (count, 6), |put| {
                sectors().try_for_each(|sector| fixed(sector).iter().try_for_each(|stress| put(stress)))
            })?;
        }
        array::<f64>(out, "von_mises", (count, 1), |put| {
            sectors().try_for_each(|sector| {
                stress(sector).into_iter().try_for_each(|stress| put(&[von_mises(stress)]))
            })
        })?;
        array::<f64>(out, "principal_stress", (count, 3), |put| {
            sectors().try_for_each(|sector| {
                stress(sector).into_iter().try_for_each(|stress| put(&principal(stress)))
            })
        })?;
    }
    writeln!(out, "</PointData>\n<Points>")?;
    array::<f64>(out, "Points", (count, 3), |put| {
        sectors().try_for_each(|sector| places.iter().try_for_each(|&place| put(&of.position(sector, place))))
    })?;
    writeln!(out, "</Points>")
}
