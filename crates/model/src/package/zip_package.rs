//! Reader of the package format itself: from a zip of `sector.json`, two tables and the matrices to a [`Content`].

use std::io::Read;
use std::path::Path;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::archive::{Archive, Hashed, inside};
use super::content::{Content, SourceLines};
use super::error::{
    ArchiveProblem, MANIFEST_FILE, ManifestProblem, MatrixProblem, PackageError, TableProblem,
};
use super::limits::Limits;
use super::lines::Fault;
use super::quote::quoted;
use super::raw::{Manifest, MatrixFormat, RawDof, RawElement, RawMatrix, RawNode, RawPackage};
use super::symmetric::Mirror;
use super::tables::Table;
use super::{check, digest, manifest, matrix_market, npz, tables};

/// Reads every file of the archive; the matrices in parallel.
pub(super) fn load(path: &Path, limits: &Limits) -> Result<Content, PackageError> {
    let archive = Archive::open(path, limits)?;
    let Tables { manifest, files, nodes, dofs, elements } = read_tables(&archive, limits)?;
    let (elements, elements_lines, elements_hash) = match elements {
        Some(Hashed { value, sha256 }) => (Some(value.rows), value.lines, Some(sha256)),
        None => (None, Vec::new(), None),
    };
    let lines = SourceLines { nodes: nodes.value.lines, dofs: dofs.value.lines, elements: elements_lines };
    // Before the matrices, which are the long work, are read.
    let index = check::tables::node_index(&manifest.nodes, &nodes.value.rows, &lines)?;
    check::tables::rows(&manifest.dofs, &dofs.value.rows, &lines, &index)?;
    if let (Some(mesh), Some(elements)) = (&manifest.mesh, &elements) {
        check::elements::check(mesh, elements, &nodes.value.rows, &lines, &index)?;
    }
    drop(index);
    let rows = dofs.value.rows.len();
    let matrix_files = files.matrices();
    // Collected before looking at errors, so that the error reported is the first file's, however threads run.
    let matrices: Vec<_> = matrix_files
        .par_iter()
        .map(|&(file, mirror)| read_matrix(path, &archive, file, mirror, rows, limits))
        .collect();
    let mut matrices = matrices.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut hashes = vec![(files.nodes.as_str(), nodes.sha256), (files.dofs.as_str(), dofs.sha256)];
    hashes.extend(files.elements.as_deref().zip(elements_hash));
    hashes.extend(
        matrix_files.iter().map(|(file, _)| file.as_str()).zip(matrices.iter().map(|matrix| matrix.sha256)),
    );
    let digest = digest::digest(&manifest, hashes.into_iter());
    let gyroscopic = matrices.split_off(1 + files.stiffness.len()).pop();
    let stiffness = matrices.split_off(1);
    let Some(mass) = matrices.pop() else {
        unreachable!("one matrix is read per file, and the mass is the first")
    };
    Ok(Content {
        package: RawPackage {
            manifest,
            nodes: nodes.value.rows,
            dofs: dofs.value.rows,
            mass: mass.value,
            stiffness: stiffness.into_iter().map(|matrix| matrix.value).collect(),
            gyroscopic: gyroscopic.map(|matrix| matrix.value),
            elements,
        },
        lines,
        digest,
    })
}

/// Digest of the archive at `path`. Matrix Market files are only hashed, never held.
pub(super) fn load_digest(path: &Path, limits: &Limits) -> Result<String, PackageError> {
    let archive = Archive::open(path, limits)?;
    let Tables { manifest, files, nodes, dofs, elements } = read_tables(&archive, limits)?;
    let mut hashes = vec![(files.nodes.as_str(), nodes.sha256), (files.dofs.as_str(), dofs.sha256)];
    hashes.extend(files.elements.as_deref().zip(elements.map(|table| table.sha256)));
    for (file, mirror) in files.matrices() {
        let sha256 = match MatrixFormat::of(file) {
            MatrixFormat::Npz => npz::read(&archive, file, mirror, dofs.value.rows.len(), limits)?.sha256,
            MatrixFormat::Mtx => archive.read(file, |_| Ok(()))?.sha256,
        };
        hashes.push((file.as_str(), sha256));
    }
    Ok(digest::digest(&manifest, hashes.into_iter()))
}

/// Content of a package without its matrices.
pub(super) struct Stated {
    pub(super) manifest: Manifest,
    pub(super) nodes: Vec<RawNode>,
    pub(super) dofs: Vec<RawDof>,
    pub(super) elements: Option<Vec<RawElement>>,
    pub(super) lines: SourceLines,
}

