//! Bases of reductions, as files of which single rows can be read:
//! `bases/<model>-<modes_per_speed>/<version>-<layout>-harmonic-<nodal diameter>`.
//!
//! Files, not rows of the database: a large model has gigabytes of them, a sweep reads a few rows, and all can be computed again.
//!
//! ```text
//! header   "rubbasis" | DOF, u64 | unknowns, u64 | SHA-256 of M_r | SHA-256 of what stands before
//! row      real, imaginary part of every unknown, f64 | the first 8 bytes of SHA-256(DOF, u64 | row)        one for each own DOF
//! ```
//!
//! All numbers are little-endian. M_r tells whether a file belongs to the reduction beside which it lies.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use faer::{Mat, MatRef, c64};
use sha2::{Digest, Sha256};

use super::error::StoreError;
use super::folders::{file_name, folder_name, model_of, prefix, remove_files_but, remove_folders};
use super::handle::Store;
use super::reserve::{self, Reserve};
use super::unfinished::unfinished_file;
use crate::dynamics::node_rows::NodeRows;
use crate::dynamics::nodes::SectorNode;
use crate::dynamics::reduction::{BasisRows, ReducedHarmonic, ReducedWheel};

/// Name of the folder that has them all, in the data folder.
const FOLDER: &str = "bases";

/// Layout of the files: raise it when it changes, so that old ones are computed again instead of misread.
const LAYOUT: i64 = 1;

const MAGIC: &[u8; 8] = b"rubbasis";
const HEADER: usize = 8 + 8 + 8 + 32 + 32;
const COMPLEX: usize = 16;
/// Bytes of a row's checksum.
const CHECK: usize = 8;

/// Rows that are read at once.
const BLOCK: usize = 256;

/// Room on the disk that a basis leaves to what cannot be computed again.
const LEFT_FREE: u64 = 4 * reserve::BYTES;

/// The basis of one reduction.
#[derive(Debug, Clone)]
pub struct BasisFolder {
    data: PathBuf,
    folder: PathBuf,
    reserve: Reserve,
}

impl Store {
    /// The basis of the reduction of `model`.
    pub fn basis(&self, model: &str, modes_per_speed: u32) -> BasisFolder {
        BasisFolder::of(&self.folder, &folder_name(model, modes_per_speed), self.reserve.clone())
    }

    fn bases_root(&self) -> PathBuf {
        self.folder.join(FOLDER)
    }

    /// Removes the bases of all reductions of a model that is gone. What cannot be removed is left to the next start.
    pub(super) async fn remove_bases(&self, model: &str) {
        if let Err(error) = remove_folders(&self.bases_root(), |name| model_of(name) == model).await {
            tracing::warn!(model.id = model, %error, "could not remove the bases of its reductions");
        }
    }

    /// Removes bases of models that are gone and of other versions of the program, and files that were never finished.
    pub(super) async fn remove_stale_bases(&self) -> Result<(), StoreError> {
        let models = sqlx::query_scalar("select id from models").fetch_all(&self.readers).await?;
        let models: BTreeSet<String> = models.into_iter().collect();
        let root = self.bases_root();
        remove_folders(&root, |name| !models.contains(model_of(name))).await?;
        remove_files_but(&root, &prefix(LAYOUT)).await?;
        Ok(())
    }
}

impl BasisFolder {
    /// The folder `name` in the data folder `data`.
    pub(super) fn of(data: &Path, name: &str, reserve: Reserve) -> Self {
        Self { data: data.to_owned(), folder: data.join(FOLDER).join(name), reserve }
    }

    /// Keeps the basis of a nodal diameter as well as it can: without it a sweep that reads nodes reduces once more.
    pub(super) fn keep(&self, rows: &BasisRows<'_>) {
        let harmonic = rows.harmonic();
        let bytes = (HEADER + rows.dofs() * row_bytes(rows.unknowns())) as u64;
        let kept = match reserve::free_bytes(&self.data) {
            Ok(free) if self.reserve.is_taken() || free < bytes.saturating_add(LEFT_FREE) => {
                Err(ErrorKind::StorageFull.into())
            }
            _ => self.write(rows),
        };
        match kept {
            Ok(()) => {
                tracing::debug!(harmonic, bytes, folder = file_name(&self.folder), "kept a basis");
            }
            Err(error) => {
                tracing::warn!(harmonic, bytes, folder = %self.folder.display(), %error, "could not keep a basis; going on without");
            }
        }
    }

    /// Rows of the basis of `reduced` at `nodes`.
    ///
    /// # Errors
    /// Of a file that is not there, is not what was written, or is of another reduction.
    pub fn rows(&self, reduced: &ReducedWheel, nodes: &[SectorNode]) -> io::Result<NodeRows> {
        let open = |reduced: &ReducedHarmonic| Opened::new(File::open(self.path(reduced.harmonic))?, reduced);
        let files: Vec<Opened> = reduced.harmonics.iter().map(open).collect::<io::Result<_>>()?;
        NodeRows::gather(nodes, reduced, |harmonic, dof| files[harmonic].row(dof))
    }

