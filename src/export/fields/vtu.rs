//! VTK's UnstructuredGrid: the elements of the wheel.

use std::io::{self, Write};

use super::file::FieldFile;
use super::vtk::{VERTEX, cell, notes, write_points};
use super::xml::{array, begin};
use crate::analysis::fields::Points;

/// Writes a frame: all elements and their nodes.
pub(super) fn write(file: &FieldFile, frame: usize, out: &mut dyn Write) -> io::Result<()> {
    let FieldFile { sector: of, part, .. } = file;
    let points = Points::all(of, *part);
    let count = points.count();
    let elements = of.mesh().map_or(&[][..], |mesh| &mesh.elements);
    let sectors = || of.sectors_of(*part);
    let cells = if of.mesh().is_some() { sectors().len() * elements.len() } else { count };
    begin(out, "UnstructuredGrid", &notes(file))?;
    writeln!(out, "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{cells}\">")?;
    write_points(file, &points, frame, out)?;
    let each = |give: &mut dyn FnMut(usize, usize) -> io::Result<()>| {
        sectors().try_for_each(|sector| (0..elements.len()).try_for_each(|element| give(sector, element)))
    };
    writeln!(out, "<CellData>")?;
    if of.mesh().is_some() {
        array::<u64>(out, "element", (cells, 1), |put| each(&mut |_, element| put(&[elements[element].id])))?;
        array::<i32>(out, "set", (cells, 1), |put| {
            each(&mut |_, element| put(&[elements[element].set as i32]))
        })?;
    }
    writeln!(out, "</CellData>\n<Cells>")?;
    if of.mesh().is_none() {
        single_points(count, out)?;
        array::<u8>(out, "types", (count, 1), |put| (0..count).try_for_each(|_| put(&[VERTEX])))?;
        return writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>");
    }
    let all: usize = sectors().len() * elements.iter().map(|element| element.nodes.len()).sum::<usize>();
    array::<i64>(out, "connectivity", (all, 1), |put| {
        each(&mut |sector, element| {
            let element = &elements[element];
            let number = |local: usize| points.number(sector, element.nodes[local]) as i64;
            let numbers: Vec<i64> = cell(element.kind).1.into_iter().map(number).collect();
            put(&numbers)
        })
    })?;
    let mut end = 0;
    array::<i64>(out, "offsets", (cells, 1), |put| {
        each(&mut |_, element| {
            end += elements[element].nodes.len() as i64;
            put(&[end])
        })
    })?;
    array::<u8>(out, "types", (cells, 1), |put| {
        each(&mut |_, element| put(&[cell(elements[element].kind).0]))
    })?;
    writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// Writes a VTK cell for each point.
pub(super) fn single_points(count: usize, out: &mut dyn Write) -> io::Result<()> {
    let count_to = |first: usize| {
        move |put: &mut dyn FnMut(&[i64]) -> io::Result<()>| {
            (0..count).try_for_each(|point| put(&[(first + point) as i64]))
        }
    };
    array::<i64>(out, "connectivity", (count, 1), count_to(0))?;
    array::<i64>(out, "offsets", (count, 1), count_to(1))
}