/// Reads `sector.json` and the tables of the archive at `path`, with the lines of the tables' rows.
pub(super) fn load_tables(path: &Path, limits: &Limits) -> Result<Stated, PackageError> {
    let Tables { manifest, nodes, dofs, elements, .. } = read_tables(&Archive::open(path, limits)?, limits)?;
    let (elements, of_elements) = match elements {
        Some(table) => (Some(table.value.rows), table.value.lines),
        None => (None, Vec::new()),
    };
    let lines = SourceLines { nodes: nodes.value.lines, dofs: dofs.value.lines, elements: of_elements };
    Ok(Stated { manifest, nodes: nodes.value.rows, dofs: dofs.value.rows, elements, lines })
}

/// Part of a package that is read before the matrices.
struct Tables {
    manifest: Manifest,
    files: Files,
    nodes: Hashed<Table<RawNode>>,
    dofs: Hashed<Table<RawDof>>,
    elements: Option<Hashed<Table<RawElement>>>,
}

fn read_tables(archive: &Archive, limits: &Limits) -> Result<Tables, PackageError> {
    let manifest = read_manifest(archive, limits)?;
    // Before anything it names is read, so that nonsense is refused early.
    check::statement::check(&manifest)?;
    let files = Files::resolve(archive, &manifest)?;
    let nodes = read_table(archive, &files.nodes, |source| tables::read_nodes(source, limits.table_rows))?;
    let dofs = read_table(archive, &files.dofs, |source| tables::read_dofs(source, limits.table_rows))?;
    let elements = match (&files.elements, &manifest.mesh) {
        (Some(file), Some(mesh)) => {
            Some(read_table(archive, file, |source| tables::read_elements(source, limits.table_rows, mesh))?)
        }
        _ => None,
    };
    Ok(Tables { manifest, files, nodes, dofs, elements })
}

/// Names under which the files are stored in the archive.
struct Files {
    mass: String,
    stiffness: Vec<String>,
    gyroscopic: Option<String>,
    nodes: String,
    dofs: String,
    elements: Option<String>,
}

impl Files {
    /// Files of the mass, stiffness and gyroscopic matrices, in this order, with their symmetry.
    fn matrices(&self) -> Vec<(&String, Mirror)> {
        std::iter::once(&self.mass)
            .chain(&self.stiffness)
            .map(|file| (file, Mirror::Symmetric))
            .chain(self.gyroscopic.iter().map(|file| (file, Mirror::Skew)))
            .collect()
    }

    /// Finds every file the manifest names, and no other.
    fn resolve(archive: &Archive, manifest: &Manifest) -> Result<Self, PackageError> {
        let mut roles: Vec<(&str, &'static str)> = vec![(MANIFEST_FILE, "the manifest")];
        let mut resolve = |field: String, name: &str, role: &'static str| {
            let problem = |problem| Err(PackageError::manifest(field.clone(), problem));
            let Some(inside) = inside(name).filter(|inside| !inside.is_empty()) else {
                return problem(ManifestProblem::BadFileName { name: quoted(name) });
            };
            let Some(stored) = archive.stored_name(&inside) else {
                return problem(missing(archive, &inside));
            };
            match roles.iter().find(|(file, other)| *file == stored && *other != role) {
                Some(&(_, role)) => {
                    return problem(ManifestProblem::FileInTwoRoles { file: stored.to_owned(), role });
                }
                None => roles.push((stored, role)),
            }
            Ok(stored.to_owned())
        };
        let files = Self {
            mass: resolve("/mass".to_owned(), &manifest.mass, "the mass matrix")?,
            // Naming one stiffness matrix at several speeds is a valid way to say that there is no stiffening.
            stiffness: (manifest.stiffness.iter().enumerate())
                .map(|(k, name)| resolve(format!("/stiffness/{k}"), name, "a stiffness matrix"))
                .collect::<Result<_, _>>()?,
            gyroscopic: (manifest.gyroscopic.as_ref())
                .map(|name| resolve("/gyroscopic".to_owned(), name, "the gyroscopic matrix"))
                .transpose()?,
            nodes: resolve("/nodes".to_owned(), &manifest.nodes, "the node table")?,
            dofs: resolve("/dofs".to_owned(), &manifest.dofs, "the DOF table")?,
            elements: (manifest.mesh.as_ref())
                .map(|mesh| resolve("/mesh/elements".to_owned(), &mesh.elements, "the element table"))
                .transpose()?,
        };
        match archive.names().find(|name| roles.iter().all(|(file, _)| file != name)) {
            Some(surplus) => Err(PackageError::archive(surplus.to_owned(), ArchiveProblem::Surplus)),
            None => Ok(files),
        }
    }
}