    /// Υ̂ X of a nodal diameter of `reduced`: `own DOF × columns` of `unknowns × columns`. Rows are read and multiplied in blocks, never
    /// held.
    ///
    /// # Errors
    /// As of [`Self::rows`].
    pub fn product(
        &self,
        reduced: &ReducedWheel,
        harmonic: usize,
        columns: MatRef<'_, c64>,
    ) -> io::Result<Mat<c64>> {
        let file = Opened::new(File::open(self.path(harmonic))?, &reduced.harmonics[harmonic])?;
        let mut product = Mat::zeros(file.dofs, columns.ncols());
        file.each(|dof, row| {
            for (unknown, value) in row.chunks_exact(2).enumerate() {
                let value = c64::new(value[0], value[1]);
                for column in 0..columns.ncols() {
                    product[(dof, column)] += value * columns[(unknown, column)];
                }
            }
        })?;
        Ok(product)
    }

    fn path(&self, harmonic: usize) -> PathBuf {
        self.folder.join(format!("{}harmonic-{harmonic}", prefix(LAYOUT)))
    }

    fn write(&self, rows: &BasisRows<'_>) -> io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        // Written whole and flushed before it gets its name: a name promises a basis, whenever the power fails.
        let file = unfinished_file(&self.folder, "unfinished-")?;
        let mut out = BufWriter::with_capacity(1 << 20, file.as_file());
        out.write_all(&header(rows.dofs(), rows.unknowns(), &rows.mark()))?;
        let mut row = Vec::with_capacity(row_bytes(rows.unknowns()));
        for dof in 0..rows.dofs() {
            row.clear();
            row.extend(rows.row(dof).flat_map(f64::to_le_bytes));
            row.extend(check(dof, &row));
            out.write_all(&row)?;
        }
        out.flush()?;
        drop(out);
        file.as_file().sync_all()?;
        file.persist(self.path(rows.harmonic())).map_err(|error| error.error)?;
        File::open(&self.folder)?.sync_all()
    }
}

/// The file of one nodal diameter.
struct Opened {
    file: File,
    dofs: usize,
    unknowns: usize,
}

impl Opened {
    /// `file`, if it belongs to `reduced`.
    fn new(file: File, reduced: &ReducedHarmonic) -> io::Result<Self> {
        let mut found = [0; HEADER];
        file.read_exact_at(&mut found, 0)?;
        let dofs = u64::from_le_bytes(std::array::from_fn(|byte| found[8 + byte])) as usize;
        let unknowns = reduced.mass.ncols();
        if found != header(dofs, unknowns, &reduced.mark()) {
            return Err(damaged("it is not of this reduction"));
        }
        if file.metadata()?.len() != (HEADER + dofs * row_bytes(unknowns)) as u64 {
            return Err(damaged("its length is not the one it had"));
        }
        Ok(Self { file, dofs, unknowns })
    }

    fn row(&self, dof: usize) -> io::Result<Vec<f64>> {
        if dof >= self.dofs {
            return Err(damaged("it has no such row"));
        }
        let length = row_bytes(self.unknowns);
        let mut bytes = vec![0; length];
        self.file.read_exact_at(&mut bytes, (HEADER + dof * length) as u64)?;
        self.checked(dof, &bytes)
    }

    /// All rows, one after the other.
    fn each(&self, mut take: impl FnMut(usize, &[f64])) -> io::Result<()> {
        let length = row_bytes(self.unknowns);
        let mut block = vec![0; length * BLOCK];
        for first in (0..self.dofs).step_by(BLOCK) {
            let bytes = &mut block[..length * BLOCK.min(self.dofs - first)];
            self.file.read_exact_at(bytes, (HEADER + first * length) as u64)?;
            for (dof, row) in (first..).zip(bytes.chunks_exact(length)) {
                take(dof, &self.checked(dof, row)?);
            }
        }
        Ok(())
    }

    /// The numbers of a row.
    fn checked(&self, dof: usize, bytes: &[u8]) -> io::Result<Vec<f64>> {
        let (row, sum) = bytes.split_at(COMPLEX * self.unknowns);
        if sum != check(dof, row) {
            return Err(damaged("its bytes are not those that were written"));
        }
        let number = |bytes: &[u8]| f64::from_le_bytes(std::array::from_fn(|byte| bytes[byte]));
        Ok(row.chunks_exact(8).map(number).collect())
    }
}

fn row_bytes(unknowns: usize) -> usize {
    COMPLEX * unknowns + CHECK
}

fn header(dofs: usize, unknowns: usize, mark: &[u8; 32]) -> [u8; HEADER] {
    let mut bytes = Vec::with_capacity(HEADER);
    bytes.extend(MAGIC);
    bytes.extend((dofs as u64).to_le_bytes());
    bytes.extend((unknowns as u64).to_le_bytes());
    bytes.extend(mark);
    bytes.extend(Sha256::digest(&bytes));
    std::array::from_fn(|byte| bytes[byte])
}

fn check(dof: usize, row: &[u8]) -> [u8; CHECK] {
    let sum = Sha256::new().chain_update((dof as u64).to_le_bytes()).chain_update(row).finalize();
    std::array::from_fn(|byte| sum[byte])
}

fn damaged(how: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, how)
}
