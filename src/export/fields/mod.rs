//! Fields of the wheel as files: VTK's XML for ParaView and pyvista, and arrays for numpy.
//!
//! A writer of our own: the XML is a few tags around arrays, which go out as they are computed, sector by sector; the crate vtkio wants the
//! whole file in memory. Arrays are Base64 within the XML, which any XML reader reads.

mod file;
mod npz;
mod series;
mod vtk;
mod vtp;
mod vtu;
mod xml;

use std::io::{self, Write};

pub use file::FieldFile;

impl FieldFile {
    /// Writes all elements as VTK's UnstructuredGrid; single points where there is no mesh. Only the first frame.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn vtu(&self, out: &mut dyn Write) -> io::Result<()> {
        vtu::write(self, 0, out)
    }

    /// Writes the skin as VTK's PolyData; single points where there is no mesh. Only the first frame.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn vtp(&self, out: &mut dyn Write) -> io::Result<()> {
        vtp::write(self, 0, out)
    }

    /// Writes all frames as arrays of numpy.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn npz(&self, out: &mut dyn Write) -> io::Result<()> {
        npz::write(self, out)
    }

    /// Writes all frames as a zip with ParaView's list of them, `series.pvd`, and a `.vtu` each.
    ///
    /// # Errors
    /// Errors of writing.
    pub fn pvd(&self, out: &mut dyn Write) -> io::Result<()> {
        series::write(self, out)
    }
}