pub(super) fn missing(archive: &Archive, file: &str) -> ManifestProblem {
    let found_in = archive.names().find_map(|name| name.strip_suffix(file)?.strip_suffix('/'));
    ManifestProblem::FileMissing { file: quoted(file), found_in: found_in.map(quoted) }
}

/// Content of `sector.json`.
pub(super) fn manifest_text(archive: &Archive, limits: &Limits) -> Result<Vec<u8>, PackageError> {
    let Some(file) = archive.stored_name(MANIFEST_FILE) else {
        return Err(PackageError::manifest("", missing(archive, MANIFEST_FILE)));
    };
    let read = archive.read(file, |source| {
        let mut text = Vec::new();
        source
            .take(limits.manifest_bytes + 1)
            .read_to_end(&mut text)
            .map_err(|error| archive.fault(file, error))?;
        if text.len() as u64 > limits.manifest_bytes {
            let problem = ManifestProblem::TooLarge { limit_bytes: limits.manifest_bytes };
            return Err(PackageError::manifest("", problem));
        }
        Ok(text)
    })?;
    Ok(read.value)
}

fn read_manifest(archive: &Archive, limits: &Limits) -> Result<Manifest, PackageError> {
    manifest::parse(&manifest_text(archive, limits)?)
}

fn read_table<T>(
    archive: &Archive,
    file: &str,
    read: impl FnOnce(&mut dyn Read) -> Result<Table<T>, Fault<TableProblem>>,
) -> Result<Hashed<Table<T>>, PackageError> {
    archive.read(file, |source| {
        read(source).map_err(|fault| match fault {
            Fault::Io(error) => archive.fault(file, error),
            Fault::At { line, problem } => PackageError::Table { file: file.to_owned(), line, problem },
        })
    })
}

fn read_matrix(
    path: &Path,
    archive: &Archive,
    file: &str,
    mirror: Mirror,
    dofs: usize,
    limits: &Limits,
) -> Result<Hashed<RawMatrix>, PackageError> {
    if MatrixFormat::of(file) == MatrixFormat::Npz {
        return npz::read(archive, file, mirror, dofs, limits);
    }
    archive.read(file, |source| {
        matrix_market::read(source, mirror, dofs, limits)
            .map_err(|fault| match fault {
                Fault::Io(error) => archive.fault(file, error),
                Fault::At { line, problem } => {
                    PackageError::Matrix { file: file.to_owned(), line: Some(line), problem }
                }
            })?
            .map_err(|problem| {
                let (line, problem) = located(path, file, mirror, limits, problem);
                PackageError::Matrix { file: file.to_owned(), line, problem }
            })
    })
}

/// Reads the file once more, as far as needed, to add to the error the lines of the entries that contradict each other.
fn located(
    path: &Path,
    file: &str,
    mirror: Mirror,
    limits: &Limits,
    problem: MatrixProblem,
) -> (Option<u64>, MatrixProblem) {
    let places = |row, column, or_mirrored| {
        // A fresh archive, because this pass must not count against the expansion limit again.
        let archive = Archive::open(path, limits)?;
        archive.inflate(file, |source| {
            matrix_market::places_of(source, mirror, row, column, or_mirrored).map_err(|_| {
                let problem = ArchiveProblem::Damaged { reason: "second pass".to_owned() };
                PackageError::archive(file.to_owned(), problem)
            })
        })
    };
    match problem {
        MatrixProblem::Repeated { row, column, mirrored, .. } => {
            let found = places(row, column, mirrored).unwrap_or_default();
            let line = |k: usize| found.get(k).map(|place| place.line);
            let alike = found.windows(2).any(|pair| pair[0].mirrored == pair[1].mirrored);
            let mirrored = mirrored && !alike;
            (line(1), MatrixProblem::Repeated { row, column, first_line: line(0), mirrored })
        }
        MatrixProblem::NotSymmetric { skew, row, column, value, mirrored, count, .. } => {
            let found = places(row, column, true).unwrap_or_default();
            let line_of =
                |mirrored| found.iter().find(|place| place.mirrored == mirrored).map(|place| place.line);
            let (line, mirrored_line) = (line_of(false), line_of(true));
            let problem = MatrixProblem::NotSymmetric {
                skew,
                row,
                column,
                value,
                mirrored,
                line,
                mirrored_line,
                count,
            };
            (line.or(mirrored_line), problem)
        }
        MatrixProblem::SkewDiagonal { row, .. } => {
            let found = places(row, row, false).unwrap_or_default();
            (found.first().map(|place| place.line), problem)
        }
        problem => (None, problem),
    }
}
