//! Fields as ParaView's time series: a list of files, and the files.

use std::io::{self, BufWriter, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::file::FieldFile;
use super::vtu;

/// Writes a zip of all frames.
pub(super) fn write(file: &FieldFile, out: &mut dyn Write) -> io::Result<()> {
    let mut zip = ZipWriter::new_stream(out);
    let options =
        SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).large_file(true);
    zip.start_file("series.pvd", options)?;
    writeln!(zip, "<?xml version=\"1.0\"?>")?;
    writeln!(zip, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>")?;
    let name = |frame: usize| format!("series_{frame:04}.vtu");
    for (index, frame) in file.field.frames.iter().enumerate() {
        writeln!(zip, "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>", frame.time, name(index))?;
    }
    writeln!(zip, "</Collection>\n</VTKFile>")?;
    for frame in 0..file.field.frames.len() {
        zip.start_file(name(frame), options)?;
        let mut out = BufWriter::with_capacity(1 << 16, &mut zip);
        vtu::write(file, frame, &mut out)?;
        out.flush()?;
    }
    zip.finish()?;
    Ok(())
}
