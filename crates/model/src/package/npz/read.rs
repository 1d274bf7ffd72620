//! Reader of matrices as scipy writes them.

use std::fs::File;
use std::io::BufReader;

use sha2::{Digest, Sha256};
use zip::ZipArchive;
use zip::result::ZipError;

use crate::package::archive::{Archive, Hashed, storage};
use crate::package::error::{ExpectedShape, MatrixProblem, NpzProblem, PackageError};
use crate::package::limits::Limits;
use crate::package::npy::{Npy, NpyFault};
use crate::package::quote::quoted;
use crate::package::raw::RawMatrix;
use crate::package::symmetric::{self, Entry, Mirror};

/// Largest number of entries for which room is reserved on a header's word; more room is made as entries really come.
const TRUSTED_ENTRIES: u64 = 1 << 22;

/// Reads a matrix of `dofs` rows.
pub(crate) fn read(
    archive: &Archive,
    file: &str,
    mirror: Mirror,
    dofs: usize,
    limits: &Limits,
) -> Result<Hashed<RawMatrix>, PackageError> {
    let wrong = |problem: NpzProblem| PackageError::matrix(file, problem.into());
    let mut arrays = Arrays::open(archive, file)?;
    let format = arrays.read("format", |npy| npy.text())?;
    let names: &[&str] = match &format[..] {
        "csr" | "csc" => &["format", "shape", "data", "indices", "indptr"],
        "coo" => &["format", "shape", "data", "row", "col"],
        _ => return Err(wrong(NpzProblem::Format { format: quoted(&format) })),
    };
    // `_is_array` tells scipy which of its two classes to make; the matrix is the same.
    let known =
        |entry: &str| entry.strip_suffix(".npy").is_some_and(|n| n == "_is_array" || names.contains(&n));
    if let Some(array) = arrays.names().into_iter().find(|entry| !known(entry)) {
        return Err(wrong(NpzProblem::Surplus { array: quoted(&array), format }));
    }
    let (rows, columns) = arrays.shape()?;
    if rows != columns {
        return Err(PackageError::matrix(file, MatrixProblem::NotSquare { rows, columns }));
    }
    if rows != dofs as u64 {
        return Err(PackageError::matrix(file, MatrixProblem::SizeDisagrees { rows, dofs }));
    }
    let mut triangles = Triangles { mirror, lower: Vec::new(), upper: Vec::new(), not_finite: None };
    if format == "coo" {
        let row = arrays.indices("row", dofs, limits)?;
        let column = arrays.indices("col", dofs, limits)?;
        let same_length = |npy: &Npy<'_>| match npy.length()? {
            length if length == row.len() as u64 => Ok(()),
            _ => Err(npy.shape_problem(ExpectedShape::AsOf { length: row.len(), array: "row" })),
        };
        if column.len() != row.len() {
            let found = vec![column.len() as u64];
            let expected = ExpectedShape::AsOf { length: row.len(), array: "row" };
            return Err(wrong(NpzProblem::Shape { array: "col", found, expected }));
        }
        arrays.read("data", |npy| {
            same_length(&npy)?;
            npy.reals(|k, value| {
                triangles.push(row[k as usize], column[k as usize], value);
                Ok(())
            })
        })?;
    } else {
        let indices = arrays.indices("indices", dofs, limits)?;
        let starts = arrays.pointers(dofs, indices.len() as u64)?;
        let mut major = 0;
        arrays.read("data", |npy| {
            if npy.length()? != indices.len() as u64 {
                return Err(npy
                    .shape_problem(ExpectedShape::AsOf { length: indices.len(), array: "indices" })
                    .into());
            }
            npy.reals(|k, value| {
                while major < dofs && starts[major + 1] <= k {
                    major += 1;
                }
                // scipy ignores what is stored behind the last pointer.
                if major < dofs {
                    let (major, minor) = (major as u32, indices[k as usize]);
                    let (row, column) = if format == "csr" { (major, minor) } else { (minor, major) };
                    triangles.push(row, column, value);
                }
                Ok(())
            })
        })?;
    }
    let value = triangles.matrix(dofs).map_err(|problem| PackageError::matrix(file, problem))?;
    Ok(Hashed { value, sha256: arrays.sha256() })
}

/// Entries folded into the lower triangle, by the triangle they were stored in.
struct Triangles {
    mirror: Mirror,
    lower: Vec<Entry>,
    upper: Vec<Entry>,
    /// First entry that is not a finite number, counted from 1.
    not_finite: Option<(u64, u64)>,
}

impl Triangles {
    fn push(&mut self, row: u32, column: u32, value: f64) {
        if !value.is_finite() && self.not_finite.is_none() {
            self.not_finite = Some((u64::from(row) + 1, u64::from(column) + 1));
        }
        let entry = self.mirror.folded(row, column, value);
        if row >= column {
            self.lower.push(entry);
        } else {
            self.upper.push(entry);
        }
    }

