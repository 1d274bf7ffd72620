//! VTK's PolyData: the skin of the wheel.

use std::io::{self, Write};

use super::file::FieldFile;
use super::vtk::{notes, write_points};
use super::vtu::single_points;
use super::xml::{array, begin};
use crate::analysis::fields::{Points, skin_faces};

/// Writes a frame: faces by their corners, points that are corners.
pub(super) fn write(file: &FieldFile, frame: usize, out: &mut dyn Write) -> io::Result<()> {
    let FieldFile { sector: of, part, .. } = file;
    let faces = of.mesh().map(|mesh| skin_faces(mesh, *part));
    let points = match &faces {
        Some(faces) => Points::of_faces(of, *part, faces),
        None => Points::all(of, *part),
    };
    let sectors = of.sectors_of(*part);
    let polygons = sectors.len() * faces.as_ref().map_or(0, Vec::len);
    let vertices = if faces.is_some() { 0 } else { points.count() };
    begin(out, "PolyData", &notes(file))?;
    writeln!(
        out,
        "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{vertices}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{polygons}\">",
        points.count()
    )?;
    write_points(file, &points, frame, out)?;
    match &faces {
        None => {
            writeln!(out, "<Verts>")?;
            single_points(vertices, out)?;
            writeln!(out, "</Verts>")?;
        }
        Some(faces) => {
            writeln!(out, "<Polys>")?;
            let corners = sectors.len() * faces.iter().map(Vec::len).sum::<usize>();
            array::<i64>(out, "connectivity", (corners, 1), |put| {
                sectors.clone().try_for_each(|sector| {
                    faces.iter().flatten().try_for_each(|&place| put(&[points.number(sector, place) as i64]))
                })
            })?;
            let mut end = 0;
            array::<i64>(out, "offsets", (polygons, 1), |put| {
                sectors.clone().try_for_each(|_| {
                    faces.iter().try_for_each(|face| {
                        end += face.len() as i64;
                        put(&[end])
                    })
                })
            })?;
            writeln!(out, "</Polys>")?;
        }
    }
    writeln!(out, "</Piece>\n</PolyData>\n</VTKFile>")
}
