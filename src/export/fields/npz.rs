//! Fields as arrays of numpy.

use std::io::{self, Write};

use super::file::FieldFile;
use super::vtk::cell;
use crate::analysis::fields::{Frame, Points, von_mises};
use crate::package::NpzWriter;

/// Writes all frames: `displacement[frame][point][x, y, z]`, `stress[frame][point][xx, yy, zz, xy, yz, zx]`, their static parts without
/// frames, elements as in VTK.
pub(super) fn write(file: &FieldFile, out: &mut dyn Write) -> io::Result<()> {
    let FieldFile { sector: of, field, part } = file;
    let points = Points::all(of, *part);
    let (places, count, frames) = (points.places(), points.count(), field.frames.len());
    let sectors = || of.sectors_of(*part);
    let mut npz = NpzWriter::stream(out);
    npz.texts("title", &[], &[&field.title])?;
    let notes: Vec<&str> = field.subtitles.iter().map(String::as_str).collect();
    npz.texts("notes", &[notes.len()], &notes)?;
    npz.reals("time", &[frames], field.frames.iter().map(|frame| frame.time))?;
    let of_nodes = || sectors().flat_map(|sector| places.iter().map(move |&place| (sector, place)));
    npz.ids("node", &[count], of_nodes().map(|(_, place)| of.nodes()[place as usize].id))?;
    npz.integers("sector", &[count], of_nodes().map(|(sector, _)| sector as i64))?;
    npz.integers("contact", &[count], of_nodes().map(|(_, place)| i64::from(of.contact(place))))?;
    npz.reals("position", &[count, 3], of_nodes().flat_map(|(sector, place)| of.position(sector, place)))?;
    // Calls `take` with every frame of every sector.
    let each = |take: &mut dyn FnMut(&Frame, usize) -> io::Result<()>| {
        field.frames.iter().try_for_each(|frame| sectors().try_for_each(|sector| take(frame, sector)))
    };
    if field.has_displacement() {
        npz.reals_by("displacement", &[frames, count, 3], |take| {
            each(&mut |frame, sector| {
                let moved = field.displacement(of, sector, places, &frame.weights);
                moved.into_iter().flatten().try_for_each(&mut *take)
            })
        })?;
    }
    if field.frames.iter().all(|frame| !frame.before.is_empty()) {
        npz.reals_by("displacement_imaginary", &[frames, count, 3], |take| {
            each(&mut |frame, sector| {
                let moved = field.displacement(of, sector, places, &frame.before);
                moved.into_iter().flatten().try_for_each(&mut *take)
            })
        })?;
    }
    if field.has_static() {
        let of_sectors = || sectors().flat_map(|sector| field.displacement(of, sector, places, &[]));
        npz.reals("static_displacement", &[count, 3], of_sectors().flatten())?;
    }
    if field.has_static() && of.has_stress() {
        let of_sectors = || sectors().filter_map(|sector| field.stress(of, sector, places, &[]));
        npz.reals("static_stress", &[count, 6], of_sectors().flatten().flatten())?;
    }
    if let Some(excluded) = of.excluded() {
        npz.integers("excluded", &[count], of_nodes().map(|(_, place)| i64::from(excluded.contains(place))))?;
    }
    if of.has_stress() {
        let stress =
            |frame: &Frame, sector| field.stress(of, sector, places, &frame.weights).unwrap_or_default();
        npz.reals_by("stress", &[frames, count, 6], |take| {
            each(&mut |frame, sector| stress(frame, sector).into_iter().flatten().try_for_each(&mut *take))
        })?;
        npz.reals_by("von_mises", &[frames, count], |take| {
            each(&mut |frame, sector| {
                stress(frame, sector).into_iter().try_for_each(|stress| take(von_mises(stress)))
            })
        })?;
    }
    let Some(mesh) = of.mesh() else { return npz.finish() };
    let cells: Vec<(u8, Vec<usize>)> = mesh.elements.iter().map(|element| cell(element.kind)).collect();
    let all = || sectors().flat_map(|sector| (0..cells.len()).map(move |element| (sector, element)));
    let number = sectors().len() * cells.len();
    let connectivity = all().flat_map(|(sector, element)| {
        let nodes = &mesh.elements[element].nodes;
        let points = &points;
        cells[element].1.iter().map(move |&local| points.number(sector, nodes[local]) as i64)
    });
    let entries = sectors().len() * mesh.elements.iter().map(|element| element.nodes.len()).sum::<usize>();
    npz.integers("connectivity", &[entries], connectivity)?;
    let ends = all().scan(0, |end, (_, element)| {
        *end += cells[element].1.len() as i64;
        Some(*end)
    });
    npz.integers("offsets", &[number], ends)?;
    npz.integers("cell_type", &[number], all().map(|(_, element)| i64::from(cells[element].0)))?;
    npz.ids("element", &[number], all().map(|(_, element)| mesh.elements[element].id))?;
    npz.finish()
}