    fn matrix(self, size: usize) -> Result<RawMatrix, MatrixProblem> {
        match self.not_finite {
            Some((row, column)) => Err(MatrixProblem::NotFinite { row, column }),
            None => symmetric::from_any(self.mirror, size, self.lower, self.upper),
        }
    }
}

/// Arrays of one `.npz` file, each hashed as it is read.
struct Arrays<'a> {
    archive: &'a Archive,
    file: &'a str,
    zip: ZipArchive<BufReader<File>>,
    hashes: Vec<(&'static str, [u8; 32])>,
}

impl<'a> Arrays<'a> {
    fn open(archive: &'a Archive, file: &'a str) -> Result<Self, PackageError> {
        let wrong = |problem: NpzProblem| PackageError::matrix(file, problem.into());
        let zip = ZipArchive::new(BufReader::new(archive.spool(file)?)).map_err(|error| match error {
            ZipError::Io(error) if error.raw_os_error().is_some() => error.into(),
            error => wrong(NpzProblem::NotAZip { reason: error.to_string() }),
        })?;
        if zip.has_duplicate_names() {
            return Err(wrong(NpzProblem::Repeated));
        }
        Ok(Self { archive, file, zip, hashes: Vec::new() })
    }

    /// Names of the zip entries, as far as they are text.
    fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.zip.file_names().flatten().map(|name| name.into_owned()).collect();
        names.sort_unstable();
        names
    }

    fn read<T>(
        &mut self,
        array: &'static str,
        read: impl FnOnce(Npy<'_>) -> Result<T, NpyFault>,
    ) -> Result<T, PackageError> {
        let wrong = |problem: NpzProblem| PackageError::matrix(self.file, problem.into());
        let entry = format!("{array}.npy");
        let Some(index) = self.zip.index_for_name(&entry) else {
            return Err(wrong(NpzProblem::Missing { array }));
        };
        let place = format!("{}/{entry}", self.file);
        let source = self.zip.by_index(index).map_err(|error| storage(&place, error))?;
        let read = self.archive.hash(&place, self.archive.counted(source), |source| {
            Npy::open(array, source).and_then(read).map_err(|fault| match fault {
                NpyFault::Io(error) => self.archive.fault(&place, error),
                NpyFault::Problem(problem) => wrong(problem),
            })
        })?;
        self.hashes.push((array, read.sha256));
        Ok(read.value)
    }

    fn shape(&mut self) -> Result<(u64, u64), PackageError> {
        let shape = self.read("shape", |npy| {
            if npy.length()? != 2 {
                return Err(npy.shape_problem(ExpectedShape::Pair).into());
            }
            let mut shape = [0; 2];
            npy.integers(|k, size| {
                shape[k as usize] = size.max(0) as u64;
                Ok(())
            })?;
            Ok(shape)
        })?;
        Ok((shape[0], shape[1]))
    }

    /// Reads the indices of rows or columns, each below `size`.
    fn indices(
        &mut self,
        array: &'static str,
        size: usize,
        limits: &Limits,
    ) -> Result<Vec<u32>, PackageError> {
        let mut too_many = None;
        let indices = self.read(array, |npy| {
            let length = npy.length()?;
            if length > limits.matrix_entries as u64 {
                too_many = Some(length);
                return Ok(Vec::new());
            }
            let mut indices = Vec::with_capacity(length.min(TRUSTED_ENTRIES) as usize);
            npy.integers(|position, value| {
                if !(0..size as i64).contains(&value) {
                    return Err(NpzProblem::IndexOutOfRange { array, position, value, size });
                }
                indices.push(value as u32);
                Ok(())
            })?;
            Ok(indices)
        })?;
        match too_many {
            None => Ok(indices),
            Some(entries) => {
                let problem = MatrixProblem::TooManyEntries { entries, limit: limits.matrix_entries };
                Err(PackageError::matrix(self.file, problem))
            }
        }
    }

    /// Reads the `size + 1` pointers to the starts of the rows or columns.
    fn pointers(&mut self, size: usize, entries: u64) -> Result<Vec<u64>, PackageError> {
        self.read("indptr", |npy| {
            if npy.length()? != size as u64 + 1 {
                return Err(npy.shape_problem(ExpectedShape::OneMoreThanRows { length: size + 1 }).into());
            }
            let mut pointers: Vec<u64> = Vec::with_capacity(size + 1);
            npy.integers(|position, value| {
                let smallest = pointers.last().copied().unwrap_or(0);
                let first = pointers.is_empty();
                match u64::try_from(value) {
                    Ok(start) if (smallest..=entries).contains(&start) && (!first || start == 0) => {
                        pointers.push(start);
                        Ok(())
                    }
                    _ => Err(NpzProblem::Pointer { position, value, entries }),
                }
            })?;
            Ok(pointers)
        })
    }

    /// SHA-256 over all arrays read, under their names; how they are zipped does not count.
    fn sha256(mut self) -> [u8; 32] {
        self.hashes.sort_unstable();
        let mut total = Sha256::new();
        for (name, hash) in self.hashes {
            total.update(name);
            total.update([0]);
            total.update(hash);
        }
        total.finalize().into()
    }
}
