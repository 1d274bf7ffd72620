//! Writer of packages: the zip of docs/package.md, numbers in shortest round-trip form or, in `.npz` matrices, as they are.

use std::io::{self, BufWriter, Seek, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::error::{ArchiveProblem, MANIFEST_FILE, PackageError};
use super::npz;
use super::raw::{MatrixFormat, RawMatrix, RawPackage};
use super::symmetric::Mirror;

/// Writes `package` as a deflated zip; reading it back gives the same bits.
///
/// Equal packages give equal bytes: entries carry no time. Files have the names of the manifest, and one named for several
/// speeds is written once; a matrix whose name ends in `.npz` is stored in that format. Nothing is checked: a wrong package is refused on
/// reading.
///
/// # Errors
///
/// Errors of `out`, and names that a zip file cannot hold.
pub fn write(package: &RawPackage, out: impl Write + Seek) -> Result<(), PackageError> {
    let mut zip = ZipWriter::new(out);
    let manifest = serde_json::to_vec_pretty(&package.manifest).map_err(io::Error::from)?;
    add(&mut zip, MANIFEST_FILE, |file| file.write_all(&manifest))?;
    let names = &package.manifest;
    add(&mut zip, &names.nodes, |file| {
        package.nodes.iter().try_for_each(|node| {
            let [x, y, z] = node.position;
            writeln!(file, "{},{x:e},{y:e},{z:e}", node.id)
        })
    })?;
    add(&mut zip, &names.dofs, |file| {
        package.dofs.iter().try_for_each(|dof| writeln!(file, "{},{}", dof.node, dof.component))
    })?;
    if let (Some(mesh), Some(elements)) = (&names.mesh, &package.elements) {
        add(&mut zip, &mesh.elements, |file| {
            elements.iter().try_for_each(|element| {
                write!(file, "{},{},{}", element.id, element.kind.name(), element.set)?;
                element.nodes.iter().try_for_each(|node| write!(file, ",{node}"))?;
                writeln!(file)
            })
        })?;
    }
    add_matrix(&mut zip, &names.mass, &package.mass, Mirror::Symmetric)?;
    let stiffness = || names.stiffness.iter().zip(&package.stiffness);
    for (k, (name, matrix)) in stiffness().enumerate() {
        if !stiffness().take(k).any(|(earlier, _)| earlier == name) {
            add_matrix(&mut zip, name, matrix, Mirror::Symmetric)?;
        }
    }
    if let (Some(name), Some(matrix)) = (&names.gyroscopic, &package.gyroscopic) {
        add_matrix(&mut zip, name, matrix, Mirror::Skew)?;
    }
    zip.finish().map_err(|error| failed(None, error))?.flush()?;
    Ok(())
}

fn add<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    name: &str,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), PackageError> {
    add_by(zip, name, CompressionMethod::Deflated, content)
}

fn add_matrix<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    name: &str,
    matrix: &RawMatrix,
    mirror: Mirror,
) -> Result<(), PackageError> {
    match MatrixFormat::of(name) {
        MatrixFormat::Mtx => add(zip, name, |file| write_matrix(matrix, mirror, file)),
        // A zip of its own already, made aside because its writer goes back to note lengths.
        MatrixFormat::Npz => add_by(zip, name, CompressionMethod::Stored, |file| {
            let mut made = tempfile::tempfile()?;
            npz::write(matrix, &mut made)?;
            made.rewind()?;
            io::copy(&mut made, file).map(drop)
        }),
    }
}

fn add_by<W: Write + Seek>(
    zip: &mut ZipWriter<W>,
    name: &str,
    method: CompressionMethod,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), PackageError> {
    let options = SimpleFileOptions::default().compression_method(method).large_file(true);
    zip.start_file(name, options).map_err(|error| failed(Some(name), error))?;
    if name.ends_with(".gz") {
        let mut file = BufWriter::new(flate2::write::GzEncoder::new(zip, flate2::Compression::default()));
        content(&mut file)?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?.finish()?;
    } else {
        let mut file = BufWriter::new(zip);
        content(&mut file)?;
        file.flush()?;
    }
    Ok(())
}

fn write_matrix(matrix: &RawMatrix, mirror: Mirror, file: &mut dyn Write) -> io::Result<()> {
    let symmetry = match mirror {
        Mirror::Symmetric => "symmetric",
        Mirror::Skew => "skew-symmetric",
    };
    writeln!(file, "%%MatrixMarket matrix coordinate real {symmetry}")?;
    writeln!(file, "{} {} {}", matrix.size, matrix.size, matrix.entries.len())?;
    matrix.entries.iter().try_for_each(|(row, column, value)| {
        writeln!(file, "{} {} {value:e}", u64::from(*row) + 1, u64::from(*column) + 1)
    })
}

fn failed(name: Option<&str>, error: zip::result::ZipError) -> PackageError {
    match error {
        zip::result::ZipError::Io(source) => source.into(),
        error => PackageError::archive(
            name.map(str::to_owned),
            ArchiveProblem::Unwritable { reason: error.to_string() },
        ),
    }
}
